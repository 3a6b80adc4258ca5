"""Nonlinear springs as rows over the modes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..connections import unit
from ..connections.nonlinear import Bend
from .coordinates import Coordinates

# Stiffness of a spring without any at rest, in the first step of the search for an equilibrium [N/m].
UNKNOWN = 1.0


@dataclass(frozen=True)
class SpringRows:
    """Nonlinear springs as rows over the modes, beyond their linear parts, which couple the modes.

    Attributes
    ----------
    rows : ndarray, shape (springs, modes)
        Stretch of each for a unit of the modes.
    bends : tuple of Bend
        Pull of each beyond its linear part.
    at_rest : tuple of float
        Stiffness of this part [N/m].
    """

    rows: Array
    bends: tuple[Bend, ...]
    at_rest: tuple[float, ...]

    def forces(self, position: Array) -> Array:
        """Return the modal forces at modal positions, shape (modes,)."""
        pulls = [bend.pull(stretch) for bend, stretch in self._with_stretch(position)]
        return np.asarray(-np.array(pulls) @ self.rows)

    def energy(self, position: Array) -> float:
        """Return the stored energy at modal positions [J]."""
        return sum(bend.energy(stretch) for bend, stretch in self._with_stretch(position))

    def steepest(self) -> tuple[Array, Array]:
        """Return a first stiffness in the search for an equilibrium, the largest of each, with no modal forces."""
        rates = [
            rate or UNKNOWN * (start == 0.0)
            for rate, start in zip((one.steepest(0.0) for one in self.bends), self.at_rest, strict=True)
        ]
        return np.asarray(self.rows.T * np.array(rates) @ self.rows), np.zeros(self.rows.shape[1])

    def tangents(self, position: Array) -> tuple[Array, Array]:
        """Return their stiffness about modal positions, (modes, modes), and the modal forces at the origin."""
        pairs = self._with_stretch(position)
        rates = np.array([bend.stiffness(stretch) for bend, stretch in pairs])
        at_origin = np.array([bend.pull(stretch) - bend.stiffness(stretch) * stretch for bend, stretch in pairs])
        return np.asarray(self.rows.T * rates @ self.rows), np.asarray(-at_origin @ self.rows)

    def _with_stretch(self, position: Array) -> list[tuple[Bend, float]]:
        return list(zip(self.bends, (self.rows @ position).tolist(), strict=True))


def spring_rows(coordinates: Coordinates) -> SpringRows:
    """Return the nonlinear springs of a system."""
    rows, bends, at_rest = list[Array](), list[Bend](), list[float]()
    for one in coordinates.system.connections:
        if one.bend is not None:
            row = unit(one) @ coordinates.trace(one.first)
            rows.append(row if one.second is None else row - unit(one) @ coordinates.trace(one.second))
            bends.append(one.bend)
            at_rest.append(one.rates[0])
    return SpringRows(np.array(rows).reshape(len(rows), coordinates.size), tuple(bends), tuple(at_rest))
