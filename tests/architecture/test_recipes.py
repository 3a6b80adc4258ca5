"""Recipes of CONTRIBUTING for a law, a probe, a verb and a setting, followed in a copy of the package."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

import stridula
from stridula._kernels.layout.laws import CODES

Steps = Sequence[tuple[str, str, str]]

LAW = '''"""Friction that falls with the inverse of the slip speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..declared import Coefficient, Speed
from .friction_law import StaticAndKinetic


@dataclass(frozen=True)
class TrialWeakening(StaticAndKinetic):
    """Friction ``kinetic + (static - kinetic) / (1 + |v| / velocity)``."""

    law: ClassVar[str] = "trial weakening"
    static: Coefficient
    kinetic: Coefficient
    velocity: Speed

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march."""
        return {"static": self.static, "kinetic": self.kinetic, "velocity": self.velocity}

    @property
    def reach(self) -> float:
        """Slip speed [m/s] up to which its curve is characteristic, for plots."""
        return 5.0 * self.velocity

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""
        return self.kinetic + (self.static - self.kinetic) / (1.0 + np.abs(velocity) / self.velocity)

    def __str__(self) -> str:
        return f"trial, {self.static:.4g} to {self.kinetic:.4g} over {self.velocity:.3g} m/s"
'''
RATIO = """    if law.code == at.TRIAL_WEAKENING:
        return table[row, KINETIC] + (table[row, STATIC] - table[row, KINETIC]) / (1.0 + speed / table[row, VELOCITY])
"""
SCALE = """    if law.code == at.TRIAL_WEAKENING:
        return table[row, VELOCITY]
"""
END = """    if law.code == at.LINEAR_WEAKENING:
        return table[row, END]
"""
# The steps of a recipe: file, text there, text in its place.
LAW_STEPS = (
    (
        "_kernels/layout/columns.py",
        f"    SLIP,\n) = range({len(CODES)})\n",
        f"    TRIAL_WEAKENING,\n    SLIP,\n) = range({len(CODES) + 1})\n",
    ),
    (
        "_kernels/layout/laws.py",
        '    "SLIP": _RATE_AND_STATE,\n',
        '    "SLIP": _RATE_AND_STATE,\n    "TRIAL_WEAKENING": _WEAKENING,\n',
    ),
    ("_kernels/layout/laws.py", '_STICKS = {"COULOMB", ', '_STICKS = {"COULOMB", "TRIAL_WEAKENING", '),
    ("_kernels/contact/friction.py", "    if law.code == at.STRIBECK:\n", RATIO + "    if law.code == at.STRIBECK:\n"),
    (
        "_kernels/contact/friction.py",
        END,
        SCALE + END,
    ),
    (
        "contact/laws.py",
        "from .rate_and_state",
        "from .trial_weakening import TrialWeakening\nfrom .rate_and_state",
    ),
    ("contact/laws.py", "    RateAndState,\n", "    RateAndState,\n    TrialWeakening,\n"),
)
LAW_SCRIPT = """
import json
import numpy as np
import stridula as st
from scipy.integrate import solve_ivp
from stridula.contact.trial_weakening import TrialWeakening

law, mass, stiffness, load, belt = TrialWeakening(0.5, 0.3, 0.2), 1.0, 4e3, 10.0, 1.0
body = st.PointMass(mass, name="mass")
contact = st.PointContact(body.centre, st.RigidTrack(velocity=belt), friction=law)
drives = [st.Force(body.centre, y=-load), st.InitialVelocity(body, x=0.3)]
system = st.System(contact, drives, [st.Spring(body.centre, stiffness=stiffness, direction="x")])
run = st.simulate(system, 0.2, sample_rate=1e4, probes=[st.Displacement(body.centre, "x")])

def motion(t, y):
    return y[1], (load * float(law.coefficient_at(belt - y[1])) - stiffness * y[0]) / mass

