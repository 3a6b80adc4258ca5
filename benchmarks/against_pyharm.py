"""Periodic motions in pyHarm, by harmonic balance with softened contacts, and in Stridula with exact ones.

``python benchmarks/against_pyharm.py --seed 2`` draws sets of parameters from the seed and prints a line for each. The
exit status is 1 if a set misses a tolerance. ``--more-friction 0.05`` gives Stridula more friction, by a share of it:
every set must then miss. pyHarm runs in its own Python, that of the variable ``PYHARM_PYTHON``, or in this one; without
it the comparison is skipped with a message.

*Friction.* A mass of 1 kg on a spring of 1 N/m beside a dashpot is driven by a force of 1 N times ``cos(w t)`` and
rubs on the ground with a force f. In pyHarm a spring of stiffness k is in series with the friction (a Jenkins element),
which is made stiffer: its motion must converge to the cycle of Stridula, which has no such spring. The *difference* is
the rms of the difference of both motions over a period, phase included, divided by the rms of the motion.

After a reversal at amplitude X the softened friction turns round over a displacement of 2 f / k, which takes a time of
order sqrt(f / (k X)): a delay, so that it has a reactive part of order k^-1/2, while the energy lost per period, 4 f (X
- f / k), differs by order k^-1 only. Hence

- a mass that slides all the time converges with order 1/2, and the motion is a series in k^-1/2. The constant of a
  quadratic fit is the limit of infinite stiffness. The first term left out is of size ``SOFTEST ** -1.5``, the
  tolerance;
- a mass that sticks rings on the spring, at a frequency of sqrt(k) rad/s, once it stops, and is let go with a velocity
  of up to 1 N / sqrt(k) that depends on the phase of the ringing: the difference falls at least with order 1/2, not
  evenly. The tolerance of the stiffest is ``STIFFEST ** -0.5``.

*A stop.* Two masses, shaken at the second, meet a stop with the same stiffness in both codes: they must agree as the
harmonics of pyHarm increase. The force of the stop has corners, its harmonics n fall with n^-2, those of the motion
with n^-4: those left out add up to order 3. At the lower frequency the masses do not reach the stop; the difference
there is that of the step of Stridula.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr

import stridula as st
from ratios import arguments, sized
from stridula.verification.systems.cycles import Stopped
from stridula.verification.systems.on_belts import Slider

PEER = os.environ.get("PYHARM_PYTHON", sys.executable)
SEED = 2011
EACH = sized(4, 1)

# Stiffnesses of the friction in pyHarm [N/m]: a path from nearly free motion, then those that are compared.
SOFTEST, STIFFEST = 64.0, sized(8192.0, 1024.0)
PATH = 2.0 ** np.arange(-3, 6)
COMPARED = 2.0 ** np.arange(np.log2(SOFTEST), np.log2(STIFFEST) + 0.25, 0.5)
SHOWN = (0, len(COMPARED) // 2, -1)
HARMONICS, SAMPLES = sized((161, 4096), (81, 2048))
STEPS = 2000
LIMIT_TOLERANCE, STIFFEST_TOLERANCE = SOFTEST**-1.5, STIFFEST**-0.5
ORDER, ORDER_WITHIN = 0.5, 0.1
# Two stops a period that are each shorter than a cycle of the ringing at the stiffest are neither kind.
STICKS_FROM = 0.02
# Residual of pyHarm's equations up to which a motion counts as found [N], and the share of those that must be.
SOLVED, FOUND = 1e-6, 0.75

STOPS = (0.5, 0.65)
STOP_HARMONICS = (5, 10, 20, 40)
STOP_PATH, RESONANCE = 2.0 ** np.arange(-10, 1), 0.618
# Five harmonics leave some percent; 40 leave a 512th of that.
STOP_TOLERANCE = 1e-4

Case = dict[str, np.ndarray | float]


@dataclass(frozen=True)
class Rubbed:
    """A mass of 1 kg on a spring of 1 N/m that is driven and rubbed.

    Attributes
    ----------
    angular : float
        Angular frequency of the force of 1 N [rad/s].
    friction : float
        Force of friction [N].
    dashpot : float
        Coefficient of the dashpot beside the spring [N s/m].
    """

    angular: float
    friction: float
    dashpot: float

    def cycle(self) -> xr.Dataset:
        """Return the cycle of Stridula."""
        shaken = st.Harmonic(self.angular / (2.0 * np.pi), phase=np.pi / 2.0)
        slider = Slider(1.0, 1.0, 1.0, st.Coulomb(self.friction), push=shaken, dashpot=self.dashpot)
        return st.limit_cycle(slider.system(), step=2.0 * np.pi / self.angular / STEPS)

    def case(self) -> Case:
        """Return the same system for pyHarm, with stiffnesses from soft to stiff."""
        one = np.eye(1)
        return {
            "mass": one,
            "damping": self.dashpot * one,
            "stiffness": one,
            "pushed": 0,
            "push": 1.0,
            "touching": 0,
            "friction": self.friction,
            "gap": np.nan,
            # The motion is symmetric: its even harmonics are zero.
            "harmonics": np.arange(1, HARMONICS + 1, 2),
            "samples": SAMPLES,
            "contact": np.concatenate([PATH, COMPARED]),
            "angular": np.full(len(PATH) + len(COMPARED), self.angular),
        }


@dataclass(frozen=True)
class Convergence:
    """The motions that pyHarm finds as its friction is made stiffer, beside that of Stridula.

    Attributes
    ----------
    sticking : float
        Share of a period in which the mass of Stridula sticks [1].
    amplitude : float
        Amplitude in Stridula [m].
    amplitudes : ndarray, shape (stiffnesses,)
        Amplitudes in pyHarm [m], NaN where it finds no motion.
    apart : ndarray, shape (stiffnesses,)
        Differences of the motions, NaN where it finds none.
    limit : float
        Difference of the limit of infinite stiffness.
    """

    sticking: float
    amplitude: float
    amplitudes: np.ndarray
    apart: np.ndarray
    limit: float

    @property
    def found(self) -> np.ndarray:
        """Whether pyHarm finds a motion at each stiffness."""
        return np.isfinite(self.apart)

    @property
    def order(self) -> float:
        """Observed order of the differences in the stiffness."""
        return float(-np.polyfit(np.log(COMPARED[self.found]), np.log(self.apart[self.found]), 1)[0])

    @property
    def agree(self) -> bool:
        """Whether pyHarm finds enough motions, and converges to the cycle of Stridula."""
        if self.found.mean() < FOUND or self.order < ORDER - ORDER_WITHIN:
            return False
        if self.sticking:
            return bool(self.apart[self.found][-1] <= STIFFEST_TOLERANCE)
        return self.order <= ORDER + ORDER_WITHIN and self.limit <= LIMIT_TOLERANCE


def draw(generator: np.random.Generator) -> tuple[list[Rubbed], int]:
    """Return sets that slide all the time, then sets that stick, and the number of draws of neither kind."""
    sets: list[Rubbed] = []
    left_out = 0
    while len(sets) < 2 * EACH:
        sticks = len(sets) >= EACH
        angular = generator.uniform(*((0.3, 0.7) if sticks else (0.6, 1.6)))
        friction = generator.uniform(*((0.6, 0.85) if sticks else (0.15, 0.6)))
        one = Rubbed(angular, friction, generator.uniform(0.05, 0.15))
        share = sticking(one.cycle())
        if share >= STICKS_FROM if sticks else share == 0.0:
            sets.append(one)
        else:
            left_out += 1
    return sets, left_out


def sticking(cycle: xr.Dataset) -> float:
    """Return the share of a period in which a contact sticks, without single steps at reversals."""
    share = float(cycle["status_share"].sel(contact_status="sticking").mean())
    return share if share > 4.0 / STEPS else 0.0


def harmonics(cycle: xr.Dataset, places: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """Return the complex amplitudes of displacements, shape (samples, coordinates), against the cosine of the drive."""
    turns = 2.0 * np.pi * cycle["time"].values / float(cycle["period"])
    found = 2.0 / len(places) * np.exp(-1j * np.outer(numbers, turns)) @ places
    return np.asarray(np.where(numbers[:, None] == 0, 0.5, 1.0) * found)


def amplitude(motion: np.ndarray, numbers: np.ndarray) -> float:
    """Return half the range of a motion of one coordinate from its complex amplitudes."""
    turns = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
    return float(np.ptp((motion @ np.exp(1j * np.outer(numbers, turns))).real) / 2.0)


def apart(motion: np.ndarray, other: np.ndarray) -> float:
    """Return the rms of the difference of two motions over that of the second, from complex amplitudes."""
    return float(np.linalg.norm(motion - other) / np.linalg.norm(other))


def in_peer(folder: str, *words: str | Path) -> subprocess.CompletedProcess[str]:
    """Run the other Python in a folder, since pyHarm writes a folder of its own into the current one."""
    program = str(Path(PEER).absolute()) if Path(PEER).exists() else PEER
    return subprocess.run([program, *words], cwd=folder, capture_output=True, text=True)


def theirs(cases: list[Case]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return for each case the motions of pyHarm and the residuals of its equations."""
    with tempfile.TemporaryDirectory() as folder:
        given, answers = Path(folder, "cases.npz"), Path(folder, "answers.npz")
        np.savez(given, **{f"{name}_{k}": value for k, case in enumerate(cases) for name, value in case.items()})
        script = Path(__file__).resolve().with_name("pyharm_cycles.py")
        done = in_peer(folder, script, given, answers)
        if done.returncode:
            raise RuntimeError(f"pyHarm ended with exit code {done.returncode}: {done.stderr[-500:]}")
        with np.load(answers) as found:
            return [(found[f"motion_{k}"], found[f"residual_{k}"]) for k in range(len(cases))]


