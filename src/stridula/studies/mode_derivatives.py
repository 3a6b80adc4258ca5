"""Derivatives of the modes of sliding by parameters of the system, and what a finite change of each does."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bars.line_bars import Show
from ..bodies import BodyPoint
from ..checks import ArgumentError, brief, by_key, count, instance, listed, non_negative, positive
from ..integration.bars import bar_if
from ..linear.equilibrium import JAMMED, Equilibrium, find_equilibrium
from ..linear.given import Status, Velocity, given_status, given_velocity
from ..linear.mode_groups import ModeGroup, group_of
from ..linear.modes import ROUND_OFF, modes_of, round_off
from ..linear.pencils import Pencil, by_mass, combined, displacement_rows, pencil_of, turned_onto
from ..linear.structure import Structure
from ..linear.vibration import Exponents, vibration
from ..records.variables import described
from ..scenarios.load import scenario_of_tables
from ..system import System
from .loci import origin_of
from .task import one_thread_each
from .values_by_key import Value, all_values, is_written, si_tables, value_of

# Modes in the result where none grows: those that decay least.
FEWEST = 5
# Changes of a parameter, relative to it, at which matrices are differenced, with an error of the fourth order: shorter
# ones where a longer one meets another mesh or another status, or where matrices bend too much.
STEPS = (1e-3, 1e-4, 1e-5)
PLACES = (-2.0, -1.0, 1.0, 2.0)
SLOPE = (1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0)
# The fourth difference, with the middle last, vanishes for whatever is smooth.
KINK = (1.0, -4.0, -4.0, 1.0, 6.0)
# Largest kink relative to the derivative, beyond round-off of matrices: this many times that of the highest frequency.
UNEVEN, ROUNDINGS = 1e-5, 100.0
Source = str | Path | xr.Dataset | System
Where = BodyPoint | tuple[str, Any]


def mode_sensitivity(
    source: Source,
    parameters: Sequence[str] | None = None,
    *,
    masses: Mapping[str, Where] | None = None,
    change: float = 0.1,
    overrides: Mapping[str, Any] | None = None,
    modes: int | None = None,
    near: float | None = None,
    status: Status | None = None,
    velocity: Velocity | None = None,
    time: float | None = None,
    progress: bool = False,
) -> xr.Dataset:
    """Return the derivatives of modes of sliding by parameters of the system.

    With the right and left vectors x and y of an exponent s of the small motions ``B x' = A x`` of
    `sliding_stability`, constraints included::

        ds = y^T (dA - s dB) x / (y^T B x)

    (Lancaster 1964, Numerische Mathematik 6). The equilibrium is found again for each change of a parameter, so that
    forces, slip velocities, slopes of friction and stiffnesses of contacts follow it. The matrices are differenced at
    four values within 0.2 % of the parameter: exactly where they are affine in it, as in coefficients of friction or
    stiffnesses, else to 1e-11, apart from the rounding of modes of meshes. Derivatives by an added mass are in closed
    form.

    Modes that merge have derivatives that grow without bound; those of sum and product of both exponents remain
    finite. The change by a finite change of a parameter is that of both modes together.

    Parameters
    ----------
    source : str, Path, xarray.Dataset or System
        A scenario, as for `load_scenario`, or a system.
    parameters : sequence of str, optional
        Keys of numbers as for `sweep`: a full path such as ``contact.friction.coefficient`` or any unique ending of
        one; those of a system are the keys of its scenario. A key that begins with the name of a contact, a surface
        or a connection means its own number; ``friction.coefficient`` means those of all contacts, and a list without a
        number, as in ``contacts.track.velocity`` or ``connections.stiffness``, all of its entries. Several numbers
        change in proportion, and the derivative is by their mean. By default all numbers other than lengths and places
        that are given and not 0.
    masses : mapping, optional
        Points at which a point mass is added, by name: a point of the system, or the name of a body and a point of it.
        The derivative is by the mass [kg], whose weight does not count.
    change : float, optional
        Change of each parameter, relative to it, whose effect is predicted [1].
    overrides : mapping, optional
        Values of other keys.
    modes : int, optional
        Number of modes, those nearest to `near`; by default those that grow or, if none does, the five that decay
        least.
    near : float, optional
        Frequency [Hz] around which `modes` are chosen.
    status, velocity, time : optional
        As for `sliding_stability`.
    progress : bool, optional
        Whether a bar on standard error shows the parameters done.

    Returns
    -------
    xarray.Dataset
        Over ``parameter`` and ``mode``, numbered as in `sliding_stability`: ``d_growth_rate`` [1/s] and ``d_frequency``
        [Hz] per unit of the parameter; ``growth_rate_change`` [1/s] and ``frequency_change`` [Hz] for `change` of it,
        NaN for masses; ``d_sum`` [1/s] and ``d_product`` [1/s²] per unit, real and imaginary ``part``, of the exponents
        of a pair, NaN for other modes. Over ``mode``: ``frequency`` [Hz], ``growth_rate`` [1/s], ``unstable``;
        ``kind``: ``alone``, ``merging`` where the shape is more like that of the ``partner`` than not, or ``double``
        where others have the same exponent, whose derivatives are then those in which each parameter splits them;
        ``partner``, its number, -1 for none. Over ``parameter``: ``value`` and ``units``. ``attrs["left_out"]`` has
        the reasons why some parameters are not among those by default.

    Raises
    ------
    ScenarioError
        If the scenario cannot be used, or a key is not known or means several places.
    ValueError
        If an argument is out of its range, there is no equilibrium with modes, or the modes have no derivative by a
        parameter: its value is 0, the status of a contact or the number of modes changes with it, or it has a kink.
    """
    positive("change", change)
    instance("progress", progress, bool)
    chosen = _Chosen(modes, near)
    given: Any = source
    if not is_written(source):
        instance("source", source, System)
    tables = si_tables(source, by_key("overrides", overrides))
    values = (
        all_values(tables)
        if parameters is None
        else [value_of(key, tables) for key in keys_of("parameters", parameters)]
    )
    own = scenario_of_tables(tables).system if is_written(source) or overrides else given
    with one_thread_each(), bar_if(progress, "derivatives of modes") as show:
        base = Base(own, lambda system: _about(system, status, velocity, time))
        if base.equilibrium.kind == JAMMED and status is None:
            raise ArgumentError("source", "have an equilibrium with modes", got=base.equilibrium.kind)
        groups = {number: group_of(base.pencil, base.found, number) for number in chosen.of(base)}
        changes, refused = base.all_changes(values, list(groups.values()), keeps_on=parameters is None, show=show)
        for name, where in by_key("masses", masses).items():
            slope = by_mass(base.pencil, displacement_rows(base.structure, point_of(name, where, own)))
            changes[f"mass at {name}"] = [group.pair.derivative(slope) for group in groups.values()]
    if not changes:
        raise ArgumentError("parameters", "hold at least one key", parameters, got="none")
    sizes = {one.key: (one.value, one.units) for one in values}
    origin = origin_of(given, overrides) if is_written(source) else {}
    return _dataset(base, groups, changes, sizes, change, {"left_out": "; ".join(refused), **origin})


@dataclass(frozen=True)
class _Chosen:
    """Choice of modes by number and frequency [Hz]."""

    modes: int | None
    near: float | None

    def __post_init__(self) -> None:
        if self.modes is not None:
            count("modes", self.modes)
        if self.near is not None:
            non_negative("near", self.near)
            if self.modes is None:
                raise ArgumentError("near", "be used with modes", self.near)

    def of(self, base: Base) -> list[int]:
        """Return the numbers of the chosen modes in their order."""
        values, shapes = base.found.values, base.found.shapes
        vibrates = (np.abs(values) > base.slack) & shapes.any(axis=0)
        if self.modes is not None:
            distance = np.abs(values - 2.0j * np.pi * (self.near or 0.0))
            order = np.argsort(np.where(vibrates, distance, np.inf), kind="stable")[: self.modes]
        else:
            grows = int(np.sum(vibrates & (values.real > base.slack)))
            order = np.argsort(np.where(vibrates, -values.real, np.inf), kind="stable")[: grows or FEWEST]
        chosen = sorted(number for number in order.tolist() if vibrates[number])
        if not chosen:
            raise ArgumentError("source", "have modes of vibration", got="none")
        return chosen


class Base:
    """Small motions of a system about its equilibrium, and of the same with one value changed.

    Parameters
    ----------
    system : System
        The system.
    about : callable
        Function of a system that returns it as matrices, and its equilibrium.
    """

    def __init__(self, system: System, about: Callable[[System], tuple[Structure, Equilibrium]]) -> None:
        self._about = about
        self.structure, self.equilibrium = about(system)
        self.motion = vibration(self.structure, self.equilibrium)
        self.slack = round_off(self.structure)

    @cached_property
    def found(self) -> Exponents:
        """Its modes."""
        return modes_of(self.structure, self.motion)

    @cached_property
    def pencil(self) -> Pencil:
        """Its small motions as a pencil."""
        return pencil_of(self.motion)

    def all_changes(
        self, values: Sequence[Value], groups: Sequence[ModeGroup], keeps_on: bool, show: Show
    ) -> tuple[dict[str, list[Array]], list[str]]:
        """Return the derivatives by each value and, if this keeps on, the reasons why others have none."""
        found, refused = dict[str, list[Array]](), list[str]()
        for number, value in enumerate(values):
            show(number, len(values), f"{number} of {len(values)} parameters, {value.key}")
            try:
                found[value.key] = self.changes(value, groups)
            except ValueError as error:
                if not keeps_on:
                    raise
                refused.append(str(error))
        show(len(values), len(values), f"{len(values)} of {len(values)} parameters")
        return found, refused

    def changes(self, value: Value, groups: Sequence[ModeGroup]) -> list[Array]:
        """Return the derivatives of the matrices of groups of modes by a value.

        Raises
        ------
        ArgumentError
            If they have none.
        """
        for share in STEPS:
            try:
                return self._slopes(value, share * value.value, groups)
            except ArgumentError as error:
                refused = error
        raise refused

    def _slopes(self, value: Value, step: float, groups: Sequence[ModeGroup]) -> list[Array]:
        """Return differences of the matrices of groups over a step of a value."""
        pencils = [self._changed(value, value.value + place * step) for place in PLACES]
        slope = combined(pencils, [weight / step for weight in SLOPE])
        kink = combined([*pencils, self.pencil], [weight / step for weight in KINK])
        highest = max(self.slack / ROUND_OFF, float(np.abs(self.found.values).max()))
        rounding = ROUNDINGS * np.finfo(float).eps * highest**2 / abs(step)
        found = []
        for group in groups:
            by_value = group.pair.derivative(slope)
            least = UNEVEN * np.abs(by_value).max() + rounding / (2.0 * abs(group.exponent))
            if not np.abs(group.pair.derivative(kink)).max() <= least:
                got = f"{brief(value.value)} for {value.key}, which does not"
                raise ArgumentError("parameters", "change modes smoothly", got=got)
            found.append(by_value)
        return found

    def _changed(self, value: Value, number: float) -> Pencil:
        """Return the small motions with another number, on the coordinates of the first system."""
        structure, equilibrium = self._about(value.system(number))
        if structure.mode_count != self.structure.mode_count:
            raise self._unlike(value, number, "the modes below the cutoffs of bodies")
        if equilibrium.status != self.equilibrium.status:
            raise self._unlike(value, number, "the statuses of contacts")
        motion = vibration(structure, equilibrium, self.motion.spread)
        return pencil_of(motion, turned_onto(self.structure, structure))

    def _unlike(self, value: Value, number: float, what: str) -> ArgumentError:
        got = f"{brief(value.value)} for {value.key}, of which {brief(number)} changes them"
        return ArgumentError("parameters", f"leave {what} as they are", got=got)

    def slopes(self, value: Value, numbers: Sequence[int]) -> list[complex]:
        """Return the derivatives of the exponents of modes, by their numbers, by a value [1/s per its unit].

        Raises
        ------
        ArgumentError
            If there are none.
        """
        groups = [group_of(self.pencil, self.found, number) for number in numbers]
        return [group.slope(one) for group, one in zip(groups, self.changes(value, groups), strict=True)]


def _about(
    system: System, status: Status | None, velocity: Velocity | None, time: float | None
) -> tuple[Structure, Equilibrium]:
    given = given_status(status, system)
    structure = Structure(system, time)
    return structure, find_equilibrium(structure, given_velocity(velocity, structure, given), given)


def keys_of(name: str, given: Any) -> tuple[str, ...]:
    """Return different keys; ArgumentError unless they are a list of them.

    Parameters
    ----------
    name : str
        Name of the argument.
    given : Any
        Its value.
    """
    if isinstance(given, str) or not isinstance(given, Sequence):
        raise ArgumentError(name, "be a list of keys", given)
    twice = next((one for one in given if list(given).count(one) > 1), None)
    if twice is not None:
        raise ArgumentError(name, "be different", twice, got=f"{brief(twice)} twice")
    return tuple(given)


def point_of(name: str, where: Any, system: System) -> BodyPoint:
    """Return the point of a system at which a mass is added."""
    key, names = f"masses[{name!r}]", {system.body_name(body): body for body in system.bodies}
    if not isinstance(where, tuple):
        instance(key, where, BodyPoint)
        if where.body not in system.bodies:
            raise ArgumentError(key, f"be a point of a body of the system ({listed(names)})", where)
        point: BodyPoint = where
        return point
    body: Any = names.get(where[0]) if len(where) == 2 else None
    if body is None:
        words = f"be a point, or the name of a body of the system ({listed(names)}) and a point of it"
        raise ArgumentError(key, words, where)
    try:
        return body.at(where[1]) if not isinstance(where[1], str) else BodyPoint(body, _position(body, where[1]))
    except ArgumentError as error:
        raise error.renamed(key) from None


def _position(body: Any, name: str) -> Any:
    """Return the position of a named point of a body."""
    return getattr(body, name).position if body.has_positions and name in body.point_names else name


def _dataset(
    base: Base,
    groups: Mapping[int, ModeGroup],
    changes: Mapping[str, Sequence[Array]],
    sizes: Mapping[str, tuple[float, str]],
    change: float,
    origin: Mapping[str, str],
) -> xr.Dataset:
    numbers, both = list(groups), ("parameter", "mode")
    values = base.found.values[numbers]

    def table(of: Callable[[ModeGroup, Array, float], Any]) -> Array:
        return np.array(
            [
                [
                    of(group, one, change * sizes.get(key, (np.nan, ""))[0])
                    for group, one in zip(groups.values(), row, strict=True)
                ]
                for key, row in changes.items()
            ]
        )

    slopes = table(lambda group, one, _: group.slope(one))
    moved = table(
        lambda group, one, amount: group.moved(one, amount) if np.isfinite(amount) else complex(np.nan, np.nan)
    )
    invariants = table(lambda group, one, _: group.invariants(one))
    percent = f"{100.0 * change:g} % of the parameter"
    data = {
        "frequency": ("mode", values.imag / (2.0 * np.pi), described("Hz", "frequency of vibration")),
        "growth_rate": ("mode", values.real, described("1/s", "rate at which the amplitude grows")),
        "unstable": ("mode", values.real > base.slack, described("1", "whether the mode grows")),
        "kind": ("mode", [one.kind for one in groups.values()]),
        "partner": ("mode", [one.partner for one in groups.values()]),
        "d_growth_rate": (both, slopes.real, described("1/s", "derivative of the growth rate, per unit")),
        "d_frequency": (both, slopes.imag / (2.0 * np.pi), described("Hz", "derivative of the frequency, per unit")),
        "growth_rate_change": (both, moved.real, described("1/s", f"change of the growth rate by {percent}")),
        "frequency_change": (
            both,
            moved.imag / (2.0 * np.pi),
            described("Hz", f"change of the frequency by {percent}"),
        ),
        "d_sum": ((*both, "part"), _parts(invariants[..., 0]), described("1/s", "derivative of the sum, per unit")),
        "d_product": (
            (*both, "part"),
            _parts(invariants[..., 1]),
            described("1/s2", "derivative of the product, per unit"),
        ),
    }
    found = [sizes.get(key, (np.nan, "kg")) for key in changes]
    coordinates = {
        "parameter": list(changes),
        "mode": numbers,
        "part": ["real", "imaginary"],
        "value": ("parameter", [value for value, _ in found]),
        "units": ("parameter", [units for _, units in found]),
    }
    attributes = {"change": change, "equilibrium": base.equilibrium.kind, "round_off": base.slack}
    return xr.Dataset(data, coordinates, attributes | dict(origin))


def _parts(numbers: Array) -> Array:
    return np.stack([numbers.real, numbers.imag], axis=-1)
