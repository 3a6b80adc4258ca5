"""Complex mode shapes as real ones, with their loss."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Array


@dataclass(frozen=True)
class RealShapes:
    """Real parts of complex shapes after a rotation to the phase in which they are largest.

    Attributes
    ----------
    shapes : ndarray, shape (places, modes)
        Real parts.
    turned : ndarray, shape (modes,)
        Phase by which each shape was ahead [rad], from -pi/2 to pi/2.
    lost : ndarray, shape (modes,)
        Share of the imaginary part in the square of the shape [1], at most a half.
    """

    shapes: Array
    turned: Array
    lost: Array

    @property
    def collinearity(self) -> Array:
        """Modal phase collinearity [1], shape (modes,): 1 for real shapes, 0 without any common phase."""
        # The eigenvalues of the covariance of real and imaginary parts are 1 - lost and lost.
        return np.square(1.0 - 2.0 * self.lost)


def real_shapes(shapes: Array) -> RealShapes:
    """Return complex shapes, shape (places, modes), as real ones."""
    turned = 0.5 * np.angle(np.sum(np.square(shapes), axis=0))
    along = shapes * np.exp(-1j * turned)
    size = np.sum(np.abs(shapes) ** 2, axis=0)
    lost = np.sum(along.imag**2, axis=0) / np.where(size > 0.0, size, 1.0)
    return RealShapes(along.real.copy(), turned, lost)
