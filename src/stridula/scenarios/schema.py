"""The tables of a scenario file: the same words as the Python API."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from ..contact import PointContact
from . import fields as is_
from .fields import BodyName, Table
from .schema_bodies import Material, Section, Slider, Track
from .schema_drives import Drive


class Coulomb(Table):
    law: Literal["coulomb"] = "coulomb"
    """law of friction"""
    coefficient: is_.Friction
    """coefficient of friction mu, the same in sticking and in sliding"""


class Contact(Table):
    at: is_.Length
    """abscissa of the tip on the track at the start [m]"""
    friction: Coulomb
    """friction between tip and track"""
    gap: is_.Distance = PointContact.gap
    """distance between tip and track at the start [m]"""
    point: is_.Point = "tip"
    """point of the slider that touches: tip, root or a position from the tip [m]"""


class Motion(Table):
    quantity: Literal["displacement", "velocity", "acceleration"]
    """displacement, velocity, acceleration or reaction"""
    body: BodyName = "track"
    """body: slider or track"""
    point: is_.Point = "centre"
    """where: tip, root, centre or a position [m]"""
    direction: Literal["x", "y", "axial", "transverse"] = "y"
    """x, y, axial or transverse"""


class Reaction(Table):
    quantity: Literal["reaction"]
    """displacement, velocity, acceleration or reaction"""
    direction: Literal["x", "y", "moment"] = "moment"
    """x, y or moment"""


Probe = Annotated[Motion | Reaction, Field(discriminator="quantity")]


class Simulation(Table):
    duration: is_.Time
    """time to simulate [s]"""
    scheme: Literal["exact modal", "central difference"] = "exact modal"
    """exact modal or central difference"""
    step: is_.Time | None = None
    """time step, a stated fraction of the scheme's limit if left out [s]"""
    sample_rate: is_.Frequency = 100e3
    """samples recorded per second [Hz]"""
    probes: list[Probe] | None = None
    """what else to record, the acceleration of the track's centre if left out"""


class ScenarioTable(Table):
    """A scenario of stridula: two beams in friction contact, what drives them, and how long to simulate."""

    title: str = ""
    """one line that says what it is"""
    description: str = ""
    """what happens in it, and why it is of interest"""
    source: str = ""
    """where it comes from"""
    base: str | None = None
    """scenario file, or shipped base, that this one changes"""
    material: Material | None = None
    """material of both bodies, unless a body has its own"""
    section: Section | None = None
    """cross-section of both bodies, unless a body has its own"""
    damping: is_.Damping | None = None
    """damping ratio of both bodies, unless a body has its own"""
    cutoff: is_.Frequency | None = None
    """highest frequency of the modes of both bodies, unless a body has its own [Hz]"""
    slider: Slider
    """the beam whose tip touches"""
    track: Track
    """the beam it slides on"""
    contact: Contact
    """where they touch"""
    drives: list[Drive] = Field(default_factory=list)
    """what pushes"""
    simulation: Simulation
    """how long, and how"""


SCHEMA: dict[str, Any] = ScenarioTable.model_json_schema()
