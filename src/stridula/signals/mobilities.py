"""Measured mobilities: frequency response functions of universal files, dataset 58."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, choice, listed
from ..disk import check_path, named
from .channels import UNKNOWN
from .universal_files import Function, read_functions

FREQUENCY_RESPONSE = 4
# Types of data of the response: its quantity, and the power of i w by which it is divided for a velocity.
QUANTITIES = {8: "receptance", 11: "mobility", 12: "accelerance"}
POWERS = {"receptance": -1, "mobility": 0, "accelerance": 1}
EXCITATIONS = (9, 13)
# Units of responses and of forces in SI.
GRAVITY = 9.80665
LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "in": 0.0254}
RESPONSES = {
    "receptance": LENGTHS,
    "mobility": {f"{word}/s": size for word, size in LENGTHS.items()},
    "accelerance": {f"{word}/s2": size for word, size in LENGTHS.items()} | {"g": GRAVITY, "gn": GRAVITY},
}
FORCES = {"N": 1.0, "kN": 1e3, "mN": 1e-3, "lbf": 4.4482216152605}
# Largest relative difference of frequencies of functions, beyond rounding to six digits.
SAME = 2e-5


def read_mobilities(path: str | os.PathLike[str], *, quantity: str | None = None) -> xr.DataArray:
    """Read measured frequency response functions of a universal file as mobilities.

    Receptances and accelerances are converted with ``i w``, units to SI by their labels, else by dataset 164. A line at
    0 Hz is left out.

    Parameters
    ----------
    path : str or Path
        The file, with functions of type 4 in dataset 58, as text or binary.
    quantity : {"receptance", "mobility", "accelerance"}, optional
        What the functions are where the file does not state the type of its data.

    Returns
    -------
    xarray.DataArray, shape (response, excitation, frequency)
        Mobilities [m/(N s)], complex, with labels such as ``7 +Z``. `identify_modes` takes them, `plot.mobility` one
        of them: ``found.sel(response="7 +Z", excitation="1 +Z")``.

    Raises
    ------
    ValueError
        If the file has no such functions, they do not have the same frequencies, one occurs twice or is missing between
        a response and an excitation, or units are not known; the message names the file.
    OSError
        If it cannot be read.
    """
    check_path("path", path)
    if quantity is not None:
        choice("quantity", quantity, tuple(POWERS))
    functions, factors = read_functions(Path(path))
    found = [one for one in functions if one.kind == FREQUENCY_RESPONSE]
    if not found:
        raise ArgumentError("path", "have frequency response functions, type 4 of dataset 58", str(path), got="none")
    frequency = _frequencies(found, path)
    pairs: dict[tuple[str, str], Array] = {}
    for one in found:
        pair = one.place, one.reference
        if pair in pairs:
            raise ValueError(f"{path}, line {one.line}: the function from {pair[1]!r} to {pair[0]!r} is there twice")
        pairs[pair] = _mobility(one, frequency, quantity, factors, path)
    responses, excitations = (list(dict.fromkeys(pair[k] for pair in pairs)) for k in (0, 1))
    lost = [(one, other) for one in responses for other in excitations if (one, other) not in pairs]
    if lost:
        words = f"have each response for each excitation, {len(responses)} times {len(excitations)}"
        got = f"none from {lost[0][1]!r} to {lost[0][0]!r}"
        raise ArgumentError("path", words, str(path), got=got, where=named(path))
    values = np.array([[pairs[one, other] for other in excitations] for one in responses])
    kept = frequency > 0.0
    coordinates = {
        "response": responses,
        "excitation": excitations,
        "frequency": ("frequency", frequency[kept], {"units": "Hz", "long_name": "frequency"}),
    }
    attributes = {"units": "m/(N s)", "long_name": "measured mobility"}
    return xr.DataArray(values[..., kept], coordinates, ("response", "excitation", "frequency"), "mobility", attributes)


def _frequencies(found: Sequence[Function], path: str | os.PathLike[str]) -> Array:
    """Return the frequencies that all functions have [Hz]."""
    first = found[0].abscissa
    for one in found:
        given = one.abscissa
        if given.size != first.size or np.abs(given - first).max() > SAME * first.max():
            words = f"have the {first.size} frequencies of that of line {found[0].line}, {_span(first)}"
            raise ValueError(f"{path}, line {one.line}: a function must {words}, got {given.size}, {_span(given)}")
    if first.size < 2 or first[0] < 0.0 or (np.diff(first) <= 0.0).any():
        raise ValueError(f"{path}, line {found[0].line}: frequencies must rise from 0 Hz or above")
    return first


def _span(given: Array) -> str:
    return f"{given.min():.6g} to {given.max():.6g} Hz" if given.size else "none"


def _mobility(
    one: Function,
    frequency: Array,
    quantity: str | None,
    factors: tuple[float, float] | None,
    path: str | os.PathLike[str],
) -> Array:
    """Return a function as a mobility [m/(N s)]."""
    where = f"{path}, line {one.line}"
    stated = QUANTITIES.get(one.data)
    if stated is None and (quantity is None or one.data):
        words = "be displacement (8), velocity (11) or acceleration (12)"
        more = "" if one.data else f"; pass quantity={' or '.join(map(repr, POWERS))}"
        raise ValueError(f"{where}: the response must {words}, got type {one.data}{more}")
    if stated is not None and quantity is not None and stated != quantity:
        raise ArgumentError("quantity", f"be that of the file, {stated}", quantity, where=where)
    if one.over not in EXCITATIONS and (quantity is None or one.over):
        raise ValueError(f"{where}: the excitation must be a force (13), got type {one.over}")
    known = stated or str(quantity)
    scale = _scale(where, "response", one.units, RESPONSES[known], factors, 0)
    scale /= _scale(where, "force", one.over_units, FORCES, factors, 1)
    angular = 2j * np.pi * np.where(frequency > 0.0, frequency, 1.0)
    return np.asarray(one.values * scale * angular ** -POWERS[known])


def _scale(
    where: str, word: str, units: str, known: dict[str, float], factors: tuple[float, float] | None, place: int
) -> float:
    """Return the size of a unit in SI, by its label or else by the factors of dataset 164."""
    if units != UNKNOWN:
        if units not in known:
            raise ValueError(f"{where}: the unit of the {word} must be one of {listed(known)}, got {units!r}")
        return known[units]
    if factors is None:
        raise ValueError(f"{where}: the unit of the {word} must be in its label or in dataset 164, got neither")
    return 1.0 / factors[place]
