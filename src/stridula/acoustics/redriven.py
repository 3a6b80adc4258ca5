"""Accelerations of the modes of bodies in space, driven again by the forces of a record and by drives.

The counterpart of `driven` in three dimensions: forces act along the normal and both tangents of each contact. Pairs of
modes of a body that turns are plain oscillators in the frame of their waves. Forces are turned into that frame and
motion out of it, by the angle ``b`` of the waves, with ``J`` a quarter of a turn:

    q'' = R(b) (Q'' + 2 b' J Q' + (b'' J - b'²) Q)

Modes that springs couple are replaced by the modes of the coupled system.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.linalg
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError
from ..lowering import Assembly, TurningModes, assemble
from ..records.by_point import by_point
from ..records.changes import check_one_system
from ..records.checked import record
from ..system import System
from .driven import FASTEST, LEAD, Modes, respond, steady
from .recorded import sampled

# Largest number of steps in an interval at which drives are evaluated.
MOST_STEPS = 50


@dataclass(frozen=True)
class Moved:
    """Motion of the modes of a system.

    Attributes
    ----------
    start, interval : float
        Time at which the record begins, and its sample interval [s].
    samples : int
        Number of its samples.
    first : float
        Time of the first acceleration [s].
    accelerations : ndarray, shape (modes, samples + 2 LEAD)
        Accelerations of all modes [m kg^(1/2) / s²], zero for those left out and for residual shapes.
    left_out : ndarray of bool, shape (modes,)
        Modes too fast for the samples.
    pushed : float or None
        Time at which the first force acts [s from the start], None if none does.
    spans : dict
        First mode of each body and the one after its last, by body name.
    is_recorded : bool
        Whether it is the recorded motion of the march itself.
    """

    start: float
    interval: float
    samples: int
    first: float
    accelerations: Array
    left_out: Array
    pushed: float | None
    spans: dict[str, tuple[int, int]]
    is_recorded: bool = False

    @property
    def words(self) -> str:
        """Origin of the motion, for attributes."""
        return "recorded" if self.is_recorded else "driven again"


def redriven(run: xr.Dataset, system: System, bodies: Sequence[Any] | None = None) -> Moved:
    """Return the motion of the modes of a system under the forces of a record, at rest before it.

    Only that of `bodies`, if given, and of all bodies whose modes springs couple to theirs.

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
    if bodies is not None:
        flat = _only(flat, [system.body_name(body) for body in bodies])
    if len(normal) != len(system.contacts):
        words = f"be a record of this system, of {len(system.contacts)} contacts"
        raise ArgumentError("run", words, run, got=f"one of {len(normal)}")
    first = start + interval * (0.5 - LEAD) - 0.5 * interval / steps
    times = first + interval * np.arange(samples + 2 * LEAD)
    rows, signals = _of_contacts(flat, normal, tangential)
    if any(one.circle is not None for one in flat.contacts):
        rows, signals = _gone_round(flat, rows, signals, _places(given, system))
    if any(contact.path_body is not None for contact in system.contacts):
        own = _on_paths(flat, system, _places(given, system), normal, tangential)
        driven = np.flatnonzero(own.any(axis=1))
        rows, signals = np.concatenate([rows, np.eye(len(own))[driven]]), np.concatenate([signals, own[driven]])
    loads = _of_drives(flat, start, interval, min(steps, MOST_STEPS), samples)
    if system.initial_equilibrium is not None:
        # It has been in equilibrium before.
        signals, loads = signals - signals[:, :1], loads - loads[:, :1]
    forces = rows.T @ steady(signals, steps)
    if len(loads):
        forces += flat.loads.T @ steady(loads, steps)
    pushes = np.flatnonzero(signals.any(axis=0))
    found, left_out = _moved(flat, forces, times, interval)
    pushed = 0.0 if loads.any() else (float(pushes[0]) * interval if pushes.size else None)
    return Moved(start, interval, samples, first, found, left_out, pushed, flat.spans)


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
        lumped=flat.lumped[kept],
        stiffness=flat.stiffness[:coupled, :coupled],
        dissipation=flat.dissipation[:coupled, :coupled],
        contacts=[replace(one, fixed=one.fixed[:, kept]) for one in flat.contacts],
        loads=flat.loads[:, kept],
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


def _of_drives(flat: Assembly, start: float, interval: float, steps: int, samples: int) -> Array:
    """Return means of the factors of loads over the steps of each interval, shape (loads, samples)."""
    step = interval / steps
    times = start + step * np.arange(samples * steps)
    found = np.zeros((len(flat.loads), samples))
    for load, signal in zip(found, flat.signals, strict=False):
        load[:] = signal(times, step).reshape(samples, steps).mean(axis=1)
    return found


