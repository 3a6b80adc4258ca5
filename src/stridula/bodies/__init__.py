"""Bodies: everything that vibrates, reduced to mass-normalised modes and their traces."""

from .beams_and_plates.finite_element_beam import FiniteElementBeam
from .beams_and_plates.modal_beam import ModalBeam
from .beams_and_plates.modal_plate import Line, ModalPlate
from .damping import Rayleigh, RisingDamping, SampledDamping
from .masses.point_mass import PointMass
from .masses.rigid_body import RigidBody
from .matrices.faces import MatrixFace
from .matrices.measured_modes import MeasuredModes
from .matrices.modal_body import ModalBody
from .matrices.reduced_body import ReducedBody
from .modes import Body, Modes
from .paths import Path, Track, Waves, is_track
from .points import BodyPoint, CircularPath, HasRoot, has_root
from .revolution.axisymmetric_body import AxisymmetricBody, Held
from .revolution.profiles import LineProfile, MeshProfile, Profile, RectangleProfile
from .sections import Circle, Material, Rectangle, Section
from .solids.mesh_parts import MeshPart, read_parts
from .solids.solid_body import SolidBody
from .solids.solid_mesh import SolidMesh
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
    "MeasuredModes",
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
