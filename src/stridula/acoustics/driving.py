"""Forces on the modes of a system: those of a record at its contacts, and those of its drives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies.paths import Path, Waves
from ..checks import ArgumentError, listed
from ..connections import held_motions
from ..lowering import Assembly, assemble
from ..records.by_point import by_point
from ..records.changes import check_one_system
from ..records.checked import record
from ..system import System
from .driven import LEAD, steady
from .recorded import BEFORE, sampled

# Largest number of steps in an interval at which drives are evaluated.
MOST_STEPS = 50


@dataclass(frozen=True)
class OnPath:
    """Forces of a contact on the modes of the track along which it moves.

    Attributes
    ----------
    span : tuple of int
        First mode of the track, and the one after its last.
    path : Path
        The path of the track.
    place : ndarray, shape (samples + 2 LEAD,)
        Abscissas of the contact [m].
    pressed, rubbed : ndarray, shape (samples + 2 LEAD,)
        Forces along the normal, compressive, and along the tangent, on the track [N].
    """

    span: tuple[int, int]
    path: Path
    place: Array
    pressed: Array
    rubbed: Array

    def forces(self, modes: Array) -> Array:
        """Return the forces on modes of the system, by their numbers, shape (modes, samples + 2 LEAD)."""
        found = np.zeros((modes.size, self.place.size))
        first, last = self.span
        axial = first + len(self.path.normal.multiples)
        parts = ((first, axial, self.path.normal, -self.pressed), (axial, last, self.path.tangential, self.rubbed))
        for begin, end, waves, force in parts:
            ours = (modes >= begin) & (modes < end)
            if ours.any():
                found[ours] = _some(waves, modes[ours] - begin).along(self.path, self.place) * force
        return found


@dataclass(frozen=True)
class Driving:
    """Forces on the modes of a system at the samples of a record.

    Attributes
    ----------
    flat : Assembly
        The system.
    start, interval : float
        Time at which the record begins, and its sample interval [s].
    samples : int
        Number of its samples.
    first : float
        Time of the first force [s], `LEAD` intervals before the record.
    rows : ndarray, shape (signals, modes)
        Modal forces of unit signals.
    signals : ndarray, shape (signals, samples + 2 LEAD)
        Forces at contacts, and factors of drives.
    on_paths : list of OnPath
        Forces on tracks along which contacts move.
    pushed : float or None
        Time at which the first force acts [s from the start], None if none does.
    """

    flat: Assembly
    start: float
    interval: float
    samples: int
    first: float
    rows: Array
    signals: Array
    on_paths: list[OnPath]
    pushed: float | None

    @property
    def times(self) -> Array:
        """Times of the forces [s], shape (samples + 2 LEAD,)."""
        return self.first + self.interval * np.arange(self.samples + 2 * LEAD)

    def forces(self, modes: Array) -> Array:
        """Return the forces on modes, by their numbers [N kg^(-1/2)], shape (modes, samples + 2 LEAD)."""
        found = self.rows[:, modes].T @ self.signals
        for one in self.on_paths:
            found += one.forces(modes)
        return np.asarray(found)


def driving(run: xr.Dataset, system: System, bodies: Sequence[Any] | None = None) -> Driving:
    """Return the forces on the modes of a system from a record, which is at rest before it.

    If `bodies` are given, the modes are theirs and those of all bodies whose modes springs couple to theirs.

    Raises
    ------
    ValueError
        If the record is not usable or not one of the system.
    """
    given = record("run", run)
    check_one_system(given)
    points = by_point(given, ("normal_force", "tangential_force"))
    if "map_time" in given.dims and points is given:
        words = "have the forces at all points of surfaces at every sample"
        raise ArgumentError("run", words, run, got="a record of maps alone: leave surface_rate out")
    start, interval, steps, (normal, tangential) = sampled(
        _in_order(points, system), "normal_force", "tangential_force"
    )
    flat, samples = assemble(system), normal.shape[1]
    if flat.springs.bends:
        raise ArgumentError(
            "system", "have linear springs and dashpots, from whose forces its motion follows", got="nonlinear ones"
        )
    if any(map(held_motions, system.connections)):
        words = "have no rigid joint, whose forces are in no record: stiff springs may take its place"
        raise ArgumentError("system", words, got="one")
    if bodies is not None:
        flat = _only(flat, [system.body_name(body) for body in bodies])
    if len(normal) != len(system.contacts):
        words = f"be a record of this system, of {len(system.contacts)} contacts"
        raise ArgumentError("run", words, run, got=f"one of {len(normal)}")
    continues = start > 0.5 * interval
    # It has been in equilibrium before.
    is_steady = continues or system.initial_equilibrium is not None
    if not is_steady:
        normal, tangential = _from_rest(assemble(system), normal, tangential, steps)
    rows, signals = _of_contacts(flat, normal, tangential)
    if any(one.circle is not None for one in flat.contacts):
        rows, signals = _gone_round(flat, rows, signals, _places(given, system))
    drive_steps = min(steps, MOST_STEPS)
    loads = _of_drives(flat, start, interval, drive_steps, samples, not is_steady)
    if is_steady:
        signals, loads = signals - signals[:, :1], loads - loads[:, :1]
    on_paths: list[OnPath] = []
    if any(contact.path_body is not None for contact in system.contacts):
        on_paths = _on_paths(flat, system, _places(given, system), normal, tangential, steps, is_steady)
    moving, starts = (np.zeros((0, flat.mode_count)), np.zeros((0, samples + 2 * LEAD)))
    if not continues and starts_are_heard(flat):
        moving, starts = _of_start(flat, interval, steps, samples)
    pushes = np.flatnonzero(signals.any(axis=0) | _acts(normal, is_steady) | _acts(tangential, is_steady))
    return Driving(
        flat,
        start,
        interval,
        samples,
        start + interval * (0.5 - LEAD) - 0.5 * interval / steps,
        np.concatenate([rows, flat.loads, moving]),
        np.concatenate(
            [*(steady(one, count) for one, count in ((signals, steps), (loads, drive_steps)) if len(one)), starts]
        ),
        on_paths,
        0.0 if loads.any() or moving.any() else (float(pushes[0]) * interval if pushes.size else None),
    )


def _only(flat: Assembly, names: Sequence[str]) -> Assembly:
    """Return a system in the plane with the modes of some of its bodies."""
    kept = np.zeros(flat.mode_count, dtype=bool)
    for name in names:
        kept[slice(*flat.spans[name])] = True
    coupled = flat.coupled if kept[: flat.coupled].any() else 0
    kept[:coupled] = True
    place = np.concatenate([[0], np.cumsum(kept)])
    return replace(
        flat,
        angular_frequency=flat.angular_frequency[kept],
        damping_rate=flat.damping_rate[kept],
        massless=flat.massless[kept],
        shapes_of_bodies=flat.shapes_of_bodies[kept],
        rigid=flat.rigid[kept],
        lumped=flat.lumped[kept],
        stiffness=flat.stiffness[:coupled, :coupled],
        dissipation=flat.dissipation[:coupled, :coupled],
        contacts=[replace(one, fixed=one.fixed[:, kept]) for one in flat.contacts],
        loads=flat.loads[:, kept],
        position=flat.position[kept],
        velocity=flat.velocity[kept],
        spans={name: (int(place[first]), int(place[last])) for name, (first, last) in flat.spans.items()},
    )


def _in_order(points: xr.Dataset, system: System) -> xr.Dataset:
    """Return a record with its contacts in the order of the system, unchanged if they have other names."""
    names = list(system.contact_names)
    shown = points["contact"].values.tolist() if "contact" in points.dims else names
    return points if shown == names or sorted(shown) != sorted(names) else points.sel(contact=names)


def _places(run: xr.Dataset, system: System) -> Array:
    """Return abscissas of the contacts of a system in the middle of each interval [m], shape (contacts, samples).

    They are zero for the points of surfaces.
    """
    run = _in_order(run, system)
    *_, (places,) = sampled(run, "contact_position")
    places = places - 0.5 * np.diff(places, axis=-1, prepend=places[..., :1])
    if len(places) == len(system.contacts):
        return places[:, 0] if places.ndim == 3 else places
    found = np.zeros((len(system.contacts), places.shape[-1]))
    for name, values in zip(run["contact"].values.tolist(), places[:, 0], strict=True):
        if name in system.contact_names:
            found[system.contact_names.index(name)] = values
    return found


def _of_drives(flat: Assembly, start: float, interval: float, steps: int, samples: int, from_rest: bool) -> Array:
    """Return means of the factors of loads over the steps of each interval, shape (loads, samples)."""
    step = interval / steps
    times = start + step * np.arange(samples * steps)
    found = np.zeros((len(flat.loads), samples))
    for load, signal in zip(found, flat.signals, strict=False):
        values = signal(times, step)
        if from_rest:
            values[0] *= 1.0 - BEFORE
        load[:] = values.reshape(samples, steps).mean(axis=1)
    return found


def starts_are_heard(flat: Assembly) -> bool:
    """Return whether vibration at the start of a run is included: of bodies that do not turn."""
    return not flat.turning


def start_notes(system: System) -> list[str]:
    """Return a note on drives whose vibration at the start is left out."""
    heard = starts_are_heard(assemble(system))
    moved = [one for one in system.drives if one.starts_motion]
    left_out = [str(one) for one in moved if not heard or (one.uniform_velocity is None and not one.vectors)]
    return [f"vibration at the start is not included: {listed(left_out)}"] if left_out else []


def _of_start(flat: Assembly, interval: float, steps: int, samples: int) -> tuple[Array, Array]:
    """Return modal forces and signals that cause the vibration of modes which start with displacement and velocity.

    With ``q = q0 + v0 t + r``, r starts at rest under ``-(K q0 + D v0) - K v0 t``, and has the acceleration of q. The
    modes have moved with v0 before, as in recorded motion.
    """
    position, velocity = (np.where(flat.massless, 0.0, one) for one in (flat.position, flat.velocity))
    pulled = [
        _times(flat, np.where(flat.massless, 0.0, flat.angular_frequency) ** 2, flat.stiffness, one)
        for one in (position, velocity)
    ]
    damped = _times(flat, flat.damping_rate, flat.dissipation, velocity)
    # Longer than the record, as what follows it is taken as constant.
    times = interval * np.arange(samples + 2 * LEAD)
    still, rising = np.ones_like(times), times + 0.5 * (steps - 1) * interval / steps
    still[0] -= BEFORE / steps
    signals = steady(np.stack([still, rising]), steps)[:, : samples + 2 * LEAD]
    return -np.stack([pulled[0] + damped, pulled[1]]), signals


def _times(flat: Assembly, alone: Array, coupled: Array, values: Array) -> Array:
    """Return the product of a matrix of all modes with values of them; modes that are not coupled have one entry."""
    found = alone * values
    found[: flat.coupled] = coupled @ values[: flat.coupled]
    return np.asarray(found)


def _from_rest(flat: Assembly, normal: Array, tangential: Array, steps: int) -> tuple[Array, Array]:
    """Return forces with the first impulse of contacts that are closed at the start counted by half, as in the run."""
    gaps = np.array([one.gap_at(flat.position) for one in flat.contacts])
    closed = (gaps < 0.0) | (np.array([one.yields is None for one in flat.contacts]) & (gaps == 0.0))
    share = np.where(closed, BEFORE / steps, 0.0)
    normal, tangential = normal.copy(), tangential.copy()
    normal[:, 0] -= share * normal[:, 0]
    tangential[..., 0] -= (share * tangential[..., 0].T).T
    return normal, tangential


def _of_contacts(flat: Assembly, normal: Array, tangential: Array) -> tuple[Array, Array]:
    """Return rows on the modes and the forces along them [N], shape (rows, modes) and (rows, samples)."""
    rows, forces = [], []
    along = tangential if tangential.ndim == 3 else tangential[:, None]
    for one, pressed, rubbed in zip(flat.contacts, normal, along, strict=True):
        # The tangential force is that on the track, the rows are those of the tip.
        rows += [one.fixed[0], *-one.fixed[1:]]
        forces += [pressed, *rubbed[: len(one.fixed) - 1]]
    return np.array(rows), np.array(forces)


def _gone_round(flat: Assembly, rows: Array, signals: Array, places: Array) -> tuple[Array, Array]:
    """Return rows and forces with contacts on circles acting on each pair of modes by its phase at their places.

    `places` are their abscissas in the middle of each interval [m], shape (contacts, samples).
    """
    rows, own = rows.copy(), np.zeros((rows.shape[1], signals.shape[1]))
    owners = [(one, number) for number, one in enumerate(flat.contacts) for _ in one.fixed]
    for row, signal, (one, number) in zip(rows, signals, owners, strict=True):
        if one.circle is None:
            continue
        first, second = one.circle.pairs.T
        angle = np.multiply.outer(one.circle.orders, (places[number] - one.contact.at) * one.rate)
        cosine, sine = np.cos(angle) * signal, np.sin(angle) * signal
        own[first] += row[first, None] * cosine - row[second, None] * sine
        own[second] += row[second, None] * cosine + row[first, None] * sine
        row[one.circle.pairs] = 0.0
    pushed = np.flatnonzero(own.any(axis=1))
    return np.concatenate([rows, np.eye(rows.shape[1])[pushed]]), np.concatenate([signals, own[pushed]])


def _on_paths(
    flat: Assembly, system: System, places: Array, normal: Array, tangential: Array, steps: int, is_steady: bool
) -> list[OnPath]:
    """Return the forces on tracks along which contacts move, less those at the start if it `is_steady`."""
    found = []
    along = tangential[:, 0] if tangential.ndim == 3 else tangential
    for contact, place, pressed, rubbed in zip(system.contacts, places, normal, along, strict=True):
        body = contact.path_body
        span = (0, 0) if body is None else flat.spans[system.body_name(body)]
        if body is None or span[0] == span[1]:
            continue
        place = np.pad(place, LEAD, mode="edge")
        found.append(OnPath(span, body.path(), place, *steady(np.stack([pressed, rubbed]), steps)))
        if is_steady:
            before = steady(np.broadcast_to([[-pressed[0]], [-rubbed[0]]], (2, pressed.size)), steps)
            found.append(OnPath(span, body.path(), np.full_like(place, place[0]), *before))
    return found


def _acts(forces: Array, is_steady: bool) -> Array:
    """Return a mask of the samples at which forces act, or change from those at the start if it `is_steady`."""
    given = forces - forces[..., :1] if is_steady else forces
    return np.asarray(given.reshape(-1, given.shape[-1]).any(axis=0))


def _some(waves: Waves, modes: Array) -> Waves:
    """Return some modes of waves, by their numbers."""
    return replace(waves, multiples=waves.multiples[modes], amplitude=waves.amplitude[modes])
