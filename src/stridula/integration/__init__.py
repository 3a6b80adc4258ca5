"""How time goes on: schemes, the time loop, watchers."""

from .run import Diverged, Interrupted
from .schemes import SCHEMES, CentralDifference, ExactModal
from .simulate import simulate
from .watchers import Progress

__all__ = ["SCHEMES", "CentralDifference", "Diverged", "ExactModal", "Interrupted", "Progress", "simulate"]
