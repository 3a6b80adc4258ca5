"""Motion of systems in the plane as drawn: a part to scale, and exaggerated departures from it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from ..arrays import Array
from ..lines import Line, Touch, lines_of
from ..system import System
from .motion import Motion

# Length by which a rigid track is drawn beyond its contact on both sides, as a share of the bodies' extent.
BEYOND = 0.1
# Extent assumed for a point at rest [m].
SMALLEST = 1e-3


@dataclass(frozen=True, eq=False)
class Surface:
    """A straight surface that moves along itself: a rigid track, or a surface that slides past a point.

    Attributes
    ----------
    place : ndarray, shape (frames, 2)
        World place of its abscissa 0, drawn to scale [m].
    departure : ndarray, shape (frames, 2)
        Departure from that place, drawn exaggerated [m].
    tangent, outwards : ndarray, shape (2,)
        Direction of the surface, and the direction from the surface to its inside.
    ends : ndarray, shape (2,)
        Abscissas between which it is drawn [m].
    travel : ndarray, shape (frames,)
        Distance moved along itself [m].
    is_exaggerated : bool
        Whether its travel is exaggerated like the slip of a point on it.
    """

    place: Array
    departure: Array
    tangent: Array
    outwards: Array
    ends: Array
    travel: Array
    is_exaggerated: bool = False


@dataclass(frozen=True, eq=False)
class PlaneMotion:
    """Motion of a system in the plane over a window of time, frame by frame.

    The part to scale is the mean shape of each body, moved so that its contacts are just closed, on the mean shape of
    the surface that it slides on. Departures from it are exaggerated. A closed contact is thus closed in the picture,
    and a gap has the same scale as the vibration.

    Attributes
    ----------
    run : xarray.Dataset
        Record over the window, a sample for each frame.
    lines : list of Line
        Lines that are drawn.
    touches : list of Touch
        Places where lines touch, one for each contact.
    reference, departure : list of ndarray, shape (frames, points, 2)
        World places of each line drawn to scale, and the departures from them [m].
    surfaces : list of Surface
        Rigid tracks, and surfaces that slide past points.
    """

    run: xr.Dataset
    lines: list[Line]
    touches: list[Touch]
    reference: list[Array]
    departure: list[Array]
    surfaces: list[Surface]

    def drawn(self, exaggeration: float) -> list[Array]:
        """Return the places of each line with departures drawn `exaggeration` times, shape (frames, points, 2)."""
        return [one + exaggeration * apart for one, apart in zip(self.reference, self.departure, strict=True)]

    @property
    def largest(self) -> float:
        """Largest departure [m]."""
        return max(float(np.abs(apart).max()) for apart in self.departure)

    @property
    def extent(self) -> float:
        """Largest extent of the part to scale [m]."""
        return extent_of(self.reference)


def extent_of(places: list[Array]) -> float:
    """Return the largest extent of places [m], 1 mm if they coincide."""
    return float(np.ptp(np.concatenate([one.reshape(-1, 2) for one in places]), axis=0).max()) or SMALLEST


def plane_motion(system: System, motion: Motion) -> PlaneMotion:
    """Return the motion of the lines of a system in the plane."""
    lines, touches = lines_of(system)
    places = []
    for line in lines:
        moved = line.place + line.moved(motion.modes.displacement[line.name])
        moved[..., 0] += motion.travel[:, None] * line.is_held
        places.append(moved)
    time = motion.run["time"].values
    bodies = _References(lines, touches, places, time).found
    reference = [bodies[number] for number in range(len(lines))]
    departure = [place - one for place, one in zip(places, reference, strict=True)]
    surfaces = surfaces_slid_on(lines, touches, reference, departure, time)
    return PlaneMotion(motion.run, lines, touches, reference, departure, surfaces)


def rest(touch: Touch, lines: list[Line]) -> Array:
    """Return the place of abscissa 0 of a rigid track at rest [m]."""
    normal, tangent = touch.contact.frame
    line, tip = touch.tip
    found: Array = lines[line].place[tip] - touch.contact.gap * normal - touch.contact.at * tangent
    return found


def _raised(touch: Touch, time: Array) -> Array:
    """Return the distance that a rigid track has moved towards the tip [m]."""
    track = touch.contact.rigid_track
    assert track is not None
    return track.normal_travel(time)


class _References:
    """Places to scale of each line; a touched line is computed before the lines that touch it."""

    def __init__(self, lines: list[Line], touches: list[Touch], places: list[Array], time: Array) -> None:
        self._lines, self._places, self._time = lines, places, time
        self.found: dict[int, Array] = {}
        left = list(range(len(lines)))
        while left:
            ours = {k: [one for one in touches if one.tip[0] == k] for k in left}
            ready = (
                k
                for k, found in ours.items()
                if all(one.touched is None or one.touched[0] in self.found for one in found)
            )
            # If two lines touch each other, only one of them can come first.
            number = next(ready, left[0])
            left.remove(number)
            known = [one for one in ours[number] if one.touched is None or one.touched[0] in self.found]
            self.found[number] = self._of(number, known)

    def _of(self, number: int, touches: list[Touch]) -> Array:
        place, line = self._places[number], self._lines[number]
        below = [self._below(one) for one in touches]
        ridden = below[0][:, None] if touches else np.zeros((1, 1, 2))
        found = np.asarray(ridden + (place - ridden).mean(axis=0) + np.zeros_like(place))
        rows = sorted({one.tip[1] for one in touches}, key=lambda row: line.along[row])
        opened = np.zeros((len(place), len(rows), 2))
        for k, row in enumerate(rows):
            here = [(one.contact.frame[0], b) for one, b in zip(touches, below, strict=True) if one.tip[1] == row]
            normals = np.array([normal for normal, _ in here])
            gaps = np.array([(found[:, row] - b) @ normal for normal, b in here])
            opened[:, k] = (np.linalg.pinv(normals) @ gaps).T
        shares = np.array([np.interp(line.along, line.along[rows], one) for one in np.eye(len(rows))])
        return found - np.einsum("fki,kp->fpi", opened, shares) if rows else found

    def _below(self, touch: Touch) -> Array:
        """Return the place of the track below a tip over time, to scale, shape (frames, 2)."""
        normal, tangent = touch.contact.frame
        tip = self._places[touch.tip[0]][:, touch.tip[1]]
        if touch.touched is None:
            origin = rest(touch, self._lines)
            height = origin @ normal + _raised(touch, self._time).mean()
            return np.asarray(np.outer(tip @ tangent, tangent) + height * normal)
        track, row = touch.touched
        places = self.found[track]
        if touch.contact.path_body is None:
            return places[:, row]
        count = self._lines[track].count
        x = tip[:, 0]
        heights = [np.interp(here, one[:count, 0], one[:count, 1]) for here, one in zip(x, places, strict=True)]
        return np.stack([x, heights], axis=1)


def surfaces_slid_on(
    lines: list[Line], touches: list[Touch], reference: list[Array], departure: list[Array], time: Array
) -> list[Surface]:
    """Return the rigid tracks and the surfaces that slide past points."""
    beyond = BEYOND * extent_of(reference)
    found = []
    for touch in touches:
        contact, (normal, tangent) = touch.contact, touch.contact.frame
        if touch.touched is None:
            origin, raised = rest(touch, lines), _raised(touch, time)
            along = (reference[touch.tip[0]][:, touch.tip[1]] - origin) @ tangent
            ends = np.array([along.min() - beyond, along.max() + beyond])
            track = contact.rigid_track
            assert track is not None
            place = np.tile(origin + raised.mean() * normal, (time.size, 1))
            apart = np.outer(raised - raised.mean(), normal)
            found.append(Surface(place, apart, tangent, -normal, ends, track.travel(time)))
        elif contact.surface_velocities[0]:
            line, row = touch.touched
            reach = np.abs(departure[line][:, row] @ tangent).max()
            place = reference[line][:, row]
            travel = -contact.surface_velocities[0] * time
            ends = np.array([-1.0, 1.0]) * reach
            found.append(Surface(place, np.zeros_like(place), tangent, normal, ends, travel, True))
    return found
