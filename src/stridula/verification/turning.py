"""Turning bodies: transport of waves, their lag by Coriolis forces, and the speed at which a wave stands still."""

from __future__ import annotations

from math import pi

import numpy as np

from ..arrays import Array
from ..bodies import AxisymmetricBody
from ..drives import Force
from ..integration import simulate
from ..linear.equilibrium import find_equilibrium
from ..linear.modes import modes_of
from ..linear.structure import SEPARATED, Structure
from ..linear.vibration import vibration
from ..lowering.schemes import Scheme
from ..records import Displacement
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme
from .systems.discs import HALF, HERE, disc, ring, struck, untouched

RPM = pi / 30.0
# Highest frequency of the modes of the disc [Hz].
CUTOFF = 2500.0


def _frequencies(body: AxisymmetricBody) -> Array:
    """Return the rising frequencies of a body without contact by linear theory of its system [Hz]."""
    structure = Structure(untouched(body))
    found = modes_of(structure, vibration(structure, find_equilibrium(structure, np.zeros(1), [SEPARATED])))
    return np.sort(np.abs(found.values.imag)) / (2.0 * pi)


def ring_case() -> Outcome:
    """A free ring of 176 mm at 12 000 rpm: its waves turn by (n² - 1) / (n² + 1) of its own turn (Bryan 1890).

    In the material the pair of n waves is split by twice 2 n / (n² + 1) of the speed: 320 and 240 Hz between the
    frequencies that Ansys prints, 411.535 and 91.535, 643.899 and 403.899 Hz. Tension, a second-order effect
    neglected here, raises their means above those at rest.
    """
    rows, turns = [], 12e3 * RPM
    turning = ring(turns).modes().turning
    assert turning is not None
    thin = "thickness and breadth of the ring, (n h / r)² and (n b / r)² / 12"
    for printed, order, drag in zip(
        (411.535 - 91.535, 643.899 - 403.899), turning.order[1:], turning.drag[1:], strict=False
    ):
        known, waves = (order**2 - 1.0) / (order**2 + 1.0), f"{order:.0f} waves"
        rows.append(Row(f"share of the turn, {waves}", known, drag / order, 1e-4 * order, thin))
        split = 2.0 * (order - drag) * turns / (2.0 * pi)
        rows.append(Row(f"split in the material, {waves}", printed, split, 5e-4 * printed, thin, "Hz"))
    speeds = np.linspace(0.0, 60.0, 5)
    curves = []
    for k, pair in enumerate(turning.pairs[1:3], start=1):
        rest = ring(turns).modes().frequency[pair[0]]
        for sign in (1.0, -1.0):
            found = rest + sign * turning.drag[k] * speeds
            curves.append(Curve(speeds, found, f"{turning.order[k]:.0f} waves, {'with' if sign > 0 else 'against'}"))
    return Outcome(rows, Sketch("turns per second [1/s]", "frequency in space [Hz]", curves))


def disc_case() -> Outcome:
    """A disc held at its bore: pairs split into f + n W and f - n W, a wave stands still at w / n, a blow causes beats.

    Bending waves of a thin disc hardly lag; their lag is computed with the modes and included in the closed forms.
    """
    turns = 60.0
    system, body = struck(turns, cutoff=CUTOFF)
    modes = body.modes()
    assert modes.turning is not None
    frequency, pairs = modes.frequency, modes.turning.pairs
    drag = np.zeros(modes.count)
    for pair, by in zip(pairs, modes.turning.drag, strict=True):
        drag[list(pair)] = np.array([1.0, -1.0]) * by
    # The separate body has three rigid motions.
    known, found = np.sort(np.abs(frequency + drag * turns / (2.0 * pi))), _frequencies(body)[3:]
    worst = int(np.abs(found - known).argmax())
    words, tolerance = "frequency in space, at the largest error", 1e-8 * known[worst]
    rows = [Row(words, float(known[worst]), float(found[worst]), tolerance, "round-off", "Hz")]

    def stiffness(speed: float) -> float:
        structure = Structure(untouched(disc(speed, CUTOFF), Force(disc(speed, CUTOFF).at(HERE), z=1.0)))
        at = find_equilibrium(structure, np.zeros(1), [SEPARATED])
        return 1.0 / float(-structure.lines[0].normal @ at.displacement)

    for order in (2.0, 3.0):
        k = modes.turning.order.index(order)
        critical = float(modes.angular_frequency[pairs[k][0]] / modes.turning.drag[k])
        near = (1.0 - 1e-4) * critical
        row, squares = body.trace(HERE)[2], modes.angular_frequency**2
        bent = float(np.sum(row**2 / (squares - (drag * near) ** 2)) / np.sum(row**2 / squares))
        reason = "sum over the modes; round-off over the distance from the pole"
        words = f"deflection over that at rest, just before {order:.0f} waves stand still"
        rows.append(Row(words, bent, stiffness(0.0) / stiffness(near), 1e-8 * bent, reason))
    curves: list[Curve] = []

    def beats(scheme: Scheme) -> list[Row]:
        step, length = 2e-6, HALF
        probes = [Displacement(body.at(HERE), "z")]
        run = simulate(system, 0.03, scheme=scheme, step=step, sample_rate=5e4, probes=probes)
        time, seen = run["time"].values, run["displacement"].values[:, 0]
        expected = np.zeros_like(time)
        # The spectrum of a triangular blow about its middle is sinc².
        for w, shape, by in zip(modes.angular_frequency, body.trace(HERE)[2], np.abs(drag) * turns, strict=True):
            for sign in (0.5, -0.5):
                f = w + 2.0 * sign * by
                share = length * np.sinc(f * length / (2.0 * pi)) ** 2
                expected += 0.5 * shape**2 / w * share * np.sin(f * (time - length))
        after = time > 1e-3
        size = float(np.abs(expected[after]).max())
        error = float(np.abs(seen - expected)[after].max()) / size
        tolerance = float(np.sum([(f * step) ** 2 / 24.0 * f * 0.03 for f in modes.angular_frequency[-2:]]))
        if not curves:
            curves.append(Curve(1e3 * time[after], 1e6 * expected[after], "closed form"))
        curves.append(Curve(1e3 * time, 1e6 * seen, scheme.name))
        reason = "phase of the highest modes, (w h)² w t / 24, and W h"
        return [Row("response at the place of the blow, error", 0.0, error, tolerance + 2e-3, reason, "1", scheme.name)]

    return Outcome([*rows, *by_scheme(beats)], Sketch("time [ms]", "displacement [um]", curves))


CASES = (
    Case(
        "turning-ring",
        "A turning ring: its waves lag behind it",
        "Bryan (1890); Ansys VM302, after Genta (2005)",
        ring_case,
    ),
    Case(
        "turning-disc",
        "A turning disc: split pairs, standing waves, beats",
        "waves carried round, closed form",
        disc_case,
    ),
)
