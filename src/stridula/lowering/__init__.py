"""Descriptions lowered to flat arrays: modes, contact rows, loads and probes, then blocks under a time scheme."""

from .assembly import Assembly, assemble, with_motion_so_far, with_travel
from .contact_rows import ContactRows
from .coordinates import without_massless_coupling
from .motion import Prescribed
from .probed import ProbeRows
from .signals import Signal, Signals
from .turning_modes import TurningModes

__all__ = [
    "Assembly",
    "ContactRows",
    "Prescribed",
    "ProbeRows",
    "Signal",
    "Signals",
    "TurningModes",
    "assemble",
    "with_motion_so_far",
    "with_travel",
    "without_massless_coupling",
]
