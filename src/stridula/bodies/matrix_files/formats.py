"""The formats that are read; the format of a file is recognised by its first bytes, then by its ending."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...checks import at_least, in_one_line
from ...disk import check_regular, opened
from .. import limits
from .abaqus import read_abaqus
from .calculix import read_calculix
from .containers import read_mat, read_npz
from .dmig import held_in_dmig, is_dmig, read_dmig
from .entries import Entries
from .harwell_boeing import is_harwell_boeing, read_harwell_boeing
from .matrix_market import HEADER, read_matrix_market
from .nastran import Held, roles
from .output4 import held_in_output4, is_output4, read_output4

PathLike = str | os.PathLike[str]
# Bytes that are searched to recognise a format: a deck may begin with a page of remarks.
HEAD = 8192
BANNER = b"%%MatrixMarket"


@dataclass(frozen=True)
class Format:
    """A format of files.

    Attributes
    ----------
    words : str
        Name.
    is_it : callable, optional
        Returns whether a file with the given first bytes has this format.
    endings : tuple of str
        Endings of its files, used if the first bytes are not recognised.
    whole : callable, optional
        Reads a file with a whole body.
    matrix : callable, optional
        Reads one matrix, given its role (mass, stiffness or damping) and the file.
    held : callable, optional
        Returns the matrices in a file of several.
    partners : mapping
        Endings of the files that belong together, by the role of their matrices.
    labels : tuple of str
        Endings of accompanying files with the degrees of freedom of the rows.
    """

    words: str
    is_it: Callable[[bytes], bool] | None = None
    endings: tuple[str, ...] = ()
    whole: Callable[[PathLike], dict[str, Any]] | None = None
    matrix: Callable[[str, PathLike], Entries] | None = None
    held: Callable[[PathLike], Sequence[Held]] | None = None
    partners: Mapping[str, str] | None = None
    labels: tuple[str, ...] = ()

    def files(self, path: PathLike) -> dict[str, PathLike]:
        """Return the files of mass, stiffness and damping that belong to a given one; none if they are not known."""
        if self.held is not None:
            with whole_file(path):
                return dict.fromkeys(roles(self.held(path)), path)
        return {role: Path(path).with_suffix(ending) for role, ending in (self.partners or {}).items()}


FORMATS = (
    Format("NumPy", lambda head: head.startswith(b"PK"), whole=read_npz),
    Format("MATLAB", lambda head: head.startswith(b"MATLAB 5.0"), (".mat",), whole=read_mat),
    Format(
        "Matrix Market",
        lambda head: head.startswith(BANNER),
        matrix=read_matrix_market,
        labels=(".mapping",),
    ),
    Format("Nastran OUTPUT4", is_output4, (".op4",), matrix=read_output4, held=held_in_output4),
    Format("Harwell-Boeing", is_harwell_boeing, matrix=read_harwell_boeing, labels=(".mapping",)),
    Format(
        "CalculiX",
        endings=(".sti", ".mas"),
        matrix=read_calculix,
        partners={"mass": ".mas", "stiffness": ".sti"},
        labels=(".dof",),
    ),
    Format("Nastran DMIG", is_dmig, (".pch", ".bdf", ".nas"), matrix=read_dmig, held=held_in_dmig),
)
# For any ending.
TEXT = Format("Abaqus", matrix=read_abaqus)

# Messages for files that are recognised but not read.
REFUSED: tuple[tuple[Callable[[bytes, str], bool], str], ...] = (
    (
        lambda head, ending: head.startswith((b"MATLAB 7.3", b"\x89HDF")),
        "a MATLAB file of version 7.3; save it with '-v7'",
    ),
    (
        lambda head, ending: ending == ".full" and b"\0" in head,
        "a binary file of Ansys; write its matrices with HBMAT",
    ),
    (
        lambda head, ending: ending == ".op2" and b"\0" in head,
        "an OUTPUT2 file of Nastran; write its matrices as OUTPUT4 or DMIG",
    ),
    (lambda head, ending: head.startswith(b"%") and not head.startswith(BANNER), HEADER),
)


def format_of(path: PathLike) -> Format:
    """Return the format of a file.

    Raises
    ------
    OSError
        If it cannot be read.
    ValueError
        If it is empty, too large, or of a format that is recognised but not read.
    """
    cannot = f"cannot read {os.fspath(path)!r}"
    with opened(path) as file:
        size = os.fstat(file.fileno()).st_size
        head = file.read(HEAD)
    if size > limits.LARGEST_FILE:
        raise ValueError(f"{cannot}: {at_least(size / 1024**3, 3)} GiB, but at most 2 GiB are read")
    if not head:
        raise ValueError(f"{cannot}: the file is empty")
    ending = Path(path).suffix.lower()
    for is_it, words in REFUSED:
        if is_it(head, ending):
            raise ValueError(f"{cannot}: {words}")
    told = (kind for kind in FORMATS if kind.is_it is not None and kind.is_it(head))
    named = (kind for kind in FORMATS if ending in kind.endings)
    return next(told, None) or next(named, TEXT)


@contextmanager
def whole_file(path: PathLike) -> Iterator[None]:
    """Turn any exception of a reader on a damaged file into a message of one line with the path."""
    check_regular(path)
    try:
        yield
    except Exception as error:
        raise ValueError(f"cannot read {os.fspath(path)!r}: {in_one_line(error)}") from error
