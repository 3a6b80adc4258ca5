"""Mode shapes in universal files: datasets 55 and 2414 with their nodes."""

from __future__ import annotations

import os
from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array
from ..reading.deck_error import DeckError
from ..reading.universal import Dataset, datasets
from ..reading.universal_nodes import Geometry

SHAPES, RESULTS = "55", "2414"
# Kinds of analysis: normal modes, and complex ones given by an eigenvalue.
NORMAL, COMPLEX = 2, (3, 7)
ANALYSES = {0: "unknown", 1: "a static result", 4: "a transient", 5: "a frequency response", 6: "buckling"}
# Types of data: unknown, general and displacements.
DISPLACEMENTS = (0, 1, 8)
OTHERS = {11: "velocities", 12: "accelerations"}
GLOBAL, LOCAL = "global", "local"
# Lines before the nodes, in dataset 55 and in 2414, and the location of results at nodes in the latter.
HEADER, LONG_HEADER, AT_NODES = 8, 13, 1


@dataclass(frozen=True)
class FileMode:
    """A mode as a file has it.

    Attributes
    ----------
    line : int
        The line at which its dataset begins.
    frequency : float
        Undamped frequency [Hz].
    damping : float
        Damping ratio [1].
    mass : float
        Modal mass in units of the file, 0 if it is not given; of a complex mode 0.
    modal_a : complex
        Modal A in units of the file, 0 if it is not given; of a normal mode 0.
    shape : dict
        Displacement (x, y, z) by node, complex.
    """

    line: int
    frequency: float
    damping: float
    mass: float
    modal_a: complex
    shape: dict[int, Array]


@dataclass
class FileModes:
    """Modes, nodes and units of a file.

    Attributes
    ----------
    modes : list of FileMode
        The modes in the order of the file.
    geometry : Geometry
        Nodes and units.
    """

    modes: list[FileMode] = field(default_factory=list)
    geometry: Geometry = field(default_factory=Geometry)

    @property
    def nodes(self) -> tuple[int, ...]:
        """Numbers of all nodes that move in a mode, in rising order."""
        return tuple(sorted({node for mode in self.modes for node in mode.shape}))


def read_universal_modes(
    path: str | os.PathLike[str], nodes: Geometry | None, quantity: str | None, directions: str | None
) -> FileModes:
    """Return the modes of a universal file in global directions.

    Parameters
    ----------
    path : str or Path
        The file.
    nodes : Geometry or None
        Nodes of another file.
    quantity : {"displacement"} or None
        Whether velocities and accelerations of the file are the shapes of displacements.
    directions : {"global", "local"} or None
        Directions of shapes at nodes with a displacement coordinate system of their own.

    Raises
    ------
    DeckError
        If a line cannot be read, or leaves open what it means.
    OSError
        If the file cannot be read.
    """
    found = FileModes()
    for one in datasets(path):
        if found.geometry.read(one):
            continue
        if one.name == SHAPES:
            found.modes.append(_mode(one, quantity))
        elif one.name == RESULTS and _has_shape(one):
            found.modes.append(_computed_mode(one, quantity))
    if nodes is not None:
        nodes.units = nodes.units or found.geometry.units
        nodes, found.geometry = found.geometry, nodes
    if found.geometry.numbers:
        for mode in found.modes:
            _place(mode, found.geometry, directions)
    return found


def _place(mode: FileMode, geometry: Geometry, directions: str | None) -> None:
    """Turn the shape of a mode into global directions."""
    known = set(geometry.numbers)
    for node, moved in mode.shape.items():
        if node not in known:
            raise DeckError(mode.line, f"the mode that begins here moves node {node}, which is not among the nodes")
        if geometry.has_own_axes(node) and directions is None:
            words = f"node {node} of the mode that begins here has a displacement coordinate system of its own: pass"
            raise DeckError(mode.line, f'{words} directions="local" for shapes in it, "global" for others')
        if geometry.has_own_axes(node) and directions == LOCAL:
            mode.shape[node] = moved @ geometry.axes(node)


def _mode(one: Dataset, quantity: str | None) -> FileMode:
    """Return the mode of a dataset 55."""
    analysis = one.whole(5, 6)[1]
    if analysis != NORMAL and analysis not in COMPLEX:
        raise one.wrong(5, f"must be of modes (2, 3 or 7), got {ANALYSES.get(analysis, 'the kind')} ({analysis})")
    width, is_complex = _values(one, 5, quantity)
    integers = one.whole(6, 2)
    # Numbers of the header that do not fit into a line of eight continue.
    if integers[0] > 6 or integers[1] > 6:
        raise one.wrong(6, f"must have at most 6 numbers in line 8 of the dataset, got {integers[1]}")
    needed = 4 if analysis == NORMAL else 6
    given = one.numbers(7, min(integers[1], needed)) + [0.0] * needed
    if integers[1] < (1 if analysis == NORMAL else 2):
        raise one.wrong(6, f"must have the frequency of its mode, got {integers[1]} numbers")
    shape = _shape(one, width, is_complex, HEADER)
    return _normal(one, 7, given[:4], shape) if analysis == NORMAL else _complex(one, 7, given[:4], shape)


