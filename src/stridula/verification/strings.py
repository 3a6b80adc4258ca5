"""Strings: frequencies with stiffness, the forces on the supports, and Helmholtz motion under a bow."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import pi, sin, sqrt

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import BodyPoint, Circle, Material, ModalBeam, Rayleigh, Section
from ..contact import Coulomb, ExponentialWeakening, FrictionLaw, PointContact, RigidTrack
from ..drives import Drive, Force, InitialEquilibrium, InitialVelocity
from ..histories import Ramp
from ..integration import ExactModal, simulate
from ..records import Probe, SupportForce, Velocity
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch

SLIDING = 2
SAMPLES = 1200
STEEL = Material(2.0e11, 7850.0)
# A plain wire in the middle of a piano.
WIRE, SPEAKING_LENGTH, TENSION = Circle(0.001), 0.65, 700.0


def frequencies() -> Outcome:
    """``f_k = k f sqrt(1 + B k²)`` with ``B = pi³ E d⁴ / 64 T L²`` of a round wire."""
    string = ModalBeam(STEEL, WIRE, SPEAKING_LENGTH, bending_modes=40, axial_modes=0, tension=TENSION)
    ideal = sqrt(TENSION / (STEEL.density * pi * WIRE.diameter**2 / 4.0)) / (2.0 * SPEAKING_LENGTH)
    inharmonicity = pi**3 * STEEL.young * WIRE.diameter**4 / (64.0 * TENSION * SPEAKING_LENGTH**2)
    numbers = np.arange(1, 41)
    known = numbers * ideal * np.sqrt(1.0 + inharmonicity * numbers**2)
    found = string.modes().frequency
    rows = [
        Row(f"partial {k}", float(known[k - 1]), float(found[k - 1]), 1e-12 * float(known[k - 1]), "round-off", "Hz")
        for k in (1, 2, 4, 8, 16, 40)
    ]
    # B from two partials: (f_k / k f_1)² = (1 + B k²) / (1 + B).
    share = (found[39] / (40.0 * found[0])) ** 2
    back = float((share - 1.0) / (1600.0 - share))
    rows.append(Row("inharmonicity", inharmonicity, back, 8.0 * np.finfo(float).eps, "round-off of the squares"))
    curves = [
        Curve(numbers, known / (numbers * ideal) - 1.0, "closed form"),
        Curve(numbers, found / (numbers * ideal) - 1.0, "modal beam under tension", marks=True),
    ]
    return Outcome(rows, Sketch("partial", "frequency over k f, less 1", curves))


@dataclass(frozen=True)
class Bowed:
    """A nearly ideal string under a bow that moves across it, along y.

    The bow is a rigid track whose tangent is y and whose normal is x. A force along x presses the string on it at the
    contact point; axial motion and bending are uncoupled and the bow is rigid, so the normal force equals that force at
    every step, and x represents the direction normal to string and bow, which does not exist in the plane.

    Attributes
    ----------
    place : float
        Distance of the bow from the left end, the bridge, as a fraction of the length [1].
    push : float
        Bow force as a fraction of Schelleng's maximum [1].
    modes : int, optional
        Number of modes.
    spread, decay : float, optional
        Kelvin-Voigt damping [s], which rounds the corner, and the rate at which all modes decay [1/s].
    length, impedance, period : float, optional
        Length [m], characteristic impedance ``sqrt(T rho S)`` [kg/s] and period of an ideal string [s].
    speed : float, optional
        Velocity of the bow [m/s].
    friction : FrictionLaw, optional
        Law of friction.
    inharmonicity : float, optional
        Inharmonicity due to bending stiffness [1].
    """

    place: float
    push: float
    modes: int = 300
    spread: float = 1e-8
    length: float = 0.33
    impedance: float = 0.35
    period: float = 1.0 / 196.0
    decay: float = 2.5
    speed: float = 0.1
    friction: FrictionLaw = ExponentialWeakening(0.8, 0.3, 0.1)  # noqa: RUF009
    inharmonicity: float = 1e-9

    @property
    def tension(self) -> float:
        """Tension [N], from the impedance ``T / c`` and the period ``2 L / c``."""
        return self.impedance * 2.0 * self.length / self.period

    @property
    def string(self) -> ModalBeam:
        """The string."""
        area, young = 1e-6, 1e9
        material = Material(young, self.impedance**2 / self.tension / area)
        section = Section(area, self.inharmonicity * self.tension * self.length**2 / (pi**2 * young))
        damping = Rayleigh(mass=2.0 * self.decay, stiffness=self.spread)
        return ModalBeam(
            material,
            section,
            self.length,
            bending_modes=self.modes,
            axial_modes=1,
            damping=damping,
            tension=self.tension,
        )

    @property
    def contrast(self) -> float:
        """Static coefficient of friction less that in fast sliding [1]."""
        return float(self.friction.coefficient_at(0.0) - self.friction.coefficient_at(100.0))

    @property
    def most(self) -> float:
        """Schelleng's maximal bow force ``2 Z v / beta dmu`` [N], above which the corner cannot free the string."""
        return 2.0 * self.impedance * self.speed / (self.place * self.contrast)

    @property
    def least(self) -> float:
        """Schelleng's minimal bow force ``Z² v / 2 R beta² dmu`` [N], below which the string slips too early.

        The resistance R of a bridge that attenuates a corner per period as much as the decay s of all modes is
        ``Z / s T`` times 2.
        """
        resistance = 2.0 * self.impedance / (self.decay * self.period)
        return self.impedance**2 * self.speed / (2.0 * resistance * self.place**2 * self.contrast)

    @property
    def force(self) -> float:
        """Bow force [N]."""
        return self.push * self.most

    @property
    def corner(self) -> float:
        """Duration of the passage of the corner [periods].

        The modes kept resolve ``1 / n`` of a period; in a period Kelvin-Voigt damping smooths a step to a Gaussian
        width of standard deviation ``sqrt(spread T)``, of which four are counted.
        """
        return 1.0 / self.modes + 4.0 * sqrt(self.spread / self.period)

    def run(self, periods: float = 160.0) -> xr.Dataset:
        """Simulate a number of periods from rest, the bow starting within the first four, with 1200 samples in each."""
        string = self.string
        point, bow = string.at(self.place * self.length), RigidTrack(velocity=self.speed, history=Ramp(4 * self.period))
        system = bowed(point, bow, self.friction, self.force)
        probes: list[Probe] = [Velocity(point, "y"), SupportForce(string, "left")]
        # Waves keep their form: free motion is exact at any step.
        return simulate(
            system, periods * self.period, scheme=ExactModal(), sample_rate=SAMPLES / self.period, probes=probes
        )


