"""Systems without the residual shapes that no contact and no dashpot sees.

Residual shapes have stiffness and no mass. Of all their motions only those matter that move a contact or a dashpot, and
those on which their forces act. With orthonormal bases N of these and U of the others, the latter follow statically::

    U^T K_ll U w = U^T (f_l - K_lh h - K_ll N n),    q_l = N n + U w

Contacts and dashpots act on heavy modes h and on n alone, whatever their friction, status or stiffness, so that this
elimination holds for all of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass, fields, replace

import numpy as np
import scipy.linalg

from ..arrays import Array
from ..contact import PointContact
from ..system import System
from .structure import ContactLine, Structure

# What may differ between contacts with the same rows, and the matrices that must not differ.
LAWS = ("friction", "stiffness", "tangential_stiffness", "tangential_damping")
MATRICES = ("mass", "stiffness", "damping", "passing", "rigid")
# Fewest residual shapes, and largest share of them that is kept, with which the elimination is worth its time.
FEWEST, LARGEST_SHARE = 32, 0.75
# Size of the part of a row, of norm 1, that counts as due to rounding.
ROUNDING = 1e-13


@dataclass(frozen=True)
class Condensed:
    """A system, and the same without the residual shapes that nothing sees.

    Attributes
    ----------
    whole : Structure
        The system.
    small : Structure
        The other one, with the same contacts, equilibria and exponents; the system itself if there is little to
        eliminate, or if nonlinear springs would see all shapes.
    forces : ndarray, shape (small modes, modes)
        Matrix from modal forces of the system to those of the other.
    """

    whole: Structure
    small: Structure
    forces: Array

    def with_laws(self, system: System) -> Condensed | None:
        """Return another system with the same matrices, None if more than laws and stiffnesses of contacts differ."""
        if not _differs_in_laws_alone(self.whole.system, system):
            return None
        whole, small = (_of(one, system) for one in (self.whole, self.small))
        return Condensed(whole, small if self.small is not self.whole else whole, self.forces)

    def with_loads(self, whole: Structure) -> Condensed | None:
        """Return another system without the same shapes, None if its matrices differ."""
        if self.small is self.whole or not _have_equal_matrices(self.whole, whole):
            return None
        small = _of(self.small, whole.system)
        small.load, small.gaps = self.forces @ whole.load, whole.gaps
        small.rates, small.ways, small.arrays = whole.rates, whole.ways, whole.arrays
        return Condensed(whole, small, self.forces)


def condensed(structure: Structure) -> Condensed:
    """Return a system without the residual shapes that nothing sees, with the same contacts, equilibria and exponents.

    Parameters
    ----------
    structure : Structure
        The system.
    """
    light, alone = structure.mass == 0.0, Condensed(structure, structure, np.zeros((0, 0)))
    if int(light.sum()) < FEWEST or structure.arrays.springs.bends:
        return alone
    seen, unseen = _bases(np.array(list(_rows(structure)))[:, light])
    if seen.shape[1] > LARGEST_SHARE * len(seen):
        return alone
    return Condensed(structure, *_without(structure, light, seen, unseen))


def _of(structure: Structure, system: System) -> Structure:
    """Return the matrices of a system for another one that has the same; the static response of bodies is kept."""
    found = copy(structure)
    found.forget(but=("response",))
    found.system = system
    return found


def _differs_in_laws_alone(one: System, other: System) -> bool:
    """Return whether two systems have the same bodies, contacts, connections and drives up to laws of contacts."""
    same = one.bodies == other.bodies and one.connections == other.connections and one.drives == other.drives
    if not same or len(one.contacts) != len(other.contacts):
        return False
    names = [each.name for each in fields(PointContact) if each.name not in LAWS]
    return all(
        all(getattr(a, name) == getattr(b, name) for name in names) and a.law.depends_on_speed == b.law.depends_on_speed
        for a, b in zip(one.contacts, other.contacts, strict=True)
    )


def _have_equal_matrices(one: Structure, other: Structure) -> bool:
    """Return whether two systems have equal matrices and contacts on their modes, whatever their loads."""
    laws = [[contact.law.depends_on_speed for contact in each.system.contacts] for each in (one, other)]
    if other.arrays.springs.bends or laws[0] != laws[1]:
        return False
    return all(np.array_equal(getattr(one, word), getattr(other, word)) for word in MATRICES) and all(
        np.array_equal(getattr(a, each.name), getattr(b, each.name))
        for a, b in zip(one.lines, other.lines, strict=True)
        for each in fields(ContactLine)
    )


def _rows(structure: Structure) -> Iterator[Array]:
    """Yield the rows on the modes by which contacts and dashpots see motions and act on them."""
    turns = structure.passing.any()
    for contact, line in zip(structure.system.contacts, structure.lines, strict=True):
        rows = [getattr(line, one.name) for one in fields(ContactLine) if one.name != "points"]
        yield from (row for row in rows if row.any())
        if turns:
            slips = [line.across, line.along, *([line.tangent] if contact.law.depends_on_speed else [])]
            yield from (row @ structure.passing for row in slips if row.any())
    light = structure.mass == 0.0
    yield from structure.damping[structure.damping[:, light].any(axis=1)]
    yield from structure.damping.T[structure.damping[light].any(axis=0)]


def _bases(rows: Array) -> tuple[Array, Array]:
    """Return orthonormal bases of the motions that rows see and of the others, each of shape (motions, count)."""
    sizes = np.linalg.norm(rows, axis=1)
    rows = rows[sizes > 0.0] / sizes[sizes > 0.0, None]
    if not len(rows):
        return np.zeros((rows.shape[1], 0)), np.eye(rows.shape[1])
    basis, triangle, _ = scipy.linalg.qr(rows.T, pivoting=True, check_finite=False)
    count = int(np.sum(np.abs(np.diag(triangle)) > ROUNDING))
    return basis[:, :count], basis[:, count:]


def _without(structure: Structure, light: Array, seen: Array, unseen: Array) -> tuple[Structure, Array]:
    """Return a system on its modes with mass and the seen motions, and the matrix from its modal forces to theirs."""
    heavy, size = np.flatnonzero(~light), int((~light).sum())
    kept = np.zeros((len(light), size + seen.shape[1]))
    kept[heavy, np.arange(size)] = 1.0
    kept[light, size:] = seen
    across = structure.stiffness[:, light] @ unseen
    held = unseen.T @ across[light]
    follows = np.linalg.solve(held, unseen.T @ (structure.stiffness[light] @ kept))
    whole = kept.copy()
    whole[light] -= unseen @ follows
    found = copy(structure)
    found.forget()
    found.stiffness = kept.T @ (structure.stiffness @ kept) - (kept.T @ across) @ follows
    forces = kept.T.copy()
    forces[:, light] -= np.linalg.solve(held.T, across.T @ kept).T @ unseen.T
    found.load = forces @ structure.load
    found.damping, found.passing = (kept.T @ (one @ kept) for one in (structure.damping, structure.passing))
    found.mass, found.rigid = np.where(np.arange(kept.shape[1]) < size, 1.0, 0.0), kept.T @ structure.rigid
    found.lines = [_line_on(line, kept, whole) for line in structure.lines]
    return found, forces


def _line_on(line: ContactLine, kept: Array, whole: Array) -> ContactLine:
    """Return a contact on the coordinates that are kept; points also move with what follows."""
    rows = {one.name: getattr(line, one.name) @ kept for one in fields(ContactLine) if one.name != "points"}
    return replace(line, points=line.points @ whole, **rows)
