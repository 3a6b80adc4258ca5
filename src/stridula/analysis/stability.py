"""Linear stability of sliding: complex eigenvalues about the equilibrium, with the exact unilateral constraint."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..bodies.modes import Array
from ..checks import choice, count, instance, non_negative, positive
from ..records.variables import STATUS_WORDS, described
from ..system import System
from .equilibrium import JAMMED, Equilibrium, depends_on_speed, find_equilibrium, slip_speed
from .structure import SLIDING, Structure
from .vibration import Exponents, all_exponents, nearest_exponents, vibration

# Modes up to which all exponents are found; beyond, the lowest COUNT.
LARGEST_DENSE = 600
COUNT = 100
# Exponents found beyond those that are wanted.
SPARE = 8
# Growth, relative to the highest angular frequency, that rounding may make.
ROUND_OFF = 1e-9


def sliding_stability(
    system: System,
    *,
    status: str | Sequence[str] | None = None,
    velocity: float | None = None,
    time: float | None = None,
    modes: int | None = None,
    near: float = 0.0,
) -> xr.Dataset:
    """Return the vibration modes of a system about its equilibrium: frequency, growth, damping, shape.

    The equilibrium is that of steady sliding where drives or tracks prescribe it, else that in the accelerating frame
    of a slider that a force drives. Small motions q about it obey, with the closed contacts' rows G of the gap and T of
    the slip, s the sense of sliding and mu the coefficient of friction::

        q'' + D q' + K q = (G - s mu T)^T m,    G q = 0

    so that, with ``Z = null(G)`` and ``Y = null(G - s mu T)``, exponents are those of ``(Y'Z, Y'DZ, Y'KZ)``, which is
    not symmetric: two modes can lock in and one of them grow. A sticking contact also holds ``T q = 0``; a separated
    one nothing. Friction that depends on the slip speed adds the normal force times its slope to D; laws with an
    internal state add that. A load adds what the deflected track does to a contact point that shifts along it. The
    place of the contact point, which travels, is taken as it is at the start.

    Parameters
    ----------
    system : System
        The system.
    status : str or sequence of str, optional
        ``separated``, ``sticking`` or ``sliding`` for each contact, taken as given whatever the equilibrium would be;
        those of the equilibrium if left out.
    velocity : float, optional
        Slip speed [m/s] of contacts for which nothing prescribes it; needed where friction depends on it.
    time : float, optional
        When drives are taken [s]; once they no longer vary if left out.
    modes : int, optional
        How many modes, those nearest to `near`; all if left out, or the lowest 100 of more than 600 degrees of freedom.
    near : float, optional
        Frequency [Hz] about which a limited number of modes is found.

    Returns
    -------
    xarray.Dataset
        Over ``mode``, by rising frequency: ``frequency`` [Hz], ``growth_rate`` [1/s], ``damping_ratio`` [1], whether
        ``unstable``, ``energy_share`` of each ``body`` in the kinetic energy [1], and ``mode_shape``, real and
        imaginary ``part`` of the modal displacements. For each contact its ``status``, forces [N], ``slip_velocity``
        [m/s], NaN where a force accelerates it and friction does not depend on it, and ``slip_acceleration`` [m/s²].
        ``attrs["equilibrium"]`` is ``sliding``; ``held``: friction holds a contact for good; ``lifted off``; or
        ``jammed``: it neither slides on nor opens, and there are no modes unless `status` is given. With `status` it
        says what would come of that instead.
        ``attrs["round_off"]`` is the growth [1/s] up to which a mode does not count as unstable.

    Raises
    ------
    ValueError
        If an argument is out of its range, a slip speed is needed, a drive never stops varying, or contacts hold the
        same motion twice.
    """
    instance("system", system, System)
    chosen = _checked(status, system)
    for word, value in (("velocity", velocity), ("time", time)):
        if value is not None:
            (positive if word == "velocity" else non_negative)(word, value)
    non_negative("near", near)
    structure = Structure(system, time)
    if modes is not None:
        count("modes", modes)
    equilibrium = find_equilibrium(structure, velocity, chosen)
    if equilibrium.kind == JAMMED and chosen is None:
        found = Exponents(np.empty(0, dtype=complex), np.empty((structure.mode_count, 0), dtype=complex))
    else:
        found = _exponents(structure, equilibrium, velocity, modes, near)
    return _dataset(structure, equilibrium, found, velocity)


def stability_of(system: System, velocity: float | None = None) -> dict[str, float | str]:
    """Return what a map shows of the stability of a system: largest growth, its frequency, how many modes grow.

    Parameters
    ----------
    system : System
        The system.
    velocity : float, optional
        Slip speed [m/s] of contacts for which nothing prescribes it; needed where friction depends on it.

    Returns
    -------
    dict
        ``growth_rate`` [1/s], NaN where no contact slides: nothing else feeds a vibration; ``flutter_frequency`` [Hz]
        of the mode that grows fastest, NaN if none grows; ``unstable_modes``, NaN where it is jammed; ``equilibrium``
        as in `sliding_stability`.
    """
    structure = Structure(system)
    equilibrium = find_equilibrium(structure, velocity)
    nothing = float("nan")
    if equilibrium.kind == JAMMED or SLIDING not in equilibrium.status:
        return {
            "growth_rate": nothing,
            "flutter_frequency": nothing,
            "unstable_modes": nothing if equilibrium.kind == JAMMED else 0.0,
            "equilibrium": equilibrium.kind,
        }
    motion = vibration(structure, equilibrium, velocity)
    large = structure.mode_count > LARGEST_DENSE
    found = _nearest(structure, motion, COUNT, 0.0) if large else all_exponents(motion, shapes=False)
    growing = found.values[found.values.real > _round_off(structure)]
    fastest = growing[np.argmax(growing.real)] if growing.size else complex(np.nan, np.nan)
    return {
        "growth_rate": float(found.values.real.max()),
        "flutter_frequency": float(fastest.imag / (2.0 * np.pi)),
        "unstable_modes": float(growing.size),
        "equilibrium": equilibrium.kind,
    }


def _checked(status: str | Sequence[str] | None, system: System) -> tuple[str, ...] | None:
    if status is None:
        return None
    given = (status,) if isinstance(status, str) else status
    if not isinstance(given, Sequence) or len(given) != len(system.contacts):
        raise ValueError(f"status must be one of {', '.join(STATUS_WORDS)} for each contact, got {status!r}")
    for number, word in enumerate(given):
        choice("status" if isinstance(status, str) else f"status[{number}]", word, STATUS_WORDS)
        law = system.contacts[number].friction
        if word == "sticking" and law.state_units:
            raise ValueError(
                f"status must be sliding or separated under {law.law} friction, which does not stick exactly, "
                f"got {word!r}"
            )
    return tuple(given)


def _exponents(
    structure: Structure, equilibrium: Equilibrium, velocity: float | None, modes: int | None, near: float
) -> Exponents:
    motion = vibration(structure, equilibrium, velocity)
    wanted = COUNT if modes is None and structure.mode_count > LARGEST_DENSE else modes
    if wanted is not None and 4 * wanted < structure.mode_count and structure.stiffness.any():
        return _nearest(structure, motion, wanted, near)
    found = all_exponents(motion)
    if wanted is None:
        return found
    order = np.argsort(np.abs(found.values - 2.0j * np.pi * near), kind="stable")[:wanted]
    return Exponents(found.values[order], found.shapes[:, order])


def _nearest(structure: Structure, motion: Any, wanted: int, near: float) -> Exponents:
    """Return the exponents nearest to a frequency [Hz], found about a place off the imaginary axis, where none is."""
    elastic = np.sqrt(np.diag(structure.stiffness))
    lowest = float(elastic[elastic > 0.0].min(initial=np.inf))
    centre = 2.0 * np.pi * near
    # Both of each pair may be found, and in another order than about the frequency itself.
    sought = min(2 * wanted + SPARE, 2 * structure.mode_count - 2)
    found = nearest_exponents(motion, sought, complex(0.1 * lowest, centre))
    order = np.argsort(np.abs(found.values - 1.0j * centre), kind="stable")[:wanted]
    return Exponents(found.values[order], found.shapes[:, order])


def _round_off(structure: Structure) -> float:
    """Return the growth that rounding may make [1/s]."""
    return ROUND_OFF * float(np.sqrt(np.diag(structure.stiffness).max(initial=0.0)))


def _dataset(structure: Structure, equilibrium: Equilibrium, found: Exponents, velocity: float | None) -> xr.Dataset:
    system = structure.system
    order = np.lexsort((-found.values.real, np.round(found.values.imag, 6)))
    values, shapes = found.values[order], found.shapes[:, order]
    size = np.abs(values)
    shapes = _normalised(shapes)
    kinetic = np.abs(shapes) ** 2
    spans = structure.arrays.spans
    share = np.array([kinetic[first:end].sum(axis=0) for first, end in spans.values()]).T
    body = np.empty(structure.mode_count, dtype=object)
    for name, (first, end) in spans.items():
        body[first:end] = name
    ratio = np.where(size > 0.0, -values.real / np.where(size > 0.0, size, 1.0), 0.0)
    data: dict[str, Any] = {
        "frequency": ("mode", values.imag / (2.0 * np.pi), described("Hz", "frequency of vibration")),
        "growth_rate": ("mode", values.real, described("1/s", "rate at which the amplitude grows")),
        "damping_ratio": ("mode", ratio, described("1", "damping ratio; below zero where the mode grows")),
        "unstable": ("mode", values.real > _round_off(structure), described("1", "whether the mode grows")),
        "energy_share": (("mode", "body"), share, described("1", "share of the body in the kinetic energy")),
        "mode_shape": (
            ("mode", "coordinate", "part"),
            np.stack([shapes.real, shapes.imag], axis=-1).transpose(1, 0, 2),
            described("1", "modal displacements, of norm 1"),
        ),
    }
    coordinates = {
        "mode": np.arange(values.size),
        "body": list(spans),
        "coordinate_body": ("coordinate", body.astype(str)),
        "part": ["real", "imaginary"],
    }
    several = len(system.contacts) > 1
    if several:
        coordinates["contact"] = list(system.contact_names)
    for name, units, meaning, numbers in _contacts(structure, equilibrium, velocity):
        data[name] = ("contact" if several else (), numbers if several else numbers[0], described(units, meaning))
    return xr.Dataset(data, coordinates, {"equilibrium": equilibrium.kind, "round_off": _round_off(structure)})


def _contacts(structure: Structure, at: Equilibrium, velocity: float | None) -> list[tuple[str, str, str, Array]]:
    """Return name, unit, meaning and values of what is known of the contacts."""
    slip = []
    for k, contact in enumerate(structure.system.contacts):
        known = at.prescribed[k] != 0.0 or (at.sense[k] and depends_on_speed(contact.friction))
        speed = slip_speed(structure, k, at.prescribed, velocity) if known else np.nan if at.sense[k] else 0.0
        slip.append(at.sense[k] * speed if at.status[k] == SLIDING else 0.0)
    return [
        ("status", "1", "status of the contact", np.array(at.status)),
        ("normal_force", "N", "normal contact force, compressive", at.normal_force),
        ("tangential_force", "N", "tangential contact force on the track along its tangent", at.tangential_force),
        ("slip_velocity", "m/s", "velocity of the tip along the track", np.array(slip)),
        ("slip_acceleration", "m/s2", "acceleration of the tip along the track", at.slip_acceleration),
    ]


def _normalised(shapes: Array) -> Array:
    """Return shapes of norm 1 whose largest entry is real."""
    if not shapes.size:
        return shapes
    largest = np.take_along_axis(shapes, np.abs(shapes).argmax(axis=0)[None], axis=0)
    # A state that forces do not depend on decays without moving anything.
    largest = np.where(largest == 0.0, 1.0, largest)
    turned = shapes * (np.abs(largest) / largest)
    size = np.linalg.norm(turned, axis=0)
    return np.asarray(turned / np.where(size > 0.0, size, 1.0))
