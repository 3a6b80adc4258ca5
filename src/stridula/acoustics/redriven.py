"""Accelerations of the modes of bodies, driven again by the forces of a record and by drives.

The counterpart of `driven` for systems: forces act along the normal and all tangents of each contact. Pairs of
modes of a body that turns are plain oscillators in the frame of their waves. Forces are turned into that frame and
motion out of it, by the angle ``b`` of the waves, with ``J`` a quarter of a turn:

    q'' = R(b) (Q'' + 2 b' J Q' + (b'' J - b'²) Q)

Modes that springs and dashpots couple are replaced by the modes of the coupled system, `coupled_modes`.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..lowering import TurningModes
from ..system import System
from .coupled_modes import coupled_response
from .driven import FASTEST, Modes, respond
from .driving import Driving, driving, start_notes
from .motions import CONTINUES, Motion


class Redriven:
    """Modes of a system driven again by forces, at rest before them.

    Modes that are coupled and those of bodies that turn are computed once, all others whenever they are needed.

    Parameters
    ----------
    given : Driving
        The forces.
    notes : sequence of str, optional
        Notes on missing parts.
    """

    def __init__(self, given: Driving, notes: Sequence[str] = ()) -> None:
        self.given, self.notes, flat = given, notes, given.flat
        self._is_kept = ~flat.massless & (flat.angular_frequency * given.interval < FASTEST)
        self._is_kept[: flat.coupled] = ~flat.massless[: flat.coupled]
        self._is_joint = np.arange(flat.mode_count) < flat.coupled
        for turning in flat.turning:
            self._is_joint[turning.pairs[np.array(turning.turning.drag) != 0.0]] = True

    def of(self, name: str) -> Motion:
        """Return the motion of a body by its name."""
        given, (first, last) = self.given, self.given.flat.spans[name]
        fast = self._joint[1] if first < given.flat.coupled else 0
        left_out = [f"{fast} coupled modes above the limit of the record's sample rate are left out"] if fast else []
        return Motion(
            given.start,
            given.interval,
            given.samples,
            given.first,
            given.pushed,
            np.flatnonzero(self._is_kept[first:last]),
            lambda modes: self.accelerations(first + modes),
            notes=[*left_out, *self.notes],
        )

    def accelerations(self, modes: Array) -> Array:
        """Return the accelerations of modes, by their numbers, shape (modes, samples + 2 LEAD) [m kg^(1/2) / s²].

        They are zero for residual shapes and for modes too fast for the samples.
        """
        flat, joint = self.given.flat, self._is_joint[modes]
        found = np.zeros((modes.size, self.given.times.size))
        if joint.any():
            found[joint] = self._joint[0][np.searchsorted(np.flatnonzero(self._is_joint), modes[joint])]
        alone = ~joint & self._is_kept[modes]
        own = modes[alone]
        oscillators = Modes(flat.angular_frequency[own], flat.damping_rate[own])
        found[alone] = respond(oscillators, self.given.forces(own), self.given.interval)
        return found

    @cached_property
    def _joint(self) -> tuple[Array, int]:
        """Accelerations of the modes that are coupled or turn, and the number of coupled ones too fast."""
        given, flat, interval = self.given, self.given.flat, self.given.interval
        forces, at = given.forces(np.flatnonzero(self._is_joint)), np.cumsum(self._is_joint) - 1
        found, fast = np.zeros_like(forces), 0
        for turning in flat.turning:
            turned = self._is_kept[turning.pairs[:, 0]] & (turning.pairs[:, 0] >= flat.coupled)
            numbers = np.flatnonzero(turned & (np.array(turning.turning.drag) != 0.0))
            pairs = turning.pairs[numbers].T
            modes = Modes(flat.angular_frequency[pairs[0]], flat.damping_rate[pairs[0]])
            drag = np.array(turning.turning.drag)[numbers, None]
            found[at[pairs]] = _turning(modes, turning, drag, forces[at[pairs]], given.times, interval)
        moving = np.flatnonzero(~flat.massless[: flat.coupled])
        if moving.size:
            block = np.ix_(moving, moving)
            rows = at[moving]
            found[rows], fast = coupled_response(flat.stiffness[block], flat.dissipation[block], forces[rows], interval)
        return found, fast


def redriven(run: xr.Dataset, system: System, bodies: Sequence[Any] | None = None) -> Redriven:
    """Return the motion of the modes of a system under the forces of a record, at rest before it.

    Only that of `bodies`, if given, and of all bodies whose modes springs couple to theirs.

    Raises
    ------
    ValueError
        If the record is not usable or not one of the system.
    """
    given = driving(run, system, bodies)
    continues = given.start > 0.5 * given.interval
    return Redriven(given, [CONTINUES] if continues else start_notes(system))


def _turning(modes: Modes, turning: TurningModes, drag: Array, forces: Array, times: Array, interval: float) -> Array:
    """Return the accelerations of pairs of modes of a body that turns, shape (2, pairs, samples) as the forces."""
    rate = drag * turning.turning.rate(times)
    angle = drag * turning.turning.velocity * turning.turning.history.integral(times)
    change = np.gradient(rate, interval, axis=1)
    cosine, sine = np.cos(angle), np.sin(angle)
    ahead, behind = cosine * forces[0] + sine * forces[1], cosine * forces[1] - sine * forces[0]
    (x, y), (u, v), (a, b) = (
        [respond(modes, force, interval, derivative) for force in (ahead, behind)] for derivative in range(3)
    )
    a, b = a - 2.0 * rate * v - change * y - rate**2 * x, b + 2.0 * rate * u + change * x - rate**2 * y
    return np.stack([cosine * a - sine * b, sine * a + cosine * b])
