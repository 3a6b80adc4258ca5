"""Symbols of mechanics in the plane as lines: springs, dashpots, supports, the ground."""

from __future__ import annotations

import numpy as np

from ..arrays import Array

# Number of turns of a spring, share of its length that is straight at either end, and number of strokes of the ground.
TURNS, STRAIGHT, STROKES = 5, 0.2, 5
# Angles of a circle.
ROUND = np.linspace(0.0, 2.0 * np.pi, 25)


def across(way: Array) -> Array:
    """Return a direction of the plane turned by a right angle, counter-clockwise."""
    return np.array([-way[1], way[0]])


def _placed(start: Array, end: Array, width: float, lines: list[list[tuple[float, float]]]) -> list[Array]:
    """Return lines given along, from 0 to 1 between two places, and across in shares of a width."""
    side = across((end - start) / np.linalg.norm(end - start))
    return [
        start + np.outer(one[:, 0], end - start) + width * np.outer(one[:, 1], side) for one in map(np.array, lines)
    ]


def spring(start: Array, end: Array, width: float) -> list[Array]:
    """Return the lines of a spring between two places."""
    along = np.linspace(STRAIGHT, 1.0 - STRAIGHT, 2 * TURNS + 1)
    beside = 0.5 * np.array([0.0, *np.resize([1.0, -1.0], 2 * TURNS - 1), 0.0])
    bends = list(zip(along.tolist(), beside.tolist(), strict=True))
    return _placed(start, end, width, [[(0.0, 0.0), *bends, (1.0, 0.0)]])


def dashpot(start: Array, end: Array, width: float) -> list[Array]:
    """Return the lines of a dashpot between two places: a piston in a cup."""
    cup = [(0.62, 0.5), (0.35, 0.5), (0.35, -0.5), (0.62, -0.5)]
    rods = [[(0.0, 0.0), (0.35, 0.0)], [(0.52, 0.0), (1.0, 0.0)]]
    return _placed(start, end, width, [*rods, cup, [(0.52, 0.35), (0.52, -0.35)]])


def ground(place: Array, inwards: Array, width: float) -> list[Array]:
    """Return the lines of the ground: its surface at a place, and strokes into it."""
    side = across(inwards)
    marks = place + width * np.outer(np.linspace(-0.5, 0.5, STROKES), side)
    depth = 0.25 * width * (inwards - side)
    return [np.array([marks[0], marks[-1]]), *(np.array([one, one + depth]) for one in marks)]


def pinned(place: Array, inwards: Array, width: float) -> list[Array]:
    """Return the lines of a support that lets turn: a triangle on the ground, its tip at a place."""
    side, foot = across(inwards), place + 0.8 * width * inwards
    triangle = np.array([place, foot + 0.45 * width * side, foot - 0.45 * width * side, place])
    return [triangle, *ground(foot, inwards, 1.2 * width)]


def clamped(place: Array, inwards: Array, width: float) -> list[Array]:
    """Return the lines of a support that holds all: a wall."""
    return ground(place, inwards, 1.6 * width)


def guided(place: Array, inwards: Array, width: float) -> list[Array]:
    """Return the lines of a support that lets move but not turn: two bars with rollers between them."""
    side, radius = across(inwards), 0.14 * width
    bars = [place + step * inwards + width * np.outer([-0.6, 0.6], side) for step in (0.0, 2.0 * radius)]
    circle = radius * np.column_stack([np.cos(ROUND), np.sin(ROUND)])
    return [*bars, *(place + radius * inwards + 0.35 * width * sign * side + circle for sign in (-1.0, 1.0))]


def bar(start: Array, end: Array, width: float) -> list[Array]:
    """Return the lines of a rigid joint between two places: two parallel bars."""
    return _placed(start, end, width, [[(0.0, 0.12), (1.0, 0.12)], [(0.0, -0.12), (1.0, -0.12)]])


CONNECTIONS = {
    "spring": spring,
    "dashpot": dashpot,
    "cubic spring": spring,
    "tabulated spring": spring,
    "tabulated dashpot": dashpot,
    "viscoelastic spring": spring,
    "bushing": spring,
    "rigid joint": bar,
}
SUPPORTS = {"pinned": pinned, "clamped": clamped, "guided": guided}