def convergence(one: Rubbed, more: float, motions: np.ndarray, residuals: np.ndarray) -> Convergence:
    """Compare a set whose friction in Stridula is more by a share."""
    cycle = replace(one, friction=(1.0 + more) * one.friction).cycle()
    numbers = np.asarray(one.case()["harmonics"])
    places = cycle["displacement"].values[:, :1]
    own = harmonics(cycle, places, numbers)[:, 0]
    found, solved = motions[len(PATH) :, :, 0], residuals[len(PATH) :] <= SOLVED
    powers = COMPARED[solved, None] ** [0.0, -0.5, -1.0]
    limit = np.linalg.lstsq(powers.astype(complex), found[solved], rcond=None)[0][0]
    return Convergence(
        sticking(cycle),
        float(np.ptp(places) / 2.0),
        np.where(solved, [amplitude(motion, numbers) for motion in found], np.nan),
        np.where(solved, [apart(motion, own) for motion in found], np.nan),
        apart(limit, own),
    )


def head() -> str:
    """Return the head of the table of friction."""
    stiff = "".join(f"{f'k {COMPARED[k]:.0f}':>10}" for k in SHOWN)
    return f"  w rad/s friction dashpot  sticks | amplitude{stiff}  exact | difference{stiff}  order   limit"


