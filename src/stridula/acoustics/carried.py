"""The sound of a beam that its root carries along at an imposed velocity, whose changes move all of it alike."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..system import System
from .air import Air
from .convolution import Convolution
from .delays import Sampling
from .dipoles import dipole_response, moved_area
from .driven import LEAD, steady
from .redriven import Moved
from .slim_beams import SlimBeam

# Number of steps in an interval with which a mean of steps is one over time.
MANY = 1_000_000


class Rigid:
    """A beam as a line of dipoles that moves as a whole along world x, for `dipole_response`."""

    width = edge = 0.0
    wavenumbers = np.zeros((1, 2))

    def __init__(self, beam: SlimBeam) -> None:
        self.length, self.across = beam.length, float(beam.body.axes[1][0])

    def shapes(self, x: Array, y: Array) -> Array:
        """Return the part across the beam of a unit motion along x, shape (places, 1)."""
        return np.full((x.size, 1), self.across)


def is_carried(system: System, body: Any) -> bool:
    """Return whether the root of a body follows an imposed velocity that changes."""
    imposed = system.imposed_velocity
    return imposed is not None and imposed.point.body == body and imposed.history.settled != 0.0


def carried_sound(beam: SlimBeam, system: System, places: Array, air: Air, moved: Moved, bandwidth: float) -> Array:
    """Return the pressure of the motion of the root of a beam, as a line of dipoles, shape (listeners, samples).

    The modes move relative to the root, on which they are driven by the inertia of the beam. Before the record the
    velocity is constant.

    Parameters
    ----------
    beam : SlimBeam
        The beam, carried.
    system : System
        Its system.
    places : ndarray, shape (listeners, 3)
        Listeners [m].
    air : Air
        The air.
    moved : Moved
        Motion of its modes, with which the sound has its samples in common.
    bandwidth : float
        Frequency up to which the sound is complete [Hz].
    """
    imposed: Any = system.imposed_velocity
    edges = moved.start + moved.interval * np.arange(moved.samples + 1)
    means = imposed.velocity * np.diff(imposed.history.factor(edges)) / moved.interval
    # Means over intervals count at their middles.
    sampling = Sampling(moved.interval, bandwidth, 0.5 - LEAD)
    line: Any = Rigid(beam)
    area = moved_area(beam.body.section)
    responses = [dipole_response(line, area, one, air, sampling) for one in beam.beside(places)]
    sound = Convolution(responses, moved.samples + 2 * LEAD)
    sound.add(steady(means[None], MANY + 1), slice(None))
    return sound.signals()[:, : moved.samples]
