"""Simultaneous solution of several contacts."""

from __future__ import annotations

from dataclasses import dataclass

from ..checks import count, within


@dataclass(frozen=True)
class GaussSeidel:
    """Block Gauss-Seidel with the exact solution of each contact in turn, until no force changes.

    Sixteen contacts or more in space, all under Coulomb's law, are first solved together by Newton's method, to 1e-12
    of the largest force, or to the tolerance where rounding leaves more.

    Parameters
    ----------
    tolerance : float, optional
        Largest change of a force in the last sweep, relative to the largest force [1].
    sweeps : int, optional
        Largest number of sweeps per step. Steps that need more are counted in ``unsolved_steps``; a run stops if the
        forces still change by more than 1e-3.
    """

    tolerance: float = 1e-10
    sweeps: int = 1000

    def __post_init__(self) -> None:
        object.__setattr__(self, "tolerance", within("tolerance", self.tolerance, 1e-15, 1e-4))
        object.__setattr__(self, "sweeps", count("sweeps", self.sweeps))
