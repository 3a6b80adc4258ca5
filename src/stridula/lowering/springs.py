"""Nonlinear springs and dashpots as rows over the modes."""

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
    """Nonlinear springs and dashpots as rows over the modes, beyond their linear parts, which couple the modes.

    Attributes
    ----------
    rows : ndarray, shape (springs, modes)
        Stretch of each for a unit of the modes.
    bends : tuple of Bend
        Pull of each beyond its linear part.
    at_rest : tuple of float
        Stiffness of the linear part [N/m].
    """

    rows: Array
    bends: tuple[Bend, ...]
    at_rest: tuple[float, ...]

    def forces(self, position: Array, velocity: Array) -> Array:
        """Return the modal forces at modal positions and velocities, shape (modes,)."""
        moved = np.where([bend.of_rate for bend in self.bends], self.rows @ velocity, self.rows @ position)
        pulls = [bend.pull(one) for bend, one in zip(self.bends, moved.tolist(), strict=True)]
        return np.asarray(-np.array(pulls) @ self.rows)

    def energy(self, position: Array) -> float:
        """Return the stored energy at modal positions [J]."""
        return sum(
            bend.constant * stretch if bend.of_rate else bend.energy(stretch)
            for bend, stretch in self._with_stretch(position)
        )

    def damping(self) -> Array:
        """Return the damping of dashpots for small motions about rest, shape (modes, modes)."""
        rates = np.array([bend.stiffness_about_rest() if bend.of_rate else 0.0 for bend in self.bends])
        return np.asarray(self.rows.T * rates @ self.rows)

    def steepest(self) -> tuple[Array, Array]:
        """Return a first stiffness in the search for an equilibrium, the largest of each, with no modal forces."""
        rates = [
            0.0 if bend.of_rate else bend.steepest(0.0) or UNKNOWN * (start == 0.0)
            for bend, start in zip(self.bends, self.at_rest, strict=True)
        ]
        return np.asarray(self.rows.T * np.array(rates) @ self.rows), np.zeros(self.rows.shape[1])

    def tangents(self, position: Array) -> tuple[Array, Array]:
        """Return their stiffness about modal positions, (modes, modes), and the modal forces at the origin, at rest."""
        moved = [(bend, 0.0 if bend.of_rate else stretch) for bend, stretch in self._with_stretch(position)]
        rates = np.array([0.0 if bend.of_rate else bend.stiffness(stretch) for bend, stretch in moved])
        at_origin = np.array([bend.pull(stretch) for bend, stretch in moved]) - rates * [one for _, one in moved]
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
