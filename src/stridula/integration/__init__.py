"""How time goes on: schemes, the time loop, watchers."""

from .schemes import SCHEMES, CentralDifference, ExactModal
from .simulate import Diverged, Interrupted, simulate
from .watchers import Progress

__all__ = ["SCHEMES", "CentralDifference", "Diverged", "ExactModal", "Interrupted", "Progress", "simulate"]