def _has_shape(one: Dataset) -> bool:
    """Return whether a dataset 2414 has a mode shape at nodes; others are stresses, static results and so on."""
    _, analysis, _, specific, _, _ = one.whole(8, 6)[:6]
    is_mode = analysis == NORMAL or analysis in COMPLEX
    return one.whole(2, 1)[0] == AT_NODES and is_mode and specific in (*DISPLACEMENTS, *OTHERS)


def _computed_mode(one: Dataset, quantity: str | None) -> FileMode:
    """Return the mode of a dataset 2414."""
    width, is_complex = _values(one, 8, quantity)
    shape = _shape(one, width, is_complex, LONG_HEADER)
    if one.whole(8, 6)[1] == NORMAL:
        # Time, frequency, eigenvalue, modal mass and damping.
        _, frequency, _, *others = one.numbers(11, 6)
        return _normal(one, 11, [frequency, *others], shape)
    return _complex(one, 12, one.numbers(12, 4), shape)


def _values(one: Dataset, at: int, quantity: str | None) -> tuple[int, bool]:
    """Return the number of values at each node, and whether they are complex, from the line that says so."""
    _, _, form, specific, kind, width = one.whole(at, 6)[:6]
    if form not in (2, 3) or width not in (3, 6) or kind not in (2, 5):
        words = "must have 3 or 6 real (2) or complex (5) values at each node, a vector (2 or 3)"
        raise one.wrong(at, f"{words}, got {one.lines[at].strip()!r}")
    if specific not in DISPLACEMENTS and quantity is None:
        words = f"has {OTHERS.get(specific, 'data')} (type {specific}), which leaves the scale of the shape open"
        raise one.wrong(at, f'{words}: pass quantity="displacement" if its modal mass is that of displacements')
    return width, kind == 5


def _normal(one: Dataset, at: int, given: list[float], shape: dict[int, Array]) -> FileMode:
    """Return a normal mode of frequency, modal mass, viscous and hysteretic damping in a line."""
    frequency, mass, viscous, hysteretic = given
    if frequency < 0.0 or mass < 0.0:
        raise one.wrong(at, f"must have frequency and modal mass of 0 or above, got {frequency:g} Hz and {mass:g}")
    return FileMode(one.first - 1, frequency, _ratio(one, at, viscous, hysteretic), mass, 0.0j, shape)


def _complex(one: Dataset, at: int, given: list[float], shape: dict[int, Array]) -> FileMode:
    """Return a complex mode of eigenvalue and modal A in a line."""
    eigenvalue, modal_a = complex(*given[:2]), complex(*given[2:4])
    size = abs(eigenvalue)
    if not size or eigenvalue.imag == 0.0 or eigenvalue.real > 0.0:
        raise one.wrong(at, f"must have an eigenvalue of a vibration that does not grow, got {eigenvalue:g} rad/s")
    if eigenvalue.imag < 0.0:
        # The mode of the conjugate.
        shape, modal_a = {node: np.conj(moved) for node, moved in shape.items()}, modal_a.conjugate()
    return FileMode(one.first - 1, size / (2.0 * np.pi), -eigenvalue.real / size, 0.0, modal_a, shape)


def _ratio(one: Dataset, at: int, viscous: float, hysteretic: float) -> float:
    """Return the damping ratio of a normal mode from its viscous and its hysteretic one, twice as large."""
    if viscous and hysteretic and abs(hysteretic - 2.0 * viscous) > 1e-3 * abs(hysteretic):
        words = f"has a viscous damping ratio of {viscous:g} and a hysteretic one of {hysteretic:g}"
        raise one.wrong(at, f"{words}, not twice as large: set the one that does not hold to 0")
    ratio = viscous or 0.5 * hysteretic
    if not 0.0 <= ratio < 1.0:
        raise one.wrong(at, f"must have a damping ratio from 0 to below 1, got {ratio:g}")
    return ratio


def _shape(one: Dataset, width: int, is_complex: bool, header: int) -> dict[int, Array]:
    """Return the displacements of the nodes, without rotations."""
    count = width * (2 if is_complex else 1)
    lines = -(-count // 6)
    found: dict[int, Array] = {}
    for at in range(header, len(one.lines), 1 + lines):
        node = one.whole(at, 1)
        if len(node) != 1 or node[0] < 1:
            raise one.wrong(at, f"needs the number of a node in a line, got {one.lines[at].strip()[:60]!r}")
        if node[0] in found:
            raise one.wrong(at, f"has node {node[0]} twice")
        values: list[float] = []
        for row in range(at + 1, at + 1 + lines):
            wanted = min(6, count - len(values))
            values += one.numbers(row, wanted)
            if len(one.words(row)) != wanted:
                raise one.wrong(row, f"needs {wanted} numbers in a line, got {one.lines[row].strip()[:60]!r}")
        numbers = np.array(values)
        found[node[0]] = (numbers[::2] + 1j * numbers[1::2] if is_complex else numbers.astype(complex))[:3]
    return found
