"""The tables of a scenario file, with the names of the Python API."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from ..integration import CentralDifference, ExactModal, GaussSeidel
from ..integration.settings import Settings
from . import fields as is_
from .derived import Keys, table_of
from .schema_bodies import Body, Material, Section, Slider, Track
from .schema_contacts import Connection, Contact, Friction, PairContact, Surface
from .schema_drives import Drive
from .schema_layers import Layer
from .schema_probes import Probe
from .tables import Table


class ContactSolve(Table):
    tolerance: is_.PositiveRatio = GaussSeidel.tolerance
    """largest change of a force in the last sweep, relative to the largest force"""
    sweeps: is_.Count = GaussSeidel.sweeps
    """largest number of sweeps per step"""


OF_RUN: Keys = {
    "surface_rate": (
        is_.FrequencyOrAll | None,
        None,
        "rate of maps of surfaces, without records of single points [Hz], or all: each point is a contact",
    ),
    "probes": (
        list[Probe] | None,
        None,
        "additional quantities to record, the acceleration of the track's centre if left out",
    ),
    "contact_solve": (ContactSolve | None, None, "solver of several contacts"),
}
if TYPE_CHECKING:
    Simulation = Any
else:
    Scheme = Literal[ExactModal.name, CentralDifference.name]
    BEFORE = {
        "duration": (is_.Time, ..., "time to simulate [s]"),
        "scheme": (Scheme, ExactModal.name, "exact modal or central difference"),
    }
    Simulation = table_of(Settings, title="Simulation", before=BEFORE, after=OF_RUN)


class ScenarioTable(Table):
    """A scenario of stridula: bodies in friction contact, their drives, and the settings of the simulation.

    Two beams are given as slider, track and contact; any other system as bodies, contacts and connections.
    """

    title: str = ""
    """title in one line"""
    description: str = ""
    """description of the motion"""
    source: str = ""
    """source of the scenario"""
    base: str | None = None
    """scenario file, or shipped base, that this one modifies"""
    material: Material | None = None
    """material of all beams and plates, unless a body has its own"""
    section: Section | None = None
    """cross-section of all beams, unless a body has its own"""
    damping: is_.Damping | None = None
    """damping of all beams and plates, a ratio or a law of frequency, unless a body has its own"""
    cutoff: is_.Frequency | None = None
    """highest frequency of the modes of all beams and plates, unless a body has its own [Hz]"""
    friction: Friction | None = None
    """law of friction of all contacts, unless a contact has its own"""
    slider: Slider | None = None
    """beam whose tip touches the track"""
    track: Track | None = None
    """beam on which the slider slides"""
    contact: PairContact | None = None
    """contact of slider and track"""
    bodies: dict[str, Body] | None = None
    """bodies by name, in place of slider and track"""
    contacts: list[Contact] | None = None
    """contacts of bodies at points, in place of contact"""
    surfaces: list[Surface] | None = None
    """contacts of faces of meshed bodies, in addition to contacts or in their place"""
    connections: list[Connection] | None = None
    """springs and dashpots between bodies"""
    layers: list[Layer] | None = None
    """layers of rubber between faces of meshed bodies, in addition to connections"""
    drives: list[Drive] = Field(default_factory=list)
    """forces, velocities and initial states"""
    simulation: Simulation
    """duration and settings of the simulation"""


PAIR = ("slider", "track", "contact")
TOUCHING = ("contacts", "surfaces")
JOINING = ("connections", "layers")
GENERAL = ("bodies", *TOUCHING)


@cache
def json_schema() -> dict[str, Any]:
    """Return the JSON schema of scenario files."""
    return ScenarioTable.model_json_schema()
