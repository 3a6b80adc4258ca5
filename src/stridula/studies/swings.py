"""Swings of contacts about their equilibrium in a run, and the growth of the swings."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..arrays import Array
from ..linear.reach import ModesAtRest

# Growth is measured up to this fraction of a mode's reach: well below one, since laws of friction and bent tracks are
# linear only for small motions.
LINEAR = 0.05
# Largest amplitude of other modes, relative to that of the mode whose growth is measured.
FOREIGN = 1e-3
# Swing of other modes that starts from rounding.
ROUNDING = 1e-12
# Smallest number of periods, and smallest growth as an exponent of e, in a measurement of growth; number of samples
# compared in a period.
FEWEST_PERIODS, LEAST_GROWTH, SAMPLES_OF_A_PERIOD = 1.0, 0.5, 7.0
# Largest relative error of the growth due to motion that one mode does not explain: a share u of such motion lets the
# roots of the recurrence decay by about u² in each of its intervals.
HIDDEN = 0.02


def relative(run: xr.Dataset, rest: ModesAtRest) -> Array:
    """Return normal forces and slip velocities over those at rest, shape (time, channels).

    A normal force that swings by one opens its contact, a slip velocity that swings by one stops it. Contacts that are
    open or stick at rest are left out.

    Parameters
    ----------
    run : xarray.Dataset
        A record.
    rest : ModesAtRest
        The equilibrium.
    """
    contacts = rest.normal_force.size
    force = run["normal_force"].values.reshape(-1, contacts)
    slip = run["slip_velocity"].values.reshape(len(force), contacts, -1)
    presses, slides = rest.normal_force > 0.0, rest.slip_velocity != 0.0
    moving = slip[:, slides] / np.abs(rest.slip_velocity[slides])[:, None]
    return np.hstack([force[:, presses] / rest.normal_force[presses], moving.reshape(len(force), -1)])


def swing(motion: Array) -> float:
    """Return the largest standard deviation of any channel [1]."""
    return float(motion.std(axis=0).max()) if motion.size else 0.0


def linear_time(rest: ModesAtRest, number: int, amplitude: float) -> float:
    """Return the time for which a growing mode dominates within linear theory [s].

    It ends once the mode has grown to `LINEAR` of its reach, or earlier, once a faster mode started by rounding has
    grown to `FOREIGN` of it.

    Parameters
    ----------
    rest : ModesAtRest
        The modes.
    number : int
        Number of the mode.
    amplitude : float
        Its initial amplitude over its reach [1].
    """
    growth = rest.exponents.real
    lasts = max(np.log(LINEAR / amplitude), 1.0) / growth[number]
    ahead = float(growth.max() - growth[number])
    if ahead > 0.0:
        lasts = min(lasts, np.log(FOREIGN * amplitude / ROUNDING) / ahead)
    return float(max(lasts, 0.0))


def growth_in_time(run: xr.Dataset, still: xr.Dataset, rest: ModesAtRest, number: int, amplitude: float) -> complex:
    """Return the exponent [1/s] at which a run departs from one started without the mode; NaN if not measurable.

    Samples of a growing oscillation are linear combinations of the two before them, the same in all channels; the roots
    of that recurrence are the exponentials over an interval (Prony).

    Parameters
    ----------
    run, still : xarray.Dataset
        Records from the same equilibrium, with and without the mode.
    rest : ModesAtRest
        The modes.
    number : int
        Number of the mode.
    amplitude : float
        Its initial amplitude over its reach [1].
    """
    known, interval = complex(rest.exponents[number]), float(run.attrs["sample_interval"])
    lasts = linear_time(rest, number, amplitude)
    samples = min(run.sizes["time"], still.sizes["time"], int(lasts / interval))
    away = (relative(run, rest)[:samples] - relative(still, rest)[:samples])[1:]
    period = 2.0 * np.pi / max(abs(known.imag), abs(known.real))
    every = max(1, round(period / SAMPLES_OF_A_PERIOD / interval))
    length = samples * interval
    if length < max(FEWEST_PERIODS * period, LEAST_GROWTH / known.real) or period < 3.0 * interval:
        return complex(np.nan, np.nan)
    # Divided by the expected growth, so that all times have equal weight.
    shrunk = np.exp(-known.real * interval * np.arange(len(away) - 2 * every))[:, None]
    past, last, now = (away[k * every : len(away) - (2 - k) * every] * shrunk for k in range(3))
    weights, *_ = np.linalg.lstsq(np.stack([last.ravel(), past.ravel()], axis=1), now.ravel(), rcond=None)
    left = now - weights[0] * last - weights[1] * past
    hidden = float(np.linalg.norm(left) / np.linalg.norm(now)) ** 2
    if hidden > HIDDEN * known.real * every * interval:
        return complex(np.nan, np.nan)
    roots = np.log(np.roots([1.0, *-weights]).astype(complex)) / (every * interval)
    seen = roots[np.argmin(np.abs(roots - known))]
    return complex(seen)
