"""What vibrates: bodies that end as mass-normalised modes and their traces."""

from .finite_element_beam import FiniteElementBeam
from .modal_beam import ModalBeam
from .modes import BodyPoint, Modes
from .sections import Circle, Material, Rectangle, Section

__all__ = [
    "BodyPoint",
    "Circle",
    "FiniteElementBeam",
    "Material",
    "ModalBeam",
    "Modes",
    "Rectangle",
    "Section",
]
