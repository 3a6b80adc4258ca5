"""Build wheel and sdist into dist/, look into both, and run the README's ten lines where only the wheel is installed.

`make dist` runs it. It downloads what the package depends on, and compiles the time march anew: some two minutes of a
processor.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DIST = ROOT / "dist"
COMPILED = (".pyc", ".nbi", ".nbc")
# What a build that forgets data would leave out.
IN_WHEEL = {
    "stridula/py.typed",
    "stridula/__init__.pyi",
    "stridula/scenarios/cases/squeal.toml",
    "stridula/scenarios/bases/laulagnet-2011.toml",
    "stridula/app/page/index.html",
    "stridula/app/page/vendor/three.module.min.js",
    "stridula/app/page/vendor/LICENSE-three.txt",
}
IN_SDIST = {"CHANGELOG.md", "CITATION.cff", "LICENSE", "Makefile", "README.md", "docs/conf.py", "tests/conftest.py"}
# Largest file [MB]: more is something that is not to be shipped.
LARGEST = {".whl": 2.0, ".gz": 8.0}
# What only extras bring.
NOT_IN_CORE = ("h5netcdf", "matplotlib", "meshio", "pydantic", "rich", "soundfile", "starlette", "typer", "uvicorn")
WITHOUT_EXTRAS = """
from importlib.util import find_spec
import stridula as st
assert not [name for name in NOT_IN_CORE if find_spec(name)], "an extra came with the package alone"
for wanted in (lambda: st.plot.overview, lambda: st.load_scenario("squeal"), lambda: st.load("squeal.nc")):
    try:
        wanted()
        raise AssertionError("an extra is not needed")
    except ImportError as error:
        print(error)
"""


def main() -> None:
    """Build and check; leave with a line on what is wrong."""
    wheel, sdist = build()
    with zipfile.ZipFile(wheel) as archive:
        check_contents(wheel, archive.namelist(), IN_WHEEL | package_files())
    with tarfile.open(sdist) as archive:
        names = [name.partition("/")[2] for name in archive.getnames()]
    check_contents(sdist, names, IN_SDIST | {f"src/{name}" for name in package_files()})
    with tempfile.TemporaryDirectory() as folder:
        check_installed(wheel, Path(folder))
    print(f"{wheel.name} and {sdist.name} are whole, and the wheel runs on its own")


def build() -> tuple[Path, Path]:
    """Build the sdist, and the wheel from it."""
    for old in DIST.glob("stridula-*"):
        old.unlink()
    subprocess.run([sys.executable, "-m", "build", "--no-isolation", "--outdir", DIST, ROOT], check=True)
    return next(DIST.glob("*.whl")), next(DIST.glob("*.tar.gz"))


def package_files() -> set[str]:
    """Return the files of the package as they lie in a wheel."""
    found = [path for path in (ROOT / "src" / "stridula").rglob("*") if path.is_file()]
    return {path.relative_to(ROOT / "src").as_posix() for path in found if is_shipped(path)}


def is_shipped(path: Path) -> bool:
    """Return whether a file is a source or data, not something that a run left there."""
    return "__pycache__" not in path.parts and path.suffix not in COMPILED


def check_contents(archive: Path, names: Iterable[str], needed: set[str]) -> None:
    """Stop if an archive lacks files, has compiled ones, or is too large."""
    there = set(names)
    if lacking := sorted(needed - there):
        raise SystemExit(f"{archive.name} lacks {', '.join(lacking)}")
    if compiled := sorted(name for name in there if not is_shipped(Path(name))):
        raise SystemExit(f"{archive.name} has compiled files: {', '.join(compiled)}")
    size, largest = archive.stat().st_size / 1e6, LARGEST[archive.suffix]
    if size > largest:
        raise SystemExit(f"{archive.name} must be at most {largest} MB, got {size:.1f} MB")


def check_installed(wheel: Path, folder: Path) -> None:
    """Install the wheel alone into an empty environment, run the ten lines there, and ask for what it lacks."""
    subprocess.run([sys.executable, "-m", "venv", folder / "alone"], check=True)
    programs = folder / "alone" / ("Scripts" if os.name == "nt" else "bin")
    python = programs / "python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", wheel], check=True)
    surroundings = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    script = folder / "ten_lines.py"
    script.write_text(ten_lines(), encoding="utf-8")
    said = subprocess.run(
        [python, "-W", "error", script], cwd=folder, env=surroundings, check=True, capture_output=True, text=True
    )
    print(said.stdout)
    if not re.search(r"squeals at 13\d\d Hz", said.stdout):
        raise SystemExit("the ten lines must end in a squeal of 1300 to 1399 Hz")
    code = f"NOT_IN_CORE = {NOT_IN_CORE!r}\n{WITHOUT_EXTRAS}"
    subprocess.run([python, "-c", code], cwd=folder, env=surroundings, check=True)
    command = subprocess.run(
        [programs / "stridula"], cwd=folder, env=surroundings, check=False, capture_output=True, text=True
    )
    if (command.returncode, command.stderr.count("\n")) != (2, 1) or "[cli]" not in command.stderr:
        raise SystemExit(f"without the extra cli the command must say so in a line, got {command.stderr!r}")


def ten_lines() -> str:
    """Return the first code of the README without its figure, which takes an extra."""
    code = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)[1]
    if "plot" not in code:
        raise SystemExit("the first code of README.md must draw a figure: what is left out here is that")
    without = code.replace("import analysis, plot\n", "import analysis\n")
    return "".join(line for line in without.splitlines(keepends=True) if "plot" not in line)


if __name__ == "__main__":
    main()