known = solve_ivp(motion, (0.0, 0.2), (0.0, 0.3), t_eval=run.time.values, rtol=1e-11, atol=1e-14).y[0]
seen = run[next(name for name in run.data_vars if "displacement" in str(name))].values.ravel()
again = st.load_scenario(run).system.contacts[0].friction
print(json.dumps({"error": float(np.abs(seen - known).max() / np.ptp(known)), "read": again == law}))
"""
PROBE = '''@dataclass(frozen=True)
class Momentum(_Probe):
    """Momentum of a body along a direction [kg m/s], centred difference over two steps.

    Parameters
    ----------
    body : Body
        The body.
    direction : {"x", "y", "z"}, optional
        World direction.
    """

    quantity: ClassVar[str] = "momentum"
    on: ClassVar[str] = "body"
    body: Body
    direction: Annotated[str, Choice(("x", "y", "z"))] = "x"

    def __post_init__(self) -> None:
        check_body(self.body)
        check_declared(self)

    @property
    def place(self) -> str:
        """Direction, as text."""
        return self.direction

    @property
    def keys(self) -> dict[str, Any]:
        """Keys of its table in a scenario, besides quantity and body."""
        return {"direction": self.direction}


Probe = (
'''
ROWS = """@_rows_of.register
def _momentum_rows(probe: Momentum, coordinates: Coordinates, loads: list[Load], blank: ProbeRows) -> ProbeRows:
    matrix = np.zeros((3, coordinates.size))
    matrix[1] = coordinates.translation(probe.body)["xyz".index(probe.direction)]
    return replace(blank, rows=matrix)


