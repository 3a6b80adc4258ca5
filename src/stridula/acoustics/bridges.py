"""Bodies that a recorded force drives, such as the top of an instrument under the bridge of its string."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
import xarray as xr

from ..arrays import Array, in_space
from ..bodies import BodyPoint, is_track
from ..checks import ArgumentError, instance, listed
from ..declared import check_declared
from ..records.checked import record
from ..records.probes import DIRECTION
from .air import Air
from .bodies_sound import Listening, bodies_sound, joined
from .driven import FASTEST, LEAD, Modes, pressed_motion, respond
from .free_bodies import ears_above
from .listeners import listeners_of
from .lone_tracks import panel_sound
from .motions import Motion
from .open_surfaces import open_surface
from .panels import Panel
from .recorded import Pressing, sampled
from .system_sound import ends_of

FORCE = "support_force"
# Component along the normal below which a force leaves a track silent.
ACROSS = 1e-6


@dataclass(frozen=True)
class Bridge:
    """A point of a body that is driven by the force that a string exerts on its support.

    The force is that of a `SupportForce` probe of the record, in one direction: the string is supported rigidly in its
    run, so the body must yield little under it. The body, which is not part of the run, is at rest before the record.

    Parameters
    ----------
    point : BodyPoint
        Point at which the force acts.
    direction : {"y", "x", "z", "axial", "transverse"} or sequence of float, optional
        Direction in which a positive force pushes the body, given as for probes.
    probe : str, optional
        Name of the probe in the record, such as "string left end"; the only one of the record if left out.

    Raises
    ------
    ValueError
        If an argument is out of its range.
    """

    point: BodyPoint
    direction: Annotated[str | Sequence[float], DIRECTION] = "y"
    probe: str | None = None

    def __post_init__(self) -> None:
        instance("point", self.point, BodyPoint)
        check_declared(self)
        if self.probe is not None:
            instance("probe", self.probe, str)

    @property
    def along(self) -> Array:
        """World components of the direction, a unit vector, shape (3,)."""
        return DIRECTION.along(self.direction, self.point.body.axes)


def bridged_sound(
    run: xr.Dataset, bridge: Bridge, listener: Any, baffled: bool | None, air: Air, sample_rate: float | None
) -> tuple[Array, Array, Array, dict[str, Any]]:
    """Return pressures (listeners, samples), their times, the listeners and attributes; arguments are as in `radiate`.

    Raises
    ------
    ValueError
        If the record has no such probe, the body has no surface, or a listener is inside a body or behind the baffle.
    """
    start, interval, force = _force(run, bridge.probe)
    body: Any = bridge.point.body
    if is_track(body) or not (body.is_spatial and getattr(body, "has_surface", False)):
        try:
            return panel_sound(
                lambda panel: _pressed(bridge, panel, start, interval, force),
                body,
                listener,
                baffled is not False,
                air,
                sample_rate,
            )
        except ArgumentError as error:
            raise error.renamed("point" if error.argument == "track" else error.argument) from None
    if baffled:
        raise ArgumentError("baffled", "be False, or left out, for bodies in space", baffled)
    if body.modes().turning is not None:
        raise ArgumentError("point", "be on a body that does not turn", bridge.point)
    # Any direction perpendicular to the force.
    aside = np.cross(bridge.along, np.eye(3)[int(np.abs(bridge.along).argmin())])
    name = getattr(body, "name", "") or type(body).__name__
    heard = [open_surface(name, body.surface(), body.modes(), np.zeros(3))]
    ears = ears_above(bridge.along, aside / np.linalg.norm(aside), heard) if listener is None else listener
    listeners = listeners_of(ears)
    pressure, time, attributes = bodies_sound(
        heard, lambda: [_moved(bridge, start, interval, force)], Listening(listeners, air, None, sample_rate)
    )
    notes = [attributes["notes"], ends_of({name: body.modes()})]
    return pressure, time, listeners, attributes | {"notes": joined(notes)}


def _force(run: xr.Dataset, probe: str | None) -> tuple[float, float, Array]:
    """Return the time at which a record begins [s], its interval [s] and the samples of a force [N]."""
    run = record("run", run)
    start, interval, _, _ = sampled(run)
    if FORCE not in run:
        raise ArgumentError("run", "have a SupportForce probe for a Bridge", run, got="none")
    known = [str(name) for name in run[f"{FORCE}_probe"].values]
    if probe is None and len(known) > 1:
        raise ArgumentError("probe", f"be one of {listed(known)}", got="none")
    if probe is not None and probe not in known:
        raise ArgumentError("probe", f"be one of {listed(known)}", probe)
    number = 0 if probe is None else known.index(probe)
    force = np.asarray(run[FORCE].transpose("time", ...).values[:, number], dtype=float)
    if not np.isfinite(force).all():
        raise ArgumentError(FORCE, "be finite", got=f"{force[~np.isfinite(force)][0]}")
    if start > 0.5 * interval:
        # The force before a continued record has already bent the body.
        force = force - force[0]
    return start, interval, force


def _pressed(bridge: Bridge, panel: Panel, start: float, interval: float, force: Array) -> Motion:
    """Return the motion of a track under the force, taken as a normal force."""
    body = bridge.point.body
    across = float(in_space(body.axes[1]) @ bridge.along)
    if abs(across) < ACROSS:
        raise ArgumentError("direction", "have a part along the normal of the body", bridge.direction)
    position = bridge.point.position
    x, y = position if isinstance(position, tuple) else panel.place(np.asarray(position))
    at = replace(panel, place=lambda abscissa: (np.full_like(abscissa, x), np.full_like(abscissa, y)))
    # Samples stand at the ends of intervals; each counts as a single impulse in its interval.
    still = np.zeros((1, force.size))
    return pressed_motion(at, Pressing(start, interval, 1, -across * force[None], still, interval), "nothing pushes")


def _moved(bridge: Bridge, start: float, interval: float, force: Array) -> Motion:
    """Return the motion of a body in space under the force."""
    body = bridge.point.body
    modes = body.modes()
    row = bridge.along @ body.trace(bridge.point.position)
    signal = np.concatenate([np.zeros(LEAD), force, np.full(LEAD, force[-1])])

    def accelerations(numbers: Array) -> Array:
        oscillators = Modes(modes.angular_frequency[numbers], modes.damping_rate[numbers])
        return respond(oscillators, row[numbers, None] * signal, interval)

    pushes = np.flatnonzero(force)
    return Motion(
        start,
        interval,
        force.size,
        start + (1 - LEAD) * interval,
        float(pushes[0]) * interval if pushes.size else None,
        np.flatnonzero(modes.angular_frequency * interval < FASTEST),
        accelerations,
    )
