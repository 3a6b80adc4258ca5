"""Films of bodies and their contacts, in slow motion."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ..cards import VIEW
from ..checks import instance, positive
from ..integration.settings import Given
from ..lines import check_in_plane
from ..lowering.schemes import Scheme
from ..records.variables import STATUS_WORDS
from ..system import System
from .motion import SAMPLE_RATE, motion_of
from .moved_bodies import has_surfaces
from .plane_motion import PlaneMotion, plane_motion
from .plane_scenes import PlaneScene
from .reels import DPI, FRAMES_PER_SECOND, HEIGHT, WIDTH, Drawn, Film, rounded, still, write_film, writer_for
from .scenes import checked_view
from .space_films import SpacePicture, exaggeration_of
from .timelines import draw_contact

DURATION, SLOWDOWN = 0.01, 1000.0
# By default, the largest vibration is drawn as this share of the bodies' extent.
SHARE = 0.1


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
    """Film bodies in slow motion, with contact points coloured by their status.

    The system is simulated from its start to the end of the window, with probes of all modes of its bodies. With
    the scheme and the step of a record, the film shows exactly that run. Motion faster than the frames is filtered out
    before sampling, so it never appears as slower motion.

    Bodies in the plane are drawn as lines. The mean shape of each and its slide along a track are to scale; the
    vibration about them is exaggerated, and so is the gap. The motion of a track along itself is not drawn. A plate is
    drawn as its cut along the line of contact, and a body defined at points only as these points. A pale band is the
    region that a body without a tip sweeps in the window. A line with strokes is a rigid track, or the side of the tip
    that slides past a point with a ``surface_velocity``; a sticking point moves along with the strokes.

    In space, meshed bodies and bodies of revolution are drawn as surfaces in perspective, coloured by their outward
    velocity, and contact points are coloured by status. Departures from the mean over the window are exaggerated. Rigid
    bodies that touch these bodies, or are joined to them directly or through others, are drawn as hulls of their points
    or as small balls; other bodies are not drawn.

    Parameters
    ----------
    system : System
        Any system in the plane, or with a `SolidBody` or an `AxisymmetricBody`.
    out : str or Path
        The file, ``.mp4`` or ``.gif``, written whole or not at all. MP4 requires an encoder: ``pip install
        .[video]`` in the source folder, or ffmpeg on the path.
    start, duration : float, optional
        The window of time [s].
    slowdown : float, optional
        Slow-motion factor, adjusted to a whole number of steps for each frame.
    exaggeration : float, optional
        Factor by which the vibration is drawn larger. If left out, the vibration is drawn near 10 % of the bodies'
        extent, in space 4 %.
    view : tuple of float, optional
        In space, elevation of the eye above the plane across y and its azimuth from z towards x [rad].
    scheme : ExactModal or CentralDifference, optional
        Time scheme; if left out, the exact modal one.
    step : float, optional
        Time step [s]; if left out, that of `simulate` at `sample_rate`.
    sample_rate : float, optional
        Sample rate [Hz] of the run shown; no effect with a given `step`.
    title : str, optional
        Title of the film.
    progress : callable, optional
        Called after each frame with its number and the number of frames.

    Returns
    -------
    Film
        Properties of the film written, with its slowdown and exaggeration.

    Raises
    ------
    ValueError
        If an argument is out of its range, the system cannot be filmed, the run ends before the window, or there is
        no encoder for the file.
    OSError
        If the file cannot be written.
    """
    instance("system", system, System)
    positive("slowdown", slowdown)
    if exaggeration is not None:
        positive("exaggeration", exaggeration)
    seen, in_space = checked_view(view), has_surfaces(system)
    if not in_space:
        check_in_plane(system)
    writer = writer_for(out)
    frame, given = 1.0 / (FRAMES_PER_SECOND * slowdown), Given(scheme=scheme, step=step, sample_rate=sample_rate)
    motion = motion_of(system, (start, duration), frame, given, velocities=in_space)
    interval = float(motion.run.attrs["sample_interval"])
    slowed = 1.0 / (FRAMES_PER_SECOND * interval)
    picture: Drawn
    if in_space:
        times = exaggeration_of(system, motion.modes, exaggeration)
        picture = SpacePicture(system, motion, times, slowed, title, seen)
    else:
        flat = plane_motion(system, motion)
        times = exaggeration or (rounded(SHARE * flat.extent / flat.largest) if flat.largest > 0.0 else 1.0)
        picture = Picture(flat, times, slowed, title)
    write_film(picture, out, writer, progress)
    return Film(str(out), picture.frames, start, picture.frames * interval, slowed, times)


class Picture:
    """The picture of a system in the plane, to be drawn frame by frame.

    Parameters
    ----------
    motion : PlaneMotion
        Motion to draw.
    exaggeration, slowdown : float
        Both factors, which the title states; the first scales the departures.
    title : str
        Title.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    scene : PlaneScene
        The bodies.
    frames : int
        Number of frames.
    """

    def __init__(self, motion: PlaneMotion, exaggeration: float, slowdown: float, title: str) -> None:
        self.run = motion.run
        self.scales = f"slowed down {slowdown:.6g} times, vibration drawn {exaggeration:.6g} times"
        self.figure = Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI, layout="constrained")
        bodies, force, status = self.figure.subplots(3, 1, height_ratios=[4.2, 1.0, 0.35])
        drawn = motion.drawn(exaggeration)
        self.scene = PlaneScene(bodies, motion.lines, motion.touches, drawn, motion.surfaces, exaggeration)
        self.frames = self.scene.frames
        if motion.largest > 0.0:
            self.scene.draw_scale(bodies, rounded(motion.largest))
        # The words have two lines, starting at the same edge: side by side they would overlap above a tall picture.
        self.words = bodies.set_title("", fontsize=9, loc="left")
        self.cursors = draw_contact(force, status, self.run)
        self.figure.suptitle(title, fontsize=11)
        self.show(0)
        # The layout is computed once, as the axes must not move from frame to frame.
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")

    def show(self, frame: int) -> None:
        """Draw one frame."""
        status = np.atleast_1d(self.run["status"].values[frame])
        self.scene.show(frame, status)
        time = float(self.run["time"].values[frame])
        for cursor in self.cursors:
            cursor.set_xdata([time, time])
        # With several contacts, the markers show the status.
        word = f", {STATUS_WORDS[int(status[0])]}" if status.size == 1 else ""
        self.words.set_text(f"{self.scales}\nt = {1e3 * time:.3f} ms{word}")
