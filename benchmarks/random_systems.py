"""Random systems under every law of friction: runs at default settings against a fortieth of their step.

    python benchmarks/random_systems.py                           the table, in a quarter of an hour
    python benchmarks/random_systems.py --number 17 --law lugre   a line for one system of each set
    python benchmarks/random_systems.py --short                   three systems for each law and set

A system is a body of 2 to 6 modes from 50 to 1000 Hz that rubs on belts at 1 to 3 points, some of which start apart.
The set *rigid* has rigid contacts; *stiffness* the same with linear, power-law and Hertzian contacts, whose vibration
lies among the modes; *cutoff* rigid contacts on bodies whose modes are those below a cutoff, as of finite elements.
Only duration and sample rate are given: ten samples in a period of the highest mode, and for the last column 2 kHz.

Errors are the root mean square of the difference over that of the fluctuation, over all contacts: of the displacements
of their points along x and y, and of their forces, which are means over samples. A reference is believed if that at a
twentieth of the step lies within half a per cent of it; chaos prevents this in the others, which are left out. *Landed*
counts the systems over one per cent in which a contact landed, *worst* is the number of the worst system.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from itertools import combinations, product
from math import ceil, inf, isnan, nan, pi

import numpy as np
import xarray as xr

import stridula as st
from ratios import arguments, sized

LAWS = ("coulomb", "static-kinetic", "stribeck", "exponential", "linear", "lugre", "aging", "slip")
SETS = sized(("rigid", "stiffness", "cutoff"), ("rigid", "stiffness"))
SYSTEMS, WORKERS = sized((50, 2), (3, 1))
LARGEST_FRICTION, DRAWS = 0.7, 1000
LOWEST, HIGHEST = 50.0, 1000.0
PERIODS = sized(5.0, 1.0)
FINE, COARSER, PER_PERIOD, LOW_RATE = 40, 20, 10, 2e3
BELIEVED, BAR = 0.005, 0.01


def slides_uniquely(shapes: np.ndarray) -> bool:
    """Return whether the forces of points that slide are unique in any sense of sliding, at the largest friction.

    That is so where the displacements along the normals under them have a P-matrix, whose principal minors are all
    positive (Painlevé's paradox is excluded). Shapes have the shape (points, 2, modes).
    """
    along, across = shapes[:, 0], shapes[:, 1]
    count = len(shapes)
    some = [list(one) for size in range(1, count + 1) for one in combinations(range(count), size)]
    for senses in product((-1.0, 1.0), repeat=count):
        matrix = across @ (across + LARGEST_FRICTION * np.array(senses)[:, None] * along).T
        if min(np.linalg.det(matrix[np.ix_(one, one)]) for one in some) <= 0.0:
            return False
    return True


def friction_of(random: np.random.Generator, law: str, belt: float, deflection: float) -> st.FrictionLaw:
    """Return a law with drawn numbers, for a belt of some velocity [m/s] and deflections of some size [m]."""
    kinetic = random.uniform(0.1, 0.4)
    static = random.uniform(kinetic + 0.05, LARGEST_FRICTION)
    velocity = belt * 10.0 ** random.uniform(-0.5, 0.5)
    if law == "coulomb":
        return st.Coulomb(kinetic)
    if law == "static-kinetic":
        return st.StaticKinetic(static, kinetic)
    if law == "stribeck":
        return st.Stribeck(static, kinetic, velocity, random.uniform(0.5, 2.0), random.uniform(0.0, 0.1) / belt)
    if law == "exponential":
        return st.ExponentialWeakening(static, kinetic, velocity)
    if law == "linear":
        return st.LinearWeakening(static, (static - kinetic) / velocity, kinetic)
    if law == "lugre":
        stiffness = kinetic / (deflection * random.uniform(0.03, 0.3))
        return st.LuGre(static, kinetic, velocity, stiffness, random.uniform(0.0, 0.3) / belt)
    a = random.uniform(0.005, 0.03)
    distance = deflection * 10.0 ** random.uniform(-1.5, 0.0)
    return st.RateAndState(static, a, a * random.uniform(0.5, 2.0), distance, velocity, law)


def stiffness_of(random: np.random.Generator, load: float, mobility: float) -> st.ContactStiffness:
    """Return a stiffness whose contact vibrates within the range of the modes under a load [N]."""
    slope = (2.0 * pi * random.uniform(2.0 * LOWEST, HIGHEST)) ** 2 / mobility
    kind = random.choice(("linear", "power", "hertz"))
    if kind == "linear":
        return st.LinearStiffness(slope, random.uniform(0.0, 0.1) * np.sqrt(slope / mobility))
    exponent = random.uniform(1.2, 3.0) if kind == "power" else 1.5
    # Its slope is p N / d at the indentation d under the load N.
    coefficient = load / (exponent * load / slope) ** exponent
    if kind == "power":
        return st.PowerStiffness(coefficient, exponent)
    modulus = 1e11
    return st.HertzStiffness((0.75 * coefficient / modulus) ** 2, modulus)


def system_of(kind: str, law: str, number: int) -> tuple[st.System, float, float]:
    """Return a drawn system, and the lowest and the highest frequency of its body [Hz]."""
    random = np.random.default_rng((LAWS.index(law), number))
    count = int(random.integers(2, 7))
    points = int(random.integers(1, min(3, count // 2) + 1))
    frequencies = np.sort(10.0 ** random.uniform(np.log10(LOWEST), np.log10(HIGHEST), count))
    shapes = next(filter(slides_uniquely, (random.standard_normal((points, 2, count)) for _ in range(DRAWS))))
    body = st.ReducedBody(
        np.eye(count),
        np.diag((2.0 * pi * frequencies) ** 2),
        {f"point {k}": shape for k, shape in enumerate(shapes)},
        damping=random.uniform(0.003, 0.03),
        cutoff=2.0 * HIGHEST if kind == "cutoff" else None,
    )
    contacts, drives = [], []
    for k, (along, across) in enumerate(shapes):
        load = 10.0 ** random.uniform(0.0, 1.5)
        deflections = (along**2 + across**2) * load / (2.0 * pi * frequencies) ** 2
        deflection = float(deflections.sum())
        belt = float((deflections * 2.0 * pi * frequencies).sum()) * 10.0 ** random.uniform(-1.0, 0.3)
        gap = deflection * random.uniform(0.0, 0.5) if random.random() < 0.25 else 0.0
        friction = friction_of(random, law, belt, deflection)
        yields = stiffness_of(random, load, float(across @ across))
        tip, track = body.at(f"point {k}"), st.RigidTrack(velocity=belt * random.choice([-1.0, 1.0]), name=f"belt {k}")
        contact = st.PointContact(tip, track, friction=friction, gap=gap, name=f"point {k}")
        contacts.append(replace(contact, stiffness=yields) if kind == "stiffness" else contact)
        drives.append(st.Force(tip, y=-load))
    return st.System(contacts, drives), float(frequencies[0]), float(frequencies[-1])


@dataclass(frozen=True)
class Found:
    """Errors of a system: of displacements, of forces, of displacements at a low sample rate, of the reference [1].

    Attributes
    ----------
    kind, law : str
        Its set and its law.
    number : int
        Its number.
    displacement, force, sampled : float
        Errors at default settings, and of displacements at the low sample rate.
    reference : float
        Difference of the displacements of the two references.
    step : float
        Default step [s].
    landings : int
        Landings of its contacts at default settings.
    unsolved : int
        Steps out of tolerance at default settings.
    """

    kind: str
    law: str
    number: int
    displacement: float
    force: float
    sampled: float
    reference: float
    step: float = nan
    landings: int = 0
    unsolved: int = 0

    @property
    def is_believed(self) -> bool:
        """Whether its references agree."""
        return self.reference <= BELIEVED


def points_of(run: xr.Dataset) -> np.ndarray:
    """Return the displacements of the points in contact, shape (2, samples, contacts)."""
    return np.stack([run[name].values.reshape(run.sizes["time"], -1) for name in ("contact_position", "gap")])


def forces_of(run: xr.Dataset) -> np.ndarray:
    """Return the forces of the contacts, shape (2, samples, contacts)."""
    return np.stack([run[name].values.reshape(run.sizes["time"], -1) for name in ("normal_force", "tangential_force")])


def error(found: np.ndarray, expected: np.ndarray) -> float:
    """Return the root mean square of a difference over that of the fluctuation; shapes (2, samples, contacts)."""
    fluctuation = np.sqrt(np.mean((expected - expected.mean(axis=1, keepdims=True)) ** 2))
    difference = np.sqrt(np.mean((found - expected) ** 2))
    return float(difference / fluctuation) if difference else 0.0


def found_of(kind: str, law: str, number: int) -> Found:
    """Return the errors of a system, NaN if a run of it stops with a message."""
    try:
        return compared(kind, law, number)
    except st.Diverged:
        return Found(kind, law, number, nan, nan, nan, inf)


def compared(kind: str, law: str, number: int) -> Found:
    """Return the errors of a system at default settings.

    A sample of the reference is half a default step: the force of a step acts about its beginning, so that its mean
    over a sample is over an interval that begins and ends half a step early. The first begins before the start and is
    left out.
    """
    system, lowest, highest = system_of(kind, law, number)
    rate = LOW_RATE * ceil(PER_PERIOD * highest / LOW_RATE)
    duration = ceil(PERIODS * LOW_RATE / lowest) / LOW_RATE
    usual = st.simulate(system, duration, sample_rate=rate)
    slowly = st.simulate(system, duration, sample_rate=LOW_RATE)
    step = usual.attrs["step"]
    fine, coarser = (
        st.simulate(system, duration, step=step / parts, sample_rate=2.0 / step) for parts in (FINE, COARSER)
    )
    points, ratio = points_of(fine), round(2.0 / (rate * step))
    impulses = forces_of(fine).cumsum(axis=1) * 0.5 * step
    ends = impulses[:, ratio - 2 :: ratio]
    forces = np.diff(ends, axis=1, prepend=0.0) * rate
    at_low = points[:, (low := round(2.0 / (LOW_RATE * step))) - 1 :: low]
    return Found(
        kind,
        law,
        number,
        error(points_of(usual), points[:, ratio - 1 :: ratio]),
        error(forces_of(usual)[:, 1:], forces[:, 1:]),
        error(points_of(slowly), at_low),
        error(points_of(coarser), points),
        step,
        int(usual.landings.sum()),
        int(usual.unsolved_steps.sum()) if "unsolved_steps" in usual else 0,
    )


def all_compared(kinds: list[str], laws: list[str], numbers: list[int]) -> Iterator[Found]:
    """Yield the errors of all systems in their order."""
    asked = [(kind, law, number) for kind in kinds for law in laws for number in numbers]
    if WORKERS == 1:
        yield from (found_of(*one) for one in asked)
        return
    with ProcessPoolExecutor(WORKERS) as pool:
        yield from pool.map(found_of, *zip(*asked, strict=True), chunksize=5)


def percent(values: list[float]) -> str:
    """Return median, 90th percentile and largest of some errors, in per cent."""
    shown = (np.median(values), np.quantile(values, 0.9), max(values))
    return "".join(f"{100.0 * one:>9.3g}" for one in shown)


def line(kind: str, law: str, found: list[Found]) -> str:
    """Return the line of a law in a set."""
    kept, stopped = [one for one in found if one.is_believed], sum(isnan(one.displacement) for one in found)
    head = f"{kind:<10} {law:<15}{len(kept):>4} of {len(found):<4}{stopped:>7}"
    if not kept:
        return head
    over = [one for one in kept if one.displacement > BAR]
    share, landed = len(over) / len(kept), sum(one.landings > 0 for one in over)
    columns = ([one.displacement for one in kept], [one.force for one in kept], [one.sampled for one in kept])
    moved, forces, sampled = map(percent, columns)
    worst = max(kept, key=lambda one: one.displacement).number
    return f"{head}{moved}{100.0 * share:>8.3g} %{landed:>8} {worst:>7} {forces} {sampled}"


def main() -> None:
    """Print the table."""
    words = arguments(__doc__)
    words.add_argument("--number", type=int, help="take this system alone")
    words.add_argument("--law", choices=LAWS, help="take this law alone")
    words.add_argument("--each", action="store_true", help="also print a line for each system")
    words.add_argument("--set", choices=SETS, help="take this set alone")
    asked = words.parse_args()
    laws, kinds = [asked.law] if asked.law else LAWS, [asked.set] if asked.set else SETS
    numbers = range(SYSTEMS) if asked.number is None else [asked.number]
    triple = "   median  90th %    worst"
    print("errors in per cent".ljust(44) + "displacements".ljust(53) + "forces".ljust(28) + "displacements, 2 kHz")
    print(
        f"{'set':<10} {'law':<15}{'believed':<11}stopped{triple}  over 1 %  landed   worst {triple} {triple}",
        flush=True,
    )
    found, wrong = all_compared(list(kinds), list(laws), list(numbers)), []
    for kind in kinds:
        for law in laws:
            some = [next(found) for _ in numbers]
            print(line(kind, law, some), flush=True)
            if asked.each:
                print(*some, sep="\n", flush=True)
            errors = [one.displacement for one in some if one.is_believed]
            if errors and np.median(errors) > BAR:
                wrong.append(f"{law}, {kind}")
    if wrong:
        raise SystemExit(f"median errors of displacements must be at most {BAR:g}, are not for {'; '.join(wrong)}")


if __name__ == "__main__":
    sys.exit(main())
