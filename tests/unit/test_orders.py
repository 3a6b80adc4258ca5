"""Orders of vibrations whose orders are known, while the speed changes."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from stridula import analysis

RATE = 25600.0


def over_time(values, units, rate=RATE, start=0.0):
    time = start + np.arange(len(values)) / rate
    return xr.DataArray(values, {"time": time}, ("time",), attrs={"units": units})


def run_up(low=5.0, high=60.0, lasts=4.0, rate=RATE):
    """Return times, speed [Hz] and angle [revolutions] of a steady run-up."""
    time = np.arange(round(lasts * rate)) / rate
    return time, low + (high - low) * time / lasts, low * time + 0.5 * (high - low) * time**2 / lasts


@pytest.mark.parametrize("order", [1.0, 2.5, 7.0, 19.875])
def test_an_order_keeps_its_value_on_a_chirp(order):
    _, speed, angle = run_up()
    found = analysis.order_spectrum(
        over_time(3.0 * np.cos(2.0 * np.pi * order * angle + 0.4), "m/s2"), over_time(speed, "Hz")
    )
    at_order = found.sel(order=order)
    np.testing.assert_allclose(at_order, 3.0 / np.sqrt(2.0), rtol=2e-4)
    # Hann windows of whole revolutions leave half of it beside the order, and nothing farther away.
    far = found.where(np.abs(found.order - order) > 0.3, drop=True)
    assert float(far.max()) < 3e-3 * 3.0
    assert found.attrs["units"] == "m/s2"
    begins = 4.0 * np.arange(found.sizes["time"])
    ends = [np.sqrt(5.0**2 + 2.0 * 13.75 * (begins + turn)) for turn in (0.0, 8.0)]
    np.testing.assert_allclose(found.speed, 0.5 * (ends[0] + ends[1]), rtol=1e-4)


def test_orders_and_a_resonance_are_apart():
    """A tone of fixed frequency is where its frequency over the speed is."""
    time, speed, angle = run_up(20.0, 40.0)
    values = np.cos(2.0 * np.pi * 3.0 * angle) + 0.5 * np.cos(2.0 * np.pi * 400.0 * time)
    found = analysis.order_spectrum(over_time(values, "N"), over_time(60.0 * speed, "rpm"))
    np.testing.assert_allclose(found.sel(order=3.0), np.sqrt(0.5), rtol=0.01)
    above = found.sel(order=slice(5.0, None))
    tops = above.order.values[above.argmax("order").values]
    np.testing.assert_allclose(tops * found.speed, 400.0, rtol=0.05)


def test_constant_speed_is_a_plain_spectrum():
    rate, turns, count = 12800.0, 16.0, 12800
    values = np.random.default_rng(2).standard_normal(count)
    found = analysis.order_spectrum(
        over_time(values, "N", rate), over_time(np.full(count, turns), "1/s", rate), revolutions=8.0
    )
    size = round(8.0 / turns * rate)
    window = np.hanning(size + 1)[:-1]
    for row in range(found.sizes["time"]):
        piece = values[row * size // 2 : row * size // 2 + size]
        mean = np.sum(window * piece) / window.sum()
        plain = np.sqrt(2.0) * np.abs(np.fft.rfft(window * (piece - mean))) / window.sum()
        np.testing.assert_allclose(found[row], plain[1 : found.sizes["order"] + 1], atol=1e-9)


def test_a_stop_to_rest_and_other_units():
    time = np.arange(51200) / RATE
    speed = np.maximum(40.0 - 30.0 * time, 0.0)
    angle = np.where(time < 4.0 / 3.0, 40.0 * time - 15.0 * time**2, 80.0 / 3.0)
    found = analysis.order_spectrum(
        over_time(np.sin(2.0 * np.pi * 4.0 * angle), "Pa"), over_time(2.0 * np.pi * speed, "rad/s")
    )
    np.testing.assert_allclose(found.sel(order=4.0), np.sqrt(0.5), rtol=2e-3)


def test_orders_above_half_of_the_rate_are_unknown():
    _, speed, angle = run_up(20.0, 60.0, rate=1000.0)
    found = analysis.order_spectrum(over_time(np.cos(2.0 * np.pi * angle), "N", 1000.0), over_time(speed, "Hz", 1000.0))
    fastest = found.isel(time=-1)
    assert np.isnan(fastest.sel(order=slice(9.0, None))).all()
    assert np.isfinite(fastest.sel(order=slice(0.0, 8.0))).all()


@pytest.mark.parametrize(
    ("speed", "words", "message"),
    [
        (over_time(np.ones(1000), "m/s"), {}, r"^speed must be in Hz, 1/s, rpm, 1/min, rad/s, got 'm/s'$"),
        (over_time(np.ones(999), "Hz"), {}, r"^speed must have the times of the signal, got others$"),
        (over_time(np.ones(1000), "Hz", start=1.0), {}, r"^speed must have the times of the signal, got others$"),
        (over_time(-np.ones(1000), "Hz"), {}, r"^speed must be finite and 0 or above, got another value at 0 s$"),
        (over_time(np.ones(1000), "Hz"), {}, r"^revolutions must be at most the 0\.039\d* of the shaft, got 8\.0$"),
        (
            over_time(np.full(1000, 500.0), "Hz"),
            {"highest": 0.1},
            r"^highest must be at least one over the revolutions",
        ),
    ],
)
def test_other_speeds_are_refused(speed, words, message):
    with pytest.raises(ValueError, match=message):
        analysis.order_spectrum(over_time(np.zeros(1000), "N"), speed, **words)
