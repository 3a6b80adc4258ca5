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
    """Return a number with as many digits as fit, without the letter of its exponent in short fields."""
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
        Form of nonzero entries: full columns if empty, ``short`` or ``long`` strings.
    kind : int
        Type of the numbers, single (1) or double precision (2).
    form : int
        Form of the matrices, square (1) or symmetric (6).
    digits : int
        Digits of numbers in a text.
    """
    pieces: list[bytes] = []
    for name, matrix in matrices.items():
        size = len(matrix)
        sizes = (size, -size if strings == "long" else size, form, kind)
        if order:
            pieces.append(_record(order, struct.pack(f"{order}4i", *sizes) + f"{name:8}".encode()))
        else:
            text = "".join(f"{number:8d}" for number in sizes)
            pieces.append(f"{text}{name:8}1P,{80 // (digits + 7)}E{digits + 7}.{digits}\n".encode())
        columns = [(j + 1, *_strings(matrix[:, j], strings, kind)) for j in range(size) if matrix[:, j].any()]
        for number, first, parts in [*columns, (size + 1, 1, [([], np.ones(1))])]:
            if order:
                body = b"".join(
                    struct.pack(f"{order}{len(begin)}i", *begin) + np.asarray(values, f"{order}f{4 * kind}").tobytes()
                    for begin, values in parts
                )
                pieces.append(_record(order, struct.pack(f"{order}3i", number, first, len(body) // 4) + body))
                continue
            # For full columns a text file has the count of numbers.
            words = sum(len(begin) + (1 if first else kind) * values.size for begin, values in parts)
            pieces.append(f"{number:8d}{first:8d}{words:8d}\n".encode())
            for begin, values in parts:
                pieces.append(("".join(f"{word:8d}" for word in begin) + "\n").encode() if begin else b"")
                pieces.append(_numbers(values, digits))
    return b"".join(pieces)


def _strings(column: Array, strings: str, kind: int) -> tuple[int, list[tuple[list[int], Array]]]:
    """Return the first row of a full column, or 0 for strings, and the header and content of each string."""
    held = np.flatnonzero(column)
    if not strings:
        return int(held[0]) + 1, [([], column[held[0] : held[-1] + 1])]
    runs = np.split(held, np.flatnonzero(np.diff(held) > 1) + 1)
    return 0, [(_beginning(int(run[0]) + 1, kind * run.size, strings), column[run]) for run in runs]


def _beginning(row: int, words: int, strings: str) -> list[int]:
    return [words + 1, row] if strings == "long" else [row + HALF * (words + 1)]


def _numbers(values: Sequence[float], digits: int) -> bytes:
    words, across = [f"{value:{digits + 7}.{digits}E}" for value in values], 80 // (digits + 7)
    return "".join("".join(words[at : at + across]) + "\n" for at in range(0, len(words), across)).encode()


def _record(order: str, content: bytes) -> bytes:
    length = struct.pack(f"{order}i", len(content))
    return length + content + length
