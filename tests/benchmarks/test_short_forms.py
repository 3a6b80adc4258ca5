"""Every benchmark runs in its short form, in which its sides agree; disagreement is reported in one line."""

from __future__ import annotations

import os
import runpy
import shutil
import subprocess
import sys
import tempfile
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import stridula
import stridula as st

FOLDER = Path(__file__).resolve().parents[2] / "benchmarks"
BENCHMARKS = sorted(
    path for path in FOLDER.glob("*.py") if '__name__ == "__main__"' in path.read_text(encoding="utf-8")
)
# Siconos and pyHarm run under another Python without the package; the suite repeats all sections.
APART = ("siconos_march.py", "siconos_cones.py", "siconos_faces.py", "pyharm_cycles.py", "suite.py")


@pytest.fixture(scope="module", autouse=True)
def benchmarks_forgotten():
    """Forget the modules of the benchmarks at the end: `ratios` knows from its import that forms are short."""
    yield
    for path in FOLDER.glob("*.py"):
        sys.modules.pop(path.stem, None)


def apart(path: Path, *words: str, **environment: str) -> tuple[str, str]:
    """Run a benchmark in a process of its own; return its complaint, empty if it succeeds, and its output."""
    package = {"PYTHONPATH": str(Path(stridula.__file__).parents[1])}
    done = subprocess.run(
        [sys.executable, path, *words], env=os.environ | package | environment, capture_output=True, text=True
    )
    assert (done.returncode, bool(done.stderr)) in ((0, False), (1, True)), done.stderr
    return done.stderr.rstrip("\n"), done.stdout


@pytest.fixture
def short(monkeypatch, capsys):
    """Return a function that runs the short form of a benchmark and returns its complaint and its output.

    It runs here, because imports would take longer. That of the card has a process of its own: no card is needed,
    since numba has a simulator, but that is selected on import.
    """

    def run(path: Path) -> tuple[str, str]:
        if path.name == "gpu.py":
            return apart(path, "--short", NUMBA_ENABLE_CUDASIM="1")
        monkeypatch.setattr(sys, "argv", [str(path), "--short"])
        monkeypatch.syspath_prepend(path.parent)
        complaint = ""
        try:
            runpy.run_path(str(path), run_name="__main__")
        except SystemExit as stop:
            complaint = str(stop.code or "")
        return complaint, capsys.readouterr().out

    return run


@pytest.mark.parametrize("path", [path for path in BENCHMARKS if path.name not in APART], ids=lambda path: path.stem)
def test_short_form(path, short):
    complaint, printed = short(path)
    assert not complaint
    said = printed.strip().splitlines()[-1].strip()
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
def test_another_step_in_c_is_refused(copied, short, right, other, quantity):
    complaint, _ = short(copied("step.c", right, other).with_name("against_c.py"))
    assert complaint.startswith(quantity)
    assert "\n" not in complaint


