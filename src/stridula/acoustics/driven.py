"""Accelerations of the modes of a track, driven again by the recorded forces at the recorded places.

The march gives a mode one impulse in each step and moves it exactly between them. A record holds the sum of the
impulses over each sample interval H. The recurrence of the exact modal scheme with step H, ``q[n+1] = a q[n] - b q[n-1]
+ c H f[n]``, therefore reproduces every natural frequency and decay; if each step is a sample, it reproduces the march.
Two corrections remain:

- The mean over R steps lowers the force at the frequency f by ``sin(pi f H) / (R sin(pi f H / R))``; a short symmetric
  filter raises it again, up to 5/12 of the sample rate.
- A second difference of q is not its acceleration. The ratio of the two is smooth in frequency, as they have the same
  poles, and seven taps approximate it: least squares of the relative error up to 5/12 of the sample rate.

For modes and sound below a fifth of the sample rate a response is then accurate to 0.1 % without damping and to 0.05 %
per percent of critical damping; below 5/12 of it to 0.3 % and 0.15 %. Overdamped modes have two real poles
instead of a pair. A force held constant over each interval would be late by half of it, and lowered by the mean once
more. Frequencies of the force above half the sample rate are aliased, less the attenuation of the mean, as in any
record of means.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np
import scipy  # its parts are imported on first use

from ..arrays import Array
from .motions import CONTINUES, Motion
from .panels import Panel
from .recorded import Pressing

# Samples on each side over which a mean is undone; as many are put before the record's start and after its end.
LEAD = 16
# Share of the sample rate up to which a mean is undone.
UNDONE = 5.0 / 12.0
# Phase of a mode over a sample interval above which it is left out [rad].
FASTEST = 0.95 * np.pi
# Samples ahead and back from which accelerations are computed, and number of frequencies of the fit.
DEGREE, FITTED = 3, 120
# Coefficients of no, a first and a second difference.
DIFFERENCES = ((1.0,), (1.0, -1.0), (1.0, -2.0, 1.0))


@lru_cache(maxsize=16)
def undo_mean(steps: int) -> Array:
    """Return the symmetric filter that undoes a mean over `steps` values, shape (2 LEAD + 1,).

    Least squares over frequencies up to `UNDONE`, accurate to 1e-5 there.
    """
    frequency = np.linspace(0.0, UNDONE, 400)
    # The limit for many steps is the sinc.
    many = np.sinc(frequency) if steps > 1000 else np.sinc(frequency) / np.sinc(frequency / steps)
    cosines = 2.0 * np.cos(2.0 * np.pi * frequency[:, None] * np.arange(LEAD + 1))
    cosines[:, 0] = 1.0
    half = np.linalg.lstsq(cosines, 1.0 / many, rcond=1e-10)[0]
    return np.concatenate([half[:0:-1], half])


def steady(force: Array, steps: int) -> Array:
    """Return forces with the mean over their intervals undone, `LEAD` samples longer at both ends.

    The force is taken as zero before the record and as its last value after it.
    """
    taps = undo_mean(steps)
    ends = ((0, 0), (2 * LEAD, 2 * LEAD))
    padded = np.pad(force, ends, mode="constant")
    padded[:, -2 * LEAD :] = force[:, -1:]
    return np.stack([np.convolve(row, taps, mode="valid") for row in padded])


def accelerations(panel: Panel, pressing: Pressing) -> Array:
    """Return the modal accelerations of a track under recorded forces, at rest before them.

    The normal force presses the track against its normal: the modal force is ``-normal_force shape(contact_position)``.
    The tangential one drives axial modes, which do not sound.

    Parameters
    ----------
    panel : Panel
        The modes wanted, each below `FASTEST` over a sample interval.
    pressing : Pressing
        The forces.

    Returns
    -------
    ndarray, shape (modes, samples + 2 LEAD)
        Accelerations [m kg^(1/2) / s²], the first at `first_time`.
    """
    return respond(panel, modal_forces(panel, pressing), pressing.interval)


def first_time(pressing: Pressing) -> float:
    """Return the time of the first acceleration [s]: the middle of the impulses of its interval."""
    step = pressing.interval / pressing.steps
    return pressing.start + pressing.interval * (0.5 - LEAD) - step / 2.0 + pressing.later


def modal_forces(panel: Panel, pressing: Pressing) -> Array:
    """Return the forces on the modes, all contacts added, shape (modes, samples + 2 LEAD)."""
    found = np.zeros((len(panel.wavenumbers), pressing.samples + 2 * LEAD))
    for force, position in zip(steady(pressing.force, pressing.steps), pressing.position, strict=True):
        if force.any():
            shapes = panel.shapes(*panel.place(np.pad(position, LEAD, mode="edge")))
            found -= (shapes * force[:, None]).T
    return found


def pressed_motion(panel: Panel, pressing: Pressing, still: str = "the contact never presses") -> Motion:
    """Return the motion of the modes of a track under recorded forces, at rest before them.

    Parameters
    ----------
    panel : Panel
        The modes of the track.
    pressing : Pressing
        The forces.
    still : str, optional
        Cause of silence without a force.
    """
    presses = np.flatnonzero(pressing.force.any(axis=0))
    return Motion(
        pressing.start,
        pressing.interval,
        pressing.samples,
        first_time(pressing),
        float(presses[0]) * pressing.interval if presses.size else None,
        np.flatnonzero(panel.angular_frequency * pressing.interval < FASTEST),
        lambda modes: accelerations(panel.only(modes), pressing),
        still=still,
        notes=[CONTINUES] if pressing.start > 0.5 * pressing.interval else [],
    )


class Oscillators(Protocol):
    """Modes as oscillators under forces."""

    @property
    def angular_frequency(self) -> Array:
        """Angular frequencies w [rad/s], shape (modes,)."""

    @property
    def damping_rate(self) -> Array:
        """``2 zeta w`` [1/s], shape (modes,)."""


@dataclass(frozen=True)
class Modes:
    """Modes as oscillators under forces.

    Attributes
    ----------
    angular_frequency, damping_rate : ndarray, shape (modes,)
        Angular frequencies w [rad/s] and ``2 zeta w`` [1/s].
    """

    angular_frequency: Array
    damping_rate: Array


def respond(modes: Oscillators, forces: Array, interval: float, derivative: int = 2, degree: int = DEGREE) -> Array:
    """Return the accelerations of modes under impulses ``interval * forces``, shape (modes, samples).

    With a `derivative` of 1 or 0, their velocities or displacements. Strongly damped modes need a higher `degree`.
    """
    found = np.empty_like(forces)
    for row, force, taps in zip(found, forces, filters(modes, interval, derivative, degree), strict=True):
        # The numerator reaches this many samples ahead.
        row[:] = scipy.signal.lfilter(*taps, np.pad(force, (0, degree), mode="edge"))[degree:]
    return found


def filters(
    modes: Oscillators, interval: float, derivative: int = 2, degree: int = DEGREE
) -> list[tuple[Array, Array]]:
    """Return for each mode the numerator and poles of its accelerations, `degree` samples late, under impulses.

    With a `derivative` of 1 or 0, of its velocities or displacements.
    """
    turned = 2.0 * np.pi * np.linspace(0.0, UNDONE, FITTED + 1)[1:]
    late, angular = np.exp(-1j * turned), turned / interval
    powers = late[:, None] ** np.arange(-degree, degree + 1)
    found = []
    for own, rate in zip(modes.angular_frequency, modes.damping_rate, strict=True):
        decay = 0.5 * float(rate) * interval
        cosine = np.cos(np.sqrt((own * interval) ** 2 - decay**2 + 0j)).real
        poles = np.array([1.0, -2.0 * np.exp(-decay) * cosine, np.exp(-2.0 * decay)])
        answer = (1j * angular) ** derivative / (own**2 - angular**2 + 1j * rate * angular)
        missing = answer * np.polyval(poles[::-1], late) / (1.0 - late) ** derivative
        weighed = powers / np.abs(missing)[:, None]
        aim = missing / np.abs(missing)
        taps = np.linalg.lstsq(
            np.concatenate([weighed.real, weighed.imag]), np.concatenate([aim.real, aim.imag]), rcond=None
        )[0]
        found.append((np.convolve(taps, DIFFERENCES[derivative]), poles))
    return found
