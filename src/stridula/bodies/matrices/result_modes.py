"""Modes computed by other programs as arguments of `MeasuredModes`: in SI, by rising frequency, with one scale."""

from __future__ import annotations

import os
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, choice, positive
from ...disk import check_path, named
from ...doubtful import LeftOut, warn_of
from ..damping import checked_damping, damping_rates
from ..reading.deck_error import DeckError
from ..result_files.computed_modes import ComputedModes, Units
from ..result_files.frd import read_frd
from ..result_files.mapdl import read_rst
from ..result_files.nastran_nodes import NastranNodes, nodes_of_deck
from ..result_files.op2 import read_op2

UNIT_MASS = "unit modal mass"
# Results of programs by the endings of their files, and ways to give those of others.
RESULTS = (".frd", ".op2", ".rst")
OTHERS = {
    ".odb": "export the shapes of Abaqus as a universal file, or its matrices (*MATRIX GENERATE) for ReducedBody.read",
    ".fil": "export the shapes of Abaqus as a universal file, or its matrices (*MATRIX GENERATE) for ReducedBody.read",
    ".f06": "write binary results beside it, PARAM,POST,-1",
    ".pch": "write binary results in its place, PARAM,POST,-1",
    ".xdb": "write binary results in its place, PARAM,POST,-1",
    ".h5": "write binary results of Nastran beside it, PARAM,POST,-1",
    ".mode": "expand the modes (MXPAND) and read the .rst",
    ".full": "expand the modes (MXPAND) and read the .rst, or pass its matrices to ReducedBody.read",
    ".rth": "read the .rst of a modal analysis",
    ".cdb": "it is a model without results: read the .rst of a modal analysis",
    ".rmed": "export the shapes as a universal file (IMPR_RESU, FORMAT='IDEAS')",
    ".med": "export the shapes as a universal file (IMPR_RESU, FORMAT='IDEAS')",
}
# Relative difference between a given scale and that of a file, and of two frequencies, that is due to rounding.
ROUNDING = 1e-4
# Size of numbers from which their squares overflow.
LARGEST = 1e100
# Cosine of the angle of two shapes above which they are the same.
ALIKE = 0.999


def ending_of(path: str | os.PathLike[str]) -> str:
    """Return the ending of a file of results, or empty for another one.

    Raises
    ------
    ValueError
        If the ending is that of results that are not read; the message says which are.
    """
    check_path("path", path)
    ending = Path(path).suffix.lower()
    if ending in OTHERS:
        allowed = f"be modes in a universal file or in results {', '.join(RESULTS)}: {OTHERS[ending]}"
        raise ArgumentError("path", allowed, str(path), got=named(path))
    return ending if ending in RESULTS else ""


def modes_of_results(
    path: str | os.PathLike[str],
    scaling: Any,
    damping: Any,
    scale: float | None,
    geometry: str | os.PathLike[str] | None,
    directions: str | None,
) -> dict[str, Any]:
    """Return the arguments of `MeasuredModes` from a file of results; its `read` documents the parameters."""
    found = _read(path, geometry, directions)
    units = _units(found, scale, path)
    # The unit of mass is that of force over length, for a second.
    mass = units.length / units.force
    order = _moving(found, path)
    frequency, shapes = found.frequency[order], found.shapes[:, :, order]
    _check_once(found, order, path)
    shapes, given = _scaled(shapes, None if found.masses is None else found.masses[order], scaling, mass, path)
    return {
        "frequency": frequency,
        "damping": ratios(0.0 if damping is None else damping, frequency),
        "shapes": shapes,
        "points": list(map(str, found.nodes.tolist())),
        "scaling": given,
        "places": found.places / units.length,
    }


def ratios(damping: Any, frequency: Array) -> Any:
    """Return damping ratios [1] for modes of frequencies [Hz]: one, one for each, or those of a law."""
    checked = checked_damping(damping)
    if isinstance(checked, (float, int, tuple)):
        return checked
    rates, angular = damping_rates(checked, 2.0 * np.pi * frequency), 2.0 * np.pi * frequency
    if (rates[angular == 0.0] > 0.0).any():
        raise ArgumentError("damping", "have no share of mass where a file has rigid motions of 0 Hz", damping)
    return np.divide(rates, 2.0 * angular, out=np.zeros_like(rates), where=angular > 0.0)