def line(one: Rubbed, found: Convergence) -> str:
    """Return a line of that table."""
    amplitudes = "".join(f"{found.amplitudes[k]:10.5f}" for k in SHOWN)
    differences = "".join(f"{100.0 * found.apart[k]:9.3f}%" for k in SHOWN)
    limit = "" if found.sticking else f"{100.0 * found.limit:.3f}%"
    lost = np.count_nonzero(~found.found)
    unsolved = f", pyHarm finds no motion at {lost} of {len(COMPARED)} stiffnesses" if lost else ""
    return (
        f"{one.angular:9.3f} {one.friction:8.3f} {one.dashpot:7.3f} {100.0 * found.sticking:6.1f}% |"
        f"{'':10}{amplitudes}{found.amplitude:8.5f}|{'':10}{differences} {found.order:7.2f} {limit:>7}"
        f"  {'agrees' if found.agree else 'MISSES'}{unsolved}"
    )


def stop_case(masses: Stopped, count: int) -> Case:
    """Return the masses at the stop for pyHarm, with a number of harmonics.

    The path begins near resonance, where they meet the stop: further from it there is also a motion without contact.
    """
    between, wall = masses.springs
    chain = np.array([[1.0, -1.0], [-1.0, 1.0]])
    held = np.diag([0.0, 1.0])
    return {
        "mass": np.eye(2),
        "damping": masses.damping * (chain + held),
        "stiffness": between * chain + wall * held,
        "pushed": 1,
        "push": masses.force,
        "touching": 0,
        "friction": np.nan,
        "gap": masses.gap,
        "harmonics": np.arange(count + 1),
        "samples": SAMPLES,
        "contact": np.concatenate([masses.stop * STOP_PATH, np.full(len(STOP_PATH), masses.stop)]),
        "angular": np.concatenate(
            [np.full(len(STOP_PATH), RESONANCE), np.linspace(RESONANCE, masses.angular, len(STOP_PATH))]
        ),
    }


