"""Rigid motions that nothing holds, in words: the body, the direction of a translation, the axis of a rotation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import scipy.linalg

from ..arrays import Array
from ..bodies import BodyPoint, SolidBody
from ..checks import ArgumentError, listed
from ..connections import ends
from ..places import origins_in_space
from ..system import System
from .structure import UNMOVED, Structure

# Relative size below which part of a motion is due to rounding.
ROUNDING = 1e-6


def normals_of(structure: Structure, closed: Sequence[int] | None = None) -> Array:
    """Return the rows of some contacts along their normals, of all if left out, shape (contacts, modes)."""
    numbers = range(len(structure.lines)) if closed is None else closed
    return np.array([structure.lines[k].normal for k in numbers]).reshape(-1, structure.mode_count)


def carried_along(structure: Structure, contacts: Sequence[int], free: Array) -> Array:
    """Return those of some free motions, (modes, motions), that slide contacts on a track that turns.

    Friction alone acts on these, and would carry the body along with the track.
    """
    turning = {name for name in (_turns_under(face) for face in structure.system.faces) if name}
    rows = []
    for k in contacts:
        contact, line = structure.system.contacts[k], structure.lines[k]
        if contact.turning_velocities or contact.surface in turning:
            rows += [line.tangent, line.across]
    if not rows or not free.shape[1]:
        return free[:, :0]
    moved = np.array(rows) @ free
    _, share, ways = scipy.linalg.svd(moved, full_matrices=False)
    return np.asarray(free @ ways[share > UNMOVED * np.linalg.norm(rows, axis=1).max()].T)


def not_held(structure: Structure, free: Array) -> ArgumentError:
    """Return the error of free motions in which friction carries bodies along with a track that turns."""
    return ArgumentError(
        "connections",
        "hold each motion in which friction carries a body along with a track that turns",
        got=f"none that hold {words_of(structure, free)}",
    )


def free_words(system: System) -> str:
    """Return the rigid motions that contacts, connections and drives leave free, in words.

    Empty if there are none, or if linear theory does not describe the system.
    """
    try:
        structure = Structure(system, 0.0)
    except ArgumentError:
        return ""
    free = structure.free_motions(normals_of(structure))
    return words_of(structure, free) if free.shape[1] else ""


def words_of(structure: Structure, free: Array) -> str:
    """Return rigid motions in words, body by body.

    Parameters
    ----------
    structure : Structure
        The system.
    free : ndarray, shape (modes, motions)
        The motions.
    """
    arrays, system = structure.arrays, structure.system
    moved, size = free.copy(), len(arrays.blend)
    moved[:size] = arrays.blend @ free[:size]
    origins = origins_in_space(system) if system.is_spatial else {}
    found = []
    for body in system.bodies:
        name = system.body_name(body)
        own = moved[slice(*arrays.spans[name])]
        if np.abs(own).max(initial=0.0) > ROUNDING * np.abs(moved).max():
            found.append(f"{name}: {' and '.join(_motions(structure, body, own, origins))}")
    return listed(found, "; ")


def _turns_under(face: Any) -> str:
    return str(face.name) if getattr(face, "turning", None) is not None else ""


def _motions(structure: Structure, body: Any, own: Array, origins: dict[Any, Array]) -> Iterator[str]:
    """Yield the motions of a body in words, from its modal displacements, shape (modes, motions)."""
    places, rows = [], []
    for point in _points(structure, body):
        places.append(_place(point, origins))
        rows.append(body.trace(point.position, structure.system.is_held(body)) @ own)
    moved = np.array(rows)
    if moved.shape[1] < 3 or any(place is None for place in places):
        yield from _without_places(moved)
        return
    there = np.array(places)
    middle = there.mean(axis=0)
    arms = there - middle
    length = float(np.abs(arms).max()) or 1.0
    design = np.array([np.hstack([np.eye(3), _crossed(arm / length)]) for arm in arms]).reshape(-1, 6)
    fitted = np.linalg.lstsq(design, moved.reshape(-1, own.shape[1]), rcond=ROUNDING)[0]
    shift, turn = fitted[:3], fitted[3:]
    largest = max(float(np.linalg.norm(fitted, 2)), 1e-300)
    _, share, ways = scipy.linalg.svd(turn)
    count = int(np.sum(share > ROUNDING * largest))
    still = shift @ ways[count:].T
    directions = scipy.linalg.orth(still, rcond=ROUNDING) if np.abs(still).max(initial=0.0) > 0.0 else still[:, :0]
    if directions.shape[1]:
        yield f"translation along {' and '.join(map(_axis, _nicest(directions).T))}"
    if not count:
        return
    turns = _nicest(scipy.linalg.orth(turn, rcond=ROUNDING))
    for axis in turns.T:
        yield f"rotation about {_axis(axis)}{_through(axis, shift, turn, directions, middle, length)}"


def _through(axis: Array, shift: Array, turn: Array, directions: Array, middle: Array, length: float) -> str:
    """Return a point of the axis of a rotation in words; nothing if the body may also move across it."""
    moved = shift @ np.linalg.lstsq(turn, axis, rcond=ROUNDING)[0]
    moved = moved - directions @ (directions.T @ moved)
    across = directions - np.outer(axis, axis @ directions)
    if across.size and np.linalg.matrix_rank(across, ROUNDING) == 2:
        return ""
    point = middle + length * np.cross(axis, moved)
    return f" through {_vector(np.where(np.abs(point) < ROUNDING * length, 0.0, point))} m"


def _without_places(moved: Array) -> Iterator[str]:
    """Yield motions of points whose places are not known, shape (points, directions, motions)."""
    apart = moved - moved.mean(axis=0)
    _, share, ways = scipy.linalg.svd(apart.reshape(-1, moved.shape[2]), full_matrices=True)
    largest = max(float(np.abs(moved).max()), 1e-300)
    turns = int(np.sum(share > ROUNDING * largest))
    still = moved.mean(axis=0) @ ways[turns:].T
    if np.abs(still).max(initial=0.0) > ROUNDING * largest:
        yield f"translation along {' and '.join(map(_axis, _nicest(scipy.linalg.orth(still, rcond=ROUNDING)).T))}"
    if turns:
        yield "rotation" if turns == 1 else f"{turns} rotations"


def _points(structure: Structure, body: Any) -> list[BodyPoint]:
    """Return points of a body: those of the system and its own, and of a mesh also its outermost nodes."""
    system = structure.system
    points = [contact.tip for contact in system.contacts]
    points += [one.touched_point for one in system.contacts if one.touched_point is not None]
    points += [point for connection in system.connections for point in ends(connection)]
    found = [point for point in points if point.body == body]
    if body.kind == SolidBody.kind:
        nodes = body.mesh.nodes
        outermost = {int(one) for one in (*nodes.argmin(axis=0), *nodes.argmax(axis=0))}
        found += [BodyPoint(body, tuple(nodes[one].tolist())) for one in sorted(outermost)]
    elif not body.has_positions:
        found += [BodyPoint(body, name) for name in body.point_names]
    return list({point.label: point for point in found}.values())


def _place(point: BodyPoint, origins: dict[Any, Array]) -> Array | None:
    if point.place is not None:
        return point.place
    body: Any = point.body
    return origins[body] + body.offset(point.position) if body in origins and hasattr(body, "offset") else None


def _crossed(arm: Array) -> Array:
    """Return the matrix that gives the displacement at an arm by a rotation, ``w x arm``."""
    x, y, z = arm
    return np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])


def _nicest(basis: Array) -> Array:
    """Return a basis of the same space of directions, (3, directions), of axes of the world if they span it."""
    world = np.eye(len(basis))
    inside = np.linalg.norm(basis.T, axis=0) > 1.0 - ROUNDING
    return world[:, inside] if int(inside.sum()) == basis.shape[1] else basis


def _axis(direction: Array) -> str:
    """Return a direction in words: an axis of the world, or its components."""
    unit = direction / np.linalg.norm(direction)
    for name, share in zip("xyz", unit, strict=False):
        if abs(share) > 1.0 - ROUNDING:
            return name
    first = unit[np.flatnonzero(np.abs(unit) > ROUNDING)[0]]
    return _vector(np.where(np.abs(unit) < ROUNDING, 0.0, unit) * np.sign(first))


def _vector(values: Array) -> str:
    return f"({', '.join(f'{one:.3g}' for one in values)})"
