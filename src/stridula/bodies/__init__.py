"""What vibrates: bodies that end as mass-normalised modes and their traces."""

from .damping import Rayleigh, RisingDamping, SampledDamping
from .finite_element_beam import FiniteElementBeam
from .modal_beam import ModalBeam
from .modal_plate import Line, ModalPlate
from .modes import Body, BodyPoint, HasRoot, Modes
from .paths import Path, Track, Waves
from .point_mass import PointMass
from .reduced_body import ReducedBody
from .sections import Circle, Material, Rectangle, Section
from .solid_body import SolidBody
from .solid_mesh import SolidMesh

__all__ = [
    "Body",
    "BodyPoint",
    "Circle",
    "FiniteElementBeam",
    "HasRoot",
    "Line",
    "Material",
    "ModalBeam",
    "ModalPlate",
    "Modes",
    "Path",
    "PointMass",
    "Rayleigh",
    "Rectangle",
    "ReducedBody",
    "RisingDamping",
    "SampledDamping",
    "Section",
    "SolidBody",
    "SolidMesh",
    "Track",
    "Waves",
]