def stop_cycle(masses: Stopped) -> xr.Dataset:
    """Return the cycle of the masses in Stridula, with the displacements of both."""
    system = masses.system()
    points = [system.contacts[0].tip, system.drives[0].point]
    step = 2.0 * np.pi / masses.angular / STEPS
    return st.limit_cycle(system, step=step, probes=[st.Displacement(point, "y") for point in points])


def stops() -> Iterator[tuple[str, bool]]:
    """Yield a line for each frequency of the masses at the stop, and whether the codes agree."""
    for angular in STOPS:
        masses = Stopped(angular)
        cycle = stop_cycle(masses)
        # Towards the stop, against y.
        places = -cycle["displacement"].values
        own = harmonics(cycle, places, np.arange(max(STOP_HARMONICS) + 1))
        answers = theirs([stop_case(masses, count) for count in STOP_HARMONICS])
        differences, residual = [], 0.0
        for motions, residuals in answers:
            motion = np.zeros_like(own)
            motion[: motions.shape[1]] = motions[-1]
            differences.append(apart(motion, own))
            residual = max(residual, float(residuals[-1]))
        agrees = differences[-1] <= STOP_TOLERANCE and residual <= SOLVED
        both = f"{abs(answers[-1][0][-1, 1, 1]):.6f} there, {abs(own[1, 1]):.6f} here"
        shown = ", ".join(f"{one:.1e} at {count}" for count, one in zip(STOP_HARMONICS, differences, strict=True))
        order = -np.polyfit(np.log(STOP_HARMONICS), np.log(differences), 1)[0]
        touches = f", order {order:.1f}" if places[:, 0].max() > masses.gap else ", without contact"
        words = f"stop, {angular:g} rad/s: first harmonic of mass 2 {both}; difference {shown} harmonics{touches}"
        yield f"{words}  {'agrees' if agrees else 'MISSES'}", agrees


def installed() -> bool:
    """Return whether the other Python has pyHarm."""
    try:
        with tempfile.TemporaryDirectory() as folder:
            return in_peer(folder, "-c", "import pyHarm").returncode == 0
    except OSError:
        return False


def main(seed: int, more: float) -> int:
    """Compare and print; return the exit status."""
    if not installed():
        print(
            f"skipped: no pyHarm in {PEER}, nothing was compared "
            "(pip install pyharm-os in an environment of its own, and set PYHARM_PYTHON to its Python)"
        )
        return 0
    began = time.perf_counter()
    sets, left_out = draw(np.random.default_rng(seed))
    print(f"seed {seed}, {len(sets)} sets, {left_out} draws left out that stick where they should slide or the reverse")
    print(head(), flush=True)
    agree = True
    for one, (motions, residuals) in zip(sets, theirs([one.case() for one in sets]), strict=True):
        found = convergence(one, more, motions, residuals)
        print(line(one, found), flush=True)
        agree &= found.agree
    for words, agrees in stops():
        print(words, flush=True)
        agree &= agrees
    print(f"{'all agree' if agree else 'NOT ALL AGREE'}, in {time.perf_counter() - began:.0f} s")
    return 0 if agree else 1


if __name__ == "__main__":
    words = arguments(__doc__ or "")
    words.add_argument("--seed", type=int, default=SEED, help="seed of the sets")
    words.add_argument("--more-friction", type=float, default=0.0, help="share by which friction is more in Stridula")
    given = words.parse_args()
    sys.exit(main(given.seed, given.more_friction))
