"""A run of the compiled march held against the twin, step by step.

Both follow the same equations by different arithmetic: increments against two positions, closed contact solve against
trial of every state. The two-position form has a relative error of ``eps / (w h)² ~ 2e-16 / (2 pi 50 x 5e-6)² = 1e-10``
by cancellation on the lowest bending mode, and a contact force follows from a gap that is a difference of positions
some 10 to 1000 times larger: 1e-8 of the peak holds for positions and energies, 1e-6 for forces. A start perturbed by
1e-9 of the gap moves the forces by 1e-9 to 3e-8 over the same steps: no chaos yet.
"""

from __future__ import annotations

import numpy as np

COLUMNS = {
    "normal_force": ("normal", 1e-6),
    "tangential_force": ("tangential", 1e-6),
    "contact_position": ("position", 1e-9),
    "kinetic_and_elastic": ("stored", 1e-8),
    "drive_work": ("drive", 1e-8),
    "contact_work": ("contact", 1e-6),
    "friction_loss": ("friction", 1e-6),
    "convection_work": ("convection", 1e-6),
    "damping_loss": ("damping", 1e-8),
    "friction_state": ("state", 1e-8),
    "temperature": ("temperature", 1e-9),
}
ENERGIES = ("contact_work", "friction_loss", "convection_work", "damping_loss")


def disagreements(run, trail, vanishing=True) -> dict[str, float]:
    """Largest difference of each recorded column over its peak, where above its tolerance.

    Where losses and heights may be `vanishing`, these are also compared with the energy in play and with all
    displacements.
    """
    found = {}
    # A loss of nothing is round-off.
    least = 1e-14 * max(np.abs(trail.stored).max(), np.abs(trail.drive).max()) if vanishing else 0.0
    for name, (attribute, tolerance) in COLUMNS.items():
        if name not in run:
            continue
        expected = getattr(trail, attribute)
        values = run[name].values.reshape(expected.shape)
        peak = np.abs(expected[np.isfinite(values)]).max()
        off = np.nanmax(np.abs(values - expected))
        if off > tolerance * peak + least * (name in ENERGIES):
            found[name] = off / max(peak, 1e-300)
    moved = max(np.abs(trail.height).max(), np.ptp(trail.position) if vanishing else 0.0)
    # A share is a ratio of the distances of a gap or a force from its border, down to a hundredth of the peaks of
    # COLUMNS.
    for name, expected, largest in (
        ("gap", trail.gap, 1e-8 * moved),
        ("contact_height", trail.height, 1e-8 * moved),
        ("status", trail.status, 0),
        ("landings", trail.landings, 0),
        ("status_share", trail.share, 1e-4),
    ):
        off = np.abs(run[name].values.reshape(expected.shape) - expected).max()
        if off > largest:
            found[name] = off
    return found
