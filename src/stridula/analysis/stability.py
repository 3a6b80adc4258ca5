"""Linear stability of sliding: complex eigenvalues about the equilibrium, with the exact unilateral constraint."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import count, instance, non_negative
from ..linear.equilibrium import JAMMED, LIFTED_OFF, Equilibrium, find_equilibrium, open_words
from ..linear.given import Status, Velocity, given_status, given_velocity
from ..linear.growth import growth_of
from ..linear.modes import modes_of, round_off
from ..linear.structure import Structure
from ..linear.vibration import Exponents, vibration
from ..lowering.model_ends import notes_of
from ..records.variables import EQUILIBRIUM, TANGENTS, described
from ..system import System

# Notes on the frequency of contacts with a stiffness are for the forces expected within this time [s].
AHEAD = 1.0
# Bodies determine a mode if they have at least this share of its kinetic energy.
OF_THE_BODIES = 0.5


def sliding_stability(
    system: System,
    *,
    status: Status | None = None,
    velocity: Velocity | None = None,
    time: float | None = None,
    modes: int | None = None,
    near: float = 0.0,
) -> xr.Dataset:
    """Return the vibration modes of a system about its equilibrium: frequency, growth, damping, shape.

    The equilibrium is that of steady sliding if drives or tracks prescribe it, else that in the accelerating frame
    of a slider driven by a force. Small motions q about it obey, with the closed contacts' rows G of the gap and T of
    the slip, s the sense of sliding and mu the coefficient of friction::

        q'' + D q' + K q = (G - s mu T)^T m,    G q = 0

    so that, with ``Z = null(G)`` and ``Y = null(G - s mu T)``, exponents are those of ``(Y'Z, Y'DZ, Y'KZ)``, which is
    not symmetric: two modes can lock in and one of them grow. A sticking contact also imposes ``T q = 0``; a separated
    contact nothing. Friction that depends on the slip speed adds the normal force times its slope to D; laws with an
    internal state add that state. A load adds the effect of the deflected track on a contact point that shifts along
    it. The travelling contact point is taken at its initial position.

    Parameters
    ----------
    system : System
        The system.
    status : str or sequence of str, optional
        ``separated``, ``sticking`` or ``sliding``, one for all contacts or one for each, which replaces that of the
        equilibrium.
    velocity : float or sequence of float, optional
        Slip velocity [m/s] of contacts for which nothing prescribes it, one for all of them, or one for each contact
        and 0 for the others: that of the tip along the track's tangent, whose sign is the sense of sliding. Needed
        if friction depends on it. A contact is then assumed to slide at this velocity, unless it decelerates.
    time : float, optional
        Time at which drives are evaluated [s]; by default once they no longer vary.
    modes : int, optional
        Number of modes, those nearest to `near`; by default all, or the lowest 100 of more than 600 degrees of freedom.
    near : float, optional
        Frequency around which a limited number of modes is computed [Hz].

    Returns
    -------
    xarray.Dataset
        Over ``mode``, by increasing frequency: ``frequency`` [Hz], ``growth_rate`` [1/s], ``damping_ratio`` [1],
        ``unstable``, ``beyond_cutoff``: whether the frequency lies above the cutoff of every body that has one, and
        these have half of the kinetic energy or more, so that modes left out would take part; ``energy_share`` of each
        ``body`` in the kinetic energy [1], and ``mode_shape``, real and imaginary ``part`` of the modal displacements.
        For each contact its ``status``, forces [N], ``slip_velocity`` [m/s], NaN if a force accelerates it and none is
        given, and ``slip_acceleration`` [m/s²].
        For the equilibrium ``modal_displacement`` [kg^(1/2) m] over ``coordinate``, as for mode shapes, and the
        displacements along world x and y (``direction``) of each tip, ``tip_displacement`` [m], and of the point of
        the track that it touches, ``track_displacement`` [m]: without rigid motions that nothing holds, and under an
        imposed velocity in the frame that moves with the root.
        ``attrs["equilibrium"]`` is ``sliding``; ``held``: friction holds a contact permanently; ``lifted off``; or
        ``jammed``: it neither slides nor opens, and there are no modes unless `status` is given. With `status` it is
        the kind that would replace these statuses if they cannot persist.
        ``attrs["equilibria"]`` is the number of equilibria: ``one``, ``several``, of which one is in the result, or
        ``none``; ``at least one`` or ``none found`` where many contacts do not allow to try all their statuses; empty
        with `status`, as nothing is searched. ``attrs["violated"]`` has, in words, the inequalities that given statuses
        violate, such as a contact that pulls or one that is open below the surface; else it is empty.
        ``attrs["notes"]`` has the parts that the model describes only roughly, as in a record of `simulate`, and the
        distances of contacts and surfaces that have lifted off.
        ``attrs["round_off"]`` is the growth rate [1/s] up to which a mode does not count as unstable.

    Raises
    ------
    ValueError
        If an argument is out of its range, a slip speed is needed, a drive never stops varying, or contacts constrain
        the same motion twice.
    """
    instance("system", system, System)
    chosen = given_status(status, system)
    if time is not None:
        non_negative("time", time)
    non_negative("near", near)
    structure = Structure(system, time)
    if modes is not None:
        count("modes", modes)
    equilibrium = find_equilibrium(structure, given_velocity(velocity, structure, chosen), chosen)
    if equilibrium.kind == JAMMED and chosen is None:
        found = Exponents(np.empty(0, dtype=complex), np.empty((structure.mode_count, 0), dtype=complex))
    else:
        found = modes_of(structure, vibration(structure, equilibrium), modes, near)
    return _dataset(structure, equilibrium, found)


def stability_of(system: System, velocity: Velocity | None = None) -> dict[str, float | str]:
    """Return the stability of a system for maps: largest growth rate, its frequency, number of growing modes.

    Parameters
    ----------
    system : System
        The system.
    velocity : float or sequence of float, optional
        Slip velocity [m/s] of contacts for which nothing prescribes it, as for `sliding_stability`.

    Returns
    -------
    dict
        ``growth_rate`` [1/s], NaN if no contact slides, since only sliding feeds a vibration; ``flutter_frequency``
        [Hz] of the mode that grows fastest, NaN if none grows; ``unstable_modes``, NaN if jammed; ``equilibrium``
        and ``equilibria`` as in `sliding_stability`.
    """
    known, nothing = growth_of(system, velocity), float("nan")
    kind, growing = known.equilibrium.kind, known.growing
    fastest = growing[np.argmax(growing.real)] if growing.size else complex(np.nan, np.nan)
    return {
        "growth_rate": nothing if known.exponents is None else float(known.exponents.real.max()),
        "flutter_frequency": float(fastest.imag / (2.0 * np.pi)),
        "unstable_modes": nothing if kind == JAMMED else float(growing.size),
        "equilibrium": kind,
        "equilibria": known.equilibrium.found,
    }


def _dataset(structure: Structure, equilibrium: Equilibrium, found: Exponents) -> xr.Dataset:
    system = structure.system
    values, shapes = found.values, found.shapes
    size = np.abs(values)
    kinetic = _kinetic(structure, shapes)
    if not structure.mass.all():
        kinetic /= np.where(shapes.any(axis=0), kinetic.sum(axis=0), 1.0)
    spans = structure.arrays.spans
    share = np.array([kinetic[first:end].sum(axis=0) for first, end in spans.values()]).T
    unstable = values.real > round_off(structure)
    limit, beyond = _beyond_cutoff(system, values.imag / (2.0 * np.pi), share)
    ratio = np.where(size > 0.0, -values.real / np.where(size > 0.0, size, 1.0), 0.0)
    data: dict[str, Any] = {
        "frequency": ("mode", values.imag / (2.0 * np.pi), described("Hz", "frequency of vibration")),
        "growth_rate": ("mode", values.real, described("1/s", "rate at which the amplitude grows")),
        "damping_ratio": ("mode", ratio, described("1", "damping ratio; below zero where the mode grows")),
        "unstable": ("mode", unstable, described("1", "whether the mode grows")),
        "beyond_cutoff": ("mode", beyond, described("1", "whether the mode lies above the cutoff of every body")),
        "energy_share": (("mode", "body"), share, described("1", "share of the body in the kinetic energy")),
        "mode_shape": (
            ("mode", "coordinate", "part"),
            np.stack([shapes.real, shapes.imag], axis=-1).transpose(1, 0, 2),
            described("1", "modal displacements, of norm 1"),
        ),
        "modal_displacement": ("coordinate", equilibrium.displacement, _attributes("modal")),
    }
    coordinates = {
        "mode": np.arange(values.size),
        "body": list(spans),
        "coordinate_body": ("coordinate", _bodies_of_coordinates(structure)),
        "part": ["real", "imaginary"],
        "direction": ["x", "y", "z"] if system.is_spatial else ["x", "y"],
    }
    several = len(system.contacts) > 1
    if several:
        coordinates["contact"] = list(system.contact_names)
    moved = np.array([line.points @ equilibrium.displacement for line in structure.lines])
    over = ("contact", "direction") if several else ("direction",)
    for side, word in enumerate(("tip", "track")):
        data[EQUILIBRIUM[word].name] = (over, moved[:, side] if several else moved[0, side], _attributes(word))
    for name, units, meaning, numbers in _contacts(equilibrium):
        data[name] = ("contact" if several else (), numbers if several else numbers[0], described(units, meaning))
    if system.has_two_tangents:
        coordinates["tangent"] = list(TANGENTS)
        lateral = {"tangential_force": equilibrium.lateral_force}
        for name in ("tangential_force", "slip_velocity", "slip_acceleration"):
            _, values, attributes = data[name]
            both = _along_tangents(np.atleast_1d(values), lateral.get(name, 0.0), structure.ways)
            data[name] = (("contact", "tangent"), both, attributes) if several else ("tangent", both[0], attributes)
    attributes = {"equilibrium": equilibrium.kind, "equilibria": equilibrium.found}
    attributes |= {"violated": "; ".join(equilibrium.violated), "round_off": round_off(structure)}
    opened = open_words(structure, equilibrium) if equilibrium.kind == LIFTED_OFF else []
    notes = [*opened, *notes_of(system, structure.arrays, AHEAD)]
    notes += _notes_of_growth(structure, found.values.real[unstable], int(np.sum(unstable & beyond)), limit)
    attributes["notes"] = "; ".join(notes)
    return xr.Dataset(data, coordinates, attributes)


def _notes_of_growth(structure: Structure, growth: Array, beyond: int, limit: float) -> list[str]:
    """Return notes on growing modes that cannot be believed.

    Parameters
    ----------
    structure : Structure
        The system.
    growth : ndarray, shape (growing modes,)
        Growth rates [1/s].
    beyond : int
        Number of growing modes above the cutoff of every body.
    limit : float
        This cutoff [Hz].
    """
    notes = []
    fastest = float(np.sqrt(np.diag(structure.stiffness)[structure.mass > 0.0].max(initial=0.0)))
    if count := int(np.sum((growth > fastest) & (fastest > 0.0))):
        grow = "mode grows" if count == 1 else "modes grow"
        notes.append(
            f"{count} {grow} faster than any mode that is kept vibrates: residual shapes, "
            "which have no mass, are unstable under this friction"
        )
    if beyond:
        lie = "mode lies" if beyond == 1 else "modes lie"
        notes.append(
            f"{beyond} growing {lie} above the cutoff of every body, {limit:.4g} Hz, without the modes left out"
        )
    return notes


def _kinetic(structure: Structure, shapes: Array) -> Array:
    """Return twice the kinetic energy of each coordinate of the bodies for modes, up to a factor of each mode."""
    arrays, moved = structure.arrays, shapes.copy()
    joined = len(arrays.blend)
    moved[:joined] = arrays.blend @ shapes[:joined]
    return np.where(arrays.shapes_of_bodies, 0.0, 1.0)[:, None] * np.abs(moved) ** 2


def _bodies_of_coordinates(structure: Structure) -> Array:
    """Return the name of the body of each coordinate."""
    body = np.empty(structure.mode_count, dtype=object)
    for name, (first, end) in structure.arrays.spans.items():
        body[first:end] = name
    return body.astype(str)


def highest_cutoff(system: System) -> float:
    """Return the highest cutoff of the bodies of a system [Hz], infinite if none has any."""
    cutoffs = [getattr(body, "cutoff", None) for body in system.bodies]
    return max((float(one) for one in cutoffs if one is not None), default=np.inf)


def _beyond_cutoff(system: System, frequency: Array, share: Array) -> tuple[float, Array]:
    """Return the highest cutoff of the bodies [Hz], and which modes of these bodies lie above it.

    Parameters
    ----------
    system : System
        The system.
    frequency : ndarray, shape (modes,)
        Frequencies [Hz].
    share : ndarray, shape (modes, bodies)
        Share of each body in the kinetic energy.
    """
    cut = np.array([getattr(body, "cutoff", None) is not None for body in system.bodies])
    limit = highest_cutoff(system)
    return limit, (frequency > limit) & (share[:, cut].sum(axis=1) >= OF_THE_BODIES)


def _along_tangents(along: Array, across: Array | float, ways: Array) -> Array:
    """Return components along both tangents from those along and across the slip of contacts, (contacts, 2)."""
    c, s = ways.T
    return np.stack([c * along - s * across, s * along + c * across], axis=1)


def _attributes(word: str) -> dict[str, str]:
    return described(EQUILIBRIUM[word].units, EQUILIBRIUM[word].long_name)


def _contacts(at: Equilibrium) -> list[tuple[str, str, str, Array]]:
    """Return name, unit, meaning and values of the variables of the contacts."""
    # The slip velocity of a contact accelerated by a force is unknown.
    slip = np.where((at.sense != 0.0) & (at.slip_velocity == 0.0), np.nan, at.slip_velocity)
    return [
        ("status", "1", "status of the contact", np.array(at.status)),
        ("normal_force", "N", "normal contact force, compressive", at.normal_force),
        ("tangential_force", "N", "tangential contact force on the track along its tangent", at.tangential_force),
        ("slip_velocity", "m/s", "velocity of the tip along the track", slip),
        ("slip_acceleration", "m/s2", "acceleration of the tip along the track", at.slip_acceleration),
    ]
