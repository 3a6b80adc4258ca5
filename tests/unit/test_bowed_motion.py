"""Motions of a bowed string from constructed slips."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from stridula import analysis

STICKING, SLIDING = 1, 2
RATE, PITCH = 40e3, 200.0
# Time in periods of the string.
TIME = np.arange(1, round(RATE) + 1) / RATE * PITCH


def bowed(*hairs: np.ndarray) -> xr.Dataset:
    """Return a record of contacts that slip at some samples."""
    status = np.stack([np.where(slips, SLIDING, STICKING) for slips in hairs], axis=1)
    along, force = ("time", "contact"), np.ones(status.shape)
    data = {
        "status_share": ((*along, "contact_status"), np.eye(3)[status]),
        "normal_force": (along, force),
        "tangential_force": (along, 0.3 * force),
        "damping_loss": ("time", 0.0 * TIME),
        "impact_loss": ("time", 0.0 * TIME),
        "friction_loss": ("time", TIME),
    }
    names = [f"hair {number}" for number in range(len(hairs))]
    return xr.Dataset(data, {"time": TIME / PITCH, "contact": names})


def at(*phases: float, period: float = 1.0, length: float = 0.1) -> np.ndarray:
    """Return whether it slips, starting at some phases of a period, for a share of the string's period."""
    since = np.stack([(TIME / period - phase) % 1.0 for phase in phases]) * period
    return (since < length).any(axis=0)


CASES = {
    "Helmholtz": (at(0.0), 1.0, PITCH),
    "double slip": (at(0.0, 0.4), 2.0, PITCH),
    "multiple slip": (at(0.0, 0.3, 0.7, length=0.05), 3.0, PITCH),
    "anomalous low": (at(0.0, period=3.0), 1.0 / 3.0, PITCH / 3.0),
}


@pytest.mark.parametrize("motion", CASES)
def test_motions(motion):
    slips, rate, frequency = CASES[motion]
    found = analysis.bowed_motion(bowed(slips), PITCH)
    assert found.motion == motion
    assert found.slips_per_period == pytest.approx(rate, rel=0.01)
    assert found.frequency == pytest.approx(frequency, rel=1e-4)
    assert found.slip_share == pytest.approx(slips[slips.size // 2 :].mean(), abs=1e-3)


def test_two_slips_half_a_period_apart_are_a_double_slip_an_octave_higher():
    found = analysis.bowed_motion(bowed(at(0.0, 0.5)), PITCH)
    assert (found.motion, found.frequency) == ("double slip", pytest.approx(2.0 * PITCH, rel=1e-4))


def test_a_little_flat_is_helmholtz_motion_and_a_third_off_is_not():
    assert analysis.bowed_motion(bowed(at(0.0, period=1.06)), PITCH).motion == "Helmholtz"
    assert analysis.bowed_motion(bowed(at(0.0, period=1.06)), PITCH, tolerance=0.05).motion == "raucous"
    assert analysis.bowed_motion(bowed(at(0.0, period=1.26)), PITCH).motion == "raucous"


def test_slips_at_random_times_are_raucous():
    ends = np.cumsum(np.random.default_rng(7).uniform(0.5, 1.5, 300))
    since = TIME - np.append(0.0, ends)[np.searchsorted(ends, TIME)]
    found = analysis.bowed_motion(bowed(since < 0.1), PITCH)
    assert found.motion == "raucous"
    assert np.isnan(found.frequency)
    assert found.unsteadiness == pytest.approx(0.29, abs=0.05)


def test_one_that_never_slips_sticks_and_one_that_always_does_slides():
    never = np.zeros(TIME.size, dtype=bool)
    assert analysis.bowed_motion(bowed(never), PITCH).motion == "sticking"
    assert analysis.bowed_motion(bowed(~never), PITCH).motion == "sliding"


def test_slips_at_one_edge_of_the_bow_do_not_count_and_those_of_most_hairs_do():
    common, more = at(0.0), at(0.0, 0.5)
    assert analysis.bowed_motion(bowed(more, more, common, common, common), PITCH).motion == "Helmholtz"
    assert analysis.bowed_motion(bowed(more, more, more, common, common), PITCH).motion == "double slip"


def test_the_start_is_left_aside():
    late = np.where(TIME < 100.0, at(0.0, 0.4), at(0.0))
    assert analysis.bowed_motion(bowed(late), PITCH, start=0.0).motion == "raucous"
    assert analysis.bowed_motion(bowed(late), PITCH).motion == "Helmholtz"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"frequency": 0.0}, "frequency must be above 0"),
        ({"tolerance": 0.6}, "tolerance must be from 0"),
        ({"steady": -1.0}, "steady must be from 0"),
        ({"start": 2.0}, "start must be from 0"),
    ],
)
def test_bad_arguments(words, message):
    with pytest.raises(ValueError, match=message):
        analysis.bowed_motion(bowed(at(0.0)), **{"frequency": PITCH} | words)