@_rows_of.register
def _support_rows("""
VARIABLE = """    "momentum": Variable("momentum", "kg m/s", "momentum of bodies", "low-pass"),
    "support_force": """
PROBE_STEPS = (
    ("records/probes.py", "Probe = (\n", PROBE),
    ("records/probes.py", "    | ModalMotion\n)", "    | ModalMotion\n    | Momentum\n)"),
    ("records/variables.py", '    "support_force": ', VARIABLE),
    (
        "lowering/probe_rows.py",
        "import ConnectionForce, Probe, Reaction",
        "import ConnectionForce, Momentum, Probe, Reaction",
    ),
    ("lowering/probe_rows.py", "@_rows_of.register\ndef _support_rows(", ROWS),
    ("records/__init__.py", "    ModalVelocity,\n", "    ModalVelocity,\n    Momentum,\n"),
    ("records/__init__.py", '    "ModalVelocity",\n', '    "ModalVelocity",\n    "Momentum",\n'),
    ("__init__.py", '        "ModalVelocity",\n', '        "ModalVelocity",\n        "Momentum",\n'),
)
PROBE_SCRIPT = """
import json
from pathlib import Path
import numpy as np
import stridula as st

TOML = '''
[bodies.block]
kind = "point mass"
mass = 2
[[contacts]]
tip = {body = "block"}
track = {kind = "rigid"}
[[drives]]
kind = "initial velocity"
body = "block"
x = 0.5
[simulation]
duration = 0.02
sample_rate = 1000
probes = [{quantity = "velocity", body = "block", direction = "x"}, {quantity = "momentum", body = "block"}]
'''
Path("case.toml").write_text(TOML)
body = st.PointMass(2.0, name="block")
system = st.System(st.PointContact(body.centre, st.RigidTrack()), [st.InitialVelocity(body, x=0.5)])
probes = [st.Velocity(body.centre, "x"), st.Momentum(body)]
called = st.simulate(system, 0.02, sample_rate=1e3, probes=probes)
loaded = st.load_scenario("case.toml").simulate()
again = st.load_scenario(loaded).simulate()
same = [bool(np.array_equal(run.momentum, called.momentum)) for run in (loaded, again)]
ratio = called.momentum.values / called.velocity.values
names, units = list(called.momentum_probe.values), called.momentum.attrs["units"]
try:
    st.load_scenario("case.toml", {"simulation.probes.1.direction": "w"})
except st.ScenarioError as error:
    refused = str(error)
print(json.dumps({"same": same, "ratio": [ratio.min(), ratio.max()], "names": names, "units": units, "no": refused}))
"""
VERB = '''"""`stridula masses`: the masses of bodies."""

from __future__ import annotations

from ..scenarios.load import load_scenario


def print_masses(name: str, digits: int) -> None:
    """Print the mass of each body of a scenario [kg], in some digits."""
    system = load_scenario(name).system
    for body in system.bodies:
        print(f"{system.body_name(body)} {body.total_mass:.{digits}g} kg")
'''
COMMAND = '''@app.command()
def masses(
    name: NameOrFile, digits: Annotated[int, typer.Option(metavar="N", help="Digits of each.")] = 3
) -> None:
    """Print the masses of the bodies of a scenario."""
    from .masses import print_masses

    print_masses(name, digits)


@app.command()
def export('''
VERB_STEPS = (("cli/commands.py", "@app.command()\ndef export(", COMMAND),)
VERB_SCRIPT = """
import sys
from stridula.cli import main

sys.argv = ["stridula", *sys.argv[1:]]
main()
"""

# A setting that is noted in records: file, text there, text in its place.
SETTING_STEPS = (
    (
        "integration/settings.py",
        "    motion_rate: float | None\n",
        "    motion_rate: float | None\n    humidity: float\n",
    ),
    (
        "integration/settings.py",
        "    motion_rate: Frequency | None = None\n",
        "    motion_rate: Frequency | None = None\n    humidity: Coefficient = 0.5\n",
    ),
    (
        "integration/settings.py",
        "        If left out, only such probes, at the sample rate.\n",
        "        If left out, only such probes, at the sample rate.\n"
        "    humidity : float, optional\n        Humidity of the air [1]; noted in the record.\n",
    ),
    ("integration/settings.py", "import Frequency, Time, declared", "import Coefficient, Frequency, Time, declared"),
    (
        "integration/run.py",
        '            "state_layout": LAYOUT,\n',
        '            "state_layout": LAYOUT,\n            "humidity": self.settings.humidity,\n',
    ),
)
SETTING_SCRIPT = """
import inspect
import json
import stridula as st
from stridula.integration.many import Options
from stridula.integration.settings import Given

def refused(call, *given, **options):
    try:
        call(*given, **options)
    except ValueError as error:
        return str(error)

def noted(run):
    return run.attrs["humidity"]

body = st.PointMass(1.0, name="mass")
contact = st.PointContact(body.centre, st.RigidTrack(velocity=1.0), friction=st.Coulomb(0.3))
system = st.System(contact, [st.Force(body.centre, y=-1.0)])
run = st.simulate(system, 0.01, humidity=0.7)
again = st.load_scenario(run)

def made(mass):
    return system, {"duration": 0.01, "humidity": mass}

functions = st.simulate, st.simulate_many
print(json.dumps({
    "by default": noted(st.simulate(system, 0.01)),
    "alone": noted(run),
    "side by side": [noted(one) for one in st.simulate_many([system] * 4, 0.01, humidity=0.2)],
    "read from a record": again.humidity,
    "run again": noted(again.simulate()),
    "set by key": noted(st.load_scenario(run, {"humidity": "30 %"}).simulate()),
    "swept": st.sweep(run, {"humidity": [0.1, 0.9]}, {"noted": noted}, workers=1).noted.values.tolist(),
    "made": st.sweep(made, {"mass": [0.4, 0.6]}, {"noted": noted}, workers=1).noted.values.tolist(),
    "refused": refused(st.simulate, system, 0.01, humidity=-1.0),
    "refused in tables": refused(st.load_scenario, run, {"humidity": -1.0}),
    "described": st.scenario_schema()["$defs"]["Simulation"]["properties"]["humidity"]["description"],
    "shown": [str(inspect.signature(one).parameters["humidity"]) for one in functions],
    "documented": ["Humidity of the air" in one.__doc__ for one in (*functions, st.Scenario)],
    "typed": ["humidity" in one.__annotations__ for one in (Given, Options)],
}))
"""
ARRIVED = {
    "by default": 0.5,
    "alone": 0.7,
    "side by side": [0.2] * 4,
    "read from a record": 0.7,
    "run again": 0.7,
    "set by key": 0.3,
    "swept": [0.1, 0.9],
    "made": [0.4, 0.6],
    "refused": "humidity must be 0 or above, got -1.0",
    "refused in tables": "simulation.humidity must be 0 or above, got -1.0",
    "described": "humidity of the air",
    "shown": ["humidity: 'float' = 0.5"] * 2,
    "documented": [True] * 3,
    "typed": [True] * 2,
}


def copied(folder: Path, steps: Steps, added: dict[str, str] | None = None) -> None:
    """Follow the steps in a copy of the package, with some files added."""
    package = folder / "stridula"
    shutil.copytree(Path(stridula.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__", "page"))
    for name, text in (added or {}).items():
        (package / name).write_text(text, encoding="utf-8")
    for name, before, after in steps:
        text = (package / name).read_text(encoding="utf-8")
        assert text.count(before) == 1, (name, before)
        (package / name).write_text(text.replace(before, after), encoding="utf-8")


def ran(folder: Path, script: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run a script with the copy, without compilation."""
    surroundings = os.environ | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": str(folder), "COLUMNS": "200"}
    command = [sys.executable, "-c", script, *arguments]
    return subprocess.run(command, env=surroundings, cwd=folder, capture_output=True, text=True, timeout=600)


def without(steps: Steps, left_out: int) -> Steps:
    return [step for number, step in enumerate(steps) if number != left_out]


def with_law(folder: Path, steps: Steps) -> subprocess.CompletedProcess[str]:
    copied(folder, steps, {"contact/trial_weakening.py": LAW})
    return ran(folder, LAW_SCRIPT)


def test_a_law_with_a_new_curve_marches_after_the_steps_of_the_recipe(tmp_path):
    done = with_law(tmp_path, LAW_STEPS)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["error"] < 1e-4
    assert found["read"]


@pytest.mark.parametrize("left_out", [2, 3])
def test_a_step_left_out_is_noticed(tmp_path, left_out):
    """Negative control: a law that nothing holds, or without a ratio of its own, does not march as it should."""
    done = with_law(tmp_path, without(LAW_STEPS, left_out))
    assert done.returncode != 0 or json.loads(done.stdout)["error"] > 0.01


def test_a_probe_arrives_in_the_record_after_the_steps_of_the_recipe(tmp_path):
    copied(tmp_path, PROBE_STEPS)
    done = ran(tmp_path, PROBE_SCRIPT)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["same"] == [True, True]
    assert found["ratio"] == pytest.approx([2.0, 2.0], rel=1e-9)
    assert (found["names"], found["units"]) == (["block x"], "kg m/s")
    assert found["no"] == "simulation.probes.1.direction must be one of x, y, z, got 'w'"


@pytest.mark.parametrize("left_out", [1, 2, 4])
def test_a_probe_without_a_step_does_not_arrive(tmp_path, left_out):
    """Negative control: a probe that is not entered, or has no variable or no rows."""
    copied(tmp_path, without(PROBE_STEPS, left_out))
    assert ran(tmp_path, PROBE_SCRIPT).returncode != 0


def test_a_verb_answers_after_the_steps_of_the_recipe(tmp_path):
    copied(tmp_path, VERB_STEPS, {"cli/masses.py": VERB})
    done = ran(tmp_path, VERB_SCRIPT, "masses", "squeal", "--digits", "2")
    assert done.returncode == 0, done.stderr
    assert [line.split()[0] for line in done.stdout.splitlines()] == ["slider", "track"]
    assert "Print the masses of the bodies of a scenario." in ran(tmp_path, VERB_SCRIPT, "--help").stdout
    refused = ran(tmp_path, VERB_SCRIPT, "masses", "sqeal")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert "did you mean 'squeal'?" in refused.stderr


def test_a_verb_that_is_not_entered_is_unknown(tmp_path):
    """Negative control."""
    copied(tmp_path, (), {"cli/masses.py": VERB})
    assert ran(tmp_path, VERB_SCRIPT, "masses", "squeal").returncode == 2


def test_a_setting_arrives_everywhere_after_the_steps_of_the_recipe(tmp_path):
    """Declared in one file and read where it acts; arguments, keys, sweeps, records and messages follow."""
    assert len({name for name, *_ in SETTING_STEPS}) == 2
    copied(tmp_path, SETTING_STEPS)
    done = ran(tmp_path, SETTING_SCRIPT)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == ARRIVED


def test_a_setting_that_nothing_reads_is_noticed(tmp_path):
    """Negative control."""
    copied(tmp_path, SETTING_STEPS[:-1])
    assert "KeyError: 'humidity'" in ran(tmp_path, SETTING_SCRIPT).stderr
