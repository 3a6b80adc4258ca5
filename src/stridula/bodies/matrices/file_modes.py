"""Modes of a universal file as arguments of `MeasuredModes`: in SI, by rising frequency, with one scale."""

from __future__ import annotations

import os
from itertools import pairwise
from typing import Any

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, counted, listed, positive
from ...disk import check_path, named
from ...doubtful import warn_of
from ..reading.deck_error import DeckError
from ..reading.universal import datasets
from ..reading.universal_nodes import Geometry
from .result_modes import ratios
from .universal_modes import FileMode, FileModes, read_universal_modes

UNIT_MASS, UNIT_A = "unit modal mass", "unit modal A"
# Relative difference between a given scale and that of a file, and of two frequencies, that is due to rounding.
ROUNDING = 1e-4
# Cosine of the angle of two shapes above which they are the same.
ALIKE = 0.99


def modes_of_file(
    path: str | os.PathLike[str],
    scaling: Any,
    geometry: str | os.PathLike[str] | None,
    quantity: str | None,
    directions: str | None,
    damping: Any = None,
    scale: float | None = None,
) -> dict[str, Any]:
    """Return the arguments of `MeasuredModes` from a universal file; its `read` documents the parameters."""
    if geometry is not None:
        check_path("geometry", geometry)
    try:
        found = read_universal_modes(path, None if geometry is None else _nodes(geometry), quantity, directions)
        points = list(map(str, found.nodes))
        places = [found.geometry.place(node) for node in found.nodes] if found.geometry.numbers else None
    except DeckError as error:
        raise ValueError(f"cannot read {named(path)}: {error}") from None
    if not found.modes:
        raise ArgumentError("path", "have mode shapes, dataset 55 or 2414", str(path), got=f"none in {named(path)}")
    length, force = _units(found, scale, path)
    _warn(found, path)
    modes = sorted(found.modes, key=lambda mode: mode.frequency)
    _check_once(modes, found.nodes, path)
    shapes, given = _scaled(modes, found.nodes, scaling, length / force, path)
    return {
        "frequency": (frequency := np.array([mode.frequency for mode in modes])),
        "damping": [mode.damping for mode in modes] if damping is None else ratios(damping, frequency),
        "shapes": shapes,
        "points": points,
        "scaling": given,
        "places": None if places is None else np.array(places) / length,
    }


def _nodes(path: str | os.PathLike[str]) -> Geometry:
    """Return the nodes of another file."""
    found = Geometry()
    try:
        for one in datasets(path):
            found.read(one)
    except DeckError as error:
        raise ValueError(f"cannot read {named(path)}: {error}") from None
    if not found.numbers:
        raise ArgumentError("geometry", "have nodes, dataset 15 or 2411", str(path), got=f"none in {named(path)}")
    return found


def _check_once(modes: list[FileMode], nodes: tuple[int, ...], path: str | os.PathLike[str]) -> None:
    """Raise ValueError if a file has a mode twice, such as from two excitations: both would vibrate."""
    for one, other in pairwise(modes):
        if abs(one.frequency - other.frequency) <= ROUNDING * other.frequency:
            first, second = (np.array([mode.shape.get(node, np.zeros(3)) for node in nodes]) for mode in (one, other))
            sizes = np.linalg.norm(first) * np.linalg.norm(second)
            if abs(np.vdot(first, second)) > ALIKE * sizes:
                words = f"the mode at {other.frequency:.6g} Hz is there twice, also in line {one.line}"
                raise ValueError(f"cannot read {named(path)}: line {other.line}: {words}")


def _units(found: FileModes, scale: float | None, path: str | os.PathLike[str]) -> tuple[float, float]:
    """Return length and force of a file per metre and newton: as it states, or metres of the scale with newtons."""
    stated = found.geometry.units
    if scale is None:
        if stated is None:
            warn_of([f"{named(path)} has no units, dataset 164: taken as SI"])
        return stated or (1.0, 1.0)
    length = 1.0 / positive("scale", scale)
    if stated is not None and not np.isclose(length, stated[0], rtol=ROUNDING):
        raise ArgumentError("scale", f"be {1.0 / stated[0]:g}, as dataset 164 states, or left out", scale)
    return stated or (length, 1.0)


def _warn(found: FileModes, path: str | os.PathLike[str]) -> None:
    """Warn of what the file leaves open."""
    doubts = []
    every = set(found.nodes)
    for mode in found.modes:
        if lost := every - set(mode.shape):
            words = f"the mode at {mode.frequency:.5g} Hz, line {mode.line}, leaves out {counted(len(lost), 'node')}"
            doubts.append(f"{words} ({listed(map(str, sorted(lost)))}): taken as at rest")
    warn_of(doubts)


def _scaled(
    modes: list[FileMode], nodes: tuple[int, ...], scaling: Any, mass: float, path: str | os.PathLike[str]
) -> tuple[Array, Any]:
    """Return the shapes of modes and their scaling; `mass` is the unit of mass of the file [kg]."""
    shapes = np.zeros((len(nodes), 3, len(modes)), dtype=complex)
    for number, mode in enumerate(modes):
        for row, node in enumerate(nodes):
            shapes[row, :, number] = mode.shape.get(node, 0.0)
    masses, of_a = (np.array([getattr(mode, word) for mode in modes]) for word in ("mass", "modal_a"))
    if scaling is None:
        known = np.where(masses > 0.0, masses, of_a)
        if not known.any():
            return shapes, None
        if not known.all():
            lost = modes[int(np.argmin(np.abs(known)))]
            words = "be given where the file lacks it in some modes"
            got = f"none for that at {lost.frequency:.5g} Hz, line {lost.line}"
            raise ArgumentError("scaling", words, got=got, where=named(path))
        if (masses > 0.0).all():
            return shapes, masses * mass
        if (of_a != 0.0).all():
            return shapes / np.sqrt(of_a * mass), UNIT_A
        raise ArgumentError("scaling", "be of one kind in a file", got="modal masses and modal A", where=named(path))
    stated = masses if scaling == UNIT_MASS else of_a if scaling == UNIT_A else np.zeros(len(modes))
    if ((stated != 0.0) & (np.abs(stated - 1.0) > ROUNDING)).any():
        warn_of([f"{scaling} in place of that of {named(path)}, {stated[np.argmax(np.abs(stated - 1.0))]:.5g}"])
    return (shapes / np.sqrt(mass), scaling) if isinstance(scaling, str) else (shapes, scaling)
