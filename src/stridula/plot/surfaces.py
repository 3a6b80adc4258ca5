"""Maps over a face in contact, and films of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from ..arrays import Array
from ..checks import ArgumentError, choice, finite, instance, positive
from ..records.variables import STATUS_WORDS, described
from .colours import STATUS_COLOURS
from .reels import (
    DPI,
    FEWEST_FRAMES,
    FRAMES_PER_SECOND,
    HEIGHT,
    MOST_FRAMES,
    WIDTH,
    Film,
    still,
    write_film,
    writer_for,
)

QUANTITIES = ("pressure", "slip_velocity", "shear", "status")
NEEDED = ("pressure", "slip_velocity", "shear", "status_share", "place", "area")
COLOURS = "viridis"
SLOWDOWN = 1000.0
# Triangles with a side longer than this multiple of the median bridge gaps in the face.
BRIDGE = 3.0
# A triangle at the edge is flat if the cosine of the angle opposite to its outer side is below this.
FLAT = -0.85
# If two moments of area differ by less than this share of the largest, their axes are arbitrary.
ALIKE = 1e-6
# Cosine above which an axis of the face counts as an axis of the world.
ALONG = 1.0 - 1e-9


def surface(
    found: xr.Dataset,
    quantity: str = "pressure",
    *,
    time: float | None = None,
    span: tuple[float, float] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw a quantity over a face in contact, in the plane of the face.

    Colours are interpolated linearly between the points of the face, which are marked. Both axes are principal axes of
    the face, or those nearest to the world's where principal axes are arbitrary. A face that is not flat is projected
    on its mean plane.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `analysis.surface`.
    quantity : str, optional
        ``pressure``, or the magnitude of ``slip_velocity`` or ``shear``; ``status`` draws the shares of time in which
        the points are separated, stick and slide.
    time : float, optional
        Show the sample interval that contains this time [s].
    span : tuple of float, optional
        Show the mean from one time to another [s]; without `time` or `span`, the mean over the whole record.
    title : str, optional
        Title of the figure; if left out, the name of the surface and the time.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If it is not a recorded face, or has no sample at that time.
    """
    choice("quantity", quantity, QUANTITIES)
    found = _over_time(found, quantity)
    face = _face(found)
    shown, when = _chosen(found, time, span)
    maps = _maps(shown, quantity)
    means = [values.mean(axis=0) for _, values in maps]
    picture = _Maps(face, quantity, [words for words, _ in maps], _largest(quantity, means), shown)
    picture.set(means)
    picture.figure.suptitle(f"{found.attrs.get('surface', '')}, {when}" if title is None else title, fontsize=11)
    return picture.figure


def animate_surface(
    found: xr.Dataset,
    out: str | Path,
    quantity: str = "pressure",
    *,
    span: tuple[float, float] | None = None,
    slowdown: float = SLOWDOWN,
    title: str | None = None,
    progress: Callable[[int, int], None] = still,
) -> Film:
    """Film a quantity over a face in contact in slow motion, each frame a mean over its duration.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `analysis.surface`.
    out : str or Path
        The file, ``.mp4`` or ``.gif``, written whole or not at all. MP4 requires an encoder, as for `animate`.
    quantity : str, optional
        As for `surface`.
    span : tuple of float, optional
        Start and end [s]; if left out, the whole record.
    slowdown : float, optional
        Slow-motion factor, adjusted to a whole number of samples for each frame.
    title : str, optional
        Title of the film; if left out, the name of the surface.
    progress : callable, optional
        Called after each frame with its number and the number of frames.

    Returns
    -------
    Film
        Properties of the film written.

    Raises
    ------
    ValueError
        If it is not a recorded face, the span has no sample, frames are too few or too many, or there is no encoder
        for the file.
    OSError
        If the file cannot be written.
    """
    choice("quantity", quantity, QUANTITIES)
    found = _over_time(found, quantity)
    face = _face(found)
    positive("slowdown", slowdown)
    writer = writer_for(out)
    shown, _ = _chosen(found, None, span)
    times = shown["time"].values
    if times.size < FEWEST_FRAMES:
        raise ArgumentError("span", f"hold at least {FEWEST_FRAMES} samples", span, got=times.size)
    interval = float(times[-1] - times[0]) / (times.size - 1)
    samples = max(1, round(1.0 / (FRAMES_PER_SECOND * slowdown * interval)))
    frames = times.size // samples
    if not FEWEST_FRAMES <= frames <= MOST_FRAMES:
        words = f"give from {FEWEST_FRAMES} to {MOST_FRAMES} frames"
        raise ArgumentError("slowdown", words, slowdown, got=f"{slowdown!r} ({frames} frames)")
    maps = _maps(shown.isel(time=slice(frames * samples)), quantity)
    values = [one.reshape(frames, samples, -1).mean(axis=1) for _, one in maps]
    slowed = 1.0 / (FRAMES_PER_SECOND * samples * interval)
    picture = _Maps(face, quantity, [words for words, _ in maps], _largest(quantity, values), shown)
    name = str(found.attrs.get("surface", "")) if title is None else title
    start = float(times[0]) - interval
    film = _FilmOfMaps(picture, values, start, samples * interval, f"{name}, slowed down {slowed:.6g} times")
    write_film(film, out, writer, progress)
    return Film(str(out), frames, start, frames * samples * interval, slowed)


