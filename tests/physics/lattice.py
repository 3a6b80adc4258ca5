"""A free lattice of masses and springs in the plane: a body whose modes lie close, as those of a block do."""

from __future__ import annotations

from itertools import product

import numpy as np

import stridula as st

COLUMNS, ROWS, PITCH = 5, 3, 0.02
POINTS = {"foot": (0, 0), "heel": (COLUMNS - 1, 0), "back": (COLUMNS // 2, ROWS - 1)}


def matrices() -> tuple[np.ndarray, np.ndarray]:
    """Mass and stiffness, two degrees of freedom a node."""
    nodes = {place: number for number, place in enumerate(product(range(COLUMNS), range(ROWS)))}
    mass, stiffness = np.zeros(2 * len(nodes)), np.zeros((2 * len(nodes),) * 2)
    for (column, row), number in nodes.items():
        mass[2 * number : 2 * number + 2] = 0.02 * (1.0 + 0.1 * column + 0.2 * row)
        for way, rate in (((1, 0), 8e6), ((0, 1), 6e6), ((1, 1), 3e6), ((1, -1), 4e6)):
            other = nodes.get((column + way[0], row + way[1]))
            if other is not None:
                along = np.array(way) / np.hypot(*way)
                spring = np.zeros(len(stiffness))
                spring[2 * number : 2 * number + 2], spring[2 * other : 2 * other + 2] = along, -along
                stiffness += rate * np.outer(spring, spring)
    return np.diag(mass), stiffness


def rows() -> dict[str, tuple[int, int]]:
    """Degrees of freedom of the points along x and y."""
    numbers = {name: column * ROWS + row for name, (column, row) in POINTS.items()}
    return {name: (2 * number, 2 * number + 1) for name, number in numbers.items()}


def lattice(cutoff: float | None = 3000.0, **words) -> st.ReducedBody:
    """The body: three rigid modes, then from 1.3 kHz to 9 kHz."""
    mass, stiffness = matrices()
    translation = np.tile(np.eye(2), COLUMNS * ROWS)
    return st.ReducedBody(
        mass, stiffness, rows(), **{"translation": translation, "cutoff": cutoff, "name": "block"} | words
    )


def on_feet(law=None, cutoff: float | None = 3000.0, belt: float = -0.8, joined: float = 2e6, **words) -> st.System:
    """The lattice on a belt with two feet, sprung at its back, pressed and weighed down."""
    body = lattice(cutoff, **words)
    contacts = [
        st.PointContact(body.at(foot), st.RigidTrack(velocity=belt, name=foot), friction=law or st.Coulomb(0.3))
        for foot in ("foot", "heel")
    ]
    springs = [st.Spring(body.at("back"), stiffness=joined or 1.0, direction=way) for way in ("x", "y")]
    loads = [st.Force(body.at("back"), y=-400.0), st.Gravity(9.81)]
    return st.System(contacts, loads, springs if joined else [])
