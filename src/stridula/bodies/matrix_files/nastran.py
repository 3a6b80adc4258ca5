"""Roles of the matrices in a file of Nastran by their names."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ...checks import ArgumentError, listed

# First letters of the names of matrices; K4 is structural damping.
LETTERS = {"mass": "M", "stiffness": "K", "damping": "B"}
STRUCTURAL_DAMPING = "K4"


@dataclass(frozen=True)
class Held:
    """A matrix in a file.

    Attributes
    ----------
    name : str
        Name.
    number : int
        Number among the matrices of the file, from 0.
    is_square, is_symmetric, is_real, is_empty : bool
        Its properties.
    size : int
        Number of rows, 0 if the file does not give it.
    """

    name: str
    number: int
    is_square: bool
    is_symmetric: bool
    is_real: bool
    is_empty: bool
    size: int = 0


def chosen(role: str, held: Iterable[Held]) -> Held:
    """Return the matrix that is the mass, the stiffness or the damping.

    Raises
    ------
    ValueError
        If there is none, or several, or it is complex.
    """
    square = [matrix for matrix in held if matrix.is_square and not matrix.is_empty]
    found = [matrix for matrix in square if _role(matrix) == role]
    if not found and len(square) == 1 and not _role(square[0]):
        found = square
    letter = LETTERS[role]
    if len(found) != 1:
        got = listed(matrix.name for matrix in (found or square)) if square else "none that is square and not zero"
        which = "one" if found else "a"
        raise ValueError(f"it must hold {which} matrix whose name begins with {letter} for {role}, but holds {got}")
    if not found[0].is_real:
        raise ArgumentError(role, "be real", got=f"complex numbers in {found[0].name}")
    return found[0]


def roles(held: Iterable[Held]) -> list[str]:
    """Return the roles of the square matrices of a file; mass and stiffness even if they are missing."""
    there = {_role(matrix) for matrix in held if matrix.is_square and not matrix.is_empty}
    return [role for role in LETTERS if role in there or role != "damping"]


def _role(matrix: Held) -> str:
    if matrix.name.startswith(STRUCTURAL_DAMPING):
        return "structural damping"
    return next((role for role, letter in LETTERS.items() if matrix.name.startswith(letter)), "")
