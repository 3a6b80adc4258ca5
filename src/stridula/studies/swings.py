"""How far contacts swing about their equilibrium in a run, and how fast that grows."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..arrays import Array
from ..linear.reach import ModesAtRest

# Share of the way to where a contact leaves linear theory, up to which growth is measured: well below one, for laws of
# friction and bent tracks are linear for small motions only.
LINEAR = 0.05
# Share of a mode that others may have when its growth is measured.
FOREIGN = 1e-3
# Swing of other modes that rounding starts.
ROUNDING = 1e-12
# Periods, and times over which a mode grows by e, from which growth can be told; samples of a period that are compared.
FEWEST_PERIODS, LEAST_GROWTH, SAMPLES_OF_A_PERIOD = 1.0, 0.5, 7.0
# Share of the growth that what one mode leaves unexplained may hide: a share u of the motion lets the roots of the
# recurrence decay by about u² in each of its intervals.
HIDDEN = 0.02


def relative(run: xr.Dataset, rest: ModesAtRest) -> Array:
    """Return normal forces and slip velocities over those at rest, shape (time, channels).

    A normal force that swings by one opens its contact, a slip velocity that does so stops it. Contacts that are open
    or stick at rest have no part in it.

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
    """Return the root mean square of what moves most about its mean [1]."""
    return float(motion.std(axis=0).max()) if motion.size else 0.0


def linear_time(rest: ModesAtRest, number: int, amplitude: float) -> float:
    """Return how long a mode that grows stays one mode within linear theory [s].

    It ends where the mode has grown to `LINEAR` of its reach, or before, where rounding has let a mode that grows
    faster come to `FOREIGN` of it.

    Parameters
    ----------
    rest : ModesAtRest
        The modes.
    number : int
        Which one.
    amplitude : float
        Its start over its reach [1].
    """
    growth = rest.exponents.real
    lasts = max(np.log(LINEAR / amplitude), 1.0) / growth[number]
    ahead = float(growth.max() - growth[number])
    if ahead > 0.0:
        lasts = min(lasts, np.log(FOREIGN * amplitude / ROUNDING) / ahead)
    return float(max(lasts, 0.0))


def growth_in_time(run: xr.Dataset, still: xr.Dataset, rest: ModesAtRest, number: int, amplitude: float) -> complex:
    """Return the exponent [1/s] at which a run leaves another one that starts without the mode; NaN if it has none.

    Samples of a growing oscillation are linear combinations of the two before them, the same in all channels; the roots
    of that recurrence are the exponentials over an interval (Prony).

    Parameters
    ----------
    run, still : xarray.Dataset
        Records from the same equilibrium, with the mode on top and without it.
    rest : ModesAtRest
        The modes.
    number : int
        Which one is on top.
    amplitude : float
        Its start over its reach [1].
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
    # As large at the end as at the start: each stretch of time weighs as much.
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
