"""Modes of a modal test: frequencies, damping and complex shapes at measured points, with their scale."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, choice, counted, instance, listed
from ...disk import check_path, write
from ...doubtful import warn_of
from ..matrix_files import Nodes
from ..matrix_input import check_finite, numbers
from .file_modes import UNIT_A, UNIT_MASS, modes_of_file
from .modal_body import ModalBody
from .real_shapes import RealShapes, real_shapes
from .residues import shapes_of_residues, split
from .result_modes import ending_of, modes_of_results
from .universal_modes import GLOBAL, LOCAL
from .universal_writing import universal_text

# Share of the imaginary part in a shape above which taking its real part is doubtful [1]: a collinearity of 0.81.
LARGEST_LOSS = 0.05
# Phase of a scaled shape above which its scale is doubtful [rad].
LARGEST_TURN = 0.2


@dataclass(frozen=True, eq=False, repr=False)
class MeasuredModes:
    """Modes from a modal test.

    Residues of the receptance are those of shapes psi with modal masses m or modal A::

        H(w) = sum_k psi_j psi_k / (a (i w - p)) + conjugate,   a = 2 i w_d m for real shapes

    with ``p = -zeta w_0 + i w_d`` and ``w_d = w_0 sqrt(1 - zeta**2)`` (Ewins 2000, 2.7).

    Parameters
    ----------
    frequency : array_like, shape (modes,)
        Undamped frequencies [Hz].
    damping : float or array_like, shape (modes,)
        Damping ratios [1], below 1.
    shapes : array_like, shape (points, 3, modes)
        Displacements of the points along world x, y and z, real or complex; 0 along directions that were not measured.
    points : sequence of str
        Names of the points.
    scaling : {"unit modal mass", "unit modal A"}, float or array_like, optional
        Scale of the shapes: unit modal mass [kg], unit modal A [kg/s], or modal masses [kg], one or each. Without it
        only shapes are known, which `mac` compares.
    places : array_like, shape (points, 3), optional
        World places of the points [m].

    Raises
    ------
    ValueError
        If an argument is out of its range or does not fit the others.

    Examples
    --------
    >>> import stridula as st
    >>> modes = st.MeasuredModes([412.0], 0.004, [[[0.0], [0.0], [1.5]]], ["tip"], "unit modal mass")
    >>> body = modes.body()
    """

    frequency: Any
    damping: Any
    shapes: Any
    points: Sequence[str]
    scaling: Any = None
    places: Any = None

    def __post_init__(self) -> None:
        frequency = _numbers("frequency", self.frequency, ("modes",))
        size = frequency.size
        damping = numbers("damping", self.damping)
        damping = np.full(size, float(damping)) if damping.ndim == 0 else _numbers("damping", damping, (size,))
        for name, values, high in (("frequency", frequency, np.inf), ("damping", damping, 1.0)):
            wrong = np.flatnonzero(~((values >= 0.0) & (values < high)))
            if wrong.size:
                allowed = "0 or above" if high == np.inf else "from 0 to below 1"
                raise ArgumentError(f"{name}[{wrong[0]}]", f"be {allowed}", float(values[wrong[0]]))
        names = tuple(self.points) if not isinstance(self.points, str) else ()
        if not names or not all(isinstance(one, str) and one for one in names) or len(set(names)) != len(names):
            raise ArgumentError("points", "be different names of points", self.points)
        shapes = _shapes(self.shapes, len(names), size)
        places = None if self.places is None else _numbers("places", self.places, (len(names), 3))
        scaling = _scaling(self.scaling, frequency)
        given = {"frequency": frequency, "damping": damping, "shapes": shapes, "points": names, "places": places}
        for name, value in (*given.items(), ("scaling", scaling)):
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        low, high = (f"{value:.4g}" for value in (self.frequency.min(), self.frequency.max()))
        return (
            f"MeasuredModes({counted(self.frequency.size, 'mode')}, {low} to {high} Hz, points {listed(self.points)})"
        )

    @classmethod
    def read(
        cls,
        path: str | os.PathLike[str],
        scaling: Any = None,
        *,
        geometry: str | os.PathLike[str] | None = None,
        quantity: str | None = None,
        directions: str | None = None,
        scale: float | None = None,
        damping: Any = None,
    ) -> MeasuredModes:
        """Read the modes of a universal file, or those computed by CalculiX, Nastran or Ansys.

        Points have the numbers of their nodes as names. A universal file has shapes in dataset 55 or 2414, nodes in 15
        or 2411, systems in 2420, units in 164. Its frequencies of normal modes are taken as undamped ones; a hysteretic
        damping ratio counts half; points are where it moves them in at least one mode. Results of programs are those of
        modal analyses with real modes: ``.frd`` of CalculiX, as text or binary, ``.op2`` of Nastran, ``.rst`` of Ansys.
        All their nodes are points, without rotations.

        Parameters
        ----------
        path : str or Path
            The file.
        scaling : {"unit modal mass", "unit modal A"}, float or array_like, optional
            Scale of the shapes in place of the modal masses or modal A of the file: 1 in its units, or modal masses
            [kg]. A ``.rst`` has no scale: ``"unit modal mass"`` is the default of Ansys (MODOPT).
        geometry : str or Path, optional
            A universal file with the nodes, or the deck of a ``.op2``, if they are not in the same file.
        quantity : {"displacement"}, optional
            Confirms that shapes that the file calls velocities or accelerations have the scale of displacements.
        directions : {"global", "local"}, optional
            Directions of shapes at nodes with a displacement coordinate system of their own; needed there in universal
            files, and for the table OUGV1PAT of a ``.op2``.
        scale : float, optional
            Length of the unit of the file [m] where it states none, 1e-3 for mm with N and s; without it such a file is
            taken as SI, with a warning.
        damping : float, sequence of float, Rayleigh, RisingDamping or SampledDamping, optional
            Damping ratios [1] in place of those of the file; computed modes have none without it.

        Returns
        -------
        MeasuredModes
            The modes by rising frequency; without a scale if neither the file nor `scaling` gives one.

        Raises
        ------
        ValueError
            If the file has no modes, a line or a record cannot be read, or an argument contradicts the file; the
            message has file and place.
        OSError
            If it cannot be read.
        """
        check_path("path", path)
        if quantity is not None:
            choice("quantity", quantity, ("displacement",))
        if directions is not None:
            choice("directions", directions, (GLOBAL, LOCAL))
        if not ending_of(path):
            return cls(**modes_of_file(path, scaling, geometry, quantity, directions, damping, scale))
        if quantity is not None:
            raise ArgumentError("quantity", "be left out for results, which have displacements", quantity)
        return cls(**modes_of_results(path, scaling, damping, scale, geometry, directions))

    @classmethod
    def from_residues(
        cls,
        poles: Any,
        residues: Any,
        responses: Sequence[str],
        excitations: Sequence[str],
        places: Mapping[str, Sequence[float]] | None = None,
    ) -> MeasuredModes:
        """Return the modes of residues and poles of receptances.

        The residue of a mode is taken as the nearest product of its shape at responses and at excitations, whose scale
        follows from the points with both.

        Parameters
        ----------
        poles : array_like, shape (modes,)
            Poles above the real axis [rad/s].
        residues : array_like, shape (responses, excitations, modes)
            Residues of the receptance [m/(N s)].
        responses, excitations : sequence of str
            Points and directions, such as ``"7 +Z"``; at least one is both.
        places : mapping, optional
            World places (x, y, z) of the points [m], by name.

        Returns
        -------
        MeasuredModes
            The modes with unit modal A.

        Raises
        ------
        ValueError
            If no point and direction is both a response and an excitation, or an argument does not fit.
        """
        poles, shapes = shapes_of_residues(poles, residues, tuple(responses), tuple(excitations))
        points, shapes = split(tuple(responses), shapes)
        found = None if places is None else _places(places, points)
        order = np.argsort(np.abs(poles), kind="stable")
        poles, shapes = poles[order], shapes[:, :, order]
        size = np.abs(poles)
        return cls(size / (2.0 * np.pi), -poles.real / size, shapes, points, UNIT_A, found)

    @cached_property
    def normalised(self) -> Array:
        """Complex shapes of unit modal mass [kg^(-1/2)], shape (points, 3, modes).

        Raises
        ------
        ValueError
            If the scale is not known.
        """
        if self.scaling is None:
            raise ArgumentError("scaling", f"be {UNIT_MASS!r}, {UNIT_A!r} or modal masses [kg]", got="none")
        if self._is_scaled(UNIT_MASS):
            return np.asarray(self.shapes)
        if self._is_scaled(UNIT_A):
            damped = 2.0 * np.pi * self.frequency * np.sqrt(1.0 - self.damping**2)
            return np.asarray(self.shapes * np.sqrt(2j * damped))
        return np.asarray(self.shapes / np.sqrt(self.scaling))

    @property
    def collinearity(self) -> Array:
        """Modal phase collinearity of the shapes [1], shape (modes,): 1 for real shapes."""
        return self._real(self.shapes).collinearity

    @property
    def imaginary_share(self) -> Array:
        """Share of the square of each shape that `body` loses [1], shape (modes,)."""
        return self._real(self.shapes).lost

    def body(self, points: Mapping[str, Any] | None = None, name: str = "") -> ModalBody:
        """Return a body with these modes.

        Complex shapes are rotated to the phase of their largest real part, which is kept. A shape that loses more than
        a twentieth of its square, or that its scale puts out of phase, is mentioned in a warning. Modes above those
        measured are left out with their flexibility: the body is too stiff at rest, and its mobility between
        resonances is that of these modes alone.

        Parameters
        ----------
        points : mapping, optional
            Measured points, or the places of measured points [m], by their new names: ``{"tip": "7"}``,
            ``{"tip": (0.1, 0.0, 0.02)}``; all with their own names if left out.
        name : str, optional
            Name in records.

        Returns
        -------
        ModalBody
            A body in space, without gravity and surface.

        Raises
        ------
        ValueError
            If the scale is not known, or a point is not measured, or none is at a place.
        """
        given = dict(zip(self.points, self.points, strict=True)) if points is None else points
        instance("points", given, Mapping)
        real = self._real(self.normalised)
        warn_of(_losses(real, self))
        shapes = real.shapes.reshape(self.shapes.shape)
        at = self._rows(given)
        angular = 2.0 * np.pi * self.frequency
        places = None if self.places is None else {new: self.places[row] for new, row in at.items()}
        rows = {new: shapes[row] for new, row in at.items()}
        return ModalBody(angular, rows, 2.0 * self.damping * angular, name=name, places=places)

    def _rows(self, given: Mapping[str, Any]) -> dict[str, int]:
        """Return the rows of points that are given by name or place."""
        row = {name: number for number, name in enumerate(self.points)}
        found = {}
        for new, old in given.items():
            word = f"points[{new!r}]"
            if isinstance(old, str) or not np.iterable(old):
                found[new] = row[old] if isinstance(old, str) and old in row else row[choice(word, old, self.points)]
            elif self.places is None:
                raise ArgumentError(word, "be the name of a measured point where places are not known", old)
            else:
                place = _numbers(word, old, (3,))
                found[new] = Nodes(np.arange(len(self.points)), self.places).nearest(word, place.tolist())
        return found

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the modes as a universal file: units of 164, nodes of 2411, shapes of 55 with their scale.

        Parameters
        ----------
        path : str or Path
            The file; points must have whole numbers as names.

        Raises
        ------
        ValueError
            If a name is not a number above 0.
        OSError
            If it cannot be written.
        """
        wrong = [one for one in self.points if not (one.isascii() and one.isdigit() and 0 < int(one) < 10**9)]
        if wrong:
            raise ArgumentError("points", "have numbers above 0 as names in a universal file", wrong[0])
        masses = np.zeros(self.frequency.size) if self.scaling is None else np.ones(self.frequency.size)
        masses = masses if self.scaling is None or isinstance(self.scaling, str) else self.scaling
        modes = self.frequency, self.damping, masses, self._is_scaled(UNIT_A)
        write(path, universal_text(list(map(int, self.points)), self.places, self.shapes, modes).encode("ascii"))

    def _is_scaled(self, word: str) -> bool:
        """Return whether the scaling is that of a word."""
        return isinstance(self.scaling, str) and self.scaling == word

    def _real(self, shapes: Array) -> RealShapes:
        return real_shapes(shapes.reshape(-1, self.frequency.size))


