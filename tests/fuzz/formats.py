"""Matrices as finite-element programs write them to files."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from itertools import chain
from typing import Any

import numpy as np

Array = Any
Labels = Sequence[tuple[int, int]]
NAMES = ("", "UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ")
HALF = 65536


def calculix(matrix: Array) -> str:
    """Return the upper triangle column by column, zeros on the diagonal as well: ``.sti`` and ``.mas``."""
    size = len(matrix)
    held = [(i, j) for j in range(size) for i in range(j + 1) if i == j or matrix[i, j]]
    return "".join(f"{i + 1} {j + 1} {matrix[i, j]:20.13e}\n" for i, j in held)


def dof(labels: Labels) -> str:
    """Return ``.dof``."""
    return "".join(f"{node}.{direction}\n" for node, direction in labels)


def mapping(labels: Labels) -> str:
    """Return ``.mapping`` of HBMAT."""
    lines = [f"{row:14d}{node:14d}    {NAMES[number]:4}" for row, (node, number) in enumerate(labels, 1)]
    return "\n".join(["    Matrix Eqn          Node    DOF     ", *lines, ""])


def harwell_boeing(matrix: Array, kind: str = "RSA", across: int = 1, right_hand_side: bool = True) -> str:
    """Return the lower triangle, or all of a matrix, as HBMAT does, or with more than one number across."""
    size = len(matrix)
    columns = [[i for i in range(j if kind[1] == "S" else 0, size) if matrix[i, j]] for j in range(size)]
    starts = np.cumsum([1, *map(len, columns)]).tolist()
    rows = [i + 1 for column in columns for i in column]
    values = [matrix[i, j] for j, column in enumerate(columns) for i in column]
    width, digits = (25, 15) if across == 1 else (20, 12)
    many = "" if across == 1 else str(across)

    def lines(numbers: Sequence[Any], form: str) -> list[str]:
        words = [format(number, form).replace("e", "D") for number in numbers]
        return ["".join(words[at : at + across]) for at in range(0, len(words), across)]

    parts = [lines(starts, "14d"), lines(rows, "14d"), lines(values, f"{width}.{digits}e")]
    parts.append(lines([0.0] * size, f"{width}.{digits}e") if right_hand_side else [])
    counts = [len(part) for part in parts]
    head = [f"{'Stiffness matrix from ANSYS FULL file dumped into Harwell-Boeing format':80}"]
    head.append("".join(f"{count:14d}" for count in (sum(counts), *counts)))
    head.append(f"{kind}           " + "".join(f"{count:14d}" for count in (size, size, len(values), 0)))
    whole, real = f"({many}I14)", f"({'1P,' if many and right_hand_side else ''}{many}E{width}.{digits})"
    head.append(f"{whole:16}{whole:16}{real:20}{real if right_hand_side else '':20}")
    head += [f"F             {1:14d}{size:14d}"] if right_hand_side else []
    return "\n".join([*head, *(line for part in parts for line in part), ""])


def dmig(matrices: Mapping[str, Array], labels: Labels, fields: str = "large", form: int = 6, kind: int = 2) -> str:
    """Return cards of some fields (small, large or free), of symmetric matrices the upper triangle."""
    lines = ["$ a punch file", "BEGIN BULK"]
    for name, matrix in matrices.items():
        lines.append(f"{'DMIG':8}{name:8}{0:8d}{form:8d}{kind:8d}{0:8d}{'':16}{len(matrix):8d}")
        for j, column in enumerate(labels):
            held = [(labels[i], matrix[i, j]) for i in range(j + 1 if form == 6 else len(matrix)) if matrix[i, j]]
            lines += _column(name, column, held, fields) if held else []
    return "\n".join([*lines, "ENDDATA", ""])


def _column(name: str, label: tuple[int, int], held: Sequence[tuple[tuple[int, int], float]], fields: str) -> list[str]:
    if fields == "large":
        lines = [f"{'DMIG*':8}{name:16}{label[0]:16d}{label[1]:16d}"]
        return lines + [f"{'*':8}{node:16d}{number:16d}{_nastran(value, 16)}" for (node, number), value in held]
    cells = [
        [str(node), str(number), _nastran(value, 8 if fields == "small" else 24).strip(), ""]
        for (node, number), value in held
    ]
    rows = [["DMIG", name, *map(str, label), "", *cells[0]]]
    rows += [["", *chain(*cells[at : at + 2])] for at in range(1, len(cells), 2)]
    if fields == "free":
        return [",".join(row) for row in rows]
    return ["".join(f"{word:8}" for word in row).rstrip() for row in rows]


def _nastran(value: float, width: int) -> str:
    """Return a number in as many digits as fit, without the letter of its exponent where there is little room."""
    if not np.isfinite(value):
        return str(value).rjust(width)
    for digits in range(16, -1, -1):
        mantissa, exponent = f"{value:.{digits}e}".split("e")
        mantissa = mantissa if "." in mantissa else mantissa + "."
        word = f"{mantissa}{int(exponent):+d}" if width == 8 else f"{mantissa}D{int(exponent):+03d}"
        if len(word) <= width:
            return word.rjust(width)
    raise ValueError(value)


def output4(
    matrices: Mapping[str, Array], order: str = "", strings: str = "", kind: int = 2, form: int = 6, digits: int = 16
) -> bytes:
    """Return an OUTPUT4 file.

    Parameters
    ----------
    matrices : mapping
        Matrices by name, those of form 6 in full.
    order : str
        Order of bytes of a binary file, ``<`` or ``>``; text if empty.
    strings : str
        How what is not zero is told: full columns if empty, ``short`` or ``long`` strings.
    kind : int
        Type of the numbers, single (1) or double precision (2).
    form : int
        Form of the matrices, square (1) or symmetric (6).
    digits : int
        Digits of numbers in a text.
    """
    width, words = digits + 7, kind
    across = 80 // width
    content = b""
    for name, matrix in matrices.items():
        size = len(matrix)
        sizes = (size, -size if strings == "long" else size, form, kind)
        if order:
            content += _record(order, struct.pack(f"{order}4i", *sizes) + f"{name:8}".encode())
        else:
            content += f"{sizes[0]:8d}{sizes[1]:8d}{form:8d}{kind:8d}{name:8}1P,{across}E{width}.{digits}\n".encode()
        for j in range(size):
            held = np.flatnonzero(matrix[:, j])
            runs = [run for run in np.split(held, np.flatnonzero(np.diff(held) > 1) + 1) if run.size]
            runs = runs if strings else [np.arange(held[0], held[-1] + 1)] if held.size else []
            if not runs:
                continue
            parts = [([int(run[0]) + 1], matrix[run, j]) for run in runs]
            if strings:
                parts = [(_beginning(first[0], words * values.size, strings), values) for first, values in parts]
            first = 0 if strings else parts[0][0][0]
            beginnings = [begin if strings else [] for begin, _ in parts]
            if order:
                body = b"".join(
                    struct.pack(f"{order}{len(begin)}i", *begin) + np.asarray(values, f"{order}f{4 * kind}").tobytes()
                    for begin, (_, values) in zip(beginnings, parts, strict=True)
                )
                content += _record(order, struct.pack(f"{order}3i", j + 1, first, len(body) // 4) + body)
                continue
            count = sum(len(begin) + words * values.size for begin, (_, values) in zip(beginnings, parts, strict=True))
            content += f"{j + 1:8d}{first:8d}{count if strings else parts[0][1].size:8d}\n".encode()
            for begin, (_, values) in zip(beginnings, parts, strict=True):
                content += ("".join(f"{word:8d}" for word in begin) + "\n").encode() if begin else b""
                content += _numbers(values, across, width, digits)
        if order:
            last = struct.pack(f"{order}3i", size + 1, 1, words) + np.ones(1, f"{order}f{4 * kind}").tobytes()
            content += _record(order, last)
        else:
            content += f"{size + 1:8d}{1:8d}{1:8d}\n".encode() + _numbers([1.0], across, width, digits)
    return content


def _beginning(row: int, words: int, strings: str) -> list[int]:
    return [words + 1, row] if strings == "long" else [row + HALF * (words + 1)]


def _numbers(values: Sequence[float], across: int, width: int, digits: int) -> bytes:
    words = [f"{value:{width}.{digits}E}" for value in values]
    return "".join("".join(words[at : at + across]) + "\n" for at in range(0, len(words), across)).encode()


def _record(order: str, content: bytes) -> bytes:
    length = struct.pack(f"{order}i", len(content))
    return length + content + length
