"""The sound of a limit cycle is that of a run that has settled to it."""

from __future__ import annotations

import numpy as np

import stridula as st

RATE = 100e3


def test_a_singing_glass_is_as_loud_as_its_cycle():
    scenario = st.load_scenario("glass")
    system = scenario.system
    run = st.simulate(system, 1.5, motion_rate=RATE)
    cycle = st.limit_cycle(system, run, motion=True)
    assert bool(cycle["stable"])
    settled = st.radiate(run, system)[-round(0.3 * RATE) :]
    rate = 1.0 / cycle.attrs["step"]
    repeated = st.radiate(st.repeat_cycle(cycle, 0.4), system)[-round(0.3 * rate) :]
    levels = [st.equivalent_level(one, "A").values for one in (settled, repeated)]
    np.testing.assert_allclose(*levels, atol=0.05)
