"""Checks of runs of every kind of system: side by side as alone, in two parts as in one."""

from __future__ import annotations

import numpy as np

import stridula as st

FORCES = ("normal_force", "tangential_force", "slip_velocity", "friction_loss")


def same_side_by_side(systems, duration, names=FORCES, **words):
    """Runs that march in one vector are those of each system alone."""
    together = st.simulate_many(systems, duration, workers=1, **words)
    for one, system in zip(together, systems, strict=True):
        alone = st.simulate(system, duration, **words)
        for name in names:
            np.testing.assert_allclose(one[name], alone[name], rtol=1e-9, atol=1e-9 * float(np.abs(alone[name]).max()))


def goes_on(system, duration, names, folder, **words):
    """A run continued from the file of its first half is the whole one to the last bit.

    Returns the whole, its first half, the rest, and the scenario that the whole is read as.
    """
    whole, half = (st.simulate(system, time, **words) for time in (duration, duration / 2))
    st.save(half, folder / "half.nc")
    rest = st.simulate(system, duration / 2, start=st.load(folder / "half.nc"), **words)
    for name in names:
        np.testing.assert_array_equal(whole[name][half.time.size :], rest[name])
    return whole, half, rest, st.load_scenario(whole)