@dataclass(frozen=True)
class _Face:
    """Points of a face in its own plane [m]."""

    triangles: Triangulation
    labels: tuple[str, str]


class _Maps:
    """Maps side by side over a face."""

    def __init__(self, face: _Face, quantity: str, words: list[str], largest: float, found: xr.Dataset) -> None:
        wide = len(words)
        self.figure = Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI, layout="constrained")
        self.axes: list[Axes] = list(np.ravel(self.figure.subplots(1, wide, sharex=True, sharey=True)))
        scale = Normalize(0.0, largest)
        start = np.zeros(face.triangles.x.size)
        self.drawn: list[Any] = []
        for axes, word in zip(self.axes, words, strict=True):
            self.drawn.append(axes.tripcolor(face.triangles, start, shading="gouraud", cmap=COLOURS, norm=scale))
            colour = STATUS_COLOURS.get(word, "black")
            axes.plot(
                face.triangles.x,
                face.triangles.y,
                "o",
                markersize=3,
                color=colour,
                markeredgecolor="black",
                markeredgewidth=0.4,
            )
            axes.set_title(word if wide > 1 else "", fontsize=9)
            axes.set_aspect("equal")
            axes.set_xlabel(face.labels[0], fontsize=8)
            axes.tick_params(labelsize=8)
        self.axes[0].set_ylabel(face.labels[1], fontsize=8)
        where = "bottom" if wide > 1 else "right"
        self.figure.colorbar(self.drawn[0], ax=self.axes, label=_label(quantity, found), location=where)

    def set(self, values: list[Array]) -> None:
        """Colour each map by values at the points."""
        for drawn, one in zip(self.drawn, values, strict=True):
            drawn.set_array(one)


class _FilmOfMaps:
    """Maps drawn frame by frame."""

    def __init__(self, maps: _Maps, values: list[Array], start: float, frame: float, words: str) -> None:
        self.figure, self.frames = maps.figure, len(values[0])
        self._maps, self._values, self._start, self._frame, self._words = maps, values, start, frame, words
        self.show(0)
        # The layout is computed once, as the axes must not move from frame to frame.
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")

    def show(self, frame: int) -> None:
        """Draw one frame."""
        self._maps.set([one[frame] for one in self._values])
        time = self._start + (frame + 1) * self._frame
        self.figure.suptitle(f"{self._words}\nt = {1e3 * time:.3f} ms", fontsize=10)


def _over_time(found: xr.Dataset, quantity: str) -> xr.Dataset:
    """Return the drawn variables of a face over ``time``, from either sample rate."""
    instance("found", found, xr.Dataset)
    if any(name not in found for name in NEEDED):
        raise ArgumentError("found", "be the result of analysis.surface, with at least one sample", found)
    shown = found[["status_share" if quantity == "status" else quantity, "place", "area"]]
    return shown.rename(map_time="time") if "map_time" in shown.dims else shown


def _face(found: xr.Dataset) -> _Face:
    if not found.sizes.get("time"):
        raise ArgumentError("found", "be the result of analysis.surface, with at least one sample", found)
    places, areas = found["place"].values, found["area"].values
    if len(places) < 3:
        raise ArgumentError("found", "have at least 3 points", found, got=len(places))
    axes = _axes(places, areas)
    middle = areas @ places / areas.sum()
    at, labels = [], []
    for axis, other in zip(axes, ("along the face [m]", "across the face [m]"), strict=True):
        world = int(np.abs(axis).argmax())
        is_world = abs(axis[world]) > ALONG
        at.append((places - (0.0 if is_world else middle)) @ axis)
        labels.append(f"{'xyz'[world]} [m]" if is_world else other)
    triangles = Triangulation(*at)
    _mask_bridges(triangles)
    return _Face(triangles, (labels[0], labels[1]))