def _of_contacts(flat: Assembly, normal: Array, tangential: Array) -> tuple[Array, Array]:
    """Return rows on the modes and the forces along them [N], shape (rows, modes) and (rows, samples)."""
    rows, forces = [], []
    along = tangential if tangential.ndim == 3 else tangential[:, None]
    for one, number in zip(flat.contacts, flat.contact_numbers, strict=True):
        if not one.is_second:
            rows.append(one.fixed[0])
            forces.append(normal[number])
        # The tangential force is that on the track, the rows are those of the tip.
        rows.append(-one.fixed[1])
        forces.append(along[number, int(one.is_second)])
    return np.array(rows), np.array(forces)


def _gone_round(flat: Assembly, rows: Array, signals: Array, places: Array) -> tuple[Array, Array]:
    """Return rows and forces with contacts on circles acting on each pair of modes by its phase at their places.

    `places` are their abscissas in the middle of each interval [m], shape (contacts, samples).
    """
    rows, own = rows.copy(), np.zeros((rows.shape[1], signals.shape[1]))
    owners = [one for one in flat.contacts for _ in range(1 if one.is_second else 2)]
    numbers = np.repeat(flat.contact_numbers, [1 if one.is_second else 2 for one in flat.contacts])
    for row, signal, one, number in zip(rows, signals, owners, numbers.tolist(), strict=True):
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


def _on_paths(flat: Assembly, system: System, places: Array, normal: Array, tangential: Array) -> Array:
    """Return the forces on the modes of tracks along which contacts move [N kg^(-1/2)], shape (modes, samples)."""
    found = np.zeros((flat.mode_count, normal.shape[1]))
    along = tangential[:, 0] if tangential.ndim == 3 else tangential
    for contact, place, pressed, rubbed in zip(system.contacts, places, normal, along, strict=True):
        body = contact.path_body
        if body is None:
            continue
        first, last = flat.spans[system.body_name(body)]
        if first < last:
            path = body.path()
            axial = first + len(path.normal.multiples)
            found[first:axial] -= path.normal.along(path, place) * pressed
            found[axial:last] += path.tangential.along(path, place) * rubbed
    return found


def _moved(flat: Assembly, forces: Array, times: Array, interval: float) -> tuple[Array, Array]:
    """Return the accelerations of all modes, and a mask of those too fast for the samples."""
    found, coupled = np.zeros_like(forces), flat.coupled
    left_out = ~flat.massless & (flat.angular_frequency * interval >= FASTEST)
    plain = ~flat.massless & ~left_out
    plain[:coupled] = False
    for turning in flat.turning:
        pairs = turning.pairs[plain[turning.pairs[:, 0]] & (np.array(turning.turning.drag) != 0.0)]
        plain[pairs] = False
        found[pairs.T.ravel()] = _turning(flat, turning, pairs, forces, times, interval)
    found[plain] = respond(Modes(flat.angular_frequency[plain], flat.damping_rate[plain]), forces[plain], interval)
    moving = np.flatnonzero(~flat.massless[:coupled])
    if moving.size:
        block = np.ix_(moving, moving)
        squared, shapes = scipy.linalg.eigh(flat.stiffness[block])
        angular = np.sqrt(np.maximum(squared, 0.0))
        kept = angular * interval < FASTEST
        rates = np.einsum("ik,ij,jk->k", shapes, flat.dissipation[block], shapes)
        own = respond(Modes(angular[kept], rates[kept]), shapes[:, kept].T @ forces[moving], interval)
        found[moving] = shapes[:, kept] @ own
        left_out[moving[len(moving) - int((~kept).sum()) :]] = True
    return found, left_out


def _turning(
    flat: Assembly, turning: TurningModes, pairs: Array, forces: Array, times: Array, interval: float
) -> Array:
    """Return the accelerations of pairs of modes of a body that turns, first ones before second ones."""
    drags = {tuple(pair): drag for pair, drag in zip(turning.pairs.tolist(), turning.turning.drag, strict=True)}
    drag = np.array([drags[tuple(pair)] for pair in pairs.tolist()])[:, None]
    rate = drag * turning.turning.rate(times)
    angle = drag * turning.turning.velocity * turning.turning.history.integral(times)
    change = np.gradient(rate, interval, axis=1)
    first, second = pairs.T
    cosine, sine = np.cos(angle), np.sin(angle)
    ahead, behind = cosine * forces[first] + sine * forces[second], cosine * forces[second] - sine * forces[first]
    modes = Modes(flat.angular_frequency[first], flat.damping_rate[first])
    (x, y), (u, v), (a, b) = (
        [respond(modes, force, interval, derivative) for force in (ahead, behind)] for derivative in range(3)
    )
    a, b = a - 2.0 * rate * v - change * y - rate**2 * x, b + 2.0 * rate * u + change * x - rate**2 * y
    return np.concatenate([cosine * a - sine * b, sine * a + cosine * b])
