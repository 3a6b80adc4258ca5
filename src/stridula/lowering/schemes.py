"""Time schemes, each a choice of three coefficients per mode.

Recurrence of increments d and positions q, for a modal force f of loads and contacts at step n::

    d[n+1] = b d[n] - r q[n] + l f[n],    q[n+1] = q[n] + d[n+1]

Modes coupled by springs, dashpots or a general damping matrix, ``q'' + D q' + K q = f``, have the same recurrence with
matrices in place of b, r and l.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
import scipy.linalg
from scipy.special import exprel, hyp1f1

from ..arrays import Array

# Damping times step up to which a start is integrated back in time.
FOLLOWED_BACK = 2.0


@dataclass(frozen=True)
class Coefficients:
    """Coefficients of the recurrence, each of shape (modes,), or (modes, modes) for coupled modes.

    Attributes
    ----------
    b, r : ndarray
        Share of the last increment kept, and stiffness of the step [1].
    load : ndarray
        Increment for a unit force [s²]; ``r = load w²``, so that the equilibrium under a constant force is exact.
    """

    b: Array
    r: Array
    load: Array


class Scheme(Protocol):
    """A time scheme."""

    @property
    def name(self) -> str:
        """Name in scenarios and records."""
        ...

    @property
    def default_fraction(self) -> float:
        """Default step as a share of the limit."""
        ...

    def coefficients(self, angular: Array, rate: Array, step: float) -> Coefficients:
        """Return the coefficients of ``q'' + d q' + w² q = f`` for w [rad/s] and a rate d [1/s] at `step` [s]."""
        ...

    def limit(self, angular: Array, rate: Array) -> float:
        """Return the step [s] below which it is stable."""
        ...

    def first_increment(
        self, angular: Array, rate: Array, step: float, position: Array, velocity: Array, force: Array
    ) -> Array:
        """Return ``q[0] - q[-1]`` of motion that passes `position` with `velocity` under a constant `force`."""
        ...

    def coupled_coefficients(self, stiffness: Array, damping: Array, step: float) -> Coefficients:
        """Return the coefficients of ``q'' + damping q' + stiffness q = f``, all matrices."""
        ...

    def coupled_limit(self, stiffness: Array, damping: Array) -> float:
        """Return the step [s] below which it is stable for coupled modes."""
        ...

    def coupled_first_increment(
        self, stiffness: Array, damping: Array, step: float, position: Array, velocity: Array, force: Array
    ) -> Array:
        """Return the first increment of coupled modes, of one motion (modes,) or several, (motions, modes)."""
        ...


@dataclass(frozen=True)
class CentralDifference:
    """Explicit central differences of second order (Carpenter, Taylor & Katona 1991, with contact multipliers).

    Stable below ``2 / w_max``; the default step is half of that.
    """

    name: ClassVar[str] = "central difference"
    default_fraction: ClassVar[float] = 0.5

    def coefficients(self, angular: Array, rate: Array, step: float) -> Coefficients:
        """Return the coefficients of ``q'' + d q' + w² q = f`` with centred derivatives."""
        divisor = 1.0 + 0.5 * rate * step
        return Coefficients(
            b=(1.0 - 0.5 * rate * step) / divisor,
            r=(angular * step) ** 2 / divisor,
            load=step**2 / divisor,
        )

    def limit(self, angular: Array, rate: Array) -> float:
        """Return ``2 / w_max`` [s]."""
        highest = float(np.max(angular, initial=0.0))
        return 2.0 / highest if highest else np.inf

    def first_increment(
        self, angular: Array, rate: Array, step: float, position: Array, velocity: Array, force: Array
    ) -> Array:
        """Return the increment whose centred velocity at the start is `velocity`."""
        return _centred(self.coefficients(angular, rate, step), step, position, velocity, force)

    def coupled_coefficients(self, stiffness: Array, damping: Array, step: float) -> Coefficients:
        """Return the matrices of the same differences, divided by ``(1 + h D / 2)``."""
        one, half = np.eye(len(stiffness)), 0.5 * step * damping
        inverse = np.linalg.inv(one + half)
        return Coefficients(b=inverse @ (one - half), r=step**2 * inverse @ stiffness, load=step**2 * inverse)

    def coupled_limit(self, stiffness: Array, damping: Array) -> float:
        """Return ``2 / w_max`` [s] of the undamped coupled modes."""
        angular = _angular(stiffness)
        return self.limit(angular, np.zeros_like(angular))

    def coupled_first_increment(
        self, stiffness: Array, damping: Array, step: float, position: Array, velocity: Array, force: Array
    ) -> Array:
        """Return the increment whose centred velocity at the start is `velocity`."""
        k = self.coupled_coefficients(stiffness, damping, step)
        return _centred_start(k, step, position, velocity, force)


