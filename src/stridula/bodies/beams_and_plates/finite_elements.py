"""Matrices of straight beam elements in the plane: Hermite cubic bending and a linear bar."""

from __future__ import annotations

import numpy as np

from ...arrays import Array

# Degrees of freedom of a node, in the world frame: displacement along x and y, and the section's rotation.
X, Y, ROTATION = 0, 1, 2
FIXED_BY_SUPPORT: dict[str, tuple[int, ...]] = {
    "free": (),
    "guided": (ROTATION,),
    "pinned": (X, Y),
    "clamped": (X, Y, ROTATION),
}


def element_stiffness(axial: float, bending: float, length: float) -> Array:
    """Return the stiffness of one element for (u, w, theta) at both ends, shape (6, 6).

    `axial` is ES [N], `bending` is EI [N m²], `length` is in m. Source: Przemieniecki, *Theory of Matrix Structural
    Analysis*, 1968, chapter 5.
    """
    stiffness = np.zeros((6, 6))
    stiffness[np.ix_((0, 3), (0, 3))] = axial / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    le = length
    hermite = [
        [12.0, 6.0 * le, -12.0, 6.0 * le],
        [6.0 * le, 4.0 * le**2, -6.0 * le, 2.0 * le**2],
        [-12.0, -6.0 * le, 12.0, -6.0 * le],
        [6.0 * le, 2.0 * le**2, -6.0 * le, 4.0 * le**2],
    ]
    stiffness[np.ix_((1, 2, 4, 5), (1, 2, 4, 5))] = bending / le**3 * np.array(hermite)
    return stiffness


def element_mass(line_density: float, length: float, kind: str) -> Array:
    """Return the mass of one element for (u, w, theta) at both ends, shape (6, 6).

    `line_density` is rho S [kg/m]. Consistent: Przemieniecki 1968, chapter 11. Lumped: half the element's mass at each
    end, and for the rotations the m le²/78 of Hinton, Rock & Zienkiewicz's scaled diagonal (1976).
    """
    le = length
    total = line_density * le
    mass = np.zeros((6, 6))
    if kind == "lumped":
        np.fill_diagonal(mass, total * np.array([0.5, 0.5, le**2 / 78.0] * 2))
        return mass
    mass[np.ix_((0, 3), (0, 3))] = total / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])
    hermite = [
        [156.0, 22.0 * le, 54.0, -13.0 * le],
        [22.0 * le, 4.0 * le**2, 13.0 * le, -3.0 * le**2],
        [54.0, 13.0 * le, 156.0, -22.0 * le],
        [-13.0 * le, -3.0 * le**2, -22.0 * le, 4.0 * le**2],
    ]
    mass[np.ix_((1, 2, 4, 5), (1, 2, 4, 5))] = total / 420.0 * np.array(hermite)
    return mass


def world_from_axes(angle: float) -> Array:
    """Return the matrix that turns (x, y, rotation) of a node into (u, w, theta) along the element, shape (3, 3).

    The axis is ``e1 = (sin a, cos a)``, the transverse direction ``t1 = (cos a, -sin a)``; the pair is left-handed,
    so theta, the slope dw/ds, is minus the counter-clockwise angle. The rotation of a node is theta itself.
    """
    sine, cosine = np.sin(angle), np.cos(angle)
    return np.array([[sine, cosine, 0.0], [cosine, -sine, 0.0], [0.0, 0.0, 1.0]])


def assemble(element: Array, angle: float, elements: int) -> Array:
    """Return the world-frame matrix of a chain of equal elements at `angle`, shape (3 (elements + 1),) twice."""
    turn = np.kron(np.eye(2), world_from_axes(angle))
    turned = turn.T @ element @ turn
    matrix = np.zeros((3 * (elements + 1),) * 2)
    for first in range(0, 3 * elements, 3):
        matrix[first : first + 6, first : first + 6] += turned
    return matrix


def slope_row(position: float, length: float, angle: float, elements: int) -> Array:
    """Return the row that gives the slope dw/ds at `position` from all nodes, shape (3 (elements + 1),)."""
    le = length / elements
    element = min(int(position / le), elements - 1)
    s = position / le - element
    bend = 6.0 * (s - s**2) / le
    slopes = np.array([0.0, -bend, 1.0 - 4.0 * s + 3.0 * s**2, 0.0, bend, 3.0 * s**2 - 2.0 * s])
    row = np.zeros(3 * (elements + 1))
    row[3 * element : 3 * element + 6] = slopes @ np.kron(np.eye(2), world_from_axes(angle))
    return row


def displacement_row(position: float, length: float, angle: float, elements: int) -> Array:
    """Return the rows that give the world displacement at `position` from all nodes, shape (2, 3 (elements + 1))."""
    le = length / elements
    element = min(int(position / le), elements - 1)
    s = position / le - element
    interpolation = np.zeros((2, 6))
    interpolation[0, [0, 3]] = 1.0 - s, s
    interpolation[1, [1, 2, 4, 5]] = (
        1.0 - 3.0 * s**2 + 2.0 * s**3,
        le * (s - 2.0 * s**2 + s**3),
        3.0 * s**2 - 2.0 * s**3,
        le * (s**3 - s**2),
    )
    nodes = interpolation @ np.kron(np.eye(2), world_from_axes(angle))
    rows = np.zeros((2, 3 * (elements + 1)))
    rows[:, 3 * element : 3 * element + 6] = world_from_axes(angle)[:2, :2].T @ nodes
    return rows
