"""The recipe of CONTRIBUTING for a law of friction with a new curve, followed in a copy of the package."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import stridula

LAW = '''"""Friction that falls with the inverse of the slip speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..declared import Coefficient, Speed
from .friction_law import StaticAndKinetic


@dataclass(frozen=True)
class RationalWeakening(StaticAndKinetic):
    """Friction ``kinetic + (static - kinetic) / (1 + |v| / velocity)``."""

    law: ClassVar[str] = "rational weakening"
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
        return f"rational, {self.static:.4g} to {self.kinetic:.4g} over {self.velocity:.3g} m/s"
'''
RATIO = """    if law.code == at.RATIONAL_WEAKENING:
        return table[row, KINETIC] + (table[row, STATIC] - table[row, KINETIC]) / (1.0 + speed / table[row, VELOCITY])
"""
# The steps of the recipe: file, text there, text in its place.
STEPS = (
    ("_kernels/layout.py", "LUGRE, AGING, SLIP = range(7)", "LUGRE, AGING, SLIP, RATIONAL_WEAKENING = range(8)"),
    (
        "_kernels/law_columns.py",
        '    "SLIP": _RATE_AND_STATE,\n',
        '    "SLIP": _RATE_AND_STATE,\n    "RATIONAL_WEAKENING": _WEAKENING,\n',
    ),
    ("_kernels/law_columns.py", '_STICKS = {"COULOMB", ', '_STICKS = {"COULOMB", "RATIONAL_WEAKENING", '),
    ("_kernels/friction.py", "    if law.code == at.STRIBECK:\n", RATIO + "    if law.code == at.STRIBECK:\n"),
    (
        "_kernels/friction.py",
        "law.code == at.STRIBECK or law.code == at.LUGRE",
        "law.code in (at.STRIBECK, at.LUGRE, at.RATIONAL_WEAKENING)",
    ),
    (
        "contact/laws.py",
        "from .rate_and_state",
        "from .rational_weakening import RationalWeakening\nfrom .rate_and_state",
    ),
    ("contact/laws.py", "    RateAndState,\n)", "    RateAndState,\n    RationalWeakening,\n)"),
)
SCRIPT = """
import json
import numpy as np
import stridula as st
from scipy.integrate import solve_ivp
from stridula.contact.rational_weakening import RationalWeakening

law, mass, stiffness, load, belt = RationalWeakening(0.5, 0.3, 0.2), 1.0, 4e3, 10.0, 1.0
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


def followed(folder: Path, steps) -> subprocess.CompletedProcess[str]:
    """Follow the steps in a copy of the package and run the script there, without compilation."""
    package = folder / "stridula"
    shutil.copytree(Path(stridula.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__", "page"))
    (package / "contact" / "rational_weakening.py").write_text(LAW)
    for name, before, after in steps:
        text = (package / name).read_text(encoding="utf-8")
        assert text.count(before) == 1, (name, before)
        (package / name).write_text(text.replace(before, after), encoding="utf-8")
    surroundings = os.environ | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": str(folder)}
    return subprocess.run(
        [sys.executable, "-c", SCRIPT], env=surroundings, cwd=folder, capture_output=True, text=True, timeout=600
    )


def test_a_law_with_a_new_curve_marches_after_the_steps_of_the_recipe(tmp_path):
    done = followed(tmp_path, STEPS)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["error"] < 1e-4
    assert found["read"]


@pytest.mark.parametrize("left_out", [2, 3])
def test_a_step_left_out_is_noticed(tmp_path, left_out):
    """Negative control: a law that nothing holds, or without a ratio of its own, does not march as it should."""
    done = followed(tmp_path, [step for number, step in enumerate(STEPS) if number != left_out])
    assert done.returncode != 0 or json.loads(done.stdout)["error"] > 0.01
