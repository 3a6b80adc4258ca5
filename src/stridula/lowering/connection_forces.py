"""Forces of connections as rows on modal motion, and as shares of loads, contact forces and nonlinear pulls."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from ..connections import elements_of, held_motions, unit
from ..connections.elements import Motion
from .coordinates import Coordinates
from .loads import Load
from .probed import ProbeRows

# Relative size of a part of the motions prevented by joints below which other joints prevent it, too.
SHARED = 1e-8


def force_on_first(
    number: int, share: Callable[[Motion], float], coordinates: Coordinates, loads: list[Load]
) -> ProbeRows:
    """Return the force or moment of a connection on its first end.

    Parameters
    ----------
    number : int
        Number of the connection.
    share : callable
        Share of the force or moment against a motion that is taken.
    coordinates : Coordinates
        Coordinates of the system.
    loads : list of Load
        Loads of the system.
    """
    connection = coordinates.system.connections[number]
    if held_motions(connection):
        return _of_joint(number, share, coordinates, loads)
    rows = np.zeros((3, coordinates.size))
    for element, inner in zip(elements_of(connection), _inner(number, coordinates), strict=True):
        taken = -share(element.motion)
        row = coordinates.between(connection, element.motion)
        rows[0] += taken * element.stiffness * row
        rows[1] += taken * element.damping * row
        for one, branch in zip(inner, element.branches, strict=True):
            rows[0, one] -= taken * np.sqrt(branch.stiffness) * branch.angular_frequency
    moved = np.zeros(len(loads))
    if connection.moved_by:
        moved[[load.history for load in loads].index(connection.history)] = connection.moved_by * share(
            Motion(unit(connection))
        )
    own = {k: -share(Motion(unit(connection))) for k, one in enumerate(_bent(coordinates)) if one == number}
    return ProbeRows(coordinates.on_march(rows), moved, np.zeros(3), np.zeros(coordinates.contact_rows), own)


def _bent(coordinates: Coordinates) -> list[int]:
    """Return the numbers of the nonlinear springs and dashpots, in their order in the march."""
    return [number for number, one in enumerate(coordinates.system.connections) if one.bend is not None]


def _inner(number: int, coordinates: Coordinates) -> list[range]:
    """Return the inner motions of the branches of each linear part of a connection."""
    connections, first, found = coordinates.system.connections, coordinates.relaxing_span[0], list[range]()
    first += sum(len(element.branches) for one in connections[:number] for element in elements_of(one))
    for element in elements_of(connections[number]):
        found.append(range(first, first + len(element.branches)))
        first += len(element.branches)
    return found


def _of_joint(number: int, share: Callable[[Motion], float], coordinates: Coordinates, loads: list[Load]) -> ProbeRows:
    """Return the force of a rigid joint on its first end.

    With the coordinates q of the bodies, and rows J of all motions that joints prevent, its forces F follow from
    ``J^T F = M q'' + C q' + K q - f``, whose right side is a combination of the rows.
    """
    connections = coordinates.system.connections
    joints = [(k, motion) for k, one in enumerate(connections) for motion in held_motions(one)]
    prevented = np.array([coordinates.between(connections[k], motion) for k, motion in joints])
    wanted = np.array([share(motion) * (k == number) for k, motion in joints])
    across = _picked(prevented, wanted)
    if across is None:
        words = "be on a rigid joint whose force the motion determines: other joints prevent the same motion"
        raise ArgumentError("probe", words, got=f"one on connections[{number}]")
    return _balance(across, coordinates, loads)


def _picked(rows: Array, wanted: Array) -> Array | None:
    """Return the motion whose product with forces on rows is the wanted combination of these, None if there is none."""
    size = np.linalg.norm(rows, axis=1)
    acts = size > SHARED * size.max()
    scaled, wanted = rows[acts] / size[acts, None], wanted[acts] / size[acts]
    left, values, right = np.linalg.svd(scaled.T, full_matrices=False)
    kept = values > SHARED * values[0]
    seen = right[kept] @ wanted
    if np.linalg.norm(wanted - seen @ right[kept]) > SHARED * np.linalg.norm(wanted):
        return None
    return np.asarray(left[:, kept] @ (seen / values[kept]))


def _balance(across: Array, coordinates: Coordinates, loads: list[Load]) -> ProbeRows:
    """Return the part along `across` of what the forces of rigid joints balance, on the coordinates of the bodies."""
    stiffness, dissipation = coordinates.of_bodies
    size, light = len(stiffness), coordinates.shapes_of_bodies
    # Residual shapes follow forces within a few steps: what balances on them at once does not count.
    shapes = coordinates.blend[:, coordinates.massless[:size]]
    across[:size] -= shapes @ (shapes.T @ (stiffness @ across[:size]))
    rows = np.zeros((3, coordinates.size))
    rows[0, :size], rows[1, :size] = across[:size] @ stiffness, across[:size] @ dissipation
    rows[2] = np.where(light, 0.0, across)
    contact = []
    for point in coordinates.system.contacts:
        # The force on the tip is the normal force along the normal minus the tangential forces along the tangents.
        signs = np.array([1.0] + [-1.0] * (len(point.frame) - 1))
        ends = [(-1.0, point.tip), *([] if point.touched_point is None else [(1.0, point.touched_point)])]
        moved = np.sum([sign * (coordinates.body_trace(one) @ across) for sign, one in ends], axis=0)
        contact.extend(signs * (point.frame @ moved[: point.frame.shape[1]]))
    springs = {
        k: pull
        for k, one in enumerate(coordinates.system.connections[number] for number in _bent(coordinates))
        if (pull := float(coordinates.between(one, Motion(unit(one))) @ across))
    }
    pushed = np.array([-float(load.own @ across) for load in loads])
    return ProbeRows(coordinates.on_march(rows), pushed, np.zeros(3), np.array(contact), springs)
