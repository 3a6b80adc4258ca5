"""Time scales of a system from which its default step follows, besides those of the modes up to a cutoff."""

from __future__ import annotations

import numpy as np

from .._kernels.layout import columns as at
from ..arrays import Array
from .assembly import Assembly

# Number of times at which loads are evaluated.
TIMES = 256
# Share of the duration over which speeds at an instant are taken.
INSTANT = 1e-6
# Contact force expected under a load that begins at once, relative to the load.
OVERSHOOT = 2.0
# Angular frequency that takes the same step as a rate of braking, over it: an error of 0.1 % in the rate.
AS_FAST = 4.0


def fastest_vibration(arrays: Assembly, duration: float) -> float:
    """Return the highest angular frequency [rad/s] of lumped masses on their springs and contacts, 0 without any.

    All motions of lumped bodies are physical, unlike the highest modes below a cutoff: a squeal or an impact on a
    contact with a stiffness may have this frequency. Other bodies are held, except for their rigid motions. Contacts
    are closed, with the stiffness under the largest force expected within `duration` [s], and stick where they have a
    tangential stiffness. Nonlinear springs have the largest stiffness of their table, or that of their stretch.
    Dashpots by a table count with a multiple of the rate at which they brake.
    """
    lumped = np.flatnonzero(arrays.lumped)
    if not lumped.size:
        return 0.0
    rows = np.array([one.fixed[0, lumped] for one in arrays.contacts if one.yields is not None])
    joints = [(one.fixed[1:, lumped], one.contact.tangential_stiffness) for one in arrays.contacts]
    joined = [(rows, stiffness) for rows, stiffness in joints if stiffness is not None]
    springs = arrays.springs
    if not rows.size and not joined and not arrays.coupled and not springs.bends:
        return float(arrays.angular_frequency[lumped].max())
    stiffness = arrays.all_stiffness[np.ix_(lumped, lumped)]
    if rows.size:
        stiffness = stiffness + (rows.T * expected_stiffness(arrays, duration)) @ rows
    for row, bend in zip(springs.rows, springs.bends, strict=True):
        if not bend.of_rate:
            stiffness = stiffness + bend.steepest(float(row @ arrays.position)) * np.outer(row[lumped], row[lumped])
    for along, joint in joined:
        stiffness = stiffness + joint * along.T @ along
    fastest = float(np.sqrt(max(np.linalg.eigvalsh(0.5 * (stiffness + stiffness.T))[-1], 0.0)))
    return max(fastest, AS_FAST * _fastest_braking(arrays, lumped))


def _fastest_braking(arrays: Assembly, lumped: Array) -> float:
    """Return the highest rate at which dashpots by a table brake lumped masses [1/s], beyond their linear parts."""
    damping = np.zeros((lumped.size, lumped.size))
    for row, bend in zip(arrays.springs.rows, arrays.springs.bends, strict=True):
        if bend.of_rate:
            damping += bend.steepest(0.0) * np.outer(row[lumped], row[lumped])
    return float(max(np.linalg.eigvalsh(damping)[-1], 0.0))


def fastest_passage(arrays: Assembly, duration: float) -> float:
    """Return the highest angular frequency [rad/s] at which waves of profiles pass under tips, 0 without any.

    Tracks and tips move as imposed within `duration` [s], and tips as at the start; other motion is not known before.
    """
    if all(one.profile is None for one in arrays.contacts):
        return 0.0
    speeds = zip(arrays.contacts, _passing(arrays, duration), strict=True)
    return max(2.0 * np.pi * speed / one.profile.wavelength for one, speed in speeds if one.profile is not None)


def _passing(arrays: Assembly, duration: float) -> list[float]:
    """Return the largest speed of each tip along its track [m/s], by imposed motion and that at the start."""
    times, instant = np.linspace(0.0, duration, TIMES), INSTANT * duration
    moved = arrays.motion(times + instant, instant) - arrays.motion(times, instant)
    speeds = (moved[:, :, at.TIP_MOTION] - moved[:, :, at.TRACK_MOTION]) / instant
    own = np.array([one.fixed[1] @ arrays.velocity for one in arrays.contacts])
    return np.abs(speeds + own).max(axis=0).tolist()


def expected_stiffness(arrays: Assembly, duration: float) -> Array:
    """Return the stiffness of each contact that has one [N/m] under the largest force expected within `duration` [s].

    A contact with a power law is expected to take the loads and to stop the velocity that it has at the start, or has
    gained while its gap closes, each as if it were the only one.
    """
    soft = [one for one in arrays.contacts if one.yields is not None]
    if all(one.yields is not None and one.yields.numbers[1] == 1.0 for one in soft):
        return np.array([one.yields.numbers[0] for one in soft if one.yields is not None])
    times = np.linspace(0.0, duration, TIMES)
    factors = arrays.signals.factors(times, times[1])
    lifts = np.gradient(arrays.motion(times, times[1])[:, :, at.GAP_MOTION], times, axis=0)
    passing, found = _passing(arrays, duration), []
    for number, one in enumerate(arrays.contacts):
        if one.yields is None:
            continue
        row = np.where(arrays.lumped, one.fixed[0], 0.0)
        mobility = float(row @ row)
        pull = -(row @ arrays.loads.T) @ factors.reshape(len(arrays.loads), -1) if len(arrays.loads) else np.zeros(1)
        pressing = max(float(pull.max()), 0.0)
        gap = float(one.gap + one.fixed[0] @ arrays.position)
        rising = 0.0 if one.profile is None else one.profile.steepest * passing[number]
        speed = max(rising - float(one.fixed[0] @ arrays.velocity + lifts[:, number].min()), 0.0)
        energy = 0.5 * speed**2 + pressing * max(gap, 0.0)
        found.append(_steepest(one.yields.numbers, energy / mobility, OVERSHOOT * pressing / mobility, -gap))
    return np.array(found)


def _steepest(numbers: tuple[float, float, float, float], energy: float, force: float, indentation: float) -> float:
    """Return the stiffness [N/m] at the deepest indentation: under an energy [J], a force [N], or as it is [m]."""
    k, p, *_ = numbers
    deepest = max((energy * (p + 1.0) / k) ** (1.0 / (p + 1.0)), (force / k) ** (1.0 / p), indentation, 0.0)
    return float(k * p * deepest ** (p - 1.0))
