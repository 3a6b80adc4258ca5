"""Motion of the track of a system in the plane under all forces of a record and all drives."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..connections import ends
from ..system import System
from .driven import FASTEST, Modes, respond
from .driving import Driving, driving
from .free_bodies import start_notes
from .redriven import Moved, moved_by


class TrackMotion:
    """Modes of a track driven again by all forces of a system.

    Parameters
    ----------
    run : xarray.Dataset
        The record.
    system : System
        Its system.
    track : ModalBeam or ModalPlate
        The track.

    Attributes
    ----------
    start, interval : float
        Time at which the record begins, and its sample interval [s].
    samples : int
        Number of its samples.
    first : float
        Time of the first acceleration [s].
    begins : float or None
        Begin of the sample interval in which a force first acts [s from the start], None if none does.
    notes : list of str
        Notes on missing parts.
    """

    words = "driven again"

    def __init__(self, run: xr.Dataset, system: System, track: Any) -> None:
        self._driving: Driving = driving(run, system, [track])
        given = self._driving
        self._from = given.flat.spans[system.body_name(track)][0]
        self.start, self.interval, self.samples = given.start, given.interval, given.samples
        self.first, self.begins = given.first, given.pushed
        continues = "the record continues another one; vibration left from the earlier record is not included"
        self.notes = [continues] if given.start > 0.5 * given.interval else start_notes(system)

    @property
    def _is_coupled(self) -> bool:
        return self._from < self._driving.flat.coupled

    @cached_property
    def _coupled(self) -> Moved:
        return moved_by(self._driving)

    def carried(self, angular_frequency: Array) -> Array:
        """Return the numbers of the modes that the sample rate can represent; of coupled ones all."""
        if self._is_coupled:
            return np.arange(angular_frequency.size)
        return np.flatnonzero(angular_frequency * self.interval < FASTEST)

    def accelerations(self, modes: Any) -> Array:
        """Return the accelerations of modes, by their numbers, shape (modes, samples or more) [m kg^(1/2) / s²]."""
        numbers = self._from + modes
        if self._is_coupled:
            return self._coupled.accelerations[numbers]
        flat = self._driving.flat
        own = Modes(flat.angular_frequency[numbers], flat.damping_rate[numbers])
        return respond(own, self._driving.forces(numbers), self.interval)


def is_driven_otherwise(system: System, track: Any) -> bool:
    """Return whether drives, a start in motion, connections or contacts at a fixed point act on a track."""
    moves = any(drive.starts_motion and drive.acted_on in (None, track) for drive in system.drives)
    joined = any(point.body == track for connection in system.connections for point in ends(connection))
    pushed = any(
        drive.fall is not None or (drive.push is not None and drive.acted_on == track) for drive in system.drives
    )
    touched = any(
        point is not None and point.body == track
        for contact in system.contacts
        for point in (contact.tip, contact.touched_point)
    )
    return moves or joined or pushed or touched or track.modes().damping_matrix is not None
