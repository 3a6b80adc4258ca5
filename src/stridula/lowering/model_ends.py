"""Notes on a system where its model ends: parts that it describes only roughly, or not at all."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from ..arrays import Array
from ..bodies import SolidBody
from ..checks import listed
from ..system import System
from .assembly import Assembly
from .time_scales import expected_stiffness

# Slope of a profile from which its tilt is no longer small against usual friction.
STEEP = 0.1
# Effects of second order matter from this share of a critical speed: centrifugal stiffening then raises the frequencies
# of discs by some percent.
NEAR_CRITICAL = 0.3
# Range of frequencies of contacts, relative to the cutoff, that are near it; above this range a contact is as good as
# rigid.
NEAR_CUTOFF = (0.5, 2.0)
# A contact determines the frequency of a mode if its stiffness has at least this share of the energy.
OF_THE_CONTACT = 0.5
# Largest number of modes for which frequencies of contacts are computed, which takes a fraction of a second.
MOST_MODES = 300


def notes_of(system: System, arrays: Assembly, duration: float) -> list[str]:
    """Return the notes on a system that is simulated for a duration [s]."""
    near = _near_cutoff(system, arrays, duration)
    whole = (_bodies, _at_rest, _frictionless, _steep, _stiff_faces)
    return [*(note for notes in whole for note in notes(system)), *near]


def _bodies(system: System) -> Iterator[str]:
    for body in system.bodies:
        name = system.body_name(body)
        if (thick := getattr(body, "thick_from", math.inf)) < math.inf:
            yield f"{name}: bending above {thick:.4g} Hz is too stiff without shear, with waves under six heights"
        if (turning := body.modes(system.is_held(body)).turning) is not None:
            yield from _near_critical(name, body, turning)


def _near_critical(name: str, body: Any, turning: Any) -> Iterator[str]:
    """Yield a note on a body that turns near the speed at which a wave stands still in space."""
    first = [pair[0] for pair in turning.pairs]
    frequency = body.modes().angular_frequency[first]
    vibrates = np.isfinite(frequency) & (frequency > 0.0)
    critical = np.where(vibrates, frequency, np.inf) / np.maximum(np.abs(turning.drag), 1e-300)
    if not critical.size:
        return
    lowest = int(critical.argmin())
    share = abs(turning.velocity) * turning.history.largest / critical[lowest]
    if share >= NEAR_CRITICAL:
        order = f"order {turning.order[lowest]:g}"
        yield (
            f"{name}: turns at {100.0 * share:.0f} % of {critical[lowest]:.4g} rad/s, critical for waves of {order}; "
            "centrifugal stiffening is left out"
        )


def _at_rest(system: System) -> Iterator[str]:
    """Yield a note on meshes that turn under a face, whose vibration is described in a frame at rest."""
    faces: Iterable[Any] = system.faces
    turning = [system.body_name(face.track) for face in faces if getattr(face, "turning", None) is not None]
    if turning:
        yield f"turning meshes whose waves are not carried round: {_once(turning)}"


def _stiff_faces(system: System) -> Iterator[str]:
    """Yield a note on meshes that miss the residual shapes of a face in contact."""
    faces: list[Any] = [one for one in system.faces if hasattr(one, "face")]
    sides = [side for one in faces for side in ((one.body, one.face), (one.track, one.track_face))]
    missing = [
        f"{name!r} of {system.body_name(body)}"
        for body, name in sides
        if body.kind == SolidBody.kind and name not in body.contact_faces
    ]
    if missing:
        yield f"too stiff in contact without residual shapes, which contact_faces gives: {_once(missing)}"


def _frictionless(system: System) -> Iterator[str]:
    """Yield notes on contacts without friction, and on tracks that friction does not move."""
    without = [
        contact.surface or name
        for name, contact in zip(system.contact_names, system.contacts, strict=True)
        if _is_frictionless(contact)
    ]
    if without:
        yield f"without friction: {_once(without)}"
    rigid = [
        system.body_name(contact.path_body)
        for contact in system.contacts
        if contact.path_body is not None
        and not _is_frictionless(contact)
        and not len(contact.path_body.path().tangential.multiples)
    ]
    if rigid:
        yield f"rigid along their contacts, so that friction does not move them: {_once(rigid)}"


def _steep(system: System) -> Iterator[str]:
    """Yield notes on profiles whose slopes are not small."""
    for name, contact in zip(system.contact_names, system.contacts, strict=True):
        profile = contact.relief
        if profile and profile.steepest >= STEEP:
            yield f"{name}: its profile is as steep as {profile.steepest:.2g}; forces keep the directions of the plane"


def _is_frictionless(contact: Any) -> bool:
    return not contact.friction.depends_on_speed and contact.friction.holding == 0.0


def _once(names: Iterable[str]) -> str:
    return listed(dict.fromkeys(names))


def _near_cutoff(system: System, arrays: Assembly, duration: float) -> Iterator[str]:
    """Yield a note on the contact whose vibration on its stiffness is nearest to the cutoff of a body."""
    soft = [number for number, one in enumerate(arrays.contacts) if one.yields]
    ends = [_cutoff(system, number) for number in soft]
    if arrays.mode_count > MOST_MODES or not any(frequency < math.inf for frequency, _ in ends):
        return
    rows = np.array(
        [
            one.fixed[0] if one.contact.path_body is None else one.rows_at(one.at)[0]
            for one in arrays.contacts
            if one.yields
        ]
    )
    frequency, shares = contact_modes(arrays, rows, expected_stiffness(arrays, duration))
    best: tuple[float, int, float] | None = None
    for mode in np.flatnonzero(shares.sum(axis=0) >= OF_THE_CONTACT).tolist():
        contact = int(shares[:, mode].argmax())
        ratio = frequency[mode] / ends[contact][0]
        distance = abs(math.log(ratio)) if ratio > 0.0 else math.inf
        if NEAR_CUTOFF[0] <= ratio <= NEAR_CUTOFF[1] and (best is None or distance < best[0]):
            best = distance, contact, float(frequency[mode])
    if best is not None:
        _, contact, found = best
        limit, body = ends[contact]
        name = system.contacts[soft[contact]].surface or system.contact_names[soft[contact]]
        yield f"{name}: vibrates on its stiffness at {found:.4g} Hz, near the cutoff of {body}, {limit:.4g} Hz"


def _cutoff(system: System, number: int) -> tuple[float, str]:
    """Return the lower cutoff [Hz] of the bodies of a contact, infinite without any, and the body."""
    contact = system.contacts[number]
    ends: tuple[Any, ...] = (contact.tip.body, contact.track_body)
    bodies = [body for body in ends if getattr(body, "cutoff", None) is not None]
    return min(((float(body.cutoff), system.body_name(body)) for body in bodies), default=(math.inf, ""))


def contact_modes(arrays: Assembly, rows: Array, stiffness: Array) -> tuple[Array, Array]:
    """Return the frequencies [Hz] with closed contacts and the share of each contact in the energy of each mode.

    Residual shapes, which have no mass, make contacts softer. `rows` are those of the contacts with a stiffness along
    their normals, shape (contacts, modes); shares have the shape (contacts, modes that vibrate).
    """
    heavy = ~arrays.massless
    give = np.diag(1.0 / stiffness) + rows[:, ~heavy] @ rows[:, ~heavy].T
    held = np.linalg.inv(give)
    moved = rows[:, heavy]
    matrix = arrays.all_stiffness[np.ix_(heavy, heavy)] + moved.T @ held @ moved
    squared, shapes = np.linalg.eigh(0.5 * (matrix + matrix.T))
    pressed = moved @ shapes
    energy = np.einsum("cm,cm->cm", pressed, held @ pressed)
    return np.sqrt(np.maximum(squared, 0.0)) / (2.0 * np.pi), energy / np.where(squared > 0.0, squared, np.inf)