def bowed(point: BodyPoint, bow: RigidTrack, friction: FrictionLaw, force: float, *drives: Drive) -> System:
    """Return a string whose point is pressed on a bow."""
    contact = PointContact(point, bow, friction=friction, inclination=pi / 2.0)
    return System(contact, [Force(point, x=force), *drives])


def left_out(modes: int, place: float) -> float:
    """Return a bound of the share of a force, at a place from a support, that omitted modes transmit to the support.

    ``(2 / pi) sum of sin(k pi a / L) / k`` over k > n, by Abel's partial summation.
    """
    return 2.0 / (pi * (modes + 1) * sin(pi * place / 2.0))


def supports() -> Outcome:
    """A stiff wire under a steadily sliding bow, which is a constant force at a point; and a thrown ideal string."""
    wire = ModalBeam(STEEL, WIRE, SPEAKING_LENGTH, bending_modes=300, axial_modes=1, tension=TENSION)
    rows, ratio, force = [], 0.4, 5.0
    reason = "modes left out: 2 / (pi (n + 1) sin(pi a / 2 L)) of the force, by Abel's summation"
    probes: list[Probe] = [SupportForce(wire, "left"), SupportForce(wire, "right")]
    places, found = np.array([0.1, 0.25, 0.5]), []
    for place in places:
        point = wire.at(place * SPEAKING_LENGTH)
        system = bowed(point, RigidTrack(velocity=1.0), Coulomb(ratio), force, InitialEquilibrium())
        run = simulate(system, 1e-5, probes=probes)
        found.append(run["support_force"].values[-1])
        for words, away, obtained in zip(("left", "right"), (place, 1.0 - place), found[-1], strict=True):
            known, most = ratio * force * (1.0 - away), ratio * force * left_out(300, away)
            rows.append(Row(f"force at {place:g} of the length, {words}", known, float(obtained), most, reason, "N"))
    rows += _thrown(Bowed(0.1, 0.0))
    curves = [
        Curve(places, ratio * force * (1.0 - places), "P (1 - a / L)"),
        Curve(places, np.array(found)[:, 0], "left support", marks=True),
        Curve(places, ratio * force * places, "P a / L"),
        Curve(places, np.array(found)[:, 1], "right support", marks=True),
    ]
    return Outcome(rows, Sketch("place of the force [lengths]", "force on the support [N]", curves))


def _thrown(ideal: Bowed) -> list[Row]:
    """Return the rows of a string thrown down at V: its support forces are -Z V for half a period, then +Z V."""
    string, speed = replace(ideal.string, damping=0.0), 2.0
    point = string.at(0.1 * string.length)
    # Hardly pressed, and without friction, so that the bow has no effect.
    system = bowed(point, RigidTrack(), Coulomb(0.0), 1e-6, InitialVelocity(string, y=-speed))
    step = ideal.period / 4000.0
    run = simulate(
        system, ideal.period, step=step, sample_rate=1.0 / step, probes=[SupportForce(string)], scheme=ExactModal()
    )
    force = run["support_force"].values[:, 0]
    known = ideal.impedance * speed
    most = known * 4.0 / (pi * (string.bending_modes + 1))
    reason = "the next term of the alternating series, 4 / (pi (n + 1))"
    return [
        Row(f"thrown, after {part} of a period", sign * known, float(force[at]), most, reason, "N", ExactModal().name)
        for part, sign, at in (("1/4", -1.0, 999), ("3/4", 1.0, 2999))
    ]


