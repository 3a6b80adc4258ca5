"""Modes of measured mobilities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import MeasuredModes
from ..bodies.matrix_input import numbers
from ..checks import ArgumentError, count, instance, listed
from ..doubtful import warn_of
from .pole_fit import fitted_poles, residues_of
from .pole_search import HIGHEST_DAMPING, stable_poles

HIGHEST_ORDER = 50
# Damping ratio with which a search from given frequencies begins.
FIRST_DAMPING = 0.01
# Share of the square of the mobilities that a fit may leave out without a warning.
LARGEST_ERROR = 0.05
# Rounds in which modes are sought in what the fit leaves out, the share of the square that is due to rounding, and how
# many times more than by fitting noise a further mode must lessen the error.
ROUNDS, ROUNDING, CLEAR = 4, 1e-10, 4.0
DIMENSIONS = ("response", "excitation", "frequency")


def identify_modes(
    measured: xr.DataArray,
    modes: Sequence[float] | None = None,
    *,
    band: Sequence[float] | None = None,
    places: Mapping[str, Sequence[float]] | None = None,
    highest_order: int = HIGHEST_ORDER,
) -> MeasuredModes:
    """Return the modes of measured mobilities.

    Poles that stay the same while the order of a fit with one denominator rises are modes; they are sought again in
    what the fit of these leaves out. From there poles are those of the least error of all functions together, with
    real terms for modes above and below the band, which the result lacks. Residues give shapes with unit modal A, see
    `MeasuredModes.from_residues`; with more excitations than responses, they are used by reciprocity.

    Parameters
    ----------
    measured : xarray.DataArray, shape (response, excitation, frequency)
        Mobilities [m/(N s)] as from `read_mobilities`. At least one response is also an excitation.
    modes : sequence of float, optional
        Frequencies of the modes [Hz], with which the search begins instead.
    band : sequence of float, length 2, optional
        Lowest and highest frequency to use [Hz]; all if left out.
    places : mapping, optional
        World places (x, y, z) of the points [m] by name.
    highest_order : int, optional
        Highest order of the fit with one denominator, several times the number of modes.

    Returns
    -------
    MeasuredModes
        The modes, with complex shapes.

    Raises
    ------
    ValueError
        If no pole stays, a mode is not in the band or does not decay, or no response is an excitation.

    Warns
    -----
    DoubtfulValue
        If more than a twentieth of the square of the mobilities is left out.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> import stridula as st
    >>> beam = st.ModalBeam(st.Material(7e10, 2700.0), st.Rectangle(0.02, 0.005), 0.4, cutoff=900.0, damping=0.005)
    >>> frequency, names = np.arange(20.0, 900.0, 0.5), ["1 +Y", "2 +Y"]
    >>> points = [beam.at(0.1), beam.at(0.27)]
    >>> rows = [[st.mobility(one, points[0], frequency=frequency).values] for one in points]
    >>> measured = xr.DataArray(
    ...     rows,
    ...     {"response": names, "excitation": names[:1], "frequency": frequency},
    ...     ("response", "excitation", "frequency"),
    ... )
    >>> found = st.identify_modes(measured)
    >>> bool(np.allclose(found.damping, 0.005))
    True
    """
    frequency, values, responses, excitations = _checked(measured, band)
    count("highest_order", highest_order, 4, 400)
    functions = values.reshape(-1, frequency.size)
    angular = 2.0 * np.pi * frequency
    if modes is None:
        poles = _found(frequency, functions, highest_order)
    else:
        begun = 2.0 * np.pi * _given(modes, frequency)
        poles = fitted_poles(angular, functions, begun * (1j - FIRST_DAMPING))
    poles = poles[np.argsort(poles.imag)]
    _check(poles, frequency)
    residues, fit = residues_of(angular, functions, poles)
    lost = _error(functions, fit)
    if lost > LARGEST_ERROR:
        warn_of([f"the modes leave out {lost:.2g} of the square of the mobilities"])
    shaped = residues.reshape(len(responses), len(excitations), poles.size)
    return MeasuredModes.from_residues(poles, shaped, responses, excitations, places)


def _found(frequency: Array, functions: Array, highest_order: int) -> Array:
    """Return poles that stay, then those of what their fit leaves out if they lessen it."""
    angular = 2.0 * np.pi * frequency
    poles = stable_poles(frequency, functions, highest_order)
    if not poles.size:
        raise ArgumentError("modes", "be given where no pole stays while the order of the fit rises", got="none")
    poles = fitted_poles(angular, functions, poles)
    for _ in range(ROUNDS):
        fit = residues_of(angular, functions, poles)[1]
        lost = _error(functions, fit)
        further = stable_poles(frequency, functions - fit, highest_order) if lost > ROUNDING else poles[:0]
        added = _lessening(angular, functions, poles, further)
        if added.size == poles.size:
            break
        poles = added
    return poles


def _lessening(angular: Array, functions: Array, poles: Array, further: Array) -> Array:
    """Return poles with those further ones that lessen the error by clearly more than by fitting noise."""
    lost = _error(functions, residues_of(angular, functions, poles)[1])
    # Real numbers of a mode over those of the functions.
    share = (1.0 + len(functions)) / (len(functions) * angular.size)
    for pole in further:
        more = fitted_poles(angular, functions, np.append(poles, pole))
        left = _error(functions, residues_of(angular, functions, more)[1])
        if _decay(more, angular / (2.0 * np.pi)).all() and left < lost * (1.0 - CLEAR * share):
            poles, lost = more, left
    return poles


def _error(functions: Array, fit: Array) -> float:
    """Return the share of the square of functions that a fit leaves out [1]."""
    return float(np.sum(np.abs(functions - fit) ** 2) / np.sum(np.abs(functions) ** 2))


def _decay(poles: Array, frequency: Array) -> Array:
    """Return which poles are of modes in the band that decay."""
    ratio = -poles.real / np.abs(poles)
    ends = 2.0 * np.pi * frequency[[0, -1]]
    return np.asarray((ratio > 0.0) & (ratio < HIGHEST_DAMPING) & (poles.imag > ends[0]) & (poles.imag < ends[1]))


def _check(poles: Array, frequency: Array) -> None:
    wrong = poles[~_decay(poles, frequency)]
    if wrong.size:
        pole = wrong[0]
        words = f"lead to modes from {frequency[0]:.5g} to {frequency[-1]:.5g} Hz with damping ratios up to"
        got = f"{abs(pole) / (2.0 * np.pi):.5g} Hz with {-pole.real / abs(pole):.3g}"
        raise ArgumentError("modes", f"{words} {HIGHEST_DAMPING:g}", got=got)


def _given(modes: Any, frequency: Array) -> Array:
    """Return frequencies of modes [Hz] as an array."""
    given = np.atleast_1d(numbers("modes", modes))
    inside = (given > frequency[0]) & (given < frequency[-1])
    if given.ndim != 1 or not given.size or not inside.all() or np.unique(given).size < given.size:
        words = f"be different frequencies from {frequency[0]:.5g} to {frequency[-1]:.5g} Hz"
        raise ArgumentError("modes", words, modes)
    return given


def _checked(measured: Any, band: Any) -> tuple[Array, Array, tuple[str, ...], tuple[str, ...]]:
    """Return frequencies [Hz], mobilities, responses and excitations, of which there are no more than responses."""
    instance("measured", measured, xr.DataArray)
    if set(measured.dims) != set(DIMENSIONS) or "frequency" not in measured.coords:
        raise ArgumentError("measured", f"have the dimensions {', '.join(DIMENSIONS)}", got=listed(measured.dims))
    ordered = measured.transpose(*DIMENSIONS)
    frequency, values = ordered["frequency"].values.astype(float), ordered.values.astype(complex)
    if str(measured.attrs.get("units", "m/(N s)")) != "m/(N s)":
        raise ArgumentError("measured", "be mobilities in m/(N s)", got=repr(measured.attrs["units"]))
    if not np.isfinite(values).all() or not np.isfinite(frequency).all() or (np.diff(frequency) <= 0.0).any():
        raise ArgumentError("measured", "be finite, over rising frequencies", got="others")
    if band is not None:
        ends = numbers("band", band)
        if ends.shape != (2,):
            raise ArgumentError("band", "be the lowest and the highest frequency [Hz]", band)
        kept = (frequency >= ends[0]) & (frequency <= ends[1])
        frequency, values = frequency[kept], values[..., kept]
    if frequency.size < 16 or frequency[0] <= 0.0 or not values.any():
        raise ArgumentError("measured", "have at least 16 frequencies above 0 Hz in the band", got=frequency.size)
    names = [tuple(map(str, ordered[word].values)) for word in DIMENSIONS[:2]]
    if len(names[1]) > len(names[0]):
        return frequency, values.swapaxes(0, 1), names[1], names[0]
    return frequency, values, names[0], names[1]