def _axes(places: Array, areas: Array) -> Array:
    """Return two directions in the mean plane of a face, that of its largest extent first, shape (2, 3)."""
    apart = places - areas @ places / areas.sum()
    moments, ways = np.linalg.eigh((apart * areas[:, None]).T @ apart)
    first, second, normal = ways[:, 2], ways[:, 1], ways[:, 0]
    if moments[2] - moments[1] < ALIKE * moments[2]:
        # If principal axes are arbitrary, those nearest to the axes of the world are used.
        world = np.eye(3)[int(np.abs(normal).argmin())]
        first = world - (world @ normal) * normal
        first /= np.linalg.norm(first)
        second = np.cross(normal, first)
    return np.array([one * np.sign(one[np.abs(one).argmax()]) for one in (first, second)])


def _mask_bridges(triangles: Triangulation) -> None:
    """Leave out triangles that bridge gaps in the face: far longer than usual, or flat ones at its edge."""
    corners = np.stack([triangles.x, triangles.y], axis=1)[triangles.triangles]
    following = np.roll(corners, -1, axis=1) - corners
    sides = np.linalg.norm(following, axis=2)
    mask = sides.max(axis=1) > BRIDGE * np.median(sides)
    # Cosine of the angle opposite to the side between each corner and the next one.
    first, second = np.roll(following, -1, axis=1), np.roll(following, -2, axis=1)
    size = np.linalg.norm(first, axis=2) * np.linalg.norm(second, axis=2)
    is_flat = -np.einsum("tsi,tsi->ts", first, second) < FLAT * size
    before = None
    while before is None or (mask != before).any():
        before = mask
        triangles.set_mask(mask)
        # Removing a triangle exposes others at the edge.
        mask = mask | (is_flat & (triangles.neighbors < 0)).any(axis=1)


def _chosen(found: xr.Dataset, time: float | None, span: tuple[float, float] | None) -> tuple[xr.Dataset, str]:
    """Return the samples of a time or a span, by default all, and a description of them."""
    times = found["time"].values
    if time is not None and span is not None:
        raise ArgumentError("time", "be left out with a span", time)
    if time is not None:
        number = int(np.searchsorted(times, finite("time", time) * (1.0 - 1e-12)))
        first = max(2.0 * times[0] - times[1], 0.0) if times.size > 1 else 0.0
        if time < first or number == times.size:
            raise ArgumentError("time", f"be from {first:.6g} to {float(times[-1]):.6g} s", time)
        return found.isel(time=[number]), f"{1e3 * float(times[number]):.6g} ms"
    low, high = (float(times[0]), float(times[-1])) if span is None else _ends(span)
    shown = found.isel(time=(times >= low) & (times <= high))
    if not shown.sizes["time"]:
        raise ArgumentError("span", "hold a sample", span)
    return shown, f"mean from {1e3 * low:.6g} to {1e3 * high:.6g} ms"


def _ends(span: Any) -> tuple[float, float]:
    if not isinstance(span, (tuple, list)) or len(span) != 2:
        raise ArgumentError("span", "be a start and an end", span)
    low, high = (finite(f"span[{k}]", one) for k, one in enumerate(span))
    if high <= low:
        raise ArgumentError("span", "end after it starts", span)
    return low, high


def _maps(found: xr.Dataset, quantity: str) -> list[tuple[str, Array]]:
    """Return the maps of a quantity: their labels, and their values over time and points."""
    if quantity == "status":
        share = found["status_share"].values
        return [(word, share[..., k]) for k, word in enumerate(STATUS_WORDS)]
    values = found[quantity].values
    return [(quantity, values if values.ndim == 2 else np.linalg.norm(values, axis=2))]


def _largest(quantity: str, values: list[Array]) -> float:
    return 1.0 if quantity == "status" else float(max(one.max() for one in values)) or 1.0


def _label(quantity: str, found: xr.Dataset) -> str:
    if quantity == "status":
        return "share of time [1]"
    words = found[quantity].attrs or described("1", quantity)
    return f"{words['long_name']} [{words['units']}]"