def _losses(real: RealShapes, modes: MeasuredModes) -> list[str]:
    """Return a doubt about each mode whose real part is not enough."""
    doubts = []
    for number, (lost, turned) in enumerate(zip(real.lost, real.turned, strict=True)):
        mode = f"mode {number + 1} at {modes.frequency[number]:.5g} Hz"
        if lost > LARGEST_LOSS:
            alike = real.collinearity[number]
            doubts.append(f"{mode} is complex: its real part leaves out {lost:.2g} of it (collinearity {alike:.2g})")
        elif modes._is_scaled(UNIT_A) and abs(turned) > LARGEST_TURN:
            doubts.append(f"{mode} is {np.degrees(turned):.3g} degrees out of phase with its modal A")
    return doubts


def _numbers(name: str, value: Any, shape: tuple[Any, ...]) -> Array:
    """Return finite numbers of a shape, in which a text stands for any size of 1 or more."""
    array = numbers(name, value)
    fits = array.ndim == len(shape) and all(
        got > 0 if isinstance(size, str) else got == size for got, size in zip(array.shape, shape, strict=True)
    )
    if not fits:
        raise ArgumentError(name, f"have the shape ({', '.join(map(str, shape))})", value, got=array.shape)
    check_finite(name, array)
    return array


def _shapes(value: Any, points: int, modes: int) -> Array:
    """Return complex shapes, shape (points, 3, modes), after checks."""
    try:
        array = np.array(value, dtype=complex)
    except (TypeError, ValueError):
        raise ArgumentError("shapes", "be an array of numbers", value) from None
    if array.shape != (points, 3, modes):
        raise ArgumentError("shapes", f"have the shape ({points}, 3, {modes})", value, got=array.shape)
    if not np.isfinite(array).all():
        point, direction, mode = np.argwhere(~np.isfinite(array))[0]
        where = f"point {point}, direction {direction}, mode {mode} (from 0)"
        raise ArgumentError("shapes", "be finite", got=f"{array[point, direction, mode]} at {where}")
    still = np.flatnonzero(~array.any(axis=(0, 1)))
    if still.size:
        raise ArgumentError("shapes", "move a point in every mode", got=f"none in mode {still[0]} (from 0)")
    return array


def _places(places: Any, points: Sequence[str]) -> list[Array]:
    """Return the places of points, which are given by name."""
    instance("places", places, Mapping)
    for name in points:
        if name not in places:
            raise ArgumentError("places", "have a place of each point", got=f"none of {name!r}")
    return [_numbers(f"places[{name!r}]", places[name], (3,)) for name in points]


def _scaling(value: Any, frequency: Array) -> Any:
    """Return a scaling after checks: None, its name, or modal masses [kg], shape (modes,)."""
    if value is None or isinstance(value, str):
        given = None if value is None else choice("scaling", value, (UNIT_MASS, UNIT_A))
        if given == UNIT_A and not frequency.all():
            raise ArgumentError("frequency", "be above 0 Hz with unit modal A", got="0 Hz")
        return given
    masses = numbers("scaling", value)
    masses = (
        np.full(frequency.size, float(masses)) if masses.ndim == 0 else _numbers("scaling", masses, frequency.shape)
    )
    wrong = np.flatnonzero(~((masses > 0.0) & np.isfinite(masses)))
    if wrong.size:
        raise ArgumentError("scaling", "be modal masses above 0 kg", got=f"{masses[wrong[0]]} for mode {wrong[0] + 1}")
    return masses
