"""Growing modes of sliding, from the equations, without the package's linear theory."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg


def unstable_frequencies(system: Any, sense: float) -> np.ndarray:
    """Return the frequencies [Hz] of the modes that grow when small motion is added to steady sliding.

    No time march: with the rows ``N q = 0`` (contact stays closed) and forces along ``N - sense mu T``, the free motion
    lies in the null space Z of N and is tested with the null space Y of ``N - sense mu T``; eigenvalues of
    ``Y' (s² + s C + K) Z``, unsymmetric.
    """
    slider, track, contact = system.slider, system.track, system.contact
    parts = slider.modes(held_x=True), track.modes()
    angular = np.concatenate([part.angular_frequency for part in parts])
    damping = np.concatenate([part.damping for part in parts])
    tip, below = slider.trace(0.0, held_x=True), track.trace(contact.at)
    tangent, normal = np.concatenate([tip, -below], axis=1)
    z = scipy.linalg.null_space(normal[None])
    y = scipy.linalg.null_space((normal - sense * contact.friction.coefficient * tangent)[None])
    mass, loss, stiffness = (y.T @ (d[:, None] * z) for d in (angular**0, 2 * damping * angular, angular**2))
    zero, one = np.zeros_like(mass), np.eye(len(mass))
    matrix = np.block([[zero, one], [-scipy.linalg.solve(mass, stiffness), -scipy.linalg.solve(mass, loss)]])
    roots = scipy.linalg.eigvals(matrix)
    return roots[(roots.real > 1.0) & (roots.imag > 0.0)].imag / (2.0 * np.pi)
