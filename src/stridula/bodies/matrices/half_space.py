"""Displacement of the surface of an elastic half-space under uniform tractions on squares."""

from __future__ import annotations

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, positive
from ..matrix_input import check_finite, numbers
from ..sections import Material

# Share of the side by which squares may overlap due to rounding.
OVERLAP = 1e-9
# Largest cosine between directions at right angles, due to rounding.
ALONG = 1e-9


def surface_frame(normal: object, along: object) -> Array:
    """Return the unit vectors along `along`, along `normal` and across both, shape (3, 3).

    Raises
    ------
    ValueError
        If one of them is not three numbers, or they are not at right angles.
    """
    given = {"normal": numbers("normal", normal), "along": numbers("along", along)}
    for name, vector in given.items():
        if vector.shape != (3,) or not vector.any():
            raise ArgumentError(name, "be three numbers, not all zero", vector)
        check_finite(name, vector)
    out, first = (vector / np.linalg.norm(vector) for vector in given.values())
    if abs(out @ first) > ALONG:
        raise ArgumentError("along", "be at right angles to the normal", along)
    return np.stack([first, out, np.cross(first, out)])


def half_space_shapes(material: Material, places: Array, side: float, frame: Array, coupled: bool) -> Array:
    """Return residual shapes of squares on a half-space, rows along the world's axes, shape (3 squares, 3 squares).

    Parameters
    ----------
    material : Material
        Material.
    places : ndarray, shape (squares, 3)
        Middles of the squares [m].
    side : float
        Side of each [m].
    frame : ndarray, shape (3, 3)
        Result of `surface_frame`; the squares' sides lie along its first and last vector.
    coupled : bool
        Whether pressure also moves the surface tangentially, and shear along the normal.

    Raises
    ------
    ValueError
        If squares overlap.
    """
    side = positive("side", side)
    apart = (places[:, None] - places[None]) @ frame[[0, 2]].T
    nearest = np.abs(apart).max(axis=2) + 2.0 * side * np.eye(len(places))
    if nearest.min() < side * (1.0 - OVERLAP):
        raise ArgumentError("places", f"be {side!r} m apart, the side of the squares", got=float(nearest.min()))
    flexibility = _flexibility(material, apart, side, coupled)
    size = flexibility.shape[0]
    shapes = np.linalg.cholesky(0.5 * (flexibility + flexibility.T))
    return np.asarray(np.einsum("ka,pkm->pam", frame, shapes.reshape(-1, 3, size)).reshape(size, size))


def _flexibility(material: Material, apart: Array, side: float, coupled: bool) -> Array:
    """Return displacements along, out and across at the middles for unit forces on squares, shape (3 n, 3 n).

    Boussinesq's and Cerruti's solutions (Johnson 1985, 3.2 and 3.6) over squares, in closed form (Love 1929).
    """
    count, poisson = len(apart), material.poisson
    shear = material.young / (2.0 * (1.0 + poisson))
    unit = 1.0 / (2.0 * np.pi * shear * side**2)
    along, across, both, slope_along, slope_across = _over_squares(apart[..., 0], apart[..., 1], side)
    found = np.zeros((count, 3, count, 3))
    found[:, 0, :, 0] = unit * (along + (1.0 - poisson) * across)
    found[:, 1, :, 1] = unit * (1.0 - poisson) * (along + across)
    found[:, 2, :, 2] = unit * (across + (1.0 - poisson) * along)
    found[:, 0, :, 2] = found[:, 2, :, 0] = unit * poisson * both
    if coupled:
        beside = 0.5 * unit * (1.0 - 2.0 * poisson)
        for direction, slope in ((0, slope_along), (2, slope_across)):
            found[:, direction, :, 1] = beside * slope
            found[:, 1, :, direction] = -beside * slope
    return found.reshape(3 * count, 3 * count)


def _over_squares(x: Array, y: Array, side: float) -> Array:
    """Return the integrals of x²/r³, y²/r³, xy/r³, x/r² and y/r² over squares about (x, y), from their corners."""
    found = np.zeros((5, *x.shape))
    for way, other in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        u, v = x + 0.5 * way * side, y + 0.5 * other * side
        far, beside, below = np.hypot(u, v), np.abs(u), np.abs(v)
        # Each is a length times a logarithm or an angle, and 0 with that length.
        with np.errstate(divide="ignore", invalid="ignore"):
            logarithm = np.where(far > 0.0, np.log(far), 0.0)
            parts = (
                np.where(below > 0.0, v * np.arcsinh(u / below), 0.0),
                np.where(beside > 0.0, u * np.arcsinh(v / beside), 0.0),
                -far,
                v * logarithm + beside * np.arctan2(v, beside),
                u * logarithm + below * np.arctan2(u, below),
            )
        found += way * other * np.array(parts)
    return found