@dataclass(frozen=True)
class ExactModal:
    """Exact free motion of every damped mode at any step (Issanchou, Acary, Perignon, Touze & Le Carrou 2018).

    The step must be below half the period of the highest mode; the default is a fifth of that.
    """

    name: ClassVar[str] = "exact modal"
    default_fraction: ClassVar[float] = 0.2

    def coefficients(self, angular: Array, rate: Array, step: float) -> Coefficients:
        """Return the coefficients of exact free motion without cancellation.

        ``b = e^(-d h)``, ``r = (1 - e^(-m1 h)) (1 - e^(-m2 h))`` and ``l = r / w²``, with the roots ``-m1`` and ``-m2``
        of ``x² + d x + w²``. Below critical damping ``r = 1 - 2 e^(-d h / 2) cos(wd h) + b``.
        """
        damped, decay = _damped(angular, rate), 0.5 * rate * step
        oscillating = damped.imag == 0.0
        safe = np.where(oscillating & (angular > 0.0), angular, 1.0)
        r = np.expm1(-decay) ** 2 + 4.0 * np.exp(-decay) * np.sin(damped.real * step / 2.0) ** 2
        fast = 0.5 * rate + damped.imag
        slow = angular**2 / np.where(fast > 0.0, fast, 1.0)
        creeping = step**2 * exprel(-slow * step) * exprel(-fast * step)
        load = np.where(oscillating & (angular > 0.0), r / safe**2, creeping)
        return Coefficients(b=np.exp(-2.0 * decay), r=load * angular**2, load=load)

    def limit(self, angular: Array, rate: Array) -> float:
        """Return half the shortest damped period [s]; overdamped modes have none."""
        highest = float(np.max(_damped(angular, rate).real, initial=0.0))
        return np.pi / highest if highest else np.inf

    def first_increment(
        self, angular: Array, rate: Array, step: float, position: Array, velocity: Array, force: Array
    ) -> Array:
        """Return ``q(0) - q(-h)`` of the exact motion, integrated back, or of a centred velocity.

        Strongly damped motion grows without bound when it is integrated back: see `coupled_first_increment`.
        """
        rigid = angular == 0.0
        decay = np.minimum(rate * step, FOLLOWED_BACK)
        phase = _damped(angular, decay / step) * step
        offset = position - np.where(rigid, 0.0, force / np.where(rigid, 1.0, angular) ** 2)
        swing = step * velocity + 0.5 * decay * offset
        back = np.exp(0.5 * decay) * (offset * np.cos(phase).real - swing * np.sinc(phase / np.pi).real)
        found = offset - back
        if rigid.any():
            free = step * velocity * exprel(decay) - 0.5 * force * step**2 * hyp1f1(1.0, 3.0, decay)
            found = np.where(rigid, free, found)
        strong = rate * step > FOLLOWED_BACK
        if not strong.any():
            return np.asarray(found)
        centred = _centred(self.coefficients(angular, rate, step), step, position, velocity, force)
        return np.where(strong, centred, found)

    def coupled_coefficients(self, stiffness: Array, damping: Array, step: float) -> Coefficients:
        """Return the matrices of exact free motion.

        With the blocks ``[[E, F], [H, G]]`` of the exponential of the state matrix over a step and ``J``, the integral
        of ``F``: ``load = J + F (F - G F^-1 J)``, ``r = load K`` without cancellation, and ``b = F (G F^-1 E - H)``
        from two steps of free motion. `load` is symmetric if K and D commute.
        """
        size = len(stiffness)
        passed = _transition(stiffness, damping, step)
        e, f, j = passed[:size, :size], passed[:size, size : 2 * size], passed[:size, 2 * size :]
        g_f, g = np.linalg.solve(f.T, passed[size : 2 * size, size : 2 * size].T).T, passed[size : 2 * size]
        load = j + f @ (f - g_f @ j)
        return Coefficients(b=f @ (g_f @ e - g[:, :size]), r=load @ stiffness, load=load)

    def coupled_limit(self, stiffness: Array, damping: Array) -> float:
        """Return half the shortest damped period [s] of the coupled modes."""
        if not stiffness.size:
            return np.inf
        zero, one = np.zeros_like(stiffness), np.eye(len(stiffness))
        roots = np.linalg.eigvals(np.block([[zero, one], [-stiffness, -damping]]))
        highest = float(np.max(np.abs(roots.imag), initial=0.0))
        return np.pi / highest if highest else np.inf

    def coupled_first_increment(
        self, stiffness: Array, damping: Array, step: float, position: Array, velocity: Array, force: Array
    ) -> Array:
        """Return ``q(0) - q(-h)`` of the exact motion, integrated back, or of a centred velocity.

        Strongly damped motion grows without bound when it is integrated back. If damping reduces a velocity by more
        than ``1 - exp(-2)`` in a step, the initial velocity is taken as ``(q(h) - q(-h)) / 2h``.
        """
        if step * float(np.max(np.abs(damping).sum(axis=1), initial=0.0)) > FOLLOWED_BACK:
            k = self.coupled_coefficients(stiffness, damping, step)
            return _centred_start(k, step, position, velocity, force)
        size = len(stiffness)
        back = _transition(stiffness, damping, -step)[:size]
        return np.asarray(position - (back @ np.concatenate([position, velocity, force], axis=-1).T).T)


