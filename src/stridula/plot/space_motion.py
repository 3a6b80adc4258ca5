"""Motion of systems in space over a window of time, as it is to be drawn: that of the modes of their bodies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, instance
from ..integration.schemes import Scheme
from ..records import ModalDisplacement, ModalVelocity
from ..system import System
from .motion import SAMPLE_RATE, simulated_window


@dataclass(frozen=True)
class ModalMotion:
    """The modes of bodies in frames.

    Attributes
    ----------
    displacement, velocity : mapping
        Of the modes of each body by its name, shape (frames, modes).
    """

    displacement: Mapping[str, Array]
    velocity: Mapping[str, Array]

    @property
    def frames(self) -> int:
        """Number of frames."""
        return len(next(iter(self.displacement.values())))


@dataclass(frozen=True)
class SpaceMotion:
    """A system in space over a window of time, in frames.

    Attributes
    ----------
    run : xarray.Dataset
        Record over the window, a sample for each frame.
    modes : ModalMotion
        Motion of the modes of its bodies.
    """

    run: xr.Dataset
    modes: ModalMotion


def has_surfaces(system: System) -> bool:
    """Return whether a system has bodies whose surface is known."""
    instance("system", system, System)
    return any(is_drawn(body) for body in system.bodies)


def is_drawn(body: Any) -> bool:
    """Return whether the surface of a body is known."""
    return hasattr(body, "drawn_surface") and getattr(body, "is_drawn", True)


def check_surfaces(system: System) -> None:
    """Raise ValueError unless a system has a body whose surface is known."""
    if not has_surfaces(system):
        kinds = sorted({type(body).__name__ for body in system.bodies})
        words = "have a SolidBody or an AxisymmetricBody, whose surface is drawn"
        raise ArgumentError("system", words, system, got=", ".join(kinds))


def space_motion_of(
    system: System,
    start: float,
    duration: float,
    frame: float,
    scheme: Scheme | None = None,
    step: float | None = None,
    sample_rate: float = SAMPLE_RATE,
) -> SpaceMotion:
    """Simulate a system up to the end of a window, with probes of all modes of its bodies.

    With the scheme and the step of a record it is the motion of that record, to the last bit.

    Parameters
    ----------
    system : System
        A system with a body whose surface is known.
    start, duration : float
        The window [s].
    frame : float
        Time between frames [s]; the nearest whole number of steps is taken.
    scheme : ExactModal or CentralDifference, optional
        Time scheme, the exact modal one if left out.
    step : float, optional
        Time step [s], that of `simulate` at `sample_rate` if left out.
    sample_rate : float, optional
        Sample rate [Hz] of the run that is shown, of no effect where a step is given.

    Raises
    ------
    ValueError
        If the system is of another kind, an argument is out of its range, or the run ends before the window does.
    """
    check_surfaces(system)
    counts = {body: body.modes(system.is_held(body)).count for body in system.bodies}
    probes = [
        kind(body, k) for kind in (ModalDisplacement, ModalVelocity) for body, n in counts.items() for k in range(n)
    ]
    run = simulated_window(system, start, duration, frame, probes, scheme, step, sample_rate)
    ends = np.cumsum(list(counts.values()))[:-1]
    names = [system.body_name(body) for body in counts]
    moved, fast = (
        dict(zip(names, np.split(run[kind.quantity].values, ends, axis=1), strict=True))
        for kind in (ModalDisplacement, ModalVelocity)
    )
    return SpaceMotion(
        run.drop_vars([kind.quantity for kind in (ModalDisplacement, ModalVelocity)]), ModalMotion(moved, fast)
    )
