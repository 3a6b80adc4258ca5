"""Limits on the size of files and matrices."""

from __future__ import annotations

from ..checks import ArgumentError

LARGEST_FILE = 2 * 1024**3
LARGEST_SIZE = 4000
# For sparse matrices: factors of meshes of this size fit into some 20 GB.
LARGEST_SPARSE = 300_000


def check_size(name: str, size: int, most: int = LARGEST_SIZE) -> None:
    """Raise ValueError if a matrix of `size` rows is too large; by default, too large to be made dense."""
    if size > most:
        raise ArgumentError(name, f"have at most {most} degrees of freedom", got=f"{size}: reduce the model first")
