"""The sound of a limit cycle is that of a run that has settled to it."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

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
    period = st.radiate(cycle, system)
    assert period.sizes["time"] == cycle.sizes["time"]
    repeated = st.repeat_cycle(period, 0.3)
    levels = [st.equivalent_level(one, "A").values for one in (settled, repeated)]
    np.testing.assert_allclose(*levels, atol=0.05)
    # The sound of the repeated record is the same, once its beginning has died away.
    whole = st.radiate(st.repeat_cycle(cycle, 0.4), system)
    np.testing.assert_allclose(whole.values[-len(period) :], period.values, atol=1e-3 * float(np.abs(period).max()))
    harmonics = st.harmonic_levels(period)
    np.testing.assert_allclose(harmonics["frequency"].values[:3], np.arange(1, 4) / float(cycle["period"]))
    # Their mean squares add up to that of the sound.
    total = 10.0 * np.log10((10.0 ** (harmonics.values / 10.0)).sum(axis=0))
    np.testing.assert_allclose(total, st.equivalent_level(repeated).values, atol=0.01)
    assert round(rate * float(cycle["period"])) == len(period)


def test_harmonics_of_a_known_sound():
    """Of a sum of cosines; a sound without a period, or of a part of one, is refused."""
    period, count = 2e-3, 200
    times = period / count * np.arange(3 * count)
    known = {1: 0.2, 2: 0.05, 5: 0.01}
    values = sum(size * np.cos(2.0 * np.pi * n * times / period + n) for n, size in known.items())
    sound = xr.DataArray(values, {"time": times}, ("time",), attrs={"units": "Pa", "period": period})
    found = st.harmonic_levels(sound, most=6)
    for harmonic, size in known.items():
        level = 20.0 * np.log10(size / np.sqrt(2.0) / 20e-6)
        assert float(found.sel(harmonic=harmonic)) == pytest.approx(level, abs=1e-9)
    assert float(found.sel(harmonic=3)) < -100.0
    with pytest.raises(ValueError, match=r"pressure must last whole periods, got 2\.5 of them"):
        st.harmonic_levels(sound[: 5 * count // 2])
    with pytest.raises(ValueError, match="pressure must be the sound of a limit cycle"):
        st.harmonic_levels(sound.assign_attrs(period=None))
    with pytest.raises(ValueError, match="cycle must be the sound of a limit cycle"):
        st.repeat_cycle(sound.drop_attrs(), 1.0)
