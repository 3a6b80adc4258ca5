"""Arrays of numbers as text, bit by bit: what a scenario holds instead of a long list."""

from __future__ import annotations

import base64
import binascii
import math
import zlib

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError

PREFIX = "float64 "
LARGEST = 4000 * 4000
# Up to this many numbers a list is easier to read.
LONGEST_LIST = 64


def packed(array: Array) -> str:
    """Return an array as text: ``float64``, its shape, and its compressed bytes in base 64."""
    content = zlib.compress(np.ascontiguousarray(array, dtype="<f8").tobytes())
    return f"{PREFIX}{'x'.join(map(str, array.shape))} {base64.b64encode(content).decode('ascii')}"


def is_packed(text: str) -> bool:
    """Return whether a text is meant as a packed array."""
    return text.startswith(PREFIX)


def unpacked(text: str) -> Array:
    """Return the array that `packed` wrote.

    Raises
    ------
    ValueError
        If the text is damaged.
    """
    try:
        _, sizes, content = text.split(" ")
        shape = tuple(int(size) for size in sizes.split("x"))
        whole = math.prod(shape) * 8
        if min(shape) < 0 or whole > LARGEST * 8:
            raise ValueError(f"the shape {sizes}")
        unfold = zlib.decompressobj()
        plain = unfold.decompress(base64.b64decode(content, validate=True), whole + 1)
        return np.frombuffer(plain, dtype="<f8").astype(float).reshape(shape)
    except (ValueError, zlib.error, binascii.Error) as error:
        raise ArgumentError("array", "be a whole packed array, as records have them") from error
