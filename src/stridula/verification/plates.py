"""The simply supported plate: natural frequencies, also in its plane, deflection under a force, mobility at a point."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
from scipy.special import j1

from ..analysis.mobilities import mobility
from ..arrays import Array
from ..bodies import Material, ModalBeam, ModalPlate, Rectangle
from .case import Case, Curve, Outcome, Row, Sketch

STEEL = Material(2.1e11, 7800.0, 0.3)
# Frequencies of the first modes (m, n) of a plate of 0.4 m x 0.3 m x 2 mm [Hz], as printed.
PRINTED = {(1, 1): 85.640, (2, 1): 178.132, (1, 2): 250.070, (2, 2): 342.561}
# First in-plane modes: half-waves, whether a shear mode, frequency [Hz].
PRINTED_IN_PLANE = (
    ((1, 1), "shear", 6704.01),
    ((1, 0), "longitudinal", 6799.10),
    ((0, 1), "longitudinal", 9065.47),
    ((2, 1), "shear", 9668.66),
    ((1, 1), "longitudinal", 11331.84),
)
# Deflection at the centre of a square plate under a force F there, over F a²/D: Timoshenko & Woinowsky-Krieger.
TIMOSHENKO = 0.01160


def frequencies() -> Outcome:
    """The first modes of a plate against the closed form."""
    plate = ModalPlate(STEEL, 0.002, 0.4, 0.3, cutoff=400.0)
    found = {(int(m), int(n)): float(f) for (m, n), f in zip(plate.numbers, plate.modes().frequency, strict=True)}
    rows = [
        Row(f"mode {pair}", known, found[pair], 0.5e-3, "half of the last digit printed", "Hz")
        for pair, known in PRINTED.items()
    ]
    rows.append(Row("modes below 400 Hz", 5, len(found), 0.0, "a count: (3, 1) lies at 332 Hz"))
    curves = [
        Curve(np.arange(1, 5), np.array(list(PRINTED.values())), "closed form"),
        Curve(np.arange(1, 5), np.array([found[pair] for pair in PRINTED]), "modal plate", marks=True),
    ]
    return Outcome(rows, Sketch("mode", "frequency [Hz]", curves))


def levy(ratio: float = 1.0, terms: int = 4000) -> float:
    """Return the deflection under a force F at the centre of a plate a x b over F a²/D, b = ratio a.

    Lévy's single series: ``sum over odd m of (tanh x - x / cosh² x) / (2 pi³ m³)`` with ``x = m pi ratio / 2``
    (Timoshenko & Woinowsky-Krieger 1959, Theory of Plates and Shells, section 34).
    """
    m = np.arange(1, 2 * terms, 2)
    x = m * pi * ratio / 2.0
    return float(np.sum((np.tanh(x) - x / np.cosh(np.minimum(x, 300.0)) ** 2) / (2.0 * pi**3 * m**3)))


def deflection() -> Outcome:
    """Sum over the modes at the centre, and its rate of convergence."""
    counts, errors, rows = np.array([5, 11, 25, 51, 101, 201]), [], []
    for count in counts:
        plate = ModalPlate(STEEL, 0.002, 0.4, 0.4, bending_modes=(int(count), int(count)))
        shapes, angular = plate.shapes(0.2, 0.2), plate.modes().angular_frequency
        found = float(np.sum((shapes / angular) ** 2)) * plate.rigidity / plate.length**2
        errors.append(levy() - found)
    # A quarter of the pairs are odd: 4 / pi⁴ times the integral of 1 / (4 r⁴) over the quadrant beyond the last.
    tail = pi / (16.0 * counts[-1] ** 2) * 4.0 / pi**4
    rows.append(Row("printed table", TIMOSHENKO, found, 0.5e-5, "half of the last digit printed"))
    rows.append(Row("single series", levy(), found, tail, "the modes left out: 4 / pi⁴ of the sum of 1 / (m² + n²)²"))
    order = -float(np.polyfit(np.log(counts[2:]), np.log(np.array(errors[2:])), 1)[0])
    rows.append(Row("order of the sum in modes a side", 2.0, order, 0.1, "terms r^-4 over an area: order 2 within 0.1"))
    curves = [Curve(counts, np.array(errors), "left out", marks=True), Curve(counts, 0.01 / counts**2.0, "order 2")]
    return Outcome(rows, Sketch("modes a side", "deflection left out / (F a²/D)", curves, logarithmic=True))


def of_images(plate: ModalPlate, place: tuple[float, float], low: float, high: float) -> tuple[float, float]:
    """Return the mean of the real mobility over that of an infinite plate, in a band [Hz], and the truncation error.

    Every edge reflects with the other sign: the real mobility is the sum of ``±J0(k r)`` over the images at distances
    r, whose mean over the band is ``2 (k J1(k r)) / r`` between its ends over the difference of k². Damping quenches
    the images by ``exp(-zeta k r / 2)``; the magnitude of the outermost ring of them is the truncation error.
    """
    band = np.sqrt(2.0 * pi * np.array([low, high]) * sqrt(plate.surface_density / plate.rigidity))
    cells, zeta = np.arange(-3, 4), float(plate.modes().damping[0])
    mean, rest = 1.0, 0.0
    for p in cells:
        for q in cells:
            for sign_x in (1, -1):
                for sign_y in (1, -1):
                    x = 2 * p * plate.length + (sign_x - 1) * place[0]
                    y = 2 * q * plate.width + (sign_y - 1) * place[1]
                    r = float(np.hypot(x, y))
                    if r == 0.0:
                        continue
                    ends = band * j1(band * r) * np.exp(-zeta * band * r / 2.0)
                    share = sign_x * sign_y * 2.0 * float(ends[1] - ends[0]) / (r * float(np.ptp(band**2)))
                    mean += share
                    rest += abs(share) * (max(abs(p), abs(q)) == 3)
    return mean, rest


def of_modes_kept(plate: ModalPlate, frequency: Array) -> float:
    """Return the share of modes from zero to the cutoff in the mean real mobility of a plate without edges.

    The density of modes is constant over frequency, and each adds a constant times
    ``2 zeta u / ((u² - 1)² + 4 zeta² u²)`` at u = w / omega; its integral is elementary. From zero to
    infinity it is ``1 - 2 zeta / pi`` of that without damping.
    """
    zeta = float(plate.modes().damping[0])
    middle = 1.0 - 2.0 * zeta**2
    half = sqrt(1.0 - middle**2)
    highest = (plate.modes().frequency[-1] / frequency) ** 2
    whole = (np.arctan((highest - middle) / half) + np.arctan(middle / half)) * 2.0 * zeta / half
    return float(np.mean(whole)) / pi


def answers() -> Outcome:
    """The mean of the real mobility at points inside against the infinite plate's, ``1 / 8 sqrt(D rho h)``."""
    plate = ModalPlate(STEEL, 0.003, 0.6, 0.5, damping=0.01, cutoff=20e3)
    low, high = 500.0, 8000.0
    frequency = np.arange(low, high, 1.0)
    infinite = 1.0 / (8.0 * sqrt(plate.rigidity * plate.surface_density))
    rows, curves = [], []
    for place in ((0.21, 0.17), (0.3, 0.25), (0.13, 0.33)):
        real = mobility(plate.at(place), frequency=frequency).values.real
        images, rest = of_images(plate, place, low, high)
        known = of_modes_kept(plate, frequency) + images - 1.0
        rows.append(
            Row(
                f"mean real mobility at {place} m, 0.5 to 8 kHz, over the infinite plate's",
                known,
                float(real.mean()) / infinite,
                rest,
                "modes kept and reflections as images; the outermost ring of them",
            )
        )
        curves.append(Curve(frequency[::10], real[::10] / infinite, f"at {place} m"))
    notes = [f"The infinite plate's mobility is {infinite:.6g} s/kg."]
    return Outcome(rows, Sketch("frequency [Hz]", "real mobility over the infinite plate's", curves), notes)


