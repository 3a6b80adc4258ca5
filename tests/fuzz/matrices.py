"""Files of matrices in all formats, damaged or with wrong counts and numbers, read as reduced bodies."""

from __future__ import annotations

import io
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
import scipy.sparse

import stridula as st

from . import formats
from .numbers import flipped, number
from .outcomes import folder, outcome

Array = Any
Given = tuple[dict[str, bytes], dict[str, Any]]
SIZE = 6
POINTS = {"tip": (0, 1)}
LABELS = [(node, dof) for node in (1, 2, 7) for dof in (1, 2)]


def inputs(seed: int, count: int) -> Iterator[Given]:
    """Return the contents of files by name, and the arguments of `ReducedBody.read`."""
    for k in range(count):
        dice = random.Random(f"matrices {seed} {k}")
        kinds = (_npz, _mat, _market, _market, _abaqus, _abaqus, _calculix, _cards, _output4, _harwell_boeing)
        files, arguments = dice.choice(kinds)(dice)
        damaged = dice.choice(list(files))
        if dice.random() < 0.75:
            files[damaged] = flipped(dice, files[damaged])
        yield files, arguments


def check(given: Given) -> str:
    """Return the outcome of reading files of matrices."""
    files, arguments = given
    with folder():
        for name, content in files.items():
            Path(name).write_bytes(content)

        def read() -> None:
            body = st.ReducedBody.read(**arguments)
            body.modes()
            for point in body.points:
                body.trace(point)

        return outcome(read)


def _matrix(dice: random.Random, stiff: float) -> Array:
    """Return a symmetric positive definite matrix, sometimes with a wrong number."""
    random_state = np.random.default_rng(dice.randrange(2**32))
    root = random_state.normal(size=(SIZE, SIZE))
    matrix = stiff * (root @ root.T + SIZE * np.eye(SIZE))
    if dice.random() < 0.25:
        i, j = dice.randrange(SIZE), dice.randrange(SIZE)
        matrix[i, j] = number(dice)
        if dice.random() < 0.7:
            matrix[j, i] = matrix[i, j]
    if dice.random() < 0.1:
        with np.errstate(all="ignore"):
            matrix *= 10.0 ** dice.choice((-300, -200, 200, 300))
    return matrix


