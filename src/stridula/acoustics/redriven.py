"""Accelerations of the modes of bodies in space, driven again by the forces of a record and by drives.

The counterpart of `driven` in three dimensions: forces act along the normal and both tangents of each contact. Pairs of
modes of a body that turns are plain oscillators in the frame of their waves. Forces are turned into that frame and
motion out of it, by the angle ``b`` of the waves, with ``J`` a quarter of a turn:

    q'' = R(b) (Q'' + 2 b' J Q' + (b'' J - b'²) Q)

Modes that springs and dashpots couple are replaced by the modes of the coupled system, `coupled_modes`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..lowering import Assembly, TurningModes
from ..system import System
from .coupled_modes import coupled_response
from .driven import FASTEST, Modes, respond
from .driving import Driving, driving


@dataclass(frozen=True)
class Moved:
    """Motion of the modes of a system.

    Attributes
    ----------
    start, interval : float
        Time at which the record begins, and its sample interval [s].
    samples : int
        Number of its samples.
    first : float
        Time of the first acceleration [s].
    accelerations : ndarray, shape (modes, samples + 2 LEAD)
        Accelerations of all modes [m kg^(1/2) / s²], zero for those left out and for residual shapes.
    left_out : ndarray of bool, shape (modes,)
        Modes too fast for the samples.
    pushed : float or None
        Time at which the first force acts [s from the start], None if none does.
    spans : dict
        First mode of each body and the one after its last, by body name.
    is_recorded : bool
        Whether it is the recorded motion of the march itself.
    """

    start: float
    interval: float
    samples: int
    first: float
    accelerations: Array
    left_out: Array
    pushed: float | None
    spans: dict[str, tuple[int, int]]
    is_recorded: bool = False

    @property
    def words(self) -> str:
        """Origin of the motion, for attributes."""
        return "recorded" if self.is_recorded else "driven again"


def redriven(run: xr.Dataset, system: System, bodies: Sequence[Any] | None = None) -> Moved:
    """Return the motion of the modes of a system under the forces of a record, at rest before it.

    Only that of `bodies`, if given, and of all bodies whose modes springs couple to theirs.

    Raises
    ------
    ValueError
        If the record is not usable or not one of the system.
    """
    return moved_by(driving(run, system, bodies))


def moved_by(given: Driving) -> Moved:
    """Return the motion of modes under forces."""
    found, left_out = _moved(given)
    return Moved(
        given.start, given.interval, given.samples, given.first, found, left_out, given.pushed, given.flat.spans
    )


def _moved(given: Driving) -> tuple[Array, Array]:
    """Return the accelerations of all modes, and a mask of those too fast for the samples."""
    flat, interval = given.flat, given.interval
    forces, coupled = given.forces(np.arange(flat.mode_count)), flat.coupled
    found = np.zeros_like(forces)
    left_out = ~flat.massless & (flat.angular_frequency * interval >= FASTEST)
    plain = ~flat.massless & ~left_out
    plain[:coupled] = False
    for turning in flat.turning:
        pairs = turning.pairs[plain[turning.pairs[:, 0]] & (np.array(turning.turning.drag) != 0.0)]
        plain[pairs] = False
        found[pairs.T.ravel()] = _turning(flat, turning, pairs, forces, given.times, interval)
    found[plain] = respond(Modes(flat.angular_frequency[plain], flat.damping_rate[plain]), forces[plain], interval)
    moving = np.flatnonzero(~flat.massless[:coupled])
    if moving.size:
        block = np.ix_(moving, moving)
        found[moving], fast = coupled_response(flat.stiffness[block], flat.dissipation[block], forces[moving], interval)
        left_out[moving[moving.size - fast :]] = True
    return found, left_out


def _turning(
    flat: Assembly, turning: TurningModes, pairs: Array, forces: Array, times: Array, interval: float
) -> Array:
    """Return the accelerations of pairs of modes of a body that turns, first ones before second ones."""
    drags = {tuple(pair): drag for pair, drag in zip(turning.pairs.tolist(), turning.turning.drag, strict=True)}
    drag = np.array([drags[tuple(pair)] for pair in pairs.tolist()])[:, None]
    rate = drag * turning.turning.rate(times)
    angle = drag * turning.turning.velocity * turning.turning.history.integral(times)
    change = np.gradient(rate, interval, axis=1)
    first, second = pairs.T
    cosine, sine = np.cos(angle), np.sin(angle)
    ahead, behind = cosine * forces[first] + sine * forces[second], cosine * forces[second] - sine * forces[first]
    modes = Modes(flat.angular_frequency[first], flat.damping_rate[first])
    (x, y), (u, v), (a, b) = (
        [respond(modes, force, interval, derivative) for force in (ahead, behind)] for derivative in range(3)
    )
    a, b = a - 2.0 * rate * v - change * y - rate**2 * x, b + 2.0 * rate * u + change * x - rate**2 * y
    return np.concatenate([cosine * a - sine * b, sine * a + cosine * b])
