"""Records: the table of recorded variables, probes, and their Dataset."""

from .probes import (
    Acceleration,
    ConnectionForce,
    Displacement,
    ModalDisplacement,
    ModalMotion,
    ModalVelocity,
    Probe,
    Reaction,
    SupportForce,
    Velocity,
)

__all__ = [
    "Acceleration",
    "ConnectionForce",
    "Displacement",
    "ModalDisplacement",
    "ModalMotion",
    "ModalVelocity",
    "Probe",
    "Reaction",
    "SupportForce",
    "Velocity",
]
