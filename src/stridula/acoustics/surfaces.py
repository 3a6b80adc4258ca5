"""Surfaces as points with areas: quadrature fine enough for a frequency and for a listener close by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from .panels import Panel

# Gauss-Legendre points along each side of a cell.
POINTS = 8
# Largest phase over a cell, the sum of that of the modes and of the sound [rad].
PHASE = 3.0 * np.pi
# Largest side of a cell over its distance to the listener.
NEARNESS = 2.0
# Cells into which one side may be cut close to a listener.
FINEST = 20


@dataclass(frozen=True)
class Surface:
    """Elements of a vibrating surface in the plane z = 0.

    Attributes
    ----------
    points : ndarray, shape (points, 2)
        Their x and y [m].
    areas : ndarray, shape (points,)
        Their areas [m²].
    shapes : callable
        Takes points (n, 2), returns the displacement of each mode out of the plane, shape (n, modes).
    panel : Panel, optional
        The panel of which they are the shapes.
    """

    points: Array
    areas: Array
    shapes: Callable[[Array], Array]
    panel: Panel | None = None


def surface_of(panel: Panel, listener: Array, wavenumber: float, refinement: float = 1.0) -> Surface:
    """Return the elements of a panel for a listener.

    Cells of 8 x 8 Gauss-Legendre points, over which the phase of modes and sound turns by 3 pi at most and that are no
    larger than twice their distance to the listener. Cells of half the size move no response by more than 1e-5 of its
    largest value.

    Parameters
    ----------
    panel : Panel
        The panel.
    listener : ndarray, shape (3,)
        Its x, y, z [m].
    wavenumber : float
        Largest wavenumber of the sound [rad/m].
    refinement : float, optional
        Factor by which the cells are smaller than that.
    """
    largest = panel.wavenumbers.max(axis=0)
    cells = _uniform(panel, PHASE / refinement / (largest + wavenumber))
    cells = _graded(cells, listener, NEARNESS / refinement)
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    x = cells[:, 0, None] + cells[:, 2, None] * (nodes + 1.0) / 2.0
    y = cells[:, 1, None] + cells[:, 3, None] * (nodes + 1.0) / 2.0
    whole = (len(cells), POINTS, POINTS)
    points = np.stack([np.broadcast_to(x[:, :, None], whole), np.broadcast_to(y[:, None, :], whole)], axis=-1)
    areas = (cells[:, 2] * cells[:, 3] / 4.0)[:, None, None] * np.outer(weights, weights)
    return Surface(points.reshape(-1, 2), areas.ravel(), lambda at: panel.shapes(at[:, 0], at[:, 1]), panel)


def line_of_points(panel: Panel, listener: Array, wavenumber: float, refinement: float = 1.0) -> tuple[Array, Array]:
    """Return abscissas and lengths [m] of the elements of a line, as fine as those of `surface_of`."""
    largest = float(panel.wavenumbers[:, 0].max())
    cells = _uniform(panel, np.array([PHASE / refinement / (largest + wavenumber), np.inf]))
    cells = _graded(cells, listener, NEARNESS / refinement)
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    points = cells[:, 0, None] + cells[:, 2, None] * (nodes + 1.0) / 2.0
    return points.ravel(), (cells[:, 2, None] / 2.0 * weights).ravel()


def _uniform(panel: Panel, size: Array) -> Array:
    """Return cells (x, y, length, width), each side at most of a size, shape (cells, 4)."""
    counts = [max(1, int(np.ceil(side / most))) for side, most in zip((panel.length, panel.width), size, strict=True)]
    length, width = panel.length / counts[0], panel.width / counts[1]
    x, y = np.meshgrid(np.arange(counts[0]) * length, panel.edge + np.arange(counts[1]) * width, indexing="ij")
    return np.stack([x.ravel(), y.ravel(), np.full(x.size, length), np.full(x.size, width)], axis=1)


def _graded(cells: Array, listener: Array, nearness: float) -> Array:
    """Return the cells, halved along each side that is longer than `nearness` times the distance to the listener."""
    for _ in range(FINEST):
        low, size = cells[:, :2], cells[:, 2:]
        away = listener[:2] - np.clip(listener[:2], low, low + size)
        distance = np.sqrt(np.sum(away**2, axis=1) + listener[2] ** 2)
        halved = False
        for axis in (0, 1):
            large = cells[:, 2 + axis] > nearness * distance
            if large.any():
                first, halved = cells[large], True
                first[:, 2 + axis] /= 2.0
                second = first.copy()
                second[:, axis] += first[:, 2 + axis]
                cells = np.concatenate([cells[~large], first, second])
                distance = np.concatenate([distance[~large], distance[large], distance[large]])
        if not halved:
            break
    return cells