def _damped(angular: Array, rate: Array) -> Array:
    """Return the damped angular frequencies [rad/s], imaginary for overdamped or rigid modes."""
    half = 0.5 * rate
    return np.asarray(np.sqrt((angular - half) * (angular + half) + 0j))


def _centred(k: Coefficients, step: float, position: Array, velocity: Array, force: Array) -> Array:
    """Return the increment before the start for a centred velocity of `velocity` there."""
    return np.asarray((2.0 * step * velocity + k.r * position - k.load * force) / (1.0 + k.b))


def _centred_start(k: Coefficients, step: float, position: Array, velocity: Array, force: Array) -> Array:
    """Return the increment before the start for a centred velocity of `velocity` there, for coupled modes."""
    right = 2.0 * step * velocity.T + k.r @ position.T - k.load @ force.T
    return np.asarray(np.linalg.solve(np.eye(len(k.b)) + k.b, right).T)


def _angular(stiffness: Array) -> Array:
    return np.asarray(np.sqrt(np.maximum(np.linalg.eigvalsh(stiffness), 0.0)))


def _transition(stiffness: Array, damping: Array, step: float) -> Array:
    """Return the transition matrix of (position, velocity, constant force) over a step, shape (3 modes, 3 modes)."""
    zero, one = np.zeros_like(stiffness), np.eye(len(stiffness))
    # Scaled by the step, all entries are displacements.
    rate = np.block([[zero, one, zero], [-stiffness * step**2, -damping * step, one], [zero, zero, zero]])
    units = np.repeat([1.0, step, step**2], len(stiffness))
    return np.asarray(scipy.linalg.expm(rate) / units[:, None] * units)


SCHEMES: dict[str, type[CentralDifference] | type[ExactModal]] = {
    "central difference": CentralDifference,
    "exact modal": ExactModal,
}
