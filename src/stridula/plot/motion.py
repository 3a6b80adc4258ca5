"""Motion of the modes of all bodies over a window of time, for drawing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, at_most, non_negative, positive
from ..integration import simulate
from ..integration.settings import Given, Settings, settings_of
from ..integration.timing import choose_timing
from ..lowering import assemble
from ..records import Displacement, ModalDisplacement, ModalVelocity, Probe
from ..system import System
from .reels import FEWEST_FRAMES, check_frames

SAMPLE_RATE = Settings.sample_rate


@dataclass(frozen=True)
class ModalMotion:
    """Motion of the modes of bodies, frame by frame.

    Attributes
    ----------
    displacement, velocity : mapping
        Modal values by body name, shape (frames, modes); velocities may be left out.
    """

    displacement: Mapping[str, Array]
    velocity: Mapping[str, Array]

    @property
    def frames(self) -> int:
        """Number of frames."""
        return len(next(iter(self.displacement.values())))


@dataclass(frozen=True)
class Motion:
    """Motion of a system over a window of time, frame by frame.

    Attributes
    ----------
    run : xarray.Dataset
        Record over the window, a sample for each frame.
    modes : ModalMotion
        Motion of the modes of its bodies.
    travel : ndarray, shape (frames,)
        Displacement along x of the body under an imposed velocity, in addition to that of its modes [m].
    """

    run: xr.Dataset
    modes: ModalMotion
    travel: Array


def motion_of(
    system: System, window: tuple[float, float], frame: float, given: Given, velocities: bool = False
) -> Motion:
    """Simulate a system up to the end of a window, with probes of all modes of its bodies.

    Parameters
    ----------
    system : System
        The system.
    window : tuple of float
        Start and duration [s].
    frame : float
        Time between frames [s]; the nearest whole number of steps is taken.
    given : Given
        Scheme, step and sample rate; with scheme and step of a record, the run equals it to the last bit. Without a
        step, that of `simulate` at the sample rate.
    velocities : bool, optional
        Whether to probe the velocities of the modes as well.

    Raises
    ------
    ValueError
        If an argument is out of its range, or the run ends before the window does.
    """
    counts = {body: body.modes(system.is_held(body)).count for body in system.bodies}
    kinds: list[Any] = [ModalDisplacement, ModalVelocity] if velocities else [ModalDisplacement]
    probes: list[Probe] = [kind(body, k) for kind in kinds for body, n in counts.items() for k in range(n)]
    imposed = system.imposed_velocity
    probes += [] if imposed is None else [Displacement(imposed.point, "x")]
    run = _simulated(system, window, frame, given, probes)
    ends = np.cumsum(list(counts.values()))[:-1]
    names = [system.body_name(body) for body in counts]
    moved: list[dict[str, Array]] = [
        dict(zip(names, np.split(run[kind.quantity].values, ends, axis=1), strict=True)) for kind in kinds
    ]
    travel = np.zeros(run.sizes["time"]) if imposed is None else run[Displacement.quantity].values[:, 0]
    quantities = [kind.quantity for kind in kinds]
    return Motion(run.drop_vars(quantities), ModalMotion(moved[0], moved[1] if velocities else {}), travel)


def _simulated(
    system: System, window: tuple[float, float], frame: float, given: Given, probes: list[Probe]
) -> xr.Dataset:
    """Simulate a system up to the end of a window and return the record over it, a sample for each frame."""
    start, duration = window
    positive("duration", duration)
    check_frames(duration, frame)
    end = non_negative("start", start) + duration
    asked = settings_of("simulate", given)
    step = asked.step
    if step is None:
        step = choose_timing(assemble(system, ()), asked.scheme, end, None, asked.sample_rate).step
    of_frames = Given(scheme=asked.scheme, step=step, sample_rate=1.0 / frame, probes=probes, surface_rate="all")
    run = simulate(system, end, **of_frames)
    shown = run.isel(time=run["time"].values > start + 0.5 * float(run.attrs["sample_interval"]))
    if shown.sizes["time"] < FEWEST_FRAMES:
        ended = f"{run.attrs['ended']} at {at_most(float(run['time'][-1]))} s"
        raise ArgumentError("start", f"be before the run ends ({ended})", start)
    return shown
