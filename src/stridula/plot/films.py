"""Films of a slider, its track and their contact, in slow motion."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..arrays import Array
from ..checks import positive
from ..integration.schemes import Scheme
from ..records.variables import STATUS_WORDS
from ..system import System
from .colours import LINE, STATUS_COLOURS
from .motion import SAMPLE_RATE, Motion, motion_of
from .reels import DPI, FRAMES_PER_SECOND, HEIGHT, WIDTH, Film, rounded, still, write_film, writer_for
from .scenes import VIEW
from .space_films import animate_in_space
from .space_motion import has_surfaces
from .timelines import draw_contact

DURATION, SLOWDOWN = 0.01, 1000.0
# Without a number, the largest vibration is drawn as this share of the bodies' extent.
SHARE = 0.1
# Thickness of the bodies' lines [points].
THICK = 2.5


def animate(
    system: System,
    out: str | Path,
    *,
    start: float = 0.0,
    duration: float = DURATION,
    slowdown: float = SLOWDOWN,
    exaggeration: float | None = None,
    view: tuple[float, float] = VIEW,
    scheme: Scheme | None = None,
    step: float | None = None,
    sample_rate: float = SAMPLE_RATE,
    title: str = "",
    progress: Callable[[int, int], None] = still,
) -> Film:
    """Film a slider and its track in slow motion, the contact point coloured by its status.

    The system is simulated from its start to the end of the window, with displacement probes along both bodies. With
    the scheme and the step of a record the film shows that very run. What is faster than the frames is smoothed away,
    and never seen as something slower. The mean shape of the track, the slide of the tip and the mean bend of the
    slider are to scale; the vibration about them is exaggerated, the gap with it. Motion of the track along itself is
    not drawn. Of a plate one sees the cut along the line of contact.

    Of a system in space one sees the surfaces of its meshed bodies and bodies of revolution in perspective, coloured by
    the velocity out of them, and its contact points by their status. What departs from the mean over the window is
    exaggerated. Rigid bodies that touch them, or are joined to them, are hulls of their points, or small balls; others
    are not drawn.

    Parameters
    ----------
    system : System
        One contact of a finite-element beam on a modal beam, a modal plate or a rigid track; or any system with a
        `SolidBody` or an `AxisymmetricBody`.
    out : str or Path
        The file, ``.mp4`` or ``.gif``, written whole or not at all. MP4 takes an encoder: ``pip install
        .[video]`` in the sources, or an ffmpeg on the path.
    start, duration : float, optional
        The window of time [s].
    slowdown : float, optional
        How much slower than life; made a whole number of steps for each frame.
    exaggeration : float, optional
        How many times larger than life the vibration is drawn; what brings it near 10 % of their extent, in space
        4 %, if left out.
    view : tuple of float, optional
        In space, elevation of the eye above the plane across y and its azimuth from z towards x [rad].
    scheme : ExactModal or CentralDifference, optional
        Time scheme, the exact modal one if left out.
    step : float, optional
        Time step [s], that of `simulate` at `sample_rate` if left out.
    sample_rate : float, optional
        Sample rate [Hz] of the run that is shown, of no effect where a step is given.
    title : str, optional
        Title of the film.
    progress : callable, optional
        Told the number of each frame drawn, and of how many.

    Returns
    -------
    Film
        What was written, with the slowdown and the exaggeration.

    Raises
    ------
    ValueError
        If an argument is out of its range, the system is of another kind, the run ends before the window, or there is
        no encoder for the file.
    OSError
        If the file cannot be written.
    """
    positive("slowdown", slowdown)
    if exaggeration is not None:
        positive("exaggeration", exaggeration)
    if has_surfaces(system):
        timing, window = (scheme, step, sample_rate), (start, duration)
        return animate_in_space(system, out, window, slowdown, exaggeration, view, timing, title, progress)
    writer = writer_for(out)
    frame = 1.0 / (FRAMES_PER_SECOND * slowdown)
    motion = motion_of(system, start, duration, frame, scheme, step, sample_rate)
    times = rounded(SHARE * motion.extent / motion.largest) if exaggeration is None else exaggeration
    interval = float(motion.run.attrs["sample_interval"])
    slowed = 1.0 / (FRAMES_PER_SECOND * interval)
    picture = Picture(motion, times, slowed, title)
    write_film(picture, out, writer, progress)
    return Film(str(out), picture.frames, start, picture.frames * interval, slowed, times)


class Picture:
    """The picture, to be drawn frame by frame.

    Parameters
    ----------
    motion : Motion
        What to draw.
    exaggeration, slowdown : float
        What is said of them, and done with the first.
    title : str
        Title.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    frames : int
        Number of frames.
    """

    def __init__(self, motion: Motion, exaggeration: float, slowdown: float, title: str) -> None:
        self.run = motion.run
        self.scales = f"slowed down {slowdown:.6g} times, vibration drawn {exaggeration:.6g} times"
        self.slider, self.track = motion.drawn(exaggeration)
        self.frames = len(self.slider)
        self.figure = Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI, layout="constrained")
        bodies, force, status = self.figure.subplots(3, 1, height_ratios=[4.2, 1.0, 0.35])
        self._draw_bodies(bodies, "x along the cut through the plate [m]" if motion.is_cut else "x [m]")
        self.cursors = draw_contact(force, status, self.run)
        self.figure.suptitle(title, fontsize=11)
        self.show(0)
        # Laid out once: the axes must not move from frame to frame.
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")

    def show(self, frame: int) -> None:
        """Draw one frame."""
        self.lines[0].set_data(*self.track[frame].T)
        self.lines[1].set_data(*self.slider[frame].T)
        word = STATUS_WORDS[int(self.run["status"].values[frame])]
        self.point.set_data(*self.slider[frame, :1].T)
        self.point.set_markerfacecolor(STATUS_COLOURS[word])
        time = float(self.run["time"].values[frame])
        for cursor in self.cursors:
            cursor.set_xdata([time, time])
        self.words.set_text(f"{self.scales}\nt = {1e3 * time:.3f} ms, {word}")

    def _draw_bodies(self, axes: Axes, label: str) -> None:
        self.lines = [
            axes.plot([], [], color=colour, linewidth=THICK, solid_capstyle="round", zorder=zorder)[0]
            for colour, zorder in (("0.45", 1), (LINE, 2))
        ]
        self.point = axes.plot(
            [], [], marker="o", markersize=8, markeredgecolor="black", markeredgewidth=0.8, zorder=3
        )[0]
        low, high = limits_of([self.slider, self.track])
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.set_aspect("equal")
        axes.set_xlabel(label, fontsize=8)
        axes.set_ylabel("y [m]", fontsize=8)
        axes.tick_params(labelsize=8)
        # On two lines from one edge: side by side they would run into each other above a tall picture.
        self.words = axes.set_title("", fontsize=9, loc="left")


def limits_of(places: list[Array]) -> tuple[Array, Array]:
    """Return the least and the largest x and y of what is drawn, with a margin."""
    low = np.min([place.min(axis=(0, 1)) for place in places], axis=0)
    high = np.max([place.max(axis=(0, 1)) for place in places], axis=0)
    margin = 0.04 * float((high - low).max())
    return low - margin, high + margin
