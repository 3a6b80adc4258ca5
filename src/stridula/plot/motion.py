"""Motion of a slider, its track and their contact over a window of time, as it is to be drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import singledispatch
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..assembly import assemble
from ..bodies import FiniteElementBeam, ModalBeam, ModalPlate
from ..checks import ArgumentError, at_most, instance, non_negative, positive
from ..contact import RigidTrack
from ..integration import simulate
from ..integration.schemes import ExactModal, Scheme
from ..integration.simulate import choose_timing
from ..records import Displacement, Probe
from ..system import System
from .reels import FEWEST_FRAMES, check_frames

# Points drawn of a body: enough for each half wave of its highest mode.
MOST_POINTS = 161
# Length of a rigid track on both sides of what is seen of it, as a share of the slider's length.
BEYOND = 0.3
SAMPLE_RATE = 100e3


@dataclass(frozen=True)
class Motion:
    """A slider and its track over a window of time, in frames.

    Attributes
    ----------
    run : xarray.Dataset
        Record over the window, a sample for each frame.
    slider : ndarray, shape (frames, points, 2)
        World places of the slider, its tip first [m], departures from rest as they are.
    track : ndarray, shape (frames, points, 2)
        The same of the track; of a plate, of the cut along the line of contact.
    slide : ndarray, shape (frames, 2)
        Place of the track below the tip where the track has its mean shape [m]: what the slider rides on.
    is_cut : bool
        Whether the track is a plate, cut along the line of contact.
    """

    run: xr.Dataset
    slider: Array
    track: Array
    slide: Array
    is_cut: bool = False

    def drawn(self, exaggeration: float) -> tuple[Array, Array]:
        """Return the places of slider and track with their vibration drawn `exaggeration` times.

        The mean shape of the track, the slide of the tip along it and the mean bend of the slider are to scale; what
        departs from them is exaggerated. So a closed contact is closed in the picture, and a gap is as large as the
        vibration beside it.
        """
        mean = self.track.mean(axis=0)
        track = mean + exaggeration * (self.track - mean)
        shape = self.slider - self.slide[:, None]
        bend = shape.mean(axis=0) - shape[:, 0].mean(axis=0)
        slider = self.slide[:, None] + bend + exaggeration * (shape - bend)
        return slider, track

    @property
    def largest(self) -> float:
        """Largest departure that is exaggerated [m]."""
        slider, track = self.drawn(2.0)
        still_slider, still_track = self.drawn(1.0)
        return max(float(np.abs(slider - still_slider).max()), float(np.abs(track - still_track).max()))

    @property
    def extent(self) -> float:
        """Largest extent of both bodies [m]."""
        places = np.concatenate([self.slider[0], self.track[0]])
        return float(np.ptp(places, axis=0).max())


def motion_of(
    system: System,
    start: float,
    duration: float,
    frame: float,
    scheme: Scheme | None = None,
    step: float | None = None,
    sample_rate: float = SAMPLE_RATE,
) -> Motion:
    """Simulate a system up to the end of a window with displacement probes along slider and track.

    With the scheme and the step of a record it is the motion of that record, to the last bit.

    Parameters
    ----------
    system : System
        One contact of a finite-element beam on a modal beam, a modal plate or a rigid track.
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
    slider, track = pair_of(system)
    shown: list[Any] = [slider] if system.contacts[0].rigid_track is track else [slider, track]
    places = {body: body_places(body) for body in shown}
    probes = [Displacement(body.at(s), axis) for body, along in places.items() for s in along for axis in "xy"]
    window = simulated_window(system, start, duration, frame, probes, scheme, step, sample_rate)
    return _motion(system, window, list(places.values()))


