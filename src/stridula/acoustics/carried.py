"""The sound of a beam that its root carries along at an imposed velocity, whose changes move all of it alike."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ..arrays import Array
from ..system import System
from .driven import LEAD, steady
from .motions import Motion
from .slim_beams import SlimBeam

# Number of steps in an interval with which a mean of steps is one over time.
MANY = 1_000_000
# Number of the only mode of a beam that moves as a whole.
WHOLE = np.zeros(1, dtype=int)


class _Carried(SlimBeam):
    """A beam as a line of dipoles that moves as a whole along world x."""

    def shapes(self, x: Array, y: Array) -> Array:
        """Return the part across the beam of a unit motion along x, shape (places, 1)."""
        return np.full((x.size, 1), float(self.body.axes[1][0]))


def carried(beam: SlimBeam) -> SlimBeam:
    """Return a beam as it moves as a whole."""
    return _Carried(beam.name, beam.body, True, WHOLE, np.zeros((1, 2)), beam.frame, beam.origin)


def is_carried(system: System, body: Any) -> bool:
    """Return whether the root of a body follows an imposed velocity that changes."""
    imposed = system.imposed_velocity
    return imposed is not None and imposed.point.body == body and imposed.history.settled != 0.0


def carried_motion(system: System, moved: Motion) -> Motion:
    """Return the motion of the root of a beam, relative to which its modes move.

    They are driven by the inertia of the beam. Before the record the velocity is constant.

    Parameters
    ----------
    system : System
        Its system.
    moved : Motion
        Motion of its modes, with which this has its samples in common.
    """
    imposed: Any = system.imposed_velocity
    edges = moved.start + moved.interval * np.arange(moved.samples + 1)
    means = imposed.velocity * np.diff(imposed.history.factor(edges)) / moved.interval
    accelerations = steady(means[None], MANY + 1)
    # Means over intervals count at their middles.
    first = moved.start + (0.5 - LEAD) * moved.interval
    return replace(moved, first=first, begins=0.0, carried=WHOLE, accelerations=lambda modes: accelerations[modes])
