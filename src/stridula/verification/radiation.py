"""Sound of surfaces in a baffle against closed forms: piston, monopole, modes of a plate; and its energy.

All use the impulse responses in time of `acoustics`, or their Fourier transforms for answers known at a frequency.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

import numpy as np

from ..acoustics.air import Air
from ..acoustics.delays import Response, Sampling
from ..acoustics.driven import respond
from ..acoustics.panels import Panel, panel_of
from ..acoustics.rayleigh import baffled_pressure, baffled_response
from ..acoustics.resistance import mean_square, radiation_damping, radiation_efficiency
from ..acoustics.surfaces import Surface, surface_of
from ..arrays import Array
from ..bodies import Material, ModalPlate
from .case import Case, Curve, Outcome, Row, Sketch

AIR = Air()
STEEL = Material(2.1e11, 7800.0)
SIDE = 0.4
# Sample rate relative to the frequency of interest, and attenuation [dB] of the errors of fractional delays: at low
# frequency, the fields of even modes nearly cancel, down to 1e-5.
SAMPLES = 20.0
ATTENUATION = 150.0
# Distance of listeners in the far field, over the size of the source.
FAR = 3e4
# Wallace's efficiencies of the modes (1, 1) and (2, 2) of a square plate.
WALLACE = {
    0.1: (1.045354e-3, 2.722374e-11),
    1.0: (0.1013226, 2.647904e-5),
    pi: (0.7590717, 1.983773e-2),
    10.0: (1.108865, 1.584820),
}


def plate(modes: tuple[int, int] = (2, 2), damping: float = 0.0) -> ModalPlate:
    """Return a square steel plate."""
    return ModalPlate(STEEL, 0.004, SIDE, SIDE, bending_modes=modes, damping=damping)


def disc(radius: float, rings: int = 60, spokes: int = 16) -> Surface:
    """Return a circular piston as points."""
    nodes, weights = np.polynomial.legendre.leggauss(rings)
    r, turn = (nodes + 1.0) / 2.0 * radius, (np.arange(spokes) + 0.5) * 2.0 * pi / spokes
    points = np.stack([np.outer(r, np.cos(turn)), np.outer(r, np.sin(turn))], axis=-1).reshape(-1, 2)
    areas = np.repeat(r * weights * radius / 2.0 * 2.0 * pi / spokes, spokes)
    return Surface(points, areas, lambda at: np.ones((len(at), 1)))


def hemisphere(polar: int, around: int) -> tuple[Array, Array]:
    """Return directions on a hemisphere, shape (directions, 3), and their solid angles [sr]."""
    nodes, weights = np.polynomial.legendre.leggauss(polar)
    up, turn = (nodes + 1.0) / 2.0, (np.arange(around) + 0.5) * 2.0 * pi / around
    across = np.sqrt(1.0 - up**2)
    whole = (polar, around)
    parts = (np.outer(across, np.cos(turn)), np.outer(across, np.sin(turn)), np.broadcast_to(up[:, None], whole))
    return np.stack(parts, axis=-1).reshape(-1, 3), np.repeat(weights / 2.0 * 2.0 * pi / around, around)


def transform(response: Response, frequency: float, interval: float) -> Array:
    """Return the Fourier transforms of impulse responses at a frequency [Hz], shape (modes,)."""
    samples = response.first + np.arange(len(response.taps))
    return np.asarray(np.exp(-2j * pi * frequency * interval * samples) @ response.taps)


def far_surface(panel: Panel, frequency: float) -> Surface:
    """Return the elements of a panel for listeners far away."""
    return surface_of(panel, np.array([0.0, 0.0, FAR * panel.length]), 2.0 * pi * frequency / AIR.speed)


def transfer(surface: Surface, listeners: Array, frequency: float) -> Array:
    """Return the pressures [Pa] at listeners for unit accelerations of the modes, shape (listeners, modes).

    Whole samples are subtracted from the delays to keep all digits of their differences, which shifts the phase of each
    listener.
    """
    interval = 1.0 / (SAMPLES * frequency)
    found = []
    for listener in listeners:
        away = np.floor(np.linalg.norm(listener) / (AIR.speed * interval))
        sampling = Sampling(interval, 2.0 * frequency, -float(away), ATTENUATION)
        response = baffled_response(surface, listener, AIR, sampling)
        found.append(transform(response, frequency, interval))
    return np.array(found)


def middle(panel: Panel) -> Array:
    """Return the centre of a panel."""
    return np.array([panel.length / 2.0, panel.edge + panel.width / 2.0, 0.0])


def far_power(
    surface: Surface, centre: Array, size: float, frequency: float, polar: int = 20, around: int = 40
) -> Array:
    """Return the sound powers [W] of the modes at unit amplitude of velocity, from a far hemisphere, shape (modes,)."""
    directions, angles = hemisphere(polar, around)
    pressure = transfer(surface, centre + FAR * size * directions, frequency) * 2.0 * pi * frequency
    return np.asarray(angles @ np.abs(pressure) ** 2) * (FAR * size) ** 2 / (2.0 * AIR.impedance)


def power_of(panel: Panel, frequency: float) -> Array:
    """Return the sound powers [W] of the modes of a panel at unit amplitude of velocity, shape (modes,)."""
    return far_power(far_surface(panel, frequency), middle(panel), panel.length, frequency)


def pulse(time: Array, length: float) -> tuple[Array, Array]:
    """Return a velocity ``exp(-(t / length)²)`` and its acceleration."""
    velocity = np.exp(-((time / length) ** 2))
    return velocity, -2.0 * time / length**2 * velocity


def piston() -> Outcome:
    """A circular piston on its axis: two plane pulses, from its centre and from its rim."""
    radius, height, length, interval = 0.05, 0.04, 20e-6, 2e-6
    time = np.arange(-200, 600) * interval
    acceleration = pulse(time, length)[1][None]
    listener = np.array([[0.0, 0.0, height]])
    found = baffled_pressure(disc(radius), acceleration, interval, listener, AIR, 0.2 / interval)[0]
    ways = height, float(np.hypot(height, radius))
    first, second = (pulse(time - way / AIR.speed, length)[0] for way in ways)
    known = AIR.impedance * (first - second)
    # Part of the pulse above the bandwidth, and error of the delays.
    tolerance = 1e-4 * float(np.abs(known).max())
    worst = int(np.argmax(np.abs(found - known)))
    reason = "delays to 100 dB, the rim in 60 rings, a pulse that ends 100 dB below the bandwidth"
    rows = [
        Row(
            f"pressure at {1e3 * time[at]:.3f} ms, {words}", float(known[at]), float(found[at]), tolerance, reason, "Pa"
        )
        for at, words in (
            (int(np.argmax(known)), "from the centre"),
            (int(np.argmin(known)), "from the rim"),
            (worst, "where the error is largest"),
        )
    ]
    curves = [Curve(1e3 * time, known, "closed form"), Curve(1e3 * time[::8], found[::8], "obtained", marks=True)]
    return Outcome(rows, Sketch("time [ms]", "pressure on the axis for 1 m/s [Pa]", curves))


def monopole() -> Outcome:
    """A small disc: power over a hemisphere."""
    radius, numbers = 0.005, np.array([0.01, 0.03, 0.1])
    known = AIR.impedance * (numbers / radius) ** 2 * (pi * radius**2) ** 2 / (4.0 * pi)
    frequency = numbers / radius * AIR.speed / (2.0 * pi)
    obtained = np.array([far_power(disc(radius), np.zeros(3), radius, each, 8, 8)[0] for each in frequency])
    reason = "size of the source: (ka)² / 6 of the power to leading order; far field 1e-5"
    rows = [
        Row(f"power, ka = {number:g}", expected, float(value), (number**2 / 6.0 + 1e-5) * expected, reason, "W")
        for number, expected, value in zip(numbers, known, obtained, strict=True)
    ]
    curves = [Curve(numbers, known, "closed form"), Curve(numbers, obtained, "obtained", marks=True)]
    return Outcome(rows, Sketch("ka", "power for 1 m/s [W]", curves, logarithmic=True))


def wallace() -> Outcome:
    """Radiation efficiencies of two modes of a square plate, from the far field."""
    panel = panel_of(plate())
    modes = [0, 3]
    rows, curves = [], []
    found: dict[float, Array] = {}
    for number in WALLACE:
        frequency = number * AIR.speed / (2.0 * pi * SIDE)
        power = power_of(panel.only(modes), frequency)
        found[number] = power / (0.5 * AIR.impedance * mean_square(panel)[modes])
    reason = "far field at 30 000 sides: terms of 1/(kr)² for quadrupoles, below 1e-5; print to 7 digits"
    for mode, name in enumerate(("(1,1)", "(2,2)")):
        for number, printed in WALLACE.items():
            value = float(found[number][mode])
            rows.append(Row(f"mode {name}, ka = {number:.4g}", printed[mode], value, 1e-4 * printed[mode], reason))
        printed_all = [printed[mode] for printed in WALLACE.values()]
        curves += [
            Curve(np.array(list(WALLACE)), np.array(printed_all), f"{name}, Wallace"),
            _marks(WALLACE, [float(each[mode]) for each in found.values()], f"{name}, obtained"),
        ]
    return Outcome(rows, Sketch("ka", "radiation efficiency", curves, logarithmic=True))


def closed_form(panel: Panel, directions: Array, reach: float, frequency: float) -> Array:
    """Return Wallace's far-field pressures for unit accelerations of the modes, shape (directions, modes).

    ``p = rho / (2 pi r) A I(k_x) I(k_y)`` with the transforms ``I(k) = p (1 - (-1)^m e^(i k L)) / (p² - k²)`` of the
    sines.
    """
    wavenumber = 2.0 * pi * frequency / AIR.speed
    sides = np.array([panel.length, panel.width])
    along = wavenumber * directions[:, None, :2]
    signs = np.cos(panel.wavenumbers * sides)
    factors = panel.wavenumbers * (1.0 - signs * np.exp(1j * along * sides)) / (panel.wavenumbers**2 - along**2)
    return np.asarray(AIR.density / (2.0 * pi * reach) * panel.amplitude * np.abs(factors.prod(axis=2)))


def directivity() -> Outcome:
    """Directivity of modes of a plate, below and above coincidence."""
    body = plate((3, 2))
    panel, names = panel_of(body), [f"({m},{n})" for m, n in body.numbers]
    slope = np.linspace(0.02, 0.48, 40) * pi
    directions = np.stack([np.sin(slope) * np.cos(0.3), np.sin(slope) * np.sin(0.3), np.cos(slope)], axis=1)
    reach, rows, curves = FAR * SIDE, [], []
    for number in (3.0, 15.0):
        frequency = number * AIR.speed / (2.0 * pi * SIDE)
        found = np.abs(transfer(far_surface(panel, frequency), middle(panel) + reach * directions, frequency))
        known = closed_form(panel, directions, reach, frequency)
        # The field at r differs from that at infinity by k side² / 8 r in phase across the plate.
        error = number / (8.0 * FAR) + 1e-5
        for mode, name in enumerate(names):
            worst = int(np.argmax(np.abs(found[:, mode] - known[:, mode])))
            words = f"mode {name}, ka = {number:g}, worst direction, at {np.degrees(slope[worst]):.0f} degrees"
            largest = float(known[:, mode].max())
            value = float(known[worst, mode]), float(found[worst, mode])
            rows.append(
                Row(
                    words, *value, error * largest, "far field: ka / 8 of the largest, over the distance in sides", "Pa"
                )
            )
        if number > 10.0:
            curves += [
                Curve(np.degrees(slope), known[:, -1], f"{names[-1]}, closed form"),
                Curve(np.degrees(slope), found[:, -1], f"{names[-1]}, obtained", marks=True),
            ]
    return Outcome(rows, Sketch("angle from the normal [degrees]", "far pressure at unit acceleration [Pa]", curves))


def balance() -> Outcome:
    """Power at the surface against power far away, and the energy of a ringing mode against its sound."""
    rows = [*_surface_power(), *_ringing()]
    damping = radiation_damping(plate((4, 4)), AIR)
    frequency = panel_of(plate((4, 4))).angular_frequency / (2.0 * pi)
    return Outcome(rows, Sketch("frequency [Hz]", "damping ratio by sound", [_marks(frequency, damping, "modes")]))


def _surface_power() -> Iterator[Row]:
    """Yield the work of the pressure just above the surface, and the power far away."""
    panel = panel_of(plate()).only([0])
    nodes, weights = np.polynomial.legendre.leggauss(10)
    side = (nodes + 1.0) / 2.0 * SIDE
    x, y = (values.ravel() for values in np.meshgrid(side, side, indexing="ij"))
    areas = np.outer(weights, weights).ravel() * SIDE**2 / 4.0
    height = 2e-3
    for number in (1.0, pi):
        frequency = number * AIR.speed / (2.0 * pi * SIDE)
        interval = 1.0 / (SAMPLES * frequency)
        sampling = Sampling(interval, 2.0 * frequency, attenuation=ATTENUATION)
        pressure = []
        for listener in np.stack([x, y, np.full(x.size, height)], axis=1):
            surface = surface_of(panel, listener, 2.0 * pi * frequency / AIR.speed)
            response = baffled_response(surface, listener, AIR, sampling)
            pressure.append(transform(response, frequency, interval)[0] * 2j * pi * frequency)
        power = 0.5 * float(np.sum(areas * np.real(pressure) * panel.shapes(x, y)[:, 0]))
        far = float(power_of(panel, frequency)[0])
        lift = (number * height / SIDE) ** 2
        # The resistance at the height z varies as sin(k R) / R with R² = r² + z²: within (kz)² / 2.
        reason = "the surface's pressure is taken 2 mm above it: (kz)² / 2; far field 1e-5"
        yield Row(f"power at the surface, ka = {number:.4g}", far, power, (0.5 * lift + 3e-5) * far, reason, "W")


def _ringing() -> Iterator[Row]:
    """Yield the energy of the sound of a struck mode, over a hemisphere and all time.

    By Parseval it is the integral of ``rho c sigma N |v|²`` over all frequencies. A mode of damping ratio zeta,
    of which z is due to sound, radiates the share z / zeta of its energy: sigma is then taken at the natural frequency,
    for a band of relative width 2 zeta over which sigma changes by twice that.
    """
    damping = 0.002
    body = plate((1, 1), damping)
    panel = panel_of(body)
    angular = float(panel.angular_frequency[0])
    interval = 2.0 * pi / (SAMPLES * angular)
    force = np.zeros((1, int(8.0 / (damping * angular) / interval)))
    # A blow of half a period.
    force[0, :11] = np.hanning(11)
    motion = respond(panel, force, interval)
    spectrum = np.fft.rfft(motion[0])[1:]
    frequency = np.fft.rfftfreq(motion.shape[1], interval)[1:]
    velocity = np.abs(spectrum / (2.0 * pi * frequency)) ** 2 * 2.0 * interval / motion.shape[1]
    heard = _energy_of_sound(panel, motion, interval)
    # Above four times the natural frequency there is less than 1e-6 of it.
    low = frequency < 4.0 * angular / (2.0 * pi)
    nodes = np.linspace(frequency[0], frequency[low][-1], 60)
    efficiency = [float(radiation_efficiency(body, float(node), AIR)[0]) for node in nodes]
    sigma = np.interp(frequency[low], nodes, efficiency)
    sent = AIR.impedance * float(mean_square(panel)[0]) * float(np.sum(sigma * velocity[low]))
    # Efficiencies vary as the square of the frequency; chords of a 15th of the natural one exceed them by (1/15)² / 4.
    reason = "efficiencies at 60 frequencies, linear between: (1/15)² / 4, half as much for the rest"
    yield Row("energy of the sound of a struck mode", sent, heard, 1.5 / 900.0 * sent, reason, "J")
    share = float(radiation_damping(body, AIR)[0]) / damping
    lost = 2.0 * damping * angular * float(np.sum(velocity))
    reason = "4 zeta: relative width of the band times the slope of the efficiency"
    yield Row("its share of the loss of the mode", share, heard / lost, 4.0 * damping * share, reason)


def _energy_of_sound(panel: Panel, motion: Array, interval: float) -> float:
    """Return the energy radiated by a motion through a hemisphere [J]."""
    directions, angles = hemisphere(8, 12)
    reach = 300.0 * panel.length
    # Fraction of the delay beyond whole samples.
    shift = 20.0 - float(np.floor(reach / (AIR.speed * interval)))
    sampling, energy = Sampling(interval, 0.2 / interval, shift), 0.0
    surface = far_surface(panel, sampling.bandwidth)
    for direction, angle in zip(directions, angles, strict=True):
        response = baffled_response(surface, middle(panel) + reach * direction, AIR, sampling)
        heard = np.convolve(motion[0], response.taps[:, 0])
        energy += angle * reach**2 / AIR.impedance * float(np.sum(heard**2)) * interval
    return energy


def _marks(x: object, y: object, label: str) -> Curve:
    return Curve(np.array(list(x)), np.array(y), label, marks=True)  # type: ignore[call-overload]


CASES = (
    Case(
        "radiation-piston",
        "Baffled circular piston on its axis",
        "p = rho c (v(t - z/c) - v(t - sqrt(z² + a²)/c)), exact (Stepanishen 1971, J. Acoust. Soc. Am. 49, 1629)",
        piston,
    ),
    Case(
        "radiation-monopole",
        "Baffled monopole",
        "W = rho c k² |Q|² / (4 pi) for an amplitude Q of volume velocity (Pierce 1989, Acoustics, section 4.3)",
        monopole,
    ),
    Case(
        "radiation-wallace",
        "Radiation efficiencies of a square plate",
        "Wallace 1972, J. Acoust. Soc. Am. 51, 946, integrated numerically; a is the side",
        wallace,
    ),
    Case(
        "radiation-directivity",
        "Far field of the modes of a plate",
        "Wallace 1972, J. Acoust. Soc. Am. 51, 946, equation 5",
        directivity,
    ),
    Case(
        "radiation-balance",
        "Balance of the energy of sound",
        "conservation of energy; radiation damping of light fluids (Cremer, Heckl & Petersson 2005, section 6.6)",
        balance,
    ),
)
