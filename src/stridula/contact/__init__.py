"""Where bodies touch: friction laws and point contact."""

from .coulomb import Coulomb
from .point_contact import PointContact

__all__ = ["Coulomb", "PointContact"]