def in_plane() -> Outcome:
    """The first modes in the plane against the closed form, and modes along the length against a clamped bar."""
    plate = ModalPlate(STEEL, 0.002, 0.4, 0.3, in_plane=True)
    frequency = plate.modes().frequency[plate.harmonics[0] :][: len(PRINTED_IN_PLANE)]
    # A longitudinal mode moves along its wave.
    along = np.abs(np.sum(plate.polarisations * (plate.in_plane_numbers / [plate.length, plate.width]), axis=1))
    kinds = np.where(along < 1e-9, "shear", "longitudinal")
    rows = []
    for place, (pair, kind, known) in enumerate(PRINTED_IN_PLANE):
        same = tuple(plate.in_plane_numbers[place]) == pair and kinds[place] == kind
        found = float(frequency[place]) if same else float("nan")
        rows.append(
            Row(f"mode {place + 1}, {kind} {pair}", known, found, 0.5e-2, "half of the last digit printed", "Hz")
        )
    light, count = Material(2.1e11, 7800.0, 0.0), 201
    strip = ModalPlate(light, 0.002, 0.4, 0.3, in_plane=True, in_plane_modes=(count, 0))
    bar = ModalBeam(light, Rectangle(0.3, 0.002), 0.4, axial_modes=count)
    shapes, angular = (one[..., strip.harmonics[0] :] for one in (strip.trace(0.2)[0], strip.modes().angular_frequency))
    axial = bar.modes().frequency[bar.harmonics[0] :]
    rows.append(
        Row(
            "without Poisson's effect, along the length: largest ratio to a bar's frequencies, less 1",
            0.0,
            float(np.abs(angular / (2.0 * pi * axial) - 1.0).max()),
            1e-12,
            "the same closed form, to round-off",
        )
    )
    stiffness = light.young * 0.3 * 0.002 / 0.4
    rows.append(
        Row(
            "of the same: compliance at mid-length over length / E S",
            0.25,
            float(np.sum((shapes / angular) ** 2)) * stiffness,
            1.0 / (pi**2 * (count + 1)),
            "a bar held at both ends; the odd modes left out: 2 / pi² of the sum of 1 / m²",
        )
    )
    numbers = np.arange(1, len(PRINTED_IN_PLANE) + 1)
    curves = [
        Curve(numbers, np.array([known for *_, known in PRINTED_IN_PLANE]), "closed form"),
        Curve(numbers, frequency, "modal plate", marks=True),
    ]
    return Outcome(rows, Sketch("mode in the plane", "frequency [Hz]", curves))


CASES = (
    Case(
        "frequencies-plate",
        "Frequencies of the simply supported plate",
        "closed form (Leissa 1969, Vibration of Plates, NASA SP-160)",
        frequencies,
    ),
    Case(
        "in-plane-plate",
        "A plate in its plane, edges held along their normals",
        "closed form (Xing & Liu 2009, Int. J. Mech. Sci. 51, 246-255); a bar clamped at both ends",
        in_plane,
    ),
    Case(
        "deflection-plate",
        "Deflection of a square plate under a force at its centre",
        "Timoshenko & Woinowsky-Krieger 1959, Theory of Plates and Shells, section 34",
        deflection,
    ),
    Case(
        "mobility-plate",
        "Mobility of a plate at a point",
        "Cremer, Heckl & Petersson 2005, Structure-Borne Sound: infinite plate and its images",
        answers,
    ),
)