def simulated_window(
    system: System,
    start: float,
    duration: float,
    frame: float,
    probes: Sequence[Probe],
    scheme: Scheme | None,
    step: float | None,
    sample_rate: float,
) -> xr.Dataset:
    """Simulate a system up to the end of a window and return the record over it, a sample for each frame."""
    positive("duration", duration)
    check_frames(duration, frame)
    end = non_negative("start", start) + duration
    chosen: Scheme = ExactModal() if scheme is None else scheme
    if step is None:
        step = choose_timing(assemble(system, ()), chosen, end, None, sample_rate).step
    run = simulate(system, end, scheme=chosen, step=step, sample_rate=1.0 / frame, probes=probes)
    window = run.isel(time=run["time"].values > start + 0.5 * float(run.attrs["sample_interval"]))
    if window.sizes["time"] < FEWEST_FRAMES:
        ended = f"{run.attrs['ended']} at {at_most(float(run['time'][-1]))} s"
        raise ArgumentError("start", f"be before the run ends ({ended})", start)
    return window


def pair_of(system: System) -> tuple[FiniteElementBeam, ModalBeam | ModalPlate | RigidTrack]:
    """Return slider and track of a system that is filmed in the plane, refuse any other."""
    instance("system", system, System)
    slider: Any = system.slider
    track: Any = system.contacts[0].track
    several, touched = len(system.contacts) > 1, system.contacts[0].touched_point
    if several or system.is_spatial or not isinstance(slider, FiniteElementBeam) or touched is not None:
        under = f"a point of {_a(touched.body)}" if touched is not None else _a(track)
        under += " in space" if system.is_spatial else ""
        got = f"{len(system.contacts)} contacts" if several else f"{_a(slider)} on {under}"
        words = (
            "be a FiniteElementBeam on one ModalBeam, ModalPlate or RigidTrack, or have meshes in space, to be filmed"
        )
        raise ArgumentError("system", words, system, got=got)
    return slider, track


def _a(body: object) -> str:
    return f"a {type(body).__name__}"


def body_places(body: FiniteElementBeam | ModalBeam | ModalPlate) -> Array:
    """Return the places along a body at which it is drawn [m]."""
    low, high = body.ends
    return np.linspace(low, high, min(max(_fewest(body), 20) + 1, MOST_POINTS))


@singledispatch
def _fewest(body: Any) -> int:
    """Return how many pieces show every half-wave of a body."""
    # Along the line a product of two sines has the sum of their wavenumbers.
    low, high = body.ends
    return math.ceil(4.0 * float((body.wavenumbers @ np.abs(body.track_line.tangent)).max()) * (high - low) / math.pi)


@_fewest.register
def _of_finite_elements(body: FiniteElementBeam) -> int:
    return 2 * body.elements


@_fewest.register
def _of_a_beam(body: ModalBeam) -> int:
    return 4 * body.harmonics[0]


def _motion(system: System, run: xr.Dataset, along: list[Array]) -> Motion:
    contact = system.contacts[0]
    slider: Any = system.slider
    moved = run["displacement"].values.reshape(run.sizes["time"], -1, 2)
    first = along[0].size
    normal, tangent = contact.frame
    # The abscissa counts along the track, whose world place is known for a beam and chosen for the others.
    tip = contact.at * tangent + contact.gap * normal
    slider_places = tip + along[0][:, None] * slider.axes[0] + moved[:, :first]
    # That of the probes, whose low-pass the contact's own record does not have.
    abscissa = contact.at + moved[:, 0] @ tangent
    if contact.rigid_track is not None:
        length = BEYOND * slider.length
        ends = np.array([abscissa.min() - length, abscissa.max() + length])
        raised = contact.rigid_track.normal_travel(run["time"].values)
        track_places = ends[:, None] * tangent + raised[:, None, None] * normal
        return Motion(run, slider_places, track_places, abscissa[:, None] * tangent + raised.mean() * normal)
    rest = np.stack([along[1], np.zeros_like(along[1])], axis=1)
    # Motion along the track is left out: the tip is where it is along it, whatever the track below does.
    track_places = rest + moved[:, first:] * [0.0, 1.0]
    below = np.interp(abscissa, along[1], track_places[:, :, 1].mean(axis=0))
    is_cut = hasattr(contact.track, "track_line")
    return Motion(run, slider_places, track_places, np.stack([abscissa, below], axis=1), is_cut)
