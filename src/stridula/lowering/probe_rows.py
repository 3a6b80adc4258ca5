"""Probes as rows on modal motion, on signals and on contact forces."""

from __future__ import annotations

from dataclasses import replace
from functools import singledispatch
from typing import Any

import numpy as np

from ..checks import ArgumentError, brief
from ..connections import ends
from ..records.probes import ConnectionForce, Probe, Reaction, SupportForce
from .connection_forces import force_on_first
from .coordinates import Coordinates
from .loads import Load
from .probed import ProbeRows


def probe_rows(probe: Probe, coordinates: Coordinates, loads: list[Load]) -> list[ProbeRows]:
    """Return the rows of a probe, several for one of all modes, checked against the system."""
    if not isinstance(probe, Reaction) and probe.body not in coordinates.system.bodies:
        raise ArgumentError("probe", "be on a body of this system", probe, got=f"one on {brief(probe.body)}")
    blank = ProbeRows(
        np.zeros((3, coordinates.size)), np.zeros(len(loads)), np.zeros(3), np.zeros(coordinates.contact_rows)
    )
    if hasattr(probe, "of_each"):
        modes = probe.of_each(coordinates.modes(probe.body).count)
        return [replace(_rows_of(one, coordinates, loads, blank), is_of_body=True) for one in modes]
    return [_rows_of(probe, coordinates, loads, blank)]


@singledispatch
def _rows_of(probe: Any, coordinates: Coordinates, loads: list[Load], blank: ProbeRows) -> ProbeRows:
    system, matrix = coordinates.system, np.zeros((3, coordinates.size))
    if hasattr(probe, "mode"):
        modes = coordinates.modes(probe.body).count
        if probe.mode >= modes:
            raise ArgumentError("probe", f"be of a mode below {modes}", probe, got=probe.mode)
        matrix[probe.derivative] = coordinates.blended(probe.body, np.eye(1, modes, probe.mode)[0])
        return replace(blank, rows=matrix)
    matrix[probe.derivative] = probe.along @ coordinates.trace(probe.point)
    imposed = np.zeros(3)
    if system.is_held(probe.point.body):
        imposed[probe.derivative] = probe.along[0]
    return replace(blank, rows=matrix, imposed=imposed)


@_rows_of.register
def _support_rows(probe: SupportForce, coordinates: Coordinates, loads: list[Load], blank: ProbeRows) -> ProbeRows:
    matrix = np.zeros((3, coordinates.size))
    matrix[0] = coordinates.blended(probe.body, probe.body.support_force(probe.end))
    return replace(blank, rows=matrix)


@_rows_of.register
def _connection_rows(
    probe: ConnectionForce, coordinates: Coordinates, loads: list[Load], blank: ProbeRows
) -> ProbeRows:
    if probe.connection not in coordinates.system.connections:
        raise ArgumentError("probe", "be on a connection of this system", probe, got=f"one on {probe.connection}")
    number = coordinates.system.connections.index(probe.connection)
    return force_on_first(number, probe.share, coordinates, loads)


@_rows_of.register
def _reaction_rows(probe: Reaction, coordinates: Coordinates, loads: list[Load], blank: ProbeRows) -> ProbeRows:
    system, beam = coordinates.system, probe.body
    component = ("x", "y", "moment").index(probe.component)
    if beam != system.slider:
        raise ArgumentError("probe", "be on the slider of this system", probe, got=f"one on {brief(beam)}")
    if beam.tip_support != "free":
        raise ArgumentError("tip_support", "be free where a Reaction is recorded", beam.tip_support)
    if any(point.body == beam for connection in system.connections for point in ends(connection)):
        raise ArgumentError("connections", "not join a body whose Reaction is recorded", got=f"one on {brief(beam)}")
    if system.is_spatial:
        raise ArgumentError("probe", "not be a Reaction in a system with bodies in space", probe)
    reaction = beam.root_reaction(system.is_held(beam))
    matrix = np.zeros((3, coordinates.size))
    matrix[2] = coordinates.blended(beam, reaction.mass[component])
    shares = np.array([-reaction.held[component] * load.root[component] for load in loads])
    contact = blank.contact.copy().reshape(-1, 2)
    for number, point in enumerate(system.contacts):
        # The force on the tip is the normal force along the normal minus the tangential force along the tangent.
        signs = np.array([-1.0, 1.0])
        if point.tip.body == beam:
            lever = beam.root_lever(point.tip.position)[component]  # type: ignore[arg-type]
            contact[number] += reaction.held[component] * signs * (point.frame @ lever)
        if point.touched_point is not None and point.touched_point.body == beam:
            lever = beam.root_lever(point.touched_point.position)[component]  # type: ignore[arg-type]
            contact[number] -= reaction.held[component] * signs * (point.frame @ lever)
    return replace(blank, rows=matrix, loads=shares, contact=contact.ravel())
