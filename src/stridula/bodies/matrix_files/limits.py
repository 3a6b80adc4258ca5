"""How large files and matrices may be."""

from __future__ import annotations

from ...checks import ArgumentError

LARGEST_FILE = 2 * 1024**3
LARGEST_SIZE = 4000
# Of sparse matrices: what the factors of meshes can number, in some 20 GB.
LARGEST_SPARSE = 300_000


def check_size(name: str, size: int, most: int = LARGEST_SIZE) -> None:
    """Raise ValueError if a matrix of `size` rows is too large, by default to be made dense."""
    if size > most:
        raise ArgumentError(name, f"have at most {most} degrees of freedom", got=f"{size}: reduce the model first")
