"""The tables of bodies in a scenario file."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ..bodies import FiniteElementBeam, ModalBeam
from . import fields as is_
from .fields import Table

Support = Literal["free", "guided", "pinned", "clamped"]


class Material(Table):
    young: is_.Modulus
    """Young's modulus [Pa]"""
    density: is_.Density
    """mass density [kg/m³]"""


class Rectangle(Table):
    shape: Literal["rectangle"]
    """rectangle, circle or general"""
    width: is_.Length
    """side normal to the plane of motion [m]"""
    height: is_.Length
    """side in the plane of motion, the one that bends [m]"""


class Circle(Table):
    shape: Literal["circle"]
    """rectangle, circle or general"""
    diameter: is_.Length
    """diameter [m]"""


class General(Table):
    shape: Literal["general"]
    """rectangle, circle or general"""
    area: is_.Area
    """area [m²]"""
    second_moment: is_.SecondMoment
    """second moment of area in the plane of motion [m⁴]"""


Section = Annotated[Rectangle | Circle | General, Field(discriminator="shape")]


class Slider(Table):
    material: Material
    """what the slider is made of"""
    section: Section
    """cross-section of the slider"""
    length: is_.Length
    """length, from tip to root [m]"""
    angle: is_.Angle = FiniteElementBeam.angle
    """angle from the track's normal; above zero the root is ahead of the tip in x [rad]"""
    elements: is_.Count = FiniteElementBeam.elements
    """number of finite elements"""
    damping: is_.Damping = FiniteElementBeam.damping
    """damping ratio of every mode"""
    root_support: Support = "guided"
    """support of the root: free, guided (no rotation), pinned or clamped"""
    tip_support: Support = "free"
    """support of the tip: free, guided, pinned or clamped"""
    mass: Literal["consistent", "lumped"] = "consistent"
    """mass matrix of the elements: consistent or lumped"""
    cutoff: is_.Frequency | None = None
    """keep the modes up to this frequency, all if left out [Hz]"""


class Track(Table):
    material: Material
    """what the track is made of"""
    section: Section
    """cross-section of the track"""
    length: is_.Length
    """length [m]"""
    bending_modes: is_.Count = ModalBeam.bending_modes
    """number of bending modes, unless there is a cutoff"""
    axial_modes: is_.CountOrNone = ModalBeam.axial_modes
    """number of axial modes, unless there is a cutoff"""
    damping: is_.Damping = ModalBeam.damping
    """damping ratio of every mode"""
    cutoff: is_.Frequency | None = None
    """keep the modes up to this frequency [Hz]"""
