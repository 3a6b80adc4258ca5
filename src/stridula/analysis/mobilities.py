"""Mobilities: velocity of a point over the force at a point, over frequency."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import BodyPoint
from ..bodies.modes import Modes
from ..checks import ArgumentError, instance
from ..linear.structure import Structure
from ..lowering import assemble
from ..records.probes import Displacement
from ..records.variables import described
from ..system import System

# Number of default frequencies, spaced evenly on a logarithmic scale from half the lowest mode to the highest.
POINTS = 800
# Points at each peak, in half-widths from its mode; half-width of a mode without damping, relative to its frequency.
PEAK, SHARP = np.array([-4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0]), 1e-3


def mobility(
    response: BodyPoint,
    excitation: BodyPoint | None = None,
    *,
    direction: str | Sequence[float] = "y",
    excitation_direction: str | Sequence[float] | None = None,
    frequency: Any = None,
    system: System | None = None,
) -> xr.DataArray:
    """Return the mobility between two points: velocity of the one over the force at the other, over frequency.

    With the modes of the body, their traces a at the response and b at the excitation along the directions::

        Y(w) = i w sum_k a_k b_k / (w_k**2 - w**2 + i w d_k) + i w F

    F is the static flexibility of the modes that a cutoff left out, of a body that keeps it as residual shapes. The
    body is free of contact; with a `system` all its springs and dashpots act, between all its bodies, and all its
    contacts are open. Phases are those of ``exp(i w t)``. Where a body turns, points stay while its material passes,
    at the velocity at which it turns in the end.

    Parameters
    ----------
    response : BodyPoint
        The point whose velocity is meant.
    excitation : BodyPoint, optional
        The point at which the force acts: a transfer mobility; the driving-point mobility of `response` if left out.
    direction : {"y", "x", "z", "axial", "transverse"} or sequence of float, optional
        Direction of the velocity, as for a `Velocity`.
    excitation_direction : {"y", "x", "z", "axial", "transverse"} or sequence of float, optional
        Direction of the force, as `direction` if left out.
    frequency : array_like, shape (frequencies,), optional
        Frequencies [Hz]; if left out, from half the lowest mode to the highest one, close together about each mode.
    system : System, optional
        The system that the points are of; needed where they are of two bodies.

    Returns
    -------
    xarray.DataArray, shape (frequency,)
        The mobility [m/(N s)], complex; infinite exactly at a mode without damping. Divide by ``2j * pi * frequency``
        for the receptance [m/N], multiply by it for the accelerance [1/kg].

    Raises
    ------
    ValueError
        If an argument is out of its range, a point is of no body of the system, or there is no system and the points
        are of two bodies.

    Examples
    --------
    A steel beam on simple supports, driven in its middle and heard at a quarter of its length:

    >>> import stridula as st
    >>> steel = st.Material(2.1e11, 7800.0)
    >>> beam = st.ModalBeam(steel, st.Rectangle(0.02, 0.01), 0.8, damping=0.01)
    >>> point = st.mobility(beam.centre)
    >>> transfer = st.mobility(beam.at(0.2), beam.centre, frequency=[50.0, 100.0])
    >>> transfer.shape, transfer.attrs["units"]
    ((2,), 'm/(N s)')
    """
    driven = response if excitation is None else excitation
    along = direction if excitation_direction is None else excitation_direction
    ways = _way("response", response, direction), _way("excitation", driven, along)
    motion = _of_body(*ways) if system is None else _of_system(system, *ways)
    values = motion.frequencies if frequency is None else _checked(frequency)
    coordinates = {"frequency": ("frequency", values, {"units": "Hz", "long_name": "frequency"})}
    places = {"response": _place(ways[0], system), "excitation": _place(ways[1], system)}
    attributes = described("m/(N s)", "mobility") | places
    return xr.DataArray(motion.mobility(2.0 * np.pi * values), coordinates, ("frequency",), "mobility", attributes)


@dataclass(frozen=True)
class _Motion:
    """Modes under a force: ``mass q'' + damping q' + stiffness q = driven``, seen as ``seen q``.

    Attributes
    ----------
    mass : ndarray, shape (modes,)
        1, and 0 of residual shapes.
    stiffness, damping : ndarray, shape (modes, modes) or (modes,)
        As matrices, or their diagonals where no modes are coupled.
    seen, driven : ndarray, shape (modes,)
        Rows of the response and of the excitation [kg^(-1/2)].
    modes : list of Modes
        The modes about which peaks are expected.
    """

    mass: Array
    stiffness: Array
    damping: Array
    seen: Array
    driven: Array
    modes: list[Modes]

    def mobility(self, angular: Array) -> Array:
        """Return the mobility at angular frequencies [rad/s], shape (frequencies,)."""
        coupled = _off_diagonal(self.stiffness) | _off_diagonal(self.damping)
        shares, alone = self.seen * self.driven, ~coupled
        mass, stiffness, damping = (_diagonal(one)[alone] for one in (self.mass, self.stiffness, self.damping))
        dynamic = stiffness + 1j * angular[:, None] * damping - np.square(angular)[:, None] * mass
        met = (dynamic == 0.0) & (shares[alone] != 0.0)
        receptance = (shares[alone] / np.where(dynamic == 0.0, 1.0, dynamic)).sum(axis=1)
        if coupled.any():
            receptance += self._coupled(angular, coupled)
        found = np.asarray(1j * angular * receptance)
        found[met.any(axis=1)] = np.inf
        return found

    def _coupled(self, angular: Array, which: Array) -> Array:
        """Return the part of the modes that are coupled of the receptance."""
        mass, stiffness, damping = (
            _matrix(one)[np.ix_(which, which)] for one in (self.mass, self.stiffness, self.damping)
        )
        seen, driven = self.seen[which], self.driven[which]
        return np.array([seen @ np.linalg.solve(stiffness + 1j * w * damping - w**2 * mass, driven) for w in angular])

    @property
    def frequencies(self) -> Array:
        """Frequencies that resolve peaks and the valleys between them [Hz]."""
        natural = np.concatenate([one.frequency[~one.massless] for one in self.modes])
        damping = np.concatenate([one.damping[~one.massless] for one in self.modes])
        natural, damping = natural[natural > 0.0], damping[natural > 0.0]
        if not natural.size:
            raise ArgumentError("frequency", "be given for bodies that are rigid", got="none")
        about = natural[:, None] * (1.0 + np.where(damping > 0.0, damping, SHARP)[:, None] * PEAK)
        about[damping == 0.0, PEAK.size // 2] = np.nan
        between = np.geomspace(0.5 * natural.min(), natural.max(), POINTS)
        found = np.unique(np.concatenate([between, about.ravel()]))
        return found[(found > 0.0) & (found <= natural.max()) & ~np.isin(found, natural[damping == 0.0])]


def _matrix(given: Array) -> Array:
    return given if given.ndim == 2 else np.diag(given)


def _diagonal(given: Array) -> Array:
    return np.diag(given) if given.ndim == 2 else given


def _off_diagonal(given: Array) -> Array:
    """Return which modes a matrix couples to others, shape (modes,)."""
    if given.ndim == 1:
        return np.zeros(given.size, dtype=bool)
    others = given != 0.0
    np.fill_diagonal(others, False)
    return np.asarray(others.any(axis=0) | others.any(axis=1))


def _of_body(response: Displacement, excitation: Displacement) -> _Motion:
    """Return the modes of a body alone."""
    body: Any = response.body
    if body != excitation.body:
        words = "be on the body of the response, unless a system with both is given"
        raise ArgumentError("excitation", words, excitation.point)
    modes = body.modes()
    damping = modes.damping_rate if modes.damping_matrix is None else modes.damping_matrix
    stiffness, mass = modes.stiffness, np.where(modes.massless, 0.0, 1.0)
    if modes.turning is not None:
        stiffness, damping = _turned(modes.turning, _matrix(stiffness), _matrix(damping), mass)
    seen, driven = (_row(body, one) for one in (response, excitation))
    return _Motion(mass, stiffness, damping, seen, driven, [modes])


def _row(body: Any, way: Displacement) -> Array:
    trace = body.trace(way.point.position)
    return np.asarray(way.along[: len(trace)] @ trace)


def _turned(turning: Any, stiffness: Array, damping: Array, mass: Array) -> tuple[Array, Array]:
    """Return stiffness and damping of modes that are carried round, see `Structure`."""
    carried, pairs = np.zeros_like(stiffness), np.array(turning.pairs, dtype=int).reshape(-1, 2)
    rate = float(turning.rate(np.array([2.0 * (turning.history.settled or 0.0) + 1.0]))[0])
    (first, second), drag = pairs.T, rate * np.array(turning.drag)
    carried[first, second], carried[second, first] = drag, -drag
    carried *= mass
    return stiffness + carried @ carried + damping @ carried, damping + 2.0 * carried


def _of_system(system: System, response: Displacement, excitation: Displacement) -> _Motion:
    """Return the modes of all bodies of a system, joined by its springs and dashpots."""
    instance("system", system, System)
    for name, one in (("response", response), ("excitation", excitation)):
        if one.body not in system.bodies:
            raise ArgumentError(name, "be of a body of the system", one.point)
    turned = [one.modes().turning for one in system.bodies]
    settled = max((one.history.settled or 0.0 for one in turned if one is not None), default=0.0)
    structure = Structure(system, 2.0 * settled + 1.0)
    seen, driven = (probe.rows[0] for probe in assemble(system, [response, excitation]).probes)
    modes = [body.modes(system.is_held(body)) for body in system.bodies]
    return _Motion(structure.mass, structure.stiffness, structure.damping, seen, driven, modes)


def _way(name: str, point: Any, direction: Any) -> Displacement:
    """Return a point with its direction; errors name the argument."""
    instance(name, point, BodyPoint)
    try:
        return Displacement(point, direction)
    except ArgumentError as error:
        raise error.renamed("direction" if name == "response" else "excitation_direction") from None


def _place(way: Displacement, system: System | None) -> str:
    name = way.body.name if system is None else system.body_name(way.body)
    return f"{name} {way.place}".strip()


def _checked(frequency: Any) -> Array:
    """Return frequencies [Hz] as an array, if they are above 0."""
    try:
        values = np.atleast_1d(np.asarray(frequency, dtype=float))
    except (TypeError, ValueError):
        raise ArgumentError("frequency", "be numbers", frequency) from None
    if values.ndim != 1 or not values.size:
        raise ArgumentError("frequency", "be a list of numbers", frequency, got=f"an array of the shape {values.shape}")
    good = np.isfinite(values) & (values > 0.0)
    if not good.all():
        raise ArgumentError("frequency", "be finite and above 0 Hz", frequency, got=float(values[~good][0]))
    return values
