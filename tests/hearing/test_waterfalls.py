"""Waterfalls of spectra: each at its value, tones at their levels, growing modes at their places."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula import plot
from stridula.plot import waterfalls

from .sounds import heard, noise, tone


def lines(figure):
    """Return the lines of spectra, without the bar of levels and the marks of theory."""
    (axes,) = figure.axes
    return [line.get_xydata() for line in axes.get_lines() if line.get_color() == waterfalls.LINE]


def levels(line, value, step, dynamic_range, top):
    """Return the levels of a line from its heights [dB]."""
    return (line[:, 1] - value) * dynamic_range / (waterfalls.OVERLAP * step) + top - dynamic_range


@pytest.fixture(scope="module")
def tones():
    """Return tones of 1, 2 and 3 kHz at 60, 70 and 80 dB by speed, in mixed order."""
    return {k: tone(1000.0 * k, 50.0 + 10.0 * k, units="Pa") for k in (3.0, 1.0, 2.0)}


def test_each_tone_is_on_its_value_at_its_frequency_and_level(tones):
    figure = plot.waterfall(tones, parameter="speed [m/s]", highest=5e3)
    (axes,) = figure.axes
    found = lines(figure)
    assert axes.get_ylabel() == "speed [m/s]"
    for number, line in enumerate(found, 1):
        peak = line[:, 1].argmax()
        assert line[peak, 0] == pytest.approx(number)
        known = 50.0 + 10.0 * number
        # The level of a tone at the centre of a frequency bin under the window.
        assert levels(line, number, 1.0, 60.0, 80.0)[peak] == pytest.approx(known, abs=0.05)
        assert np.median(line[:, 1]) == pytest.approx(number), "what is below the range lies on the value"
    words = [text.get_text().strip() for text in axes.texts]
    assert words == ["1", "2", "3", "20 dB; the highest is 80.0 dB re 20 µPa"]
    assert axes.get_xlim() == (0.0, 5.0)


def test_low_values_hide_what_is_behind(tones):
    (axes,) = plot.waterfall(tones).axes
    orders = [line.get_zorder() for line in axes.get_lines() if line.get_color() == waterfalls.LINE]
    assert orders == sorted(orders, reverse=True)
    assert len(set(orders)) == 3


def test_the_bar_is_as_high_as_20_decibels(tones):
    (axes,) = plot.waterfall(tones, dynamic_range=40.0).axes
    low, high = axes.get_ylim()
    (bar,) = [line for line in axes.get_lines() if line.get_color() == "black"]
    assert np.ptp(bar.get_ydata()) * (high - low) == pytest.approx(waterfalls.OVERLAP * 20.0 / 40.0)


def test_an_array_over_a_parameter_has_its_name_and_unit(tones):
    whole = xr.concat([tones[k] for k in (1.0, 2.0, 3.0)], dim="speed").assign_coords(speed=[1.0, 2.0, 3.0])
    whole["speed"].attrs["units"] = "m/s"
    figure = plot.waterfall(whole)
    assert figure.axes[0].get_ylabel() == "speed [m/s]"
    for one, other in zip(lines(figure), lines(plot.waterfall(tones)), strict=True):
        np.testing.assert_allclose(one, other)


def test_one_signal_is_cut_into_stretches_of_time():
    both = heard(np.concatenate([tone(1000.0, 60.0).values, tone(2000.0, 60.0).values]))
    figure = plot.waterfall(both, pieces=4)
    peaks = [line[line[:, 1].argmax(), 0] for line in lines(figure)]
    np.testing.assert_allclose(peaks, [1.0, 1.0, 2.0, 2.0], atol=0.01)
    starts = [np.median(line[:, 1]) for line in lines(figure)]
    np.testing.assert_allclose(starts, [0.25, 0.75, 1.25, 1.75], atol=1e-3)
    assert figure.axes[0].get_ylabel() == "time [s]"


def theory(*modes):
    """Return frequencies and whether they grow, in the form of linear theory."""
    frequency, unstable = zip(*modes, strict=True)
    data = {"frequency": ("mode", list(frequency)), "unstable": ("mode", list(unstable))}
    return xr.Dataset(data)


def marks(figure):
    """Return the rings that mark growing modes."""
    found = [line for line in figure.axes[0].get_lines() if line.get_marker() == "o"]
    return found[0].get_xydata().tolist() if found else []


def test_modes_that_grow_are_marked_where_they_are(tones):
    grows, decays = theory((900.0, False), (1500.0, True)), theory((1000.0, False))
    figure = plot.waterfall(tones, {1.0: decays, 2.0: grows, 3.0: decays}, highest=5e3)
    assert marks(figure) == [[1.5, 2.0]], "the tone of 2 kHz leaves nothing there"
    on_it = plot.waterfall(tones, {2.0: theory((2000.0, True)), 2.5: grows}, highest=5e3)
    assert marks(on_it) == [[2.0, pytest.approx(lines(on_it)[1][:, 1].max())], [1.5, 2.5]]
    assert figure.axes[0].get_legend() is not None
    none = plot.waterfall(tones, {1.0: decays}, highest=5e3)
    assert (marks(none), none.axes[0].get_legend()) == ([], None)
    beyond = plot.waterfall(tones, {2.0: grows}, highest=1.2e3)
    assert marks(beyond) == []
    through = plot.waterfall(tones, grows, highest=5e3).axes[0].get_lines()
    assert [line.get_xdata() for line in through if line.get_linestyle() == "--"] == [[1.5, 1.5]]


def test_root_loci_and_records_go_together():
    frictions = [0.4, 1.2]
    runs = {mu: st.load_scenario("weak-pressure", {"friction": mu, "duration": 0.02}).simulate() for mu in frictions}
    loci = st.root_loci("weak-pressure", "friction", frictions, highest=4e3)
    forces = {mu: run.normal_force for mu, run in runs.items()}
    figure = plot.waterfall(forces, loci, parameter="friction [1]", highest=4e3, resolution=50.0)
    known = [
        [float(f) / 1e3, mu]
        for mu in frictions
        for f, grows in zip(loci.frequency.sel(friction=mu), loci.unstable.sel(friction=mu), strict=True)
        if grows and 0.0 < f <= 4e3
    ]
    assert known
    by_friction = dict(zip(frictions, lines(figure), strict=True))
    known = [[f, float(np.interp(f, *by_friction[mu].T))] for f, mu in known]
    np.testing.assert_allclose(marks(figure), known)


@pytest.mark.parametrize(
    ("signals", "options", "message"),
    [
        (3.0, {}, "signals must be a DataArray over time"),
        ({1.0: tone()}, {}, "signals must have from 2 to 100 values"),
        ({"low": tone(), "high": tone()}, {}, r"signals\['low'\] must be a number"),
        ({1.0: tone(), 2.0: tone(rate=44.1e3)}, {}, "signals must have one sample interval"),
        ({1.0: tone(), 2.0: tone(units="N")}, {}, "signals must have one unit"),
        (noise(duration=0.001), {}, "pieces must leave at least 16 samples"),
        ({1.0: tone(), 2.0: tone()}, {"highest": 12.0}, "highest must be at least 20 Hz"),
        ({1.0: tone(), 2.0: tone()}, {"theory": {1.0: 2.0}}, "theory must be the result of root_loci"),
        ({1.0: tone(), 2.0: tone()}, {"theory": 1.0}, "theory must be the result of root_loci"),
        (xr.DataArray(np.zeros((3, 99)), dims=("case", "time")), {}, "signals must have numbers along case"),
    ],
)
def test_bad_arguments_are_refused(signals, options, message):
    with pytest.raises(ValueError, match=message):
        plot.waterfall(signals, **options)
