"""Cards for notebooks: a small drawing and a table of facts, in the colours of the notebook."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from .arrays import Array

# Largest width and height of a drawing, its least height, and the margin [px].
WIDTH, HEIGHT, LOWEST, ROOM = 260.0, 180.0, 24.0, 8.0
# The colour is visible on light and on dark pages.
TOUCH = "#e8743b"
# Elevation above the plane across y and azimuth from z towards x [rad].
VIEW = (np.pi / 6.0, 7.0 * np.pi / 36.0)
# The edge between two polygons is drawn if the cosine of their angle is below this; largest number of edges drawn.
CREASE, MOST_EDGES = 0.9, 3000
# Largest number of lines of a list that are shown.
MOST_LINES = 8


@dataclass(frozen=True)
class Stroke:
    """Lines in the same style, or dots.

    Attributes
    ----------
    lines : sequence of ndarray, shape (points, 2)
        Places along each, x to the right and y up, in any unit.
    width : float
        Width [px].
    opacity : float
        Opacity, from 0 to 1.
    dots : bool
        Whether the places are drawn as dots instead.
    """

    lines: Sequence[Array]
    width: float = 1.6
    opacity: float = 1.0
    dots: bool = False


def card(title: str, facts: Mapping[str, str | Sequence[str]], picture: str = "") -> str:
    """Return a card as HTML.

    Parameters
    ----------
    title : str
        Title.
    facts : mapping
        Facts by name, in one line or several; of many lines only the first ones are shown.
    picture : str, optional
        A drawing.
    """
    rows = "".join(_row(name, (words,) if isinstance(words, str) else words) for name, words in facts.items() if words)
    look = "border-collapse: collapse; margin: 0; color: inherit; font: inherit"
    table = f'<table style="{look}"><tbody>{rows}</tbody></table>'
    beside = f'<div style="flex: none">{picture}</div>' if picture else ""
    inside = f'<div style="display: flex; gap: 1.5em; align-items: center; flex-wrap: wrap">{beside}{table}</div>'
    return f'<div style="color: inherit"><strong>{escape(title)}</strong>{inside}</div>'


def _row(name: str, lines: Sequence[str]) -> str:
    shown = [escape(line) for line in lines[:MOST_LINES]]
    if len(lines) > MOST_LINES:
        shown.append(f"and {len(lines) - MOST_LINES} more")
    style = "text-align: left; vertical-align: top; padding: 1px 0.8em 1px 0; border: 0; background: none"
    head = f'<th scope="row" style="{style}; font-weight: normal; opacity: 0.65">{escape(name)}</th>'
    return f'<tr style="background: none">{head}<td style="{style}">{"<br>".join(shown)}</td></tr>'


def drawing(strokes: Sequence[Stroke], words: str) -> str:
    """Return strokes as an SVG to scale, in the colour of the surrounding text; empty where there is nothing to see.

    Parameters
    ----------
    strokes : sequence of Stroke
        Strokes, the last one on top.
    words : str
        Description for screen readers.
    """
    lines = [line for stroke in strokes for line in stroke.lines]
    if not lines:
        return ""
    places = np.concatenate(lines)
    low, size = places.min(axis=0), np.ptp(places, axis=0)
    if not size.any():
        return ""
    scale = float(np.min([WIDTH, HEIGHT] / np.where(size > 0.0, size, size.max() * 1e-9)))
    height = max(float(size[1]) * scale, LOWEST)
    lift = 0.5 * (height - float(size[1]) * scale)

    def put(line: Array) -> Array:
        x, y = ((line - low) * scale).T
        return np.column_stack([x + ROOM, height - y - lift + ROOM])

    body = "".join(_stroke(stroke, [put(line) for line in stroke.lines]) for stroke in strokes)
    across, down = float(size[0]) * scale + 2.0 * ROOM, height + 2.0 * ROOM
    box = f'width="{across:.0f}" height="{down:.0f}" viewBox="0 0 {across:.1f} {down:.1f}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{escape(words)}" {box}>{body}</svg>'


def _stroke(stroke: Stroke, lines: Sequence[Array]) -> str:
    if stroke.dots:
        return "".join(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{1.6 * stroke.width:.1f}" fill="{TOUCH}"/>'
            for x, y in np.concatenate(lines).tolist()
        )
    path = "".join("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in line.tolist()) for line in lines)
    look = f'stroke="currentColor" stroke-width="{stroke.width:g}" stroke-opacity="{stroke.opacity:g}"'
    return f'<path d="{path}" fill="none" {look} stroke-linecap="round" stroke-linejoin="round"/>'


def flattened(places: Array) -> Array:
    """Return places in space projected onto the view, y up, shape (..., 2)."""
    return np.asarray(places @ _view()[:2].T)


def edges_seen(place: Array, polygons: Array, normals: Array) -> Array:
    """Return the visible edges of a body in space: its outline in the view, and its creases.

    Edges of polygons that face away are left out; those hidden by other bodies are not.

    Parameters
    ----------
    place : ndarray, shape (points, 3)
        Corners of the polygons.
    polygons : ndarray of int, shape (polygons, corners)
        Corners of each, counter-clockwise about its outward normal.
    normals : ndarray, shape (polygons, 3)
        Outward unit normals, zero for polygons without an area.

    Returns
    -------
    ndarray, shape (edges, 2, 2)
        Both ends of each, projected onto the view.
    """
    ends = np.sort(np.stack([polygons, np.roll(polygons, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(polygons)), polygons.shape[1])
    has_area = np.any(normals, axis=1)[owner] & (place[ends[:, 0]] != place[ends[:, 1]]).any(axis=1)
    ends, owner = ends[has_area], owner[has_area]
    edges, number = np.unique(ends, axis=0, return_inverse=True)
    order = np.argsort(number.ravel(), kind="stable")
    first = np.searchsorted(number.ravel()[order], np.arange(len(edges)))
    last = np.append(first[1:], len(order)) - 1
    one, other = owner[order[first]], owner[order[last]]
    facing: Array = np.asarray(normals @ _view()[2]) > 0.0
    turn = np.where(one == other, -1.0, np.einsum("ei,ei->e", normals[one], normals[other]))
    turn[facing[one] != facing[other]] = -1.0
    seen = np.flatnonzero((facing[one] | facing[other]) & (turn < CREASE))
    seen = seen[np.argsort(turn[seen], kind="stable")[:MOST_EDGES]]
    return flattened(place[edges[seen]])


def _view() -> Array:
    """Return the directions to the right, up and to the eye, shape (3, 3)."""
    azimuth, eye = VIEW[1], eye_of(VIEW)
    right = np.array([np.cos(azimuth), 0.0, -np.sin(azimuth)])
    return np.stack([right, np.cross(eye, right), eye])


def eye_of(view: tuple[float, float]) -> Array:
    """Return the direction towards the eye; y is up."""
    elevation, azimuth = view
    across = np.cos(elevation)
    return np.array([across * np.sin(azimuth), np.sin(elevation), across * np.cos(azimuth)])


def spoken(number: float, unit: str) -> str:
    """Return a quantity with a prefixed unit, such as ``210 GPa``."""
    for prefix, size in (("G", 1e9), ("M", 1e6), ("k", 1e3)):
        if abs(number) >= size:
            return f"{number / size:.4g} {prefix}{unit}"
    return f"{number:.4g} {unit}"


def band(frequencies: Array) -> str:
    """Return the range of frequencies [Hz] in words."""
    low, high = (spoken(float(one), "Hz") for one in (frequencies.min(), frequencies.max()))
    return f"at {low}" if low == high else f"from {low} to {high}"
