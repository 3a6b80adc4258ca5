"""The table of recorded variables: name, dimensions, unit, meaning."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import STATUS_WORDS


@dataclass(frozen=True)
class Variable:
    """A recorded variable.

    Attributes
    ----------
    name : str
        Name in a Dataset, on labels and in files.
    units : str
        Unit.
    long_name : str
        Meaning, in a phrase.
    cell_methods : str
        ``mean`` or ``sum`` over the sample interval, or ``point`` at its end.
    """

    name: str
    units: str
    long_name: str
    cell_methods: str = "point"


def described(units: str, meaning: str) -> dict[str, str]:
    """Return the attributes of a variable with its unit and meaning."""
    return {"units": units, "long_name": meaning}


CONTACT = (
    Variable("normal_force", "N", "normal contact force, compressive", "mean"),
    Variable("tangential_force", "N", "tangential contact force on the track along its tangent", "mean"),
    Variable("contact_position", "m", "abscissa of the tip along the track"),
    Variable("contact_height", "m", "height of the tip above the undeformed track"),
    Variable("gap", "m", "distance from tip to track"),
    Variable("slip_velocity", "m/s", "velocity of the tip along the track's material", "mean"),
    Variable("jammed_steps", "1", "steps in which sliding would have jammed", "sum"),
    Variable("landings", "1", "landings: steps at which an open contact closes", "sum"),
)
# Variables with a component along each tangent in space.
ALONG_TANGENTS = ("tangential_force", "contact_position", "slip_velocity")
TANGENTS = ("first", "second")
# Units depend on the law: m for LuGre's bristles, s for the state of rate and state.
FRICTION_STATE = Variable("friction_state", "1", "internal state of the law of friction")
TEMPERATURE = Variable("temperature", "degC", "temperature of the contact")
HEAT = (
    Variable("heat", "J", "heat of friction that has gone into the layers since the start"),
    Variable("stored_heat", "J", "heat stored in the layers since the start; the rest has gone to the surroundings"),
)
SOLVE = (
    Variable("contact_sweeps", "1", "largest number of sweeps, or steps of Newton's method, a step", "maximum"),
    Variable("unsolved_steps", "1", "steps in which the contact forces are out of tolerance", "sum"),
)
STATUS = Variable("status", "1", "contact status that holds for the largest part of the interval", "mode")
STATUS_SHARE = Variable("status_share", "1", "share of the interval in each contact status", "mean")

ENERGY = (
    Variable("kinetic_and_elastic", "J", "kinetic and elastic energy of the vibration"),
    Variable("drive_work", "J", "work of the drives since the start"),
    Variable("contact_work", "J", "work of the contact forces on both bodies since the start"),
    Variable("friction_loss", "J", "energy lost to friction since the start"),
    Variable(
        "convection_work",
        "J",
        "work by the advance of the contact point along the bent track since the start",
    ),
    Variable("damping_loss", "J", "energy lost to damping since the start"),
    Variable("impact_loss", "J", "energy lost in impacts since the start"),
    Variable(
        "ledger_residual",
        "J",
        "kinetic_and_elastic + damping_loss - drive_work - contact_work - initial energy",
    ),
)

PROBES = {
    "displacement": Variable("displacement", "m", "displacement at the probes", "low-pass"),
    "velocity": Variable("velocity", "m/s", "velocity at the probes", "low-pass"),
    "acceleration": Variable("acceleration", "m/s2", "acceleration at the probes", "low-pass"),
    "reaction": Variable("reaction", "N", "force of the root's support (its moment in N m)", "low-pass"),
    "modal_displacement": Variable("modal_displacement", "kg^(1/2) m", "displacement of modes", "low-pass"),
    "modal_velocity": Variable("modal_velocity", "kg^(1/2) m/s", "velocity of modes", "low-pass"),
    "modal_motion": Variable("modal_motion", "kg^(1/2) m/s", "velocities of all modes of bodies", "low-pass"),
    "connection_force": Variable(
        "connection_force", "N", "force of connections on their first ends (moments in N m)", "low-pass"
    ),
    "support_force": Variable("support_force", "N", "force along y on the supports at its ends", "low-pass"),
}
# Variables of the equilibrium of linear theory, without free rigid motions.
EQUILIBRIUM = {
    "modal": Variable("modal_displacement", "kg^(1/2) m", "modal displacements, in the order of mode_shape"),
    "tip": Variable("tip_displacement", "m", "displacement of the tip along world x and y"),
    "track": Variable(
        "track_displacement", "m", "displacement of the point of the track that it touches, zero on a rigid track"
    ),
}


def attributes_of(variable: Variable) -> dict[str, Any]:
    """Return the attributes of a variable in a Dataset."""
    return described(variable.units, variable.long_name) | {"cell_methods": f"time: {variable.cell_methods}"}


def status_attributes() -> dict[str, Any]:
    """Return the attributes of the status, with the meanings of its numbers."""
    flags = {"flag_values": np.arange(3, dtype=np.int8), "flag_meanings": " ".join(STATUS_WORDS)}
    return attributes_of(STATUS) | flags


def dominant_status(share: Array) -> Array:
    """Return the status that holds for the largest part of each interval, from the shares, shape (..., 3).

    For equal shares the later state is returned: sliding before sticking before separated.
    """
    return (2 - np.argmax(share[..., ::-1], axis=-1)).astype(np.int8)
