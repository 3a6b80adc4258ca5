"""Bodies: everything that vibrates, reduced to mass-normalised modes and their traces."""

from .axisymmetric_body import AxisymmetricBody, Held
from .damping import Rayleigh, RisingDamping, SampledDamping
from .finite_element_beam import FiniteElementBeam
from .matrix_faces import MatrixFace
from .mesh_parts import MeshPart, read_parts
from .modal_beam import ModalBeam
from .modal_body import ModalBody
from .modal_plate import Line, ModalPlate
from .modes import Body, Modes
from .paths import Path, Track, Waves, is_track
from .point_mass import PointMass
from .points import BodyPoint, CircularPath, HasRoot, has_root
from .profiles import LineProfile, MeshProfile, Profile, RectangleProfile
from .reduced_body import ReducedBody
from .rigid_body import RigidBody
from .sections import Circle, Material, Rectangle, Section
from .solid_body import SolidBody
from .solid_mesh import SolidMesh
from .turning import Turning

__all__ = [
    "AxisymmetricBody",
    "Body",
    "BodyPoint",
    "Circle",
    "CircularPath",
    "FiniteElementBeam",
    "HasRoot",
    "Held",
    "Line",
    "LineProfile",
    "Material",
    "MatrixFace",
    "MeshPart",
    "MeshProfile",
    "ModalBeam",
    "ModalBody",
    "ModalPlate",
    "Modes",
    "Path",
    "PointMass",
    "Profile",
    "Rayleigh",
    "Rectangle",
    "RectangleProfile",
    "ReducedBody",
    "RigidBody",
    "RisingDamping",
    "SampledDamping",
    "Section",
    "SolidBody",
    "SolidMesh",
    "Track",
    "Turning",
    "Waves",
    "has_root",
    "is_track",
    "read_parts",
]
