"""Every benchmark runs in its short form, in which its sides agree; disagreement is reported in one line."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import stridula

FOLDER = Path(__file__).resolve().parents[2] / "benchmarks"
BENCHMARKS = sorted(
    path for path in FOLDER.glob("*.py") if '__name__ == "__main__"' in path.read_text(encoding="utf-8")
)
# Siconos runs under another Python without the package; the suite repeats all sections.
APART = ("siconos_march.py", "siconos_cones.py", "suite.py")


def short(path: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run the short form of a benchmark."""
    # No card is needed: numba has a simulator, which is selected on import.
    own = {"NUMBA_ENABLE_CUDASIM": "1"} if path.name == "gpu.py" else {}
    package = {"PYTHONPATH": str(Path(stridula.__file__).parents[1])}
    return subprocess.run(
        [sys.executable, path, "--short"], env=os.environ | package | own | environment, capture_output=True, text=True
    )


@pytest.mark.parametrize("path", [path for path in BENCHMARKS if path.name not in APART], ids=lambda path: path.stem)
def test_short_form(path):
    done = short(path)
    assert done.returncode == 0, done.stderr
    said = done.stdout.strip().splitlines()[-1].strip()
    if said.startswith("skipped: "):
        pytest.skip(said)
    assert said


@pytest.fixture
def copied(tmp_path):
    """Return a copy of the benchmarks, and a function that introduces an error."""
    shutil.copytree(FOLDER, tmp_path / "benchmarks", ignore=shutil.ignore_patterns("__pycache__"))

    def wrong(name: str, right: str, other: str) -> Path:
        path = tmp_path / "benchmarks" / name
        text = path.read_text(encoding="utf-8")
        assert text.count(right) == 1
        path.write_text(text.replace(right, other), encoding="utf-8")
        return path

    return wrong


def complaint(path: Path) -> str:
    done = short(path)
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    return line


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc is not installed, so there is no C to compare with")
@pytest.mark.parametrize(
    ("right", "other", "quantity"),
    [
        ("double *restrict raw)", "double *restrict raw, int more)", "march of step.c must take"),
        ("constants[GAP] + y", "constants[START] + y", "positions"),
        ("energies[FRICTION_LOSS] += fabs(tangential", "energies[FRICTION_LOSS] += fabs(normal", "ledgers"),
        ("columns[NORMAL_FORCE] += normal", "columns[NORMAL_FORCE] += tangential", "forces"),
        ("columns[SEPARATED + was] += closed", "columns[SEPARATED] += closed", "steps in each state"),
    ],
)
def test_another_step_in_c_is_refused(copied, right, other, quantity):
    assert complaint(copied("step.c", right, other).with_name("against_c.py")).startswith(quantity)


# Marches a brake whose points stick by the package and by each source in C, and prints their agreement.
STICKING = """
import sys, tempfile
from pathlib import Path

import brake
from against_c import built

pair = brake.Pair(brake.brake(turning=0.01), 1000)
(chunk,) = pair.march.copy().advance([pair.case.imposed], brake.STEPS // brake.RATIO)
print(chunk.contacts[:, ::2, brake.at.STICKING].mean())
for name in sys.argv[2:]:
    folder = tempfile.mkdtemp()
    try:
        brake.agree(pair.ours(), pair.theirs(built(Path(folder), Path(name), vars(brake.kernel))))
    except SystemExit as stop:
        print(stop)
    else:
        print("agree")
"""
WRONG_BRAKES = (
    ("ledger[DAMPING_LOSS] += lost + 0.25 * taken;", "ledger[DAMPING_LOSS] += lost;", "ledgers"),
    ("c[MATERIAL] - c[ANCHOR] : 0.0;", "c[MATERIAL] - 0.9 * c[ANCHOR] : 0.0;", "forces"),
)


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc is not installed, so there is no C to compare with")
def test_a_brake_that_sticks_agrees_with_c_and_another_c_is_refused(copied):
    """Also the distance from the anchor of a sticking point, which only such a brake has."""
    given = FOLDER / "brake.c"
    sources = [given]
    for number, (right, other, _) in enumerate(WRONG_BRAKES):
        path = copied("brake.c", right, other)
        sources.append(path.rename(path.with_name(f"wrong{number}.c")))
        shutil.copy(given, path)
    package = {"PYTHONPATH": os.pathsep.join([str(Path(stridula.__file__).parents[1]), str(FOLDER)])}
    done = subprocess.run(
        [sys.executable, "-c", STICKING, "--short", *map(str, sources)],
        env=os.environ | package,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    share, agreed, *complaints = done.stdout.splitlines()
    assert float(share) > 0.5
    assert agreed == "agree"
    for line, (*_, quantity) in zip(complaints, WRONG_BRAKES, strict=True):
        assert line.startswith(quantity)
        assert "brake.c" in line


WRONG_SIDES = {
    "many_runs.py": ("simulate_many(systems, workers=1", "simulate_many(systems[::-1], workers=1", "normal forces"),
    "maps.py": ('sweep("--workers", "1")', 'sweep("--set", "transverse=3")', "maps of one worker and of all"),
    "gpu.py": (
        "march_of(kind, few, at)",
        "march_of(kind, few[:: 1 - 2 * (kind is CudaMarch)], at)",
        "motion on the card",
    ),
}


@pytest.mark.parametrize("name", WRONG_SIDES)
def test_sides_that_do_not_agree_are_refused(copied, name):
    right, other, quantity = WRONG_SIDES[name]
    assert complaint(copied(name, right, other)).startswith(quantity)


def test_the_suite_has_every_section():
    sections = {path.stem for path in BENCHMARKS if "\nTITLE = " in path.read_text(encoding="utf-8")}
    suite = (FOLDER / "suite.py").read_text(encoding="utf-8")
    listed = suite.partition("SECTIONS = (")[2].partition(")")[0]
    assert {name.strip() for name in listed.split(",") if name.strip()} == sections
