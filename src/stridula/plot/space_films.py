"""Pictures and films of systems in space."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..cards import VIEW
from ..checks import positive
from ..integration.settings import Given
from ..lowering.schemes import Scheme
from ..system import System
from .motion import SAMPLE_RATE, ModalMotion, Motion, motion_of
from .moved_bodies import check_surfaces, extent_of, largest_departure, surfaces_of
from .reels import DPI, HEIGHT, WIDTH, rounded
from .scenes import Scene, checked_view
from .timelines import draw_contact

# By default, the largest vibration is drawn as this share of the bodies' extent.
SHARE = 0.04
# Length of time before a picture over which the mean is taken, and interval of its samples [s].
BEFORE, FRAME = 2e-3, 4e-5
# Areas in the figure: left and lower edge, width, height. The layouts of matplotlib reserve space for axes in space
# even if they are hidden.
SCENE, COLOUR_BAR = (0.02, 0.31, 0.86, 0.62), (0.905, 0.36, 0.015, 0.5)
FORCE, STATUS = (0.09, 0.17, 0.79, 0.11), (0.09, 0.075, 0.79, 0.03)


def bodies(
    system: System,
    time: float,
    *,
    exaggeration: float | None = None,
    view: tuple[float, float] = VIEW,
    scheme: Scheme | None = None,
    step: float | None = None,
    sample_rate: float = SAMPLE_RATE,
    title: str = "",
) -> Figure:
    """Draw the bodies of a system in space at one time, coloured by the velocity across their surfaces.

    The system is simulated from its start. Contact points are coloured by status. Departures from the mean of the last
    2 ms are exaggerated.

    Parameters
    ----------
    system : System
        A system with a `SolidBody` or an `AxisymmetricBody`.
    time : float
        Time of the picture [s].
    exaggeration : float, optional
        Factor by which the vibration is drawn larger; if left out, the vibration is drawn near 4 % of the extent.
    view : tuple of float, optional
        Elevation of the eye above the plane across y and its azimuth from z towards x [rad].
    scheme : ExactModal or CentralDifference, optional
        Time scheme; if left out, the exact modal one.
    step : float, optional
        Time step [s]; if left out, that of `simulate` at `sample_rate`.
    sample_rate : float, optional
        Sample rate [Hz] of the run shown; no effect with a given `step`.
    title : str, optional
        Title of the picture.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If an argument is out of its range, no body has a surface, or the run ends before the time.
    """
    check_surfaces(system)
    seen = checked_view(view)
    duration = min(positive("time", time), BEFORE)
    frame = min(FRAME, 0.5 * duration)
    start = max(time - duration, 0.0)
    given = Given(scheme=scheme, step=step, sample_rate=sample_rate)
    motion = motion_of(system, (start, duration), frame, given, velocities=True)
    times = exaggeration_of(system, motion.modes, exaggeration)
    picture = SpacePicture(system, motion, times, None, title, seen)
    picture.show(picture.frames - 1)
    return picture.figure


def exaggeration_of(system: System, modes: ModalMotion, given: float | None) -> float:
    """Return the exaggeration of the vibration: as given, else to draw it near `SHARE` of the bodies' extent."""
    if given is not None:
        return positive("exaggeration", given)
    shown = surfaces_of(system, np.zeros(3))
    largest = largest_departure(shown, modes)
    return rounded(SHARE * extent_of(shown) / largest) if largest > 0.0 else 1.0


class SpacePicture:
    """The picture of a system in space, to be drawn frame by frame.

    Parameters
    ----------
    system : System
        The system.
    motion : Motion
        Its motion.
    exaggeration : float
        Factor by which the vibration is drawn larger.
    slowdown : float or None
        Slow-motion factor, None for a still picture.
    title : str
        Title.
    view : tuple of float
        Elevation and azimuth of the eye [rad].

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    scene : Scene
        The bodies.
    frames : int
        Number of frames.
    """

    def __init__(
        self,
        system: System,
        motion: Motion,
        exaggeration: float,
        slowdown: float | None,
        title: str,
        view: tuple[float, float],
    ) -> None:
        self.run, self.frames = motion.run, motion.modes.frames
        slowed = "" if slowdown is None else f"slowed down {slowdown:.6g} times, "
        self.scales = f"{slowed}vibration drawn {exaggeration:.6g} times"
        self.figure = Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI)
        self.scene = Scene(self.figure, SCENE, system, motion.modes, exaggeration, view)
        self.scene.colour_bar(self.figure.add_axes(COLOUR_BAR), self.scene.moved.largest_velocity)
        self.words = self.figure.text(0.01, 0.98, "", fontsize=9, verticalalignment="top")
        self.cursors = draw_contact(self.figure.add_axes(FORCE), self.figure.add_axes(STATUS), self.run)
        self.figure.suptitle(title, fontsize=11)
        self.show(0)
        self.scene.fill()

    def show(self, frame: int) -> None:
        """Draw one frame."""
        self.scene.show(frame, np.atleast_1d(self.run["status"].values[frame]))
        time = float(self.run["time"].values[frame])
        for cursor in self.cursors:
            cursor.set_xdata([time, time])
        self.words.set_text(f"{self.scales}\nt = {1e3 * time:.3f} ms")