def _read(
    path: str | os.PathLike[str], geometry: str | os.PathLike[str] | None, directions: str | None
) -> ComputedModes:
    """Return the modes of a file, after warnings about what is left out."""
    ending = ending_of(path)
    if ending != ".op2":
        for name, value in (("geometry", geometry), ("directions", directions)):
            if value is not None:
                raise ArgumentError(name, f"be left out for {ending}, which has nodes and global directions", value)
    nodes = None if geometry is None else _nodes(geometry)
    readers: dict[str, Callable[[], ComputedModes]] = {
        ".frd": lambda: read_frd(path),
        ".op2": lambda: read_op2(path, nodes, directions),
        ".rst": lambda: read_rst(path),
    }
    try:
        # Numbers of damaged files are checked after they are converted.
        with np.errstate(all="ignore"):
            found = readers[ending]()
    except DeckError as error:
        raise ValueError(f"cannot read {named(path)}: {error}") from None
    for word, array in (("place", found.places), ("displacement", found.shapes), ("frequency", found.frequency)):
        if not (np.abs(array) < LARGEST).all():
            raise ValueError(
                f"cannot read {named(path)}: a {word} is not finite, or {LARGEST:g} and more: it is damaged"
            )
    warn_of([f"{named(path)}: {words}" for words in found.doubts], LeftOut)
    return found


def _nodes(path: str | os.PathLike[str]) -> NastranNodes:
    """Return the nodes of a deck of Nastran."""
    check_path("geometry", path)
    try:
        return nodes_of_deck(path)
    except DeckError as error:
        raise ValueError(f"cannot read {named(path)}: {error}") from None


def _units(found: ComputedModes, scale: float | None, path: str | os.PathLike[str]) -> Units:
    """Return the units of a file: those that it states, or metres of the scale with newtons."""
    given = None if scale is None else Units(1.0 / positive("scale", scale), 1.0)
    if found.units is None:
        if given is None:
            words = "has no units: taken as SI; pass scale=1.0 if it is, scale=1e-3 for mm, N and s"
            warn_of([f"{named(path)} {words}"])
        return given or Units(1.0, 1.0)
    if given is not None and not np.isclose(given.length, found.units.length, rtol=ROUNDING):
        allowed = f"be {1.0 / found.units.length:g}, as the file states, or left out"
        raise ArgumentError("scale", allowed, scale, where=named(path))
    return found.units


def _moving(found: ComputedModes, path: str | os.PathLike[str]) -> Array:
    """Return the modes that move nodes, by rising frequency, after a warning about those that only turn them."""
    moves = np.asarray(found.shapes.any(axis=(0, 1)))
    if not moves.any():
        raise ValueError(f"cannot read {named(path)}: its modes move no node along x, y or z")
    warn_of(
        [
            f"{named(path)}: {found.where[at]} at {found.frequency[at]:.5g} Hz only turns nodes and is left out"
            for at in np.flatnonzero(~moves)
        ],
        LeftOut,
    )
    order = np.argsort(found.frequency, kind="stable")
    return np.asarray(order[moves[order]])


def _check_once(found: ComputedModes, order: Array, path: str | os.PathLike[str]) -> None:
    """Raise ValueError if a file has a mode twice, such as from two steps: both would vibrate."""
    for one, other in pairwise(order.tolist()):
        low, high = found.frequency[one], found.frequency[other]
        first, second = found.shapes[:, :, one], found.shapes[:, :, other]
        sizes = np.linalg.norm(first) * np.linalg.norm(second)
        if high - low <= ROUNDING * high and abs(np.vdot(first, second)) > ALIKE * sizes > 0.0:
            words = f"the mode at {high:.6g} Hz is there twice, also as {found.where[one]}"
            raise ValueError(f"cannot read {named(path)}: {found.where[other]}: {words}")


def _scaled(
    shapes: Array, masses: Array | None, scaling: Any, mass: float, path: str | os.PathLike[str]
) -> tuple[Array, Any]:
    """Return shapes of modes and their scaling; `mass` is the unit of mass of the file [kg]."""
    if scaling is None:
        return shapes, None if masses is None else masses * mass
    if not isinstance(scaling, str):
        return shapes, scaling
    choice("scaling", scaling, (UNIT_MASS,))
    if masses is not None and (np.abs(masses - 1.0) > ROUNDING).any():
        warn_of([f"{scaling} in place of that of {named(path)}, {masses[np.argmax(np.abs(masses - 1.0))]:.5g}"])
    return shapes / np.sqrt(mass), scaling