def _arrays(dice: random.Random) -> dict[str, Array]:
    arrays = {"mass": _matrix(dice, 1.0), "stiffness": _matrix(dice, 1e6), "point_tip": np.eye(2, SIZE)}
    extra: dict[str, Callable[[], Array]] = {
        "damping": lambda: dice.choice((0.01, np.full(SIZE, 0.01), _matrix(dice, 1.0), number(dice))),
        "translation": lambda: np.tile(np.eye(2), SIZE // 2),
        "rayleigh": lambda: np.array([number(dice), number(dice)]),
        "cutoff": lambda: np.array(number(dice), dtype=float),
        "name": lambda: np.array(dice.choice(("a", "", "音", "x" * 500))),
        "point_x": lambda: np.full(dice.choice(((2, SIZE), (3, SIZE), (2,), (0, SIZE))), number(dice), dtype=float),
        "mass": lambda: np.zeros(dice.choice(((0, 0), (SIZE, SIZE), (3, 3), (1,), (2, 2, 2)))),
        "stiffness": lambda: np.array([["a"]]),
    }
    for name in extra:
        if dice.random() < 0.15:
            arrays[name] = np.asarray(extra[name]())
    return arrays


def _npz(dice: random.Random) -> Given:
    content = io.BytesIO()
    save = np.savez_compressed if dice.random() < 0.3 else np.savez
    save(content, **_arrays(dice))
    return {"body.npz": content.getvalue()}, {"path": "body.npz"}


def _mat(dice: random.Random) -> Given:
    content, arrays = io.BytesIO(), _arrays(dice)
    if dice.random() < 0.5:
        arrays |= {name: scipy.sparse.csc_array(arrays[name]) for name in ("mass",) if arrays[name].ndim == 2}
    scipy.io.savemat(content, arrays, do_compression=dice.random() < 0.3)
    # The time of writing stands in the header.
    whole = b"MATLAB 5.0 MAT-file".ljust(116) + content.getvalue()[116:]
    return {"body.mat": whole}, {"path": "body.mat"}


def _pair(write: Callable[[random.Random, Array], bytes], dice: random.Random, points: Any) -> Given:
    files = {name: write(dice, _matrix(dice, stiff)) for name, stiff in (("m.txt", 1.0), ("k.txt", 1e6))}
    return files, {"mass": "m.txt", "stiffness": "k.txt", "points": points}


def _market(dice: random.Random) -> Given:
    return _pair(_as_market, dice, POINTS)


def _as_market(dice: random.Random, matrix: Array) -> bytes:
    content = io.BytesIO()
    held = scipy.sparse.coo_array(matrix) if dice.random() < 0.5 else matrix
    scipy.io.mmwrite(content, held, symmetry=dice.choice(("general", "symmetric", "AUTO")), precision=9)
    return _recounted(dice, content.getvalue())


def _recounted(dice: random.Random, content: bytes) -> bytes:
    """Return a Matrix Market file, sometimes with wrong counts or words in its header."""
    lines = content.split(b"\n")
    if dice.random() < 0.15:
        at = next(k for k, line in enumerate(lines) if not line.startswith(b"%"))
        counts = lines[at].split()
        counts[dice.randrange(len(counts))] = str(dice.choice((0, 1, 5, 7, 37, -1, 10**9, 10**18))).encode()
        lines[at] = b" ".join(counts)
    if dice.random() < 0.1:
        words = (b"complex", b"pattern", b"integer", b"hermitian", b"skew-symmetric", b"vector", b"")
        lines[0] = lines[0].replace(dice.choice((b"real", b"symmetric", b"general", b"matrix")), dice.choice(words))
    return b"\n".join(lines)


def _abaqus(dice: random.Random) -> Given:
    if dice.random() < 0.5:
        return _pair(_as_input, dice, {"tip": ((1, 1), dice.choice(((1, 2), (7, 2), (9, 9), None)))})
    return _pair(_as_coordinate, dice, POINTS)


def _as_input(dice: random.Random, matrix: Array) -> bytes:
    rows = [
        f"{LABELS[i][0]},{LABELS[i][1]}, {LABELS[j][0]},{LABELS[j][1]}, {matrix[i, j]:.9e}"
        for i in range(SIZE)
        for j in range(i + 1)
    ]
    return _with_a_bad_line(dice, ["*MATRIX INPUT, NAME=M", *rows])


def _as_coordinate(dice: random.Random, matrix: Array) -> bytes:
    rows = [f"{i + 1} {j + 1} {matrix[i, j]:.9e}" for i in range(SIZE) for j in range(SIZE)]
    return _with_a_bad_line(dice, rows)


def _symmetric(dice: random.Random) -> dict[str, Array]:
    return {role: _matrix(dice, stiff) for role, stiff in (("mass", 1.0), ("stiffness", 1e6))}


def _calculix(dice: random.Random) -> Given:
    matrices = _symmetric(dice)
    files = {"j.mas": formats.calculix(matrices["mass"]), "j.sti": formats.calculix(matrices["stiffness"])}
    if dice.random() < 0.8:
        files["j.dof"] = formats.dof(LABELS[: dice.choice((SIZE, SIZE, SIZE, SIZE - 1, 0))])
    points = {"tip": dice.choice((7, 9, (0.5, 0.0, 0.0), ((1, 1), (1, 2))))} if "j.dof" in files else POINTS
    arguments: dict[str, Any] = {"path": "j.sti", "points": points}
    if dice.random() < 0.5:
        places = "".join(f"{node}, {0.1 * node}, 0, 0\n" for node in (1, 2, 5, 7))
        cards = "".join(f"GRID,{node},,{0.1 * node},0.,0.\n" for node in (1, 2, 5, 7))
        deck, content = dice.choice((("j.inp", f"*NODE\n{places}"), ("j.bdf", cards)))
        files[deck], arguments["mesh"] = content, deck
    return {name: content.encode() for name, content in files.items()}, arguments


def _named(dice: random.Random) -> dict[str, Array]:
    matrices = _symmetric(dice)
    names = {"MAAX": matrices["mass"], "KAAX": matrices["stiffness"]}
    return names | ({dice.choice(("BAAX", "K4AAX", "KGG", "X")): np.eye(SIZE)} if dice.random() < 0.4 else {})


def _cards(dice: random.Random) -> Given:
    fields, form, kind = dice.choice(("small", "large", "free")), dice.choice((1, 6, 6, 9)), dice.choice((1, 2, 2, 4))
    content = formats.dmig(_named(dice), LABELS, fields, form, kind)
    return {"b.pch": content.encode()}, {"path": "b.pch", "points": {"tip": dice.choice((7, ((1, 1), (1, 2))))}}


def _output4(dice: random.Random) -> Given:
    order, strings = dice.choice(("", "<", ">")), dice.choice(("", "short", "long"))
    with np.errstate(all="ignore"):
        content = formats.output4(_named(dice), order, strings, dice.choice((1, 2)), dice.choice((1, 2, 6, 6)))
    return {"b.op4": content}, {"path": "b.op4", "points": POINTS}


def _harwell_boeing(dice: random.Random) -> Given:
    files, across = dict[str, bytes](), dice.choice((1, 3))
    for role, matrix in _symmetric(dice).items():
        text = formats.harwell_boeing(matrix, dice.choice(("RSA", "RUA")), across, dice.random() < 0.5)
        files[f"{role}.matrix"] = text.encode()
    arguments: dict[str, Any] = {role: f"{role}.matrix" for role in ("mass", "stiffness")} | {"points": POINTS}
    if dice.random() < 0.5:
        files["mass.mapping"], arguments["points"] = formats.mapping(LABELS).encode(), {"tip": 7}
    return files, arguments


def _with_a_bad_line(dice: random.Random, lines: list[str]) -> bytes:
    bad = (
        "",
        "x",
        "1 1",
        "0 0 1.0",
        "1000000000 1000000000 1.0",
        "-1 -1 1.0",
        "1,1,1,1,1e36",
        "1.5 1 1.0",
        "1 1 1 1 1 1",
    )
    if dice.random() < 0.2:
        lines[dice.randrange(len(lines))] = dice.choice(bad)
    return ("\n".join(lines) + "\n").encode()
