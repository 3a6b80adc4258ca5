"""Packages of extras: if one is missing, an error names its purpose and how to install it."""

from __future__ import annotations

import pickle
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from stridula.extras import NEEDED, MissingPackage, how_to_install, missing, named_extras, on_first_use, require

ROOT = Path(__file__).resolve().parents[2]
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
# An interpreter in which packages appear not to be installed.
WITHOUT = """
import sys
from importlib.machinery import PathFinder
found = PathFinder.find_spec
PathFinder.find_spec = lambda name, *where: None if name.partition(".")[0] in {packages!r} else found(name, *where)
"""
# Actions of a user without any of them, and the error up to the name of the package.
IN_PYTHON = {
    "st.load_scenario('squeal')": "scenarios need pydantic",
    "st.sweep": "scenarios need pydantic",
    "st.report": "scenarios need pydantic",
    "st.load('a.nc')": "records in files need h5netcdf",
    "st.save(xr.Dataset(), 'b.nc')": "records and meshes in files need h5py",
    "st.SolidMesh.read('a.msh')": "meshes in files need meshio",
    "st.MeshProfile.read('a.msh')": "meshes in files need meshio",
    "st.read_wav('a.wav')": "sound files need soundfile",
    "st.write_wav('a.wav', heard)": "sound files need soundfile",
    "st.read_signal('a.wav')": "sound files need soundfile",
    "st.read_signal('a.tdms')": "TDMS files need nptdms",
    "st.read_signal('a.mf4')": "MDF files need asammdf",
    "st.loudness(heard)": "loudness, sharpness and roughness need mosqito",
    "st.plot.overview": "figures need matplotlib",
    "from stridula.plot import regime_map": "figures need matplotlib",
    "st.verification.verify()": "figures need matplotlib",
}
GIVEN = """
import numpy as np, stridula as st, xarray as xr
for name in ("a.msh", "a.nc"):
    open(name, "w").write("$MeshFormat")
time = np.arange(48000) / 48000
heard = xr.DataArray(np.sin(time), {"time": time}, "time", "pressure", {"units": "Pa"})
"""
EACH = """
for code in CODES:
    try:
        exec(code)
        print("nothing")
    except Exception as error:
        print(type(error).__name__ + ": " + str(error))
"""
# Commands with the command line installed, but not the package of the command.
VERBS = {
    ("run", "squeal", "--plot", "a.png"): "figures need matplotlib",
    ("run", "squeal", "--wav", "a.wav"): "sound files need soundfile",
    ("report", "belt", "--out", "a.html"): "reports need jinja2",
    ("verify",): "figures need matplotlib",
    ("app", "--no-browser"): "the page needs uvicorn",
}
EACH_VERB = """
from stridula.cli import main
for words in VERBS:
    sys.argv = ["stridula", *words]
    try:
        main()
    except SystemExit as stop:
        print(stop.code)
"""


def run_without(packages: set[str], code: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run code where packages are missing."""
    command = [sys.executable, "-c", WITHOUT.format(packages=packages) + code]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, timeout=300, check=False)


def line(beginning: str) -> str:
    """Return the complete line."""
    package = beginning.rpartition(" ")[2]
    return f'{beginning}, which is not installed: pip install ".[{NEEDED[package][1]}]" in the source folder'


def test_in_python_the_error_names_the_extra(tmp_path):
    done = run_without({*NEEDED}, f"CODES = {[*IN_PYTHON]!r}\n{GIVEN}{EACH}", tmp_path)
    said = dict(zip(IN_PYTHON, done.stdout.splitlines(), strict=True))
    assert said == {code: f"MissingPackage: {line(beginning)}" for code, beginning in IN_PYTHON.items()}, done.stderr


def test_the_command_line_reports_it_in_one_line_before_it_runs(tmp_path):
    packages = {"jinja2", "matplotlib", "soundfile", "starlette", "uvicorn"}
    done = run_without(packages, f"VERBS = {[*VERBS]!r}\n{EACH_VERB}", tmp_path)
    assert done.stderr.splitlines() == [f"stridula: {line(beginning)}" for beginning in VERBS.values()]
    assert done.stdout.split() == ["2"] * len(VERBS)
    assert not [*tmp_path.iterdir()]


def test_without_a_command_line_the_command_reports_it(tmp_path):
    done = run_without({"typer"}, "sys.argv = ['stridula', 'list']\nfrom stridula.cli import main\nmain()", tmp_path)
    assert (done.returncode, done.stderr) == (2, f"stridula: {line('the command line needs typer')}\n")


def test_other_missing_modules_keep_their_own_error():
    with pytest.raises(ModuleNotFoundError, match="No module named 'nothing_of_ours'") as caught, named_extras():
        import nothing_of_ours  # noqa: F401
    assert not isinstance(caught.value, MissingPackage)


def test_missing_names_stay_attribute_errors():
    with pytest.raises(AttributeError, match=r"module 'stridula\.plot' has no attribute 'overvew'"):
        on_first_use("stridula.plot", {}, "overvew")


def test_an_installed_package_is_not_reported(monkeypatch):
    require("pytest")
    monkeypatch.setitem(sys.modules, "soundfile", None)
    with pytest.raises(MissingPackage, match="soundfile"):
        require("soundfile")


def test_the_error_crosses_to_other_processes():
    error = pickle.loads(pickle.dumps(missing("meshio")))
    assert (str(error), error.name) == (str(missing("meshio")), "meshio")


def brought(extra: str) -> set[str]:
    """Return the packages of an extra and of the extras that it includes."""
    found = set()
    for text in EXTRAS[extra]:
        name, inner = re.match(r"([\w-]+)(?:\[(.*?)\])?", text).groups()
        found |= {one for part in inner.split(",") for one in brought(part)} if name == "stridula" else {name}
    return found


@pytest.mark.parametrize("package", NEEDED)
def test_the_extra_that_is_named_brings_the_package(package):
    assert package in brought(NEEDED[package][1])


def test_all_of_the_command_line_and_the_page_comes_with_all():
    extras = ("cli", "files", "page", "plot", "report", "scenarios", "sound")
    assert brought("all") == {name for extra in extras for name in brought(extra)}
    assert how_to_install("all") == 'pip install ".[all]" in the source folder'
