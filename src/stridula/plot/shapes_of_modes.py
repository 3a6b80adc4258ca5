"""Figures of mode shapes of bodies and of sliding systems: panels with frequencies and damping ratios."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from ..analysis.stability import sliding_stability
from ..arrays import Array
from ..bodies.drawn_surfaces import is_drawn
from ..cards import VIEW, eye_of
from ..checks import ArgumentError, count
from ..lines import Line, lines_of
from .colours import LINE, LINES
from .mode_films import shapes_of_mode
from .moved_bodies import AWAY, ShownBody, extent_of, has_surfaces, surfaces_of
from .plane_motion import extent_of as flat_extent_of
from .scenes import Stage, checked_view

# Default number of panels, largest number, and panels side by side.
PANELS, MOST_PANELS, COLUMNS = 6, 24, 3
# Largest displacement, as a share of the bodies' extent.
SHARE = 0.08
SIZES, SIGNS = "viridis", "RdBu_r"
# Width of the colour bar with its label [inches].
BAR = 0.9
# Points along the longer side of a plate, and arrows along it.
POINTS, ARROWS = 80, 16


def mode_shapes(
    what: Any,
    numbers: Sequence[int] | None = None,
    *,
    theory: xr.Dataset | None = None,
    view: tuple[float, float] = VIEW,
    title: str = "",
) -> Figure:
    """Draw mode shapes of a body or of a sliding system, each in a panel with frequency and damping ratio.

    A beam is drawn as its displacements across and along its axis, over the place on the axis; a plate as its
    displacement along the normal by colour, in its plane as arrows; a body in space as its deformed surface, coloured
    by the magnitude of the displacement. All are relative to the largest. A system is drawn as deformed lines in the
    plane, and as deformed surfaces in space. As modes of sliding are complex, they are shown at the instant when the
    largest displacement peaks.

    Parameters
    ----------
    what : FiniteElementBeam, ModalBeam, ModalPlate, SolidBody, AxisymmetricBody, ModalBody or System
        A body, without contact, or a system, with the modes of `sliding_stability`.
    numbers : sequence of int, optional
        Numbers of the modes from 0, at most 24; if left out, the lowest six that vibrate, or, for a system with modes
        that grow, these.
    theory : xarray.Dataset, optional
        Result of `sliding_stability` for the system; computed if left out.
    view : tuple of float, optional
        In space, elevation of the eye above the plane across y and its azimuth from z towards x [rad].
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If an argument is out of its range, the shape of the body between its points is unknown, or a mode of the
        system does not oscillate.

    Examples
    --------
    >>> import stridula as st
    >>> plate = st.ModalPlate(st.Material(7e10, 2700.0), 0.002, 0.4, 0.3, damping=0.005)
    >>> figure = st.plot.mode_shapes(plate)
    >>> chosen = st.plot.mode_shapes(plate, [0, 5, 9])
    """
    seen = checked_view(view)
    if hasattr(what, "contacts") and hasattr(what, "bodies"):
        shown = _of_system(what, numbers, theory)
    elif theory is not None:
        raise ArgumentError("theory", "be used with a System", theory)
    else:
        shown = _of_body(what, numbers)
    figure, spaces = _panels(len(shown.numbers), shown.shape, shown.is_flat)
    figure.suptitle(title, fontsize=11)
    for place, number in enumerate(shown.numbers):
        shown.draw(figure, spaces[place], number, seen)
    if shown.bar is not None:
        largest = Normalize(-1.0 if shown.bar == SIGNS else 0.0, 1.0)
        # The room for the label is the same [inches] for any number of panels.
        axes = None if shown.is_flat else figure.add_axes((1.0 - BAR / figure.get_figwidth(), 0.25, 0.012, 0.5))
        drawn = ScalarMappable(largest, shown.bar)
        options: dict[str, Any] = {"cax": axes} if axes else {"ax": figure.axes, "shrink": 0.7}
        figure.colorbar(drawn, **options).set_label("displacement over the largest [1]", fontsize=9)
    return figure


@dataclass(frozen=True)
class _Shown:
    """Contents of the panels of a figure.

    Attributes
    ----------
    numbers : list of int
        Numbers of the modes.
    draw : callable
        Function that draws a mode, of the figure, the place in it, the number and the view.
    shape : float
        Ratio of height to width of a panel.
    is_flat : bool
        Whether panels have axes of the plane, laid out by matplotlib.
    bar : str or None
        Colours of the bar, None without a bar.
    """

    numbers: list[int]
    draw: Callable[[Figure, Any, int, tuple[float, float]], None]
    shape: float
    is_flat: bool
    bar: str | None


def _of_body(body: Any, numbers: Any) -> _Shown:
    """Return the panels of a body."""
    if not hasattr(body, "modes") or not hasattr(body, "trace") or isinstance(body, type):
        raise ArgumentError("what", "be a body or a System", body)
    if hasattr(body, "track_line"):
        draw = _plate
    elif hasattr(body, "drawn_places"):
        draw = _beam
    elif is_drawn(body):
        draw = _solid
    else:
        words = "be a beam, a plate, or a body whose surface is drawn"
        raise ArgumentError("what", words, body, got=f"a {type(body).__name__}, which has points only")
    modes = body.modes()
    vibrates = np.flatnonzero(~modes.massless & (modes.angular_frequency > 0.0))
    chosen = vibrates[:PANELS].tolist() if numbers is None else _checked(numbers, int((~modes.massless).sum()))
    if not chosen:
        raise ArgumentError("what", "have a mode that vibrates", body, got="none")
    return draw(body, chosen, [_words(k, modes.frequency[k], modes.damping[k]) for k in range(modes.count)])


def _checked(numbers: Any, modes: int) -> list[int]:
    if isinstance(numbers, str) or not isinstance(numbers, (Sequence, np.ndarray, range)) or not len(numbers):
        raise ArgumentError("numbers", "be a list of numbers of modes", numbers)
    if len(numbers) > MOST_PANELS:
        raise ArgumentError("numbers", f"be at most {MOST_PANELS} modes", numbers, got=len(numbers))
    return [count(f"numbers[{k}]", one, low=0, high=modes - 1) for k, one in enumerate(numbers)]


def _words(number: int, frequency: float, damping: float, growth: float = 0.0) -> str:
    """Return number, frequency and damping ratio of a mode."""
    if frequency == 0.0:
        return f"mode {number}, rigid"
    grows = f"grows by {growth:.4g} /s" if growth > 0.0 else f"damping ratio {100.0 * damping:.3g} %"
    return f"mode {number}, {frequency:.5g} Hz\n{grows}"


def _beam(body: Any, numbers: list[int], words: list[str]) -> _Shown:
    """Return the panels of a beam: its displacements over the place on its axis."""
    along = body.drawn_places
    axes = np.asarray(body.axes)
    moved = np.array([axes @ body.trace(place)[: axes.shape[1]] for place in along.tolist()])

    def draw(figure: Figure, where: Any, number: int, _: tuple[float, float]) -> None:
        panel = figure.add_subplot(where)
        shape = moved[:, :, number] / np.abs(moved[:, :, number]).max()
        shape *= np.sign(shape.ravel()[np.abs(shape).argmax()])
        panel.axhline(0.0, color="0.6", linewidth=0.8)
        panel.plot(along, shape[:, 1], color=LINE, linewidth=1.6, label="across the axis")
        panel.plot(along, shape[:, 0], color=LINES[1], linewidth=1.2, linestyle="--", label="along the axis")
        panel.set(ylim=(-1.15, 1.15), xlim=(along[0], along[-1]))
        _label(panel, words[number], "place on the axis [m]", "displacement\nover the largest [1]")
        if number == numbers[0]:
            panel.legend(fontsize=7, frameon=False, loc="lower right")

    return _Shown(numbers, draw, 0.72, True, None)


def _plate(body: Any, numbers: list[int], words: list[str]) -> _Shown:
    """Return the panels of a plate, seen from the side of the sliders."""
    sides = np.array([body.length, body.width])
    x, y = (np.linspace(0.0, side, max(round(POINTS * side / sides.max()), 8)) for side in sides)
    grid = np.meshgrid(x, y, indexing="ij")
    bending = body.harmonics[0]
    shapes = body.shapes(*grid)
    every = max(1, POINTS // ARROWS)
    few = [one[::every, ::every] for one in grid]

    def draw(figure: Figure, where: Any, number: int, _: tuple[float, float]) -> None:
        panel = figure.add_subplot(where)
        if number < bending:
            shape = shapes[..., number] / np.abs(shapes[..., number]).max()
            panel.pcolormesh(x, y, shape.T, cmap=SIGNS, vmin=-1.0, vmax=1.0, shading="gouraud", rasterized=True)
        else:
            moved = body.in_plane_shapes(*few)[..., number - bending]
            panel.quiver(*few, moved[..., 0], moved[..., 1], color=LINE, pivot="tail", angles="xy")
        panel.plot(*body.track_line.point(np.array(body.ends)), color="black", linewidth=0.8, linestyle="--")
        panel.set(xlim=(0.0, sides[0]), ylim=(0.0, sides[1]), aspect="equal")
        _label(panel, words[number], "along the length [m]", "along the width [m]")

    bar = SIGNS if min(numbers) < bending else None
    return _Shown(numbers, draw, float(np.clip(sides[1] / sides[0], 0.3, 2.0)), True, bar)


def _label(panel: Axes, words: str, x: str, y: str) -> None:
    panel.set_title(words, fontsize=9)
    panel.set_xlabel(x, fontsize=8)
    panel.set_ylabel(y, fontsize=8)
    panel.tick_params(labelsize=8)
    panel.grid(alpha=0.25, linewidth=0.5)


def _solid(body: Any, numbers: list[int], words: list[str]) -> _Shown:
    """Return the panels of a body in space."""
    surface = body.drawn.swept

    def draw(figure: Figure, where: Any, number: int, view: tuple[float, float]) -> None:
        shown = [ShownBody(body.name, surface, surface.normals @ eye_of(view) > AWAY)]
        _draw_deformed(figure, where, shown, [surface.shapes[..., number]], view, words[number])

    return _Shown(numbers, draw, 0.85, False, SIZES)


def _draw_deformed(
    figure: Figure, room: Any, shown: list[ShownBody], moved: list[Array], view: tuple[float, float], words: str
) -> None:
    """Draw bodies in space deformed, coloured by the magnitude of the displacement, shape (points, 3) for each."""
    largest = max(float(np.linalg.norm(one, axis=1).max()) for one in moved) or 1.0
    factor = SHARE * extent_of(shown) / largest
    stage = Stage(figure, room, shown, view)
    places = [one.surface.place + factor * by for one, by in zip(shown, moved, strict=True)]
    sizes = [np.linalg.norm(by, axis=1)[one.surface.polygons[one.seen]] for one, by in zip(shown, moved, strict=True)]
    colours = colormaps[SIZES](np.concatenate([one.mean(axis=1) for one in sizes]) / largest)
    colours[:, :3] *= stage.shade[:, None]
    stage.drawn(stage.polygons(places), facecolors=colours, linewidths=0.1, edgecolors="0.45")
    stage.fill_with(np.concatenate(places))
    left, low, width, height = room
    figure.text(left + 0.5 * width, low + height, words, fontsize=9, ha="center", va="bottom")


def _of_system(system: Any, numbers: Any, theory: xr.Dataset | None) -> _Shown:
    """Return the panels of a sliding system."""
    found = sliding_stability(system) if theory is None else theory
    chosen = _growing_or_lowest(found) if numbers is None else _checked(numbers, found.sizes.get("mode", 0))
    if not chosen:
        raise ArgumentError("what", "have a mode that oscillates", system, got="none")
    shapes = {number: shapes_of_mode(system, found, number) for number in chosen}
    columns = (found[name].values for name in ("frequency", "damping_ratio", "growth_rate"))
    words = [_words(k, *one) for k, one in enumerate(zip(*columns, strict=True))]
    if has_surfaces(system):
        return _space_system(system, chosen, shapes, words)
    return _plane_system(system, chosen, shapes, words)


def _growing_or_lowest(theory: xr.Dataset) -> list[int]:
    oscillates = theory["frequency"].values > 0.0
    grows = np.flatnonzero(oscillates & theory["unstable"].values)
    return [int(k) for k in (grows if grows.size else np.flatnonzero(oscillates))[:PANELS]]


def _at_peak(moved: list[Array]) -> list[Array]:
    """Return complex displacements at the instant when the largest of them peaks."""
    every = np.concatenate([one.ravel() for one in moved])
    largest = every[np.abs(every).argmax()]
    return [np.asarray((one * (np.abs(largest) / largest if largest else 1.0)).real) for one in moved]


def _space_system(system: Any, numbers: list[int], shapes: dict[int, dict[str, Array]], words: list[str]) -> _Shown:
    def draw(figure: Figure, where: Any, number: int, view: tuple[float, float]) -> None:
        shown = surfaces_of(system, eye_of(view))
        moved = _at_peak([one.surface.shapes @ shapes[number][one.name] for one in shown])
        _draw_deformed(figure, where, shown, moved, view, words[number])

    return _Shown(numbers, draw, 0.85, False, SIZES)


def _plane_system(system: Any, numbers: list[int], shapes: dict[int, dict[str, Array]], words: list[str]) -> _Shown:
    lines, touches = lines_of(system)
    extent = flat_extent_of([line.place for line in lines])
    tips = {one.tip[0] for one in touches}
    places = np.concatenate([line.place for line in lines])
    size = np.maximum(np.ptp(places, axis=0), 0.3 * extent) + 4.0 * SHARE * extent
    middle = 0.5 * (places.min(axis=0) + places.max(axis=0))

    def draw(figure: Figure, where: Any, number: int, _: tuple[float, float]) -> None:
        panel = figure.add_subplot(where)
        moved = _at_peak([_of_line(line, shapes[number]) for line in lines])
        factor = SHARE * extent / (max(float(np.abs(one).max()) for one in moved) or 1.0)
        for k, (line, by) in enumerate(zip(lines, moved, strict=True)):
            marker = "s" if line.count == 1 else ""
            panel.plot(*line.place[: line.count].T, color="0.8", linewidth=1.0)
            deformed = line.place + factor * by
            panel.plot(*deformed[: line.count].T, color=LINE if k in tips else LINES[1], linewidth=1.6, marker=marker)
        for one in touches:
            tip, row = one.tip
            panel.plot(*(lines[tip].place + factor * moved[tip])[row], "o", color="black", markersize=3.5)
        low, high = middle - 0.5 * size, middle + 0.5 * size
        panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
        _label(panel, words[number], "x [m]", "y [m]")

    return _Shown(numbers, draw, float(size[1] / size[0]), True, None)


def _of_line(line: Line, shapes: dict[str, Array]) -> Array:
    return np.asarray(np.einsum("pim,m->pi", line.shapes, shapes[line.name]))


def _panels(panels: int, shape: float, is_flat: bool) -> tuple[Figure, list[Any]]:
    """Return a figure with room for panels, and the place of each."""
    columns = min(panels, COLUMNS)
    rows = -(-panels // columns)
    width = 3.3 * columns + 1.2
    figure = Figure(
        figsize=(width, rows * (3.0 * shape + 0.55) + 0.7), layout="constrained" if is_flat else None, dpi=120
    )
    if is_flat:
        grid = figure.add_gridspec(rows, columns)
        return figure, [grid[k // columns, k % columns] for k in range(panels)]
    across, down = (1.0 - (BAR + 0.2) / width) / columns, 0.92 / rows
    rooms = [
        (0.01 + across * (k % columns), 0.93 - down * (k // columns + 1) + 0.0, across, 0.84 * down)
        for k in range(panels)
    ]
    return figure, rooms
