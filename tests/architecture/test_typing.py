"""Types for users: stubs list names imported on first use, and a user's script is checked strictly."""

from __future__ import annotations

import ast
import inspect
import os
import pkgutil
import runpy
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import stridula
from stridula.integration.many import Options
from stridula.integration.settings import NAMES, Given

ROOT = Path(stridula.__file__).parent
SCRIPT = Path(__file__).with_name("user_script.py")
# Packages whose names are imported on first use.
LAZY = ["stridula", "stridula.acoustics", "stridula.plot", "stridula.scenarios", "stridula.studies"]
WRONG = {
    "a name that is not there": "import stridula as st\nst.simulat",
    "an argument of another kind": "import stridula as st\nst.Coulomb('much')",
    "a result taken for another": "import stridula as st\nx: int = st.sound_level(st.read_wav('a.wav'))",
    "an argument that is not there": "import stridula as st\nst.simulate_many([], 1.0, sample_rat=1.0)",
}


def homes_in_stub(text: str) -> dict[str, str]:
    """Return the module that each name of a stub comes from, empty for the package itself."""
    imports = [node for node in ast.parse(text).body if isinstance(node, ast.ImportFrom)]
    assert all(alias.asname == alias.name for node in imports for alias in node.names), "a stub exports X as X"
    return {alias.name: node.module or "" for node in imports for alias in node.names}


def homes_at_run_time(package: str) -> dict[str, str]:
    """Return the same for names imported on first use."""
    if package != "stridula":
        found = import_module(package)
        at_once = [name for name in found.__all__ if name not in found._HOME]
        return found._HOME | {name: getattr(found, name).__module__.rpartition(".")[2] for name in at_once}
    return stridula._MODULE | dict.fromkeys(stridula._PUBLIC, "") | {"__version__": "version"}


def checked_strictly(path: Path, folder: Path) -> str:
    """Return the output of mypy for a user's script."""
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file=", "--follow-imports=silent", str(path)]
    done = subprocess.run(
        [*command, "--cache-dir", str(folder)],
        env=os.environ | {"MYPYPATH": str(ROOT.parent)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert not done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """Cache of mypy for all tests here."""
    return tmp_path_factory.mktemp("mypy")


@pytest.mark.parametrize("package", LAZY)
def test_stubs_name_what_is_imported_on_first_use(package):
    stub = Path(import_module(package).__file__).with_suffix(".pyi")
    assert homes_in_stub(stub.read_text(encoding="utf-8")) == homes_at_run_time(package)


@pytest.mark.parametrize("package", LAZY)
def test_no_name_imported_on_first_use_is_that_of_a_module(package):
    """Whoever imports such a module first gets the module in place of the function, in the whole process."""
    found = import_module(package)
    on_first_use = set(getattr(found, "_MODULE", found._HOME))
    assert not on_first_use & {module.name for module in pkgutil.iter_modules(found.__path__)}


def test_types_of_results_are_known_for_every_argument():
    """Options that do not change the type are listed again, since those that do have one overload each."""
    given = inspect.signature(stridula.simulate_many).parameters.values()
    named = {one.name for one in given if one.kind is inspect.Parameter.KEYWORD_ONLY} - {"errors", "labelled"}
    assert named == set(Options.__annotations__)


def test_settings_are_typed_as_arguments():
    assert list(Given.__annotations__) == list(NAMES)


def test_every_package_that_imports_on_first_use_has_a_stub():
    """Type checkers accept any name of a module with a `__getattr__`, even a missing one."""
    lazy = {
        path.with_suffix(".pyi")
        for path in ROOT.rglob("__init__.py")
        if "def __getattr__" in path.read_text(encoding="utf-8")
    }
    assert lazy == set(ROOT.rglob("*.pyi"))
    assert len(lazy) == len(LAZY)


def test_the_package_is_marked_as_typed():
    assert (ROOT / "py.typed").is_file()


def test_a_script_of_users_is_typed(cache):
    assert checked_strictly(SCRIPT, cache).startswith("Success")


def test_a_script_that_is_wrong_is_refused(cache, tmp_path):
    """Negative control: one script, an error in each part."""
    found = []
    lines = []
    for text in WRONG.values():
        lines += text.splitlines()
        found.append(len(lines))
    script = tmp_path / "wrong.py"
    script.write_text("\n".join(lines), encoding="utf-8")
    said = checked_strictly(script, cache)
    assert all(f"wrong.py:{number}: error" in said for number in found), said


def test_the_script_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(SCRIPT))
    assert (tmp_path / "run.wav").stat().st_size > 10_000
