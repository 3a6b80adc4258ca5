"""Reader of matrices in MATLAB files of version 5; SciPy's reader ends the process on damaged files."""

from __future__ import annotations

import math
import os
import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse

from ...arrays import Array
from .. import limits

HEADER = 128
# Types of elements that hold numbers, and types that hold a variable.
NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
VARIABLE, COMPRESSED = 14, 15
# Classes of variables.
SPARSE, FULL = 5, range(6, 16)
COMPLEX = 0x0800
# Bytes of a variable that include its name and its shape.
BEGINNING = 4096
# Larger than any matrix of a body [bytes].
LARGEST_VARIABLE = 2**30


@dataclass(frozen=True)
class _Heading:
    """Name, shape and type of a variable, and the place at which its values begin."""

    name: str
    shape: tuple[int, ...]
    flags: int
    values: int


def read_matlab(
    path: str | os.PathLike[str], is_wanted: Callable[[str], bool], check_shape: Callable[[str, tuple[int, ...]], None]
) -> dict[str, Any]:
    """Return arrays and sparse arrays of a file by name.

    Parameters
    ----------
    path : str or path-like
        The file.
    is_wanted : callable
        Returns whether the variable of a name is read.
    check_shape : callable
        Raises if a variable is too large, given its name and shape, before anything is unpacked.

    Raises
    ------
    ValueError
        If the file is damaged, or a wanted variable is not a matrix of real numbers.
    """
    content = np.memmap(path, dtype=np.uint8, mode="r").data
    if len(content) < HEADER:
        raise ValueError("it ends within its header")
    order = ">" if bytes(content[126:128]) == b"MI" else "<"
    found, unpacked = {}, 0
    for kind, data in _elements(content[HEADER:], order):
        if kind not in (VARIABLE, COMPRESSED):
            continue
        beginning = data if kind == VARIABLE else _unpacked_beginning(data, order)
        heading = _heading(beginning, order)
        if not is_wanted(heading.name):
            continue
        check_shape(heading.name, heading.shape)
        if kind == COMPRESSED:
            data = _unpacked(data, order)
            unpacked += len(data)
        if unpacked > limits.LARGEST_FILE:
            raise ValueError(f"more than {limits.LARGEST_FILE // 1024**3} GiB when unpacked")
        found[heading.name] = _matrix(heading, data, order)
    return found


def _elements(content: memoryview, order: str) -> Iterator[tuple[int, memoryview]]:
    """Iterate over the elements of a file or of a variable: their types and contents."""
    place = 0
    while place < len(content):
        kind, data, place = _element(content, order, place)
        yield kind, data


def _element(content: memoryview, order: str, place: int) -> tuple[int, memoryview, int]:
    """Return the type and content of the element at a place, and the place of the next one."""
    if len(content) - place < 8:
        raise ValueError("it ends within an element")
    kind, size = struct.unpack_from(f"{order}II", content, place)
    if kind >> 16:
        # Up to four bytes are stored in place of the byte count.
        kind, size, begin = kind & 0xFFFF, min(kind >> 16, 4), place + 4
    else:
        begin = place + 8
    end = begin + size
    if end > len(content):
        raise ValueError("it ends within an element")
    following = end if kind == COMPRESSED else end + -end % 8
    return kind, content[begin:end], min(following, len(content))


def _unpacked_beginning(data: memoryview, order: str) -> memoryview:
    tag = zlib.decompressobj().decompress(data, BEGINNING)
    # A long variable is cut here.
    return memoryview(tag)[8:]


def _unpacked(data: memoryview, order: str) -> memoryview:
    whole = zlib.decompressobj().decompress(data, LARGEST_VARIABLE)
    kind, variable, _ = _element(memoryview(whole), order, 0)
    if kind != VARIABLE:
        raise ValueError("it contains a compressed element that is not a variable")
    return variable


def _heading(variable: memoryview, order: str) -> _Heading:
    _, flags, place = _element(variable, order, 0)
    kind, sizes, place = _element(variable, order, place)
    _, name, place = _element(variable, order, place)
    shape = tuple(int(size) for size in _values(kind, sizes, order))
    if len(flags) < 8 or len(shape) < 2 or min(shape) < 0:
        raise ValueError("it holds a variable without a shape")
    return _Heading(bytes(name).decode("latin-1"), shape, struct.unpack_from(f"{order}I", flags)[0], place)


def _matrix(heading: _Heading, variable: memoryview, order: str) -> Any:
    name, shape, kind = heading.name, heading.shape, heading.flags & 0xFF
    if heading.flags & COMPLEX:
        raise ValueError(f"{name} must be real, got complex numbers")
    if kind != SPARSE and kind not in FULL:
        raise ValueError(f"{name} must be a matrix of numbers, got another kind of variable")
    parts = [_values(of, data, order) for of, data in _elements(variable[heading.values :], order)]
    if kind == SPARSE:
        return _sparse(name, shape, parts)
    if not parts or parts[0].size != math.prod(shape):
        raise ValueError(f"{name} must hold {math.prod(shape)} numbers, as its shape {shape} requires")
    return parts[0].reshape(shape, order="F")


def _sparse(name: str, shape: tuple[int, ...], parts: list[Array]) -> Any:
    if len(shape) != 2 or len(parts) < 3 or parts[1].size != shape[1] + 1:
        raise ValueError(f"{name} must hold rows, columns and values, as its shape {shape} requires")
    rows, starts, values = parts[:3]
    held = int(starts[-1])
    if not 0 <= held <= min(rows.size, values.size):
        raise ValueError(f"{name} must hold the {held} values that its columns announce, but holds fewer")
    whole = rows[:held].astype(np.int64), starts.astype(np.int64)
    matrix = scipy.sparse.csc_array((values[:held].astype(float), *whole), shape=shape)
    matrix.check_format(full_check=True)
    return matrix


def _values(kind: int, data: memoryview, order: str) -> Array:
    if kind not in NUMBERS:
        raise ValueError(f"it contains numbers of an unknown kind, {kind}")
    of = np.dtype(order + NUMBERS[kind])
    if len(data) % of.itemsize:
        raise ValueError("it ends within a number")
    return np.frombuffer(data, dtype=of).astype(of.newbyteorder("="))
