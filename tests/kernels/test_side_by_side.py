"""Every kind of system side by side: plates, joined bodies, several contacts, every law, as each marches alone.

Sums over modes have another order in a vector of runs than in one of modes: 1e-6 of the peak over the steps compared,
where round-off has not grown to more.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from kernels.systems import SYSTEMS
from stridula.integration import many

STEPS, TOLERANCE = 400, 1e-6
COMPARED = (
    "normal_force",
    "tangential_force",
    "contact_position",
    "kinetic_and_elastic",
    "friction_loss",
    "drive_work",
)


def words(step):
    return {"step": step, "sample_rate": 1 / step, "probes": []}


def pressed(system, factor):
    """The system under other forces, else the same."""
    drives = [
        replace(drive, **{name: factor * getattr(drive, name) for name in ("axial", "transverse", "x", "y")})
        if isinstance(drive, st.Force)
        else drive
        for drive in system.drives
    ]
    return st.System(system.contacts, drives, system.connections)


@pytest.mark.parametrize("name", SYSTEMS)
def test_runs_side_by_side_are_those_alone(name, monkeypatch):
    monkeypatch.setattr(many, "MOST_MODES", 10**6)
    make, step = SYSTEMS[name]
    system = make()
    together = st.simulate_many(
        [pressed(system, 1.0 + 0.1 * number) for number in range(5)], STEPS * step, workers=1, **words(step)
    )
    for number in (0, 4):
        alone = st.simulate(pressed(system, 1.0 + 0.1 * number), STEPS * step, **words(step))
        for quantity in COMPARED:
            one, other = together[number][quantity].values, alone[quantity].values
            assert np.abs(one - other).max() <= TOLERANCE * np.abs(other).max() + 1e-15, quantity


@pytest.mark.parametrize("name", ["pad on a beam", "pad on a shaken belt", "two sliders", "frozen contact", "plate"])
def test_neighbouring_runs_do_not_matter(name):
    make, step = SYSTEMS[name]
    system = make()
    among = {
        first: st.simulate_many(
            [pressed(system, factor) for factor in (1.0, *(first + 0.2 * n for n in range(7)))],
            STEPS * step,
            **words(step),
        )[0]
        for first in (0.3, 1.7)
    }
    for quantity in (*COMPARED, "gap", "slip_velocity"):
        np.testing.assert_array_equal(among[0.3][quantity], among[1.7][quantity])


def test_harness_distinguishes_a_run_from_its_neighbour():
    """Negative control."""
    make, step = SYSTEMS["pad on a beam"]
    one, other = (
        st.simulate(pressed(make(), factor), STEPS * step, **words(step)).normal_force.values for factor in (1.0, 1.1)
    )
    assert np.abs(one - other).max() > TOLERANCE * np.abs(other).max()
