"""Films of the modes of linear theory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ..arrays import Array
from ..cards import VIEW
from ..checks import ArgumentError, count, instance
from ..lines import lines_of
from ..lowering import assemble
from ..system import System
from .motion import ModalMotion
from .moved_bodies import MovedBodies, extent_of, has_surfaces, surfaces_of
from .plane_motion import extent_of as flat_extent_of
from .plane_motion import surfaces_slid_on
from .plane_scenes import PlaneScene
from .reels import DPI, FRAMES_PER_SECOND, HEIGHT, WIDTH, Drawn, Film, still, write_film, writer_for
from .scenes import Scene, checked_view

# Number of frames in a period.
FRAMES = 32
# Largest displacement, as a share of the bodies' extent.
SHARE = 0.05
SCENE, COLOUR_BAR = (0.02, 0.03, 0.86, 0.87), (0.905, 0.2, 0.015, 0.55)


def animate_mode(
    system: System,
    theory: xr.Dataset,
    number: int,
    out: str | Path,
    *,
    view: tuple[float, float] = VIEW,
    title: str = "",
    progress: Callable[[int, int], None] = still,
) -> Film:
    """Film one period of a mode of linear theory, with its largest displacement drawn as 5 % of the bodies' extent.

    Growth and damping are left out. In space, colours show the outward surface velocity relative to the largest.

    Parameters
    ----------
    system : System
        A system that `animate` can film.
    theory : xarray.Dataset
        Result of `sliding_stability` for the system.
    number : int
        Number of the mode, from 0.
    out : str or Path
        The file, ``.mp4`` or ``.gif``, written whole or not at all. MP4 requires an encoder, as for `animate`.
    view : tuple of float, optional
        In space, elevation of the eye above the plane across y and its azimuth from z towards x [rad].
    title : str, optional
        Title of the film.
    progress : callable, optional
        Called after each frame with its number and the number of frames.

    Returns
    -------
    Film
        Properties of the film written.

    Raises
    ------
    ValueError
        If an argument is out of its range, the mode does not oscillate, the system cannot be drawn or is not that
        of the theory, or there is no encoder for the file.
    OSError
        If the file cannot be written.
    """
    shapes = shapes_of_mode(system, theory, number)
    seen = checked_view(view)
    frequency, growth = (float(theory[name].values[number]) for name in ("frequency", "growth_rate"))
    words = f"{frequency:.6g} Hz, growth {growth:.4g} /s"
    writer = writer_for(out)
    picture: Drawn
    if has_surfaces(system):
        picture = _InSpace(system, shapes, complex(growth, 2.0 * np.pi * frequency), seen)
    else:
        picture = _InPlane(system, shapes)
    picture.figure.text(0.01, 0.98, words, fontsize=9, verticalalignment="top")
    picture.figure.suptitle(title, fontsize=11)
    write_film(picture, out, writer, progress)
    return Film(str(out), FRAMES, 0.0, 1.0 / frequency, FRAMES / FRAMES_PER_SECOND * frequency)


def turned(shape: Array) -> Array:
    """Return a complex shape over one period, shape (frames, ...)."""
    phases = np.exp(2.0j * np.pi * np.arange(FRAMES) / FRAMES)
    return np.multiply.outer(phases, shape).real


def motion_of_mode(system: System, shapes: dict[str, Array], exponent: complex) -> ModalMotion:
    """Return one period of a mode of a system in space, drawn as large as in films."""
    bodies = surfaces_of(system, np.zeros(3))
    moved = [np.abs(one.surface.shapes @ shapes[one.name]).max() for one in bodies]
    factor = SHARE * extent_of(bodies) / float(max(moved))
    return ModalMotion(
        {name: turned(factor * shape) for name, shape in shapes.items()},
        {name: turned(factor * exponent * shape) for name, shape in shapes.items()},
    )


def over_largest(moved: MovedBodies) -> ModalMotion:
    """Return the motion of bodies with velocities relative to the largest across their surfaces."""
    largest = moved.largest_velocity or 1.0
    return replace(moved.motion, velocity={name: v / largest for name, v in moved.motion.velocity.items()})


class _InSpace:
    """Picture of a mode of a system in space, frame by frame."""

    def __init__(self, system: System, shapes: dict[str, Array], exponent: complex, view: tuple[float, float]) -> None:
        self.frames, self.figure = FRAMES, Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI)
        self.scene = Scene(self.figure, SCENE, system, motion_of_mode(system, shapes, exponent), 1.0, view)
        moved = self.scene.moved
        moved.motion = over_largest(moved)
        words = "velocity out of the surface over the largest"
        self.scene.colour_bar(self.figure.add_axes(COLOUR_BAR), 1.0, words, "1")
        self.show(0)
        self.scene.fill()

    def show(self, frame: int) -> None:
        """Draw one frame."""
        self.scene.show(frame)


class _InPlane:
    """Picture of a mode of a system in the plane, frame by frame."""

    def __init__(self, system: System, shapes: dict[str, Array]) -> None:
        lines, touches = lines_of(system)
        moved = [np.einsum("pim,m->pi", line.shapes, shapes[line.name]) for line in lines]
        rest = [np.tile(line.place, (FRAMES, 1, 1)) for line in lines]
        factor = SHARE * flat_extent_of(rest) / (max(float(np.abs(one).max()) for one in moved) or 1.0)
        apart = [turned(factor * one) for one in moved]
        surfaces = surfaces_slid_on(lines, touches, rest, apart, np.zeros(FRAMES))
        self.frames, self.figure = FRAMES, Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI)
        axes = self.figure.add_axes((0.09, 0.1, 0.88, 0.78))
        for line in lines:
            axes.plot(*line.place[: line.count].T, color="0.8", linewidth=1.0)
        places = [one + moved for one, moved in zip(rest, apart, strict=True)]
        self.scene = PlaneScene(axes, lines, touches, places, surfaces)
        self.show(0)

    def show(self, frame: int) -> None:
        """Draw one frame."""
        self.scene.show(frame)


def shapes_of_mode(system: System, theory: xr.Dataset, number: int) -> dict[str, Array]:
    """Return the complex shape of a mode of linear theory in the modes of each body, by its name."""
    instance("system", system, System)
    instance("theory", theory, xr.Dataset)
    if "mode_shape" not in theory or not theory.sizes.get("mode"):
        raise ArgumentError("theory", "be the result of sliding_stability, with at least one mode", theory)
    count("number", number, low=0, high=theory.sizes["mode"] - 1)
    if not theory["frequency"].values[number] > 0.0:
        raise ArgumentError("number", "be that of a mode that oscillates", number)
    flat = assemble(system)
    if theory["mode_shape"].shape[1] != flat.mode_count:
        got = theory["mode_shape"].shape[1]
        raise ArgumentError("theory", f"have the modes of this system, {flat.mode_count}", theory, got=got)
    shape = theory["mode_shape"].values[number] @ np.array([1.0, 1.0j])
    joined = len(flat.blend)
    shape[:joined] = flat.blend @ shape[:joined]
    return {name: shape[first:end] for name, (first, end) in flat.spans.items()}
