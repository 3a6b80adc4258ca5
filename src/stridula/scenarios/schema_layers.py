"""The tables of layers between faces in a scenario file."""

from __future__ import annotations

from typing import Annotated, Any

from ..declared import FREQUENCY, Number, OneOrEach
from . import fields as is_
from .kinds import Read
from .tables import Table, number_or

Frequencies = Annotated[Any, Read(OneOrEach(FREQUENCY))]
StiffnessOrEach = Annotated[Any, Read(OneOrEach(Number("N/m", above=0.0)))]
LossOrEach = Annotated[Any, Read(OneOrEach(Number("1", least=0.0)))]


class Face(Table):
    body: str
    """meshed body: its name among the bodies"""
    face: str
    """name of its face"""


class LayerStiffness(Table):
    x: StiffnessOrEach | None = None
    """stiffness of the whole layer along x: a number, or one for each frequency [N/m]; none if left out"""
    y: StiffnessOrEach | None = None
    """stiffness of the whole layer along y [N/m]"""
    z: StiffnessOrEach | None = None
    """stiffness of the whole layer along z [N/m]"""


class LayerLoss(Table):
    x: LossOrEach | None = None
    """loss factor along x: a number, or one for each frequency"""
    y: LossOrEach | None = None
    """loss factor along y"""
    z: LossOrEach | None = None
    """loss factor along z"""


class Layer(Table):
    first: Face
    """one face, of which every part has something opposite: the smaller one"""
    second: Face | None = None
    """face on the other side, the ground if left out"""
    frequency: Frequencies
    """frequency of stiffness and loss factor: a number, or several that rise [Hz]"""
    stiffness: LayerStiffness
    """stiffness of the whole layer along x, y and z"""
    loss_factor: number_or(LossOrEach, LayerLoss)  # type: ignore[valid-type]
    """loss factor of all directions: a number, or one for each frequency; or a table of them along x, y and z"""
    points: is_.Count = 12
    """approximate number of pairs of points that share the layer"""
    farthest: is_.Length | None = None
    """largest distance between the faces [m]; a tenth of the first face if left out"""