def helmholtz() -> Outcome:
    """A bow at a tenth and at a fifth of the string, from rest."""
    rows, curves, notes = [], [], []
    for place in (0.1, 0.2):
        case = Bowed(place, 0.3)
        run = case.run()
        words = f"bow at {place:g}"
        rows += motion(case, run, words)
        last = slice(-2 * SAMPLES, None)
        time = np.arange(-2 * SAMPLES, 0) / SAMPLES
        curves.append(Curve(time, run["velocity"].values[last, 0] / case.speed, words))
        notes.append(
            f"{words}: the bow force of {case.force:.3g} N lies between Schelleng's limits {case.least:.2g} N and "
            f"{case.most:.3g} N"
        )
    return Outcome(rows, Sketch("time [periods]", "velocity under the bow over that of the bow", curves), notes)


def motion(case: Bowed, run: xr.Dataset, words: str, last: int = 40) -> list[Row]:
    """Return the rows of Helmholtz motion, from the last periods of a run."""
    kept = run.isel(time=slice(-last * SAMPLES, None))
    slips = kept["status"].values == SLIDING
    begins = np.flatnonzero(~slips[:-1] & slips[1:]) + 1
    share = float(kept["status_share"].values[:, SLIDING].mean())
    velocity = float(np.median(kept["velocity"].values[slips, 0])) if slips.any() else 0.0
    period = float(np.diff(begins).mean()) * case.period / SAMPLES if begins.size > 1 else np.nan
    place, speed, corner = case.place, case.speed, case.corner
    slip = -speed * (1.0 - place) / place
    faster = -speed * (1.0 - place + corner) / (place - corner)
    waits = "the corner is delayed under the bow by at most its passage: 1/n + 4 sqrt(spread / T)"
    follows = "as for the share of slip, since motion back equals motion forth"
    normal = run["normal_force"].values
    off = float(np.abs(normal - case.force).max())
    scheme = ExactModal().name
    rows = [
        Row(f"{words}: largest change of normal force", 0.0, off, 1e-9 * case.force, "round-off", "N", scheme),
        Row(f"{words}: slips per period", 1.0, begins.size / last, 1.0 / last, "one at the edge", "1", scheme),
        Row(f"{words}: period", case.period, period, corner * case.period, waits, "s", scheme),
        Row(f"{words}: share of slip", place, share, corner, waits, "1", scheme),
        Row(f"{words}: velocity of slip", slip, velocity, slip - faster, follows, "m/s", scheme),
    ]
    return [*rows, _bridge(case, kept, begins, words)]


def _bridge(case: Bowed, kept: xr.Dataset, begins: Array, words: str) -> Row:
    """Return the row of the force on the bridge, which rises in proportion to the travel of the bow while it sticks.

    Waves between bridge and bow have the period ``beta T``, so that they vanish in means over it: the first mean in
    each stick is subtracted from the last.
    """
    force, slips = kept["support_force"].values[:, 0], kept["status"].values == SLIDING
    window, passes = round(case.place * SAMPLES), round(case.corner * SAMPLES)
    rates = []
    for before, after in pairwise(begins):
        first = before + int(np.argmin(slips[before:after])) + passes
        end = after - passes
        if end - first > 2 * window:
            rise = force[end - window : end].mean() - force[first : first + window].mean()
            rates.append(rise / (end - window - first))
    known = 2.0 * case.impedance * case.speed / case.place
    shortest = 1.0 - 2.0 * case.place - 3.0 * case.corner
    held = float(case.friction.coefficient_at(0.0)) * case.force
    most = 2.0 * held * left_out(case.modes, case.place) / shortest + known * 2.0 / (pi**2 * case.modes * case.place)
    reason = "modes left out: of the force of friction at the support, of the compliance under the bow"
    found = float(np.mean(rates)) * SAMPLES if rates else np.nan
    return Row(f"{words}: rise of the bridge force in a period", known, found, most, reason, "N", ExactModal().name)


CASES = (
    Case(
        "string-frequencies",
        "Partials of a stiff string",
        "Fletcher 1964, J. Acoust. Soc. Am. 36, 203-209 (pinned string with stiffness)",
        frequencies,
    ),
    Case(
        "string-supports",
        "Forces of a string on its supports",
        "statics of a force at a point; d'Alembert's solution of the string",
        supports,
    ),
    Case(
        "bowed-string",
        "Helmholtz motion of a bowed string",
        "Helmholtz 1863; Schelleng 1973, J. Acoust. Soc. Am. 53, 26-41",
        helmholtz,
    ),
)
