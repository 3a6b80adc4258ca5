"""How time goes on: schemes, the time loop, watchers."""

# ruff: noqa: E402
from .compiled_code import find_a_place

find_a_place()

from ..lowering.schemes import SCHEMES, CentralDifference, ExactModal
from .contact_solve import GaussSeidel
from .many import simulate_many
from .simulate import simulate
from .stops import Diverged, Interrupted
from .watchers import Progress

__all__ = [
    "SCHEMES",
    "CentralDifference",
    "Diverged",
    "ExactModal",
    "GaussSeidel",
    "Interrupted",
    "Progress",
    "simulate",
    "simulate_many",
]
