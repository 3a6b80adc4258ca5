"""Sliding stability of the paper's pair: against the formula, against printed figures, and as growth in time."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np
import scipy.linalg
import xarray as xr

from ..arrays import Array
from ..bodies import FiniteElementBeam, ModalBeam, ReducedBody
from ..contact import Coulomb, PointContact
from ..drives import Force, InitialState
from ..integration import simulate
from ..lowering.schemes import Scheme
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme
from .prony import exponents, only_sliding
from .systems.pair import PUSH, Pair

# Highest frequency of the printed figures [Hz].
AUDIBLE = 6000.0
# Printed for the pair of 0.15 and 0.40 m at 45°: coefficient of friction, frequencies [Hz], growths [1/s].
PRINTED_FREE = (0.0, 109.2, 403.8, 588.2, 1210.7, 2352.8)
PRINTED_GROWING = ((1.1, ((3221.1, 1503.7),)), (1.5, ((891.4, 1454.0), (3486.1, 4595.0))))
# Printed for the pair of 0.2 and 0.3 m: angle [°] and the first unstable multiple of 0.02.
PRINTED_ONSETS = ((30.0, 0.58), (45.0, 1.02), (60.0, 1.74))
GRID = 0.02
# Smallest growth that counts [1/s]. Beyond the onset growth rises as the square root, to 20 within 1e-4.
COUNTS = 0.1


# So fine that the truncation changes no printed digit.
FINE = Pair(elements=60, bending=120, axial=120)


def below(frequency: float, found: xr.Dataset) -> Array:
    """Return the exponents [1/s] of a record below a frequency [Hz], the stiffest last."""
    values = found["growth_rate"].values + 2j * pi * found["frequency"].values
    return np.asarray(values[found["frequency"].values < frequency])


def growing(values: Array) -> Array:
    """Return the growing exponents."""
    return values[values.real > COUNTS]


def _formula_rows() -> list[Row]:
    pair, rows = Pair(), []
    for friction in (0.0, 1.1, 1.5):
        known, found = pair.formula(friction), below(AUDIBLE, pair.found(friction))
        for exponent in found[np.abs(found) > 1.0]:
            nearest = known[np.abs(known - exponent).argmin()]
            words = f"friction {friction:g}: {exponent.imag / (2.0 * pi):.0f} Hz, growth {exponent.real:.0f} 1/s"
            reason = "the same matrices: round-off of squares, 10 eps times the highest over twice this one"
            off = float(abs(exponent - nearest))
            rows.append(Row(f"{words}, distance", 0.0, off, pair.rounding(exponent), reason, "1/s"))
    return rows


def _printed_rows() -> list[Row]:
    pair, reason = FINE, "half of the last digit printed"
    free = below(AUDIBLE, pair.found(0.0)).imag / (2.0 * pi)
    rows = [
        Row(f"friction 0, frequency {k}", known, float(free[k]), 0.05, reason, "Hz")
        for k, known in enumerate(PRINTED_FREE)
    ]
    for friction, expected in PRINTED_GROWING:
        found = growing(below(AUDIBLE, pair.found(friction)))
        rows.append(Row(f"friction {friction:g}: modes that grow", len(expected), found.size, 0.0, "a count"))
        for (frequency, growth), exponent in zip(expected, found, strict=True):
            words, digit = f"friction {friction:g}, near {frequency:.0f} Hz", 0.05 if growth % 1.0 else 0.5
            seen = float(exponent.imag) / (2.0 * pi)
            rows.append(Row(f"{words}: frequency", frequency, seen, 0.05, reason, "Hz"))
            rows.append(Row(f"{words}: growth", growth, float(exponent.real), digit, reason, "1/s"))
    return rows


def _onset_rows() -> list[Row]:
    """Return the first unstable multiple of 0.02 at each angle, as in the printed scan."""
    rows = []
    for angle, onset in PRINTED_ONSETS:
        pair = Pair(0.2, 0.3, angle, elements=12, bending=30, axial=15)
        scan = GRID * np.arange(round(onset / GRID) - 5, round(onset / GRID) + 3)
        grows = [growing(below(np.inf, pair.found(float(friction)))).size > 0 for friction in scan]
        found = float(scan[int(np.argmax(grows))]) if any(grows) else float("nan")
        rows.append(Row(f"{angle:g}°: first unstable in steps of 0.02", onset, found, 1e-9, "a multiple of 0.02"))
    return rows


def _seen(which: int, scheme: Scheme) -> tuple[complex, complex, float, Curve]:
    """Return a growing exponent of the pair with modes below 6 kHz, and that of its normal force in time.

    For bodies given by matrices the contact point is fixed, so that small motions are linear while they slide.
    """
    pair, friction = Pair(), 1.5
    rod = _matrices(pair.rod, pair.rod.length, "rod")
    beam = _matrices(pair.beam, pair.beam.length / 2.0, "beam")
    contact = PointContact(rod.at("0"), beam.at("1"), friction=Coulomb(friction))
    along = radians(pair.angle)
    push = Force(rod.at("1"), x=-PUSH * sin(along), y=-PUSH * cos(along))
    # Shapes and equilibrium are computed here by the formula, not by the package.
    tip, under = rod.trace("0"), beam.trace("1")
    tangent, normal = (np.concatenate([tip[k], -under[k]]) for k in (0, 1))
    angular = np.concatenate([rod.modes().angular_frequency, beam.modes().angular_frequency])
    acts, count = normal + friction * tangent, rod.modes().count
    load = np.concatenate([np.array([push.x, push.y]) @ rod.trace("1"), np.zeros(beam.modes().count)])
    rest, free = _rest(angular, acts, normal, load)
    right, left = scipy.linalg.null_space(normal[None]), scipy.linalg.null_space(acts[None])
    squared, shapes = scipy.linalg.eig((left.T * angular**2) @ right, left.T @ right)
    value = np.sqrt(-squared.astype(complex))
    value = np.where(value.real < 0.0, -value, value)
    chosen = np.flatnonzero((value.real > COUNTS) & (value.imag > 0.0))
    chosen = chosen[np.argsort(value[chosen].imag)][which]
    shape, exponent = right @ shapes[:, chosen], complex(value[chosen])
    kick = 1e-4 * np.abs(rest).max() * shape / np.abs(shape).max()
    place = rest + kick.real
    speed = (exponent * kick).real - free / (tangent @ free)
    start = [
        InitialState(body, displacement=tuple(body.shapes @ place[part]), velocity=tuple(body.shapes @ speed[part]))
        for body, part in ((rod, slice(0, count)), (beam, slice(count, None)))
    ]
    period, every = 2.0 * pi / exponent.imag, 40
    step = period / 2000.0
    system = System(contact, drives=[push, *start])
    run = simulate(system, 2.0 * period, scheme=scheme, step=step, sample_rate=1.0 / step, probes=[])
    only_sliding(run)
    force = run["normal_force"].values[every // 2 :: every]
    both = exponents(force[:, None], every * step, 1.0 / abs(exponent))
    found = both[np.nanargmin(np.abs(both - exponent))]
    tolerance = abs(exponent) * (float(angular.max()) * step) ** 2 / 12.0
    name = f"{exponent.imag / (2.0 * pi):.0f} Hz, {scheme.name}"
    time, change = run["time"].values / period, np.abs(run["normal_force"].values / run["normal_force"].values[0] - 1.0)
    return exponent, complex(found), tolerance, Curve(time, change, name)


def _rest(angular: Array, acts: Array, normal: Array, load: Array) -> tuple[Array, Array]:
    """Return the equilibrium of the pair in the frame of its free rigid motion, and that motion."""
    rigid = np.eye(angular.size)[:, angular == 0.0]
    free = rigid @ scipy.linalg.null_space((normal @ rigid)[None])[:, 0]
    size = angular.size
    whole = np.zeros((size + 2, size + 2))
    whole[:size] = np.hstack([np.diag(angular**2), free[:, None], -acts[:, None]])
    whole[size, :size], whole[size + 1, :size] = free, normal
    scale = 1.0 / np.append(np.maximum(angular, 1.0), [1.0, 1.0])
    solved = scale * np.linalg.solve(whole * np.outer(scale, scale), scale * np.append(load, [0.0, 0.0]))
    return solved[:size], free


def _matrices(body: FiniteElementBeam | ModalBeam, place: float, name: str) -> ReducedBody:
    """Return the modes of a body below 6 kHz as matrices, with its end as point 0 and a place along it as point 1."""
    kept = body.modes().angular_frequency <= 2.0 * pi * AUDIBLE
    points = {word: body.trace(at)[:, kept] for word, at in {"0": 0.0, "1": place}.items()}
    angular = body.modes().angular_frequency[kept]
    return ReducedBody(np.eye(angular.size), np.diag(angular**2), points, name=name)


def stability() -> Outcome:
    """The formula, the figures printed, and growth in time."""
    curves: list[Curve] = []

    def rows(scheme: Scheme) -> list[Row]:
        found = []
        for which in (0, 1):
            known, seen, tolerance, curve = _seen(which, scheme)
            curves.append(curve)
            words = f"friction 1.5, modes below 6 kHz, in time, near {known.imag / (2.0 * pi):.0f} Hz"
            reason = "second order: |s| (W h)² / 12, W the highest frequency without contact"
            found.append(Row(f"{words}: growth", known.real, seen.real, tolerance, reason, "1/s", scheme.name))
            found.append(Row(f"{words}: frequency", known.imag, seen.imag, tolerance, reason, "rad/s", scheme.name))
        return found

    every = [*_formula_rows(), *_printed_rows(), *_onset_rows(), *by_scheme(rows)]
    sketch = Sketch("time [periods]", "normal force over that of rest, less 1", curves)
    return Outcome(every, sketch, [ONSETS])


ONSETS = (
    "Printed onsets are the first unstable multiples of 0.02: undamped, with all modes and growth above "
    "0.1 1/s counted, flutter begins at 0.579, 1.002 and 1.734, near 1823 Hz, for any number of modes."
)

CASES = (
    Case(
        "sliding-stability",
        "Sliding stability of the paper's pair",
        "eigenvalues of (Y'MZ, Y'KZ), Z = null(G), Y = null(G - s mu T), and stated figures of the pair of "
        "Laulagnet 2011 in steel, guided at its root",
        stability,
    ),
)
