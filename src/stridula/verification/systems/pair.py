"""A rod that is pushed along its axis over a beam: the exponents of its sliding by formula."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians

import numpy as np
import scipy.linalg
import xarray as xr

from ...analysis.stability import sliding_stability
from ...arrays import Array
from ...bodies import FiniteElementBeam, ModalBeam
from ...contact import Coulomb, PointContact
from ...drives import Force
from ...system import System
from .beams import SQUARE, STEEL

PUSH = 1e-3


@dataclass(frozen=True)
class Pair:
    """A rod, guided at its root, that is pushed along its axis over a beam, tip first.

    Attributes
    ----------
    slider, track : float, optional
        Lengths [m].
    angle : float, optional
        Angle of the rod from the normal [°].
    elements, bending, axial : int, optional
        Elements of the rod, modes of the beam.
    """

    slider: float = 0.15
    track: float = 0.40
    angle: float = 45.0
    elements: int = 30
    bending: int = 60
    axial: int = 30

    @property
    def rod(self) -> FiniteElementBeam:
        """The rod."""
        return FiniteElementBeam(STEEL, SQUARE, self.slider, angle=radians(self.angle), elements=self.elements)

    @property
    def beam(self) -> ModalBeam:
        """The beam."""
        return ModalBeam(STEEL, SQUARE, self.track, bending_modes=self.bending, axial_modes=self.axial)

    def found(self, friction: float) -> xr.Dataset:
        """Return its vibration in sliding by the package, without checking whether friction would hold it."""
        rod, beam = self.rod, self.beam
        contact = PointContact(rod.tip, beam, at=self.track / 2.0, friction=Coulomb(friction))
        return sliding_stability(System(contact, drives=[Force(rod.root, axial=-PUSH)]), status="sliding")

    def formula(self, friction: float) -> Array:
        """Return exponents [1/s] with positive frequency of ``(Y'Z, Y'KZ)``, ``Z = null(G)``, ``Y = null(G + mu T)``.

        Pushed along its axis the tip moves towards -x. Rows are those of the modes; a free rigid motion gives zero.
        """
        rod, beam = self.rod, self.beam
        tip, under = rod.trace(0.0), beam.trace(self.track / 2.0)
        tangent, normal = (np.concatenate([tip[k], -under[k]])[None] for k in (0, 1))
        angular = np.concatenate([rod.modes().angular_frequency, beam.modes().angular_frequency])
        right, left = scipy.linalg.null_space(normal), scipy.linalg.null_space(normal + friction * tangent)
        squared = scipy.linalg.eigvals((left.T * angular**2) @ right, left.T @ right)
        root = np.sqrt(-squared.astype(complex))
        both = np.concatenate([root, -root])
        return both[np.lexsort((-both.real, np.round(both.imag, 3)))][both.size // 2 :]

    def rounding(self, exponent: complex) -> float:
        """Return the error of an exponent due to rounding of its square [1/s]."""
        highest = float(self.beam.modes().angular_frequency.max()), float(self.rod.modes().angular_frequency.max())
        return 10.0 * np.finfo(float).eps * max(highest) ** 2 / max(abs(exponent), 1.0)
