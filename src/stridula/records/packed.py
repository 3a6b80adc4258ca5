"""Lossless text form of arrays, used in scenarios in place of long lists."""

from __future__ import annotations

import base64
import binascii
import math
import re
import zlib

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError

KINDS = {"float64": "<f8", "float32": "<f4"}
LARGEST = 4000 * 4000
# Up to this many numbers a list is more readable.
LONGEST_LIST = 64
# Pattern of the text of `packed`, no character of which needs escaping.
PACKED = re.compile(rf"(?:{'|'.join(KINDS)}) [\dx]* [\w+/=]*", re.ASCII)


def packed(array: Array) -> str:
    """Return an array as text: ``float32`` if it has that type, else ``float64``; shape, bytes in base 64."""
    kind = "float32" if array.dtype == np.float32 else "float64"
    content = zlib.compress(np.ascontiguousarray(array, dtype=KINDS[kind]).tobytes())
    return f"{kind} {'x'.join(map(str, array.shape))} {base64.b64encode(content).decode('ascii')}"


def is_packed(text: str) -> bool:
    """Return whether a text begins like a packed array."""
    return text.partition(" ")[0] in KINDS


def unpacked(text: str) -> Array:
    """Return the array from the text of `packed`.

    Raises
    ------
    ValueError
        If the text is damaged.
    """
    try:
        kind, sizes, content = text.split(" ")
        shape = tuple(int(size) for size in sizes.split("x"))
        numbers = np.dtype(KINDS[kind])
        whole = math.prod(shape) * numbers.itemsize
        if min(shape) < 0 or whole > LARGEST * 8:
            raise ValueError(f"the shape {sizes}")
        unfold = zlib.decompressobj()
        plain = unfold.decompress(base64.b64decode(content, validate=True), whole + 1)
        return np.frombuffer(plain, dtype=numbers).astype(float).reshape(shape)
    except (KeyError, ValueError, zlib.error, binascii.Error) as error:
        raise ArgumentError("array", "be a complete packed array, as in records") from error