WRONG_BRAKES = (
    ("ledger[DAMPING_LOSS] += lost + 0.25 * taken;", "ledger[DAMPING_LOSS] += lost;", "ledgers"),
    ("c[MATERIALS[k]] - c[ANCHORS[k]] : 0.0;", "c[MATERIALS[k]] - 0.9 * c[ANCHORS[k]] : 0.0;", "forces"),
)


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc is not installed, so there is no C to compare with")
def test_a_brake_that_sticks_agrees_with_c_and_another_c_is_refused(copied, monkeypatch, tmp_path):
    """Also the distance from the anchor of a sticking point, which only such a brake has."""
    monkeypatch.setattr(sys, "argv", ["", "--short"])
    monkeypatch.syspath_prepend(FOLDER)
    brake, against_c = import_module("brake"), import_module("against_c")
    steps = 20
    pair = brake.Pair(brake.brake(turning=0.01), 1000, steps)
    (chunk,) = pair.march.copy().advance([pair.case.imposed], steps // brake.RATIO)
    assert chunk.contacts[:, :, brake.at.STICKING].mean() > 0.5
    ours = pair.ours()

    def agree(source: Path) -> None:
        folder = Path(tempfile.mkdtemp(dir=tmp_path))
        brake.agree(ours, pair.theirs(against_c.built(folder, source, vars(brake.kernel))))

    agree(FOLDER / "brake.c")
    for right, other, quantity in WRONG_BRAKES:
        path = copied("brake.c", right, other)
        with pytest.raises(SystemExit, match=rf"^{quantity} .*brake\.c.*") as stop:
            agree(path)
        assert "\n" not in stop.value.code
        shutil.copy(FOLDER / "brake.c", path)


def test_cycles_with_more_friction_do_not_agree_with_pyharm(monkeypatch, capsys):
    """Each set misses with 5 % more friction on one side; without the peer this is skipped."""
    monkeypatch.setattr(sys, "argv", ["", "--short"])
    monkeypatch.syspath_prepend(FOLDER)
    against = import_module("against_pyharm")
    if not against.installed():
        pytest.skip(f"no pyHarm in {against.PEER}")
    assert against.main(against.SEED, 0.05) == 1
    _, _, *lines = capsys.readouterr().out.splitlines()
    sets = lines[: 2 * against.EACH]
    assert all("MISSES" in line for line in sets)


def test_a_missing_pyharm_is_told(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["", "--short"])
    monkeypatch.syspath_prepend(FOLDER)
    against = import_module("against_pyharm")
    monkeypatch.setattr(against, "PEER", "no-such-python")
    assert against.main(against.SEED, 0.0) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("skipped: no pyHarm in no-such-python, nothing was compared")
    assert "pip install pyharm-os" in printed


WRONG_SIDES = {
    "many_runs.py": ("simulate_many(systems, workers=1", "simulate_many(systems[::-1], workers=1", "normal forces"),
    "maps.py": ('sweep("--workers", "1")', 'sweep("--set", "transverse=3")', "maps of one worker and of all"),
    "gpu.py": (
        "march_of(kind, few, at)",
        "march_of(kind, few[:: 1 - 2 * (kind is CudaMarch)], at)",
        "motion on the card",
    ),
    "random_faces.py": ("marched = solve(problem)", "marched = solve(plain)", "forces of all faces"),
}


@pytest.mark.parametrize("name", WRONG_SIDES)
def test_sides_that_do_not_agree_are_refused(copied, short, name):
    right, other, quantity = WRONG_SIDES[name]
    complaint, _ = short(copied(name, right, other))
    assert complaint.startswith(quantity)
    assert "\n" not in complaint


def test_the_suite_has_every_section():
    sections = {path.stem for path in BENCHMARKS if "\nTITLE = " in path.read_text(encoding="utf-8")}
    suite = (FOLDER / "suite.py").read_text(encoding="utf-8")
    listed = suite.partition("SECTIONS = (")[2].partition(")")[0]
    assert {name.strip() for name in listed.split(",") if name.strip()} == sections


def test_shares_of_damped_contacts_that_open_while_indented_are_shares(monkeypatch):
    """A random system in which a lining is let go before it has come out."""
    monkeypatch.setattr(sys, "argv", ["", "--short"])
    monkeypatch.syspath_prepend(FOLDER)
    system, *_ = import_module("random_systems").system_of("stiffness", "static-kinetic", 40)
    step = 1e-4 / 3.0
    run = st.simulate(system, 600 * step, step=step, sample_rate=1.0 / step, probes=[])
    assert run.status_share.values.min() >= 0.0
    assert run.status_share.values.max() <= 1.0


@pytest.mark.parametrize("seed", range(8))
def test_forces_of_faces_that_break_a_law_are_told(seed, monkeypatch):
    """Larger forces, one less, other friction, friction along the slip, and none; those of the kernel break none."""
    monkeypatch.setattr(sys, "argv", ["", "--short"])
    monkeypatch.syspath_prepend(FOLDER)
    problems, laws = import_module("face_problems"), import_module("face_laws")
    _, problem = problems.drawn(seed)
    forces = problems.solve(problem).forces
    assert laws.judge(problem, forces)[1].max() < 1e-9
    largest = np.argmax(forces[:, 0])
    without = np.where(np.arange(len(forces))[:, None] == largest, 0.0, forces)
    ways = [1.0, *[-1.0] * (forces.shape[1] - 1)]
    for wrong in (1.001 * forces, without, forces * ways, np.full_like(forces, np.nan), 0.0 * forces):
        assert not laws.judge(problem, wrong)[0].max() < 1e-6
    assert laws.judge(replace(problem, friction=0.9 * problem.friction), forces)[0].max() > 1e-6
