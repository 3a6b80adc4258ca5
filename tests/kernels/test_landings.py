"""The recorded number of landings against a plain count in a run that keeps every step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physics.cases import CASES, STEP

import stridula as st
from kernels.systems import SYSTEMS

STEPS, RATIO = 12_000, 600
SINGLE = {name: (CASES[name], STEP) for name in ("squeal", "judder", "shaken, thrown and heavy")}
GENERAL = {
    name: SYSTEMS[name] for name in ("slider, exponential", "pad on a belt, bristles and age", "groove", "two sliders")
}


def counted(run, system) -> np.ndarray:
    """Landings in blocks of `RATIO` steps of a run recorded at every step, shape (blocks, contacts).

    A contact that is closed and pressed at the start does not land in its first step.
    """
    closed = run.status.values.reshape(STEPS, -1) != 0
    at_start = [[contact.gap == 0.0 for contact in system.contacts]]
    landed = closed & ~np.concatenate([at_start, closed[:-1]])
    return landed.reshape(STEPS // RATIO, RATIO, -1).sum(axis=1)


@pytest.mark.parametrize("name", SINGLE | GENERAL)
def test_landings_are_those_of_every_step(name):
    make, step = (SINGLE | GENERAL)[name]
    fine, coarse = (
        st.simulate(make(), STEPS * step, step=step, sample_rate=1 / (ratio * step), probes=[]) for ratio in (1, RATIO)
    )
    expected = counted(fine, make())
    assert coarse.landings.dtype == np.int64
    np.testing.assert_array_equal(coarse.landings.values.reshape(expected.shape), expected)
    assert expected.max() > 1, "no sample with two landings: what changes inside an interval is not tested"


def test_runs_side_by_side_count_their_own():
    systems = [CASES["judder"](), CASES["squeal"](), CASES["stable"]()] * 3
    words = {"step": STEP, "sample_rate": 1 / (RATIO * STEP), "probes": []}
    together = st.simulate_many(systems, STEPS * STEP, workers=1, **words)
    counts = []
    for system, run in zip(systems[:3], together, strict=False):
        alone = st.simulate(system, STEPS * STEP, **words)
        np.testing.assert_array_equal(run.landings, alone.landings)
        counts.append(int(run.landings.sum()))
    assert len(set(counts)) == 3


def test_a_contact_that_starts_at_rest_on_its_track_does_not_land():
    """Neither a contact that sticks to the belt from the start nor one that is dragged."""
    system = st.load_scenario("belt").system
    dragged = replace(system, drives=[*system.drives, st.InitialVelocity(system.slider, x=5.0)])
    for one, status in ((system, 1), (dragged, 2)):
        run = st.simulate(one, 1.0, step=1e-3, sample_rate=1e3, probes=[])
        assert run.status[0] == status
        assert not run.landings.any()
