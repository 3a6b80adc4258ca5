"""Frozen contacts in Siconos and Stridula: trajectories until they drift apart, shares of the states, speed.

``python benchmarks/against_siconos.py --seed 2`` draws sets of parameters from the seed, marches each in both codes and
prints a line for each. The exit status is 1 if a set misses a tolerance. Siconos runs in its own Python, `PEER`;
without it the comparison is skipped with a message.

Siconos marches Moreau-Jean with theta 1/2: implicit midpoint, contact and friction on velocities. Stridula is explicit,
with contact and stick on positions. Each landing, lift-off and reversal of slip differs by a fraction of a step, so the
difference is of first order in the step. Runs are compared until two Stridula runs with initial gaps 1e-9 m apart have
drifted apart. Where the step is too long for agreement, it is halved for both.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

import stridula as st
from ratios import arguments, sized

PEER = "/usr/bin/python3"
SEED = 2011
SETS = sized(12, 3)

DURATION = sized(0.3, 0.03)
SAMPLE_RATE = 1e4
CUTOFF = 6000.0
GAP = 1e-6

STEPS = (1e-6, 5e-7, 2.5e-7, 1.25e-7)
PERTURBATION = 1e-9
TRAJECTORY_TOLERANCE = 5e-3
APART = TRAJECTORY_TOLERANCE / 2.0

STARTS = sized(8, 2)
ENSEMBLE_STEP = 5e-6
SHARE_TOLERANCE = 0.05
SETTLED_FROM = DURATION / 1.2
SETTLED_SHARE = 0.999

SPEED_REPEATS = sized(5, 1)
SPEED_DURATION = sized(0.02, 0.002)

Case = dict[str, np.ndarray | float]


@dataclass(frozen=True)
class Pair:
    """A slider on a frozen point of a track, and its drive."""

    words: str
    tip: st.BodyPoint
    point: st.BodyPoint
    friction: float
    drive: st.Force | st.ImposedVelocity

    @property
    def held(self) -> bool:
        """Whether the root is driven at an imposed velocity."""
        return isinstance(self.drive, st.ImposedVelocity)

    @property
    def rows(self) -> np.ndarray:
        """Gap and tangential displacement of the tip against the point from the modes, shape (2, modes)."""
        tip = self.tip.body.trace(self.tip.position, self.held)
        point = self.point.body.trace(self.point.position)
        return np.hstack([tip, -point])[::-1]

    @property
    def jams(self) -> bool:
        """Whether sliding in one sense would press the tip in faster than the force can hold it off."""
        normal, coupling = self.rows @ self.rows[0]
        return normal <= self.friction * abs(coupling)

    def system(self, gap: float) -> st.System:
        """Return the system for Stridula."""
        return st.System(
            st.PointContact(self.tip, self.point, friction=st.Coulomb(self.friction), gap=gap), [self.drive]
        )

    def case(self, gaps: list[float], duration: float, step: float) -> Case:
        """Return the same system as arrays for Siconos."""
        slider, track = self.tip.body.modes(self.held), self.point.body.modes()
        force = [0.0, -self.drive.normal_load] if self.held else [self.drive.x, self.drive.y]
        root = self.tip.body.trace(self.drive.point.position, self.held)
        return {
            "angular_frequency": np.concatenate([slider.angular_frequency, track.angular_frequency]),
            "damping": np.concatenate([slider.damping, track.damping]),
            "rows": self.rows,
            "load": np.concatenate([force @ root, np.zeros(track.angular_frequency.size)]),
            "gap": np.array(gaps),
            "friction": self.friction,
            "speed": self.drive.velocity if self.held else 0.0,
            "step": step,
            "steps": round(duration / step),
            "stride": round(1.0 / (SAMPLE_RATE * step)),
        }


def draw(generator: np.random.Generator) -> tuple[list[Pair], int]:
    """Return the sets and the number of draws that jam.

    A jam is Painleve's case: contact and separation are both consistent, and the codes may choose differently.
    """
    pairs: list[Pair] = []
    jammed = 0
    while len(pairs) < SETS:
        pair = draw_one(generator, len(pairs))
        if pair.jams:
            jammed += 1
        else:
            pairs.append(pair)
    return pairs, jammed


def draw_one(generator: np.random.Generator, number: int) -> Pair:
    """Return a pair of steel beams, pushed across, along or at a velocity in turn, with friction from low to high."""
    steel = st.Material(2.1e11, 7800.0)
    lengths = generator.uniform([0.2, 0.4], [0.6, 1.4])
    heights = generator.uniform(0.003, 0.012, 2)
    angle = np.radians(generator.uniform(20.0, 60.0)) * generator.choice([-1.0, 1.0])
    friction = 0.2 + 1.4 * (number + generator.uniform()) / SETS
    damping = generator.uniform(0.005, 0.03)
    load = 10.0 ** generator.uniform(-0.5, 1.0)
    speed = generator.uniform(0.005, 0.05) * generator.choice([-1.0, 1.0])
    place = lengths[1] * generator.uniform(0.2, 0.8)

    slider_section, track_section = (st.Rectangle(0.02, height) for height in heights)
    rod = st.FiniteElementBeam(steel, slider_section, lengths[0], angle, elements=30, damping=damping, cutoff=CUTOFF)
    track = st.ModalBeam(steel, track_section, lengths[1], damping=damping, cutoff=CUTOFF)
    along, across = rod.axes
    kind = ("across", "along", "velocity")[number % 3]
    if kind == "velocity":
        drive: st.Force | st.ImposedVelocity = st.ImposedVelocity(rod.root, speed, normal_load=load)
    else:
        x, y = load * (np.sign(angle) * across if kind == "across" else -along)
        drive = st.Force(rod.root, x=x, y=y)
    words = f"{kind:<8} {friction:8.2f} {np.degrees(angle):6.0f} {load:6.2f}"
    return Pair(words, rod.tip, track.at(place), friction, drive)


def ours(pair: Pair, gap: float, duration: float, step: float) -> xr.Dataset:
    """Return the Stridula run from one initial gap."""
    return st.simulate(pair.system(gap), duration, step=step, sample_rate=SAMPLE_RATE)


def theirs(pair: Pair, gaps: list[float], duration: float, step: float) -> dict[str, np.ndarray]:
    """Return the results of Siconos from some initial gaps."""
    with tempfile.TemporaryDirectory() as folder:
        case, answer = Path(folder, "case.npz"), Path(folder, "answer.npz")
        np.savez(case, **pair.case(gaps, duration, step))
        script = Path(__file__).with_name("siconos_march.py")
        done = subprocess.run([PEER, script, case, answer], env=one_thread(), capture_output=True, text=True)
        # Siconos prints a line for each contact that it has not solved, and continues.
        if done.returncode or done.stdout:
            raise RuntimeError(f"Siconos did not solve {pair.words}: {(done.stderr or done.stdout)[:500]}")
        with np.load(answer) as stored:
            return dict(stored)


def one_thread() -> dict[str, str]:
    """Return an environment that restricts a process to one thread."""
    return os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}


@dataclass(frozen=True)
class Trajectories:
    """Differences of the two codes until two Stridula runs drift apart.

    Attributes
    ----------
    until : float
        Time at which two Stridula runs are apart, or the end [s].
    step : float
        Step of both codes [s].
    apart : ndarray, shape (3,)
        Largest differences of cumulative normal and tangential impulse and path, over their largest values.
    """

    until: float
    step: float
    apart: np.ndarray

    @property
    def agree(self) -> bool:
        """Whether the differences are within the tolerance."""
        return bool(np.all(self.apart <= TRAJECTORY_TOLERANCE))


def trajectories(pair: Pair) -> Trajectories:
    """Compare one start, with smaller steps for both until the differences are within the tolerance."""
    for step in STEPS:
        own = curves(ours(pair, GAP, DURATION, step))
        twin = curves(ours(pair, GAP + PERTURBATION, DURATION, step))
        until = drift(own, twin)
        answer = theirs(pair, [GAP], until / SAMPLE_RATE, step)
        peer = np.array(
            [np.cumsum(answer["normal_impulse"][0]), np.cumsum(answer["tangential_impulse"][0]), answer["path"][0]]
        )
        scale = np.abs(own[:, :until]).max(axis=1)
        result = Trajectories(until / SAMPLE_RATE, step, np.abs(peer - own[:, :until]).max(axis=1) / scale)
        if result.agree:
            break
    return result


def curves(run: xr.Dataset) -> np.ndarray:
    """Return cumulative normal and tangential impulse and the tip's path, shape (3, samples)."""
    impulses = [np.cumsum(run[name].values) / SAMPLE_RATE for name in ("normal_force", "tangential_force")]
    return np.array([*impulses, run["contact_position"].values])


def drift(own: np.ndarray, twin: np.ndarray) -> int:
    """Return the number of samples until two runs are apart, by a share of the largest value so far."""
    scale = np.maximum.accumulate(np.abs(own), axis=1)
    apart = np.abs(twin - own) > APART * scale
    # At first the largest value so far is as small as the perturbation.
    apart &= scale > 0.01 * scale[:, -1:]
    where = np.flatnonzero(apart.any(axis=0))
    return int(where[0]) if where.size else own.shape[1]


@dataclass(frozen=True)
class Shares:
    """Shares of the three states in an ensemble of each code.

    Attributes
    ----------
    ours, theirs : ndarray, shape (3,)
        Shares of steps separated, sticking, sliding.
    settles : bool
        Whether all Stridula runs end in one state.
    """

    ours: np.ndarray
    theirs: np.ndarray
    settles: bool

    @property
    def agree(self) -> bool:
        """Whether the differences are within the tolerance."""
        return bool(np.all(np.abs(self.ours - self.theirs) <= SHARE_TOLERANCE))


def shares(pair: Pair) -> Shares:
    """Compare ensembles of starts from half the gap to one and a half."""
    gaps = list(GAP * np.linspace(0.5, 1.5, STARTS))
    runs = [ours(pair, gap, DURATION, ENSEMBLE_STEP)["status_share"] for gap in gaps]
    own = np.mean([run.mean("time").values for run in runs], axis=0)
    ends = [run.sel(time=slice(SETTLED_FROM, None)).mean("time").max() for run in runs]
    peer = theirs(pair, gaps, DURATION, ENSEMBLE_STEP)["shares"].mean(axis=0)
    return Shares(own, peer, settles=min(ends) >= SETTLED_SHARE)


def speed(pair: Pair) -> list[float]:
    """Return the ratios of the time of Siconos to that of Stridula for the same steps, one after the other."""
    step, ratios = STEPS[0], []
    for _ in range(SPEED_REPEATS):
        own = ours(pair, GAP, DURATION, step).attrs["wall_time"] / DURATION
        ratios.append(theirs(pair, [GAP], SPEED_DURATION, step)["wall_time"][0] / SPEED_DURATION / own)
    return ratios


def compare(pairs: list[Pair]) -> Iterator[tuple[Pair, Trajectories, Shares]]:
    """Yield the comparisons of all pairs, with one Siconos process on each core."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        both = [(pool.submit(trajectories, pair), pool.submit(shares, pair)) for pair in pairs]
        for pair, (trajectory, share) in zip(pairs, both, strict=True):
            yield pair, trajectory.result(), share.result()


HEAD = (
    "drive    friction  angle   load modes settles   until    step    normal   tangent      path"
    "      shares here      shares there   verdict"
)


def line(pair: Pair, trajectory: Trajectories, share: Shares) -> str:
    """Return a line of the table."""
    apart = " ".join(f"{100.0 * value:8.4f}%" for value in trajectory.apart)
    here, there = (" ".join(f"{value:.3f}" for value in side) for side in (share.ours, share.theirs))
    settles = "yes" if share.settles else "no"
    misses = [name for name, part in (("trajectory", trajectory), ("shares", share)) if not part.agree]
    verdict = f"MISSES {' and '.join(misses)}" if misses else "agree"
    return (
        f"{pair.words} {pair.rows.shape[1]:5d} {settles:>7} {trajectory.until:6.4f}s {1e6 * trajectory.step:5.3f}us "
        f"{apart}  {here}  {there}  {verdict}"
    )


def installed() -> bool:
    """Return whether the other Python has Siconos."""
    try:
        return subprocess.run([PEER, "-c", "import siconos.kernel"], capture_output=True).returncode == 0
    except OSError:
        return False


def main(seed: int) -> int:
    """Compare and print; return the exit status."""
    if not installed():
        print(f"skipped: no Siconos in {PEER}, nothing was compared (Debian: apt-get install python3-siconos)")
        return 0
    began = time.perf_counter()
    pairs, jammed = draw(np.random.default_rng(seed))
    print(f"seed {seed}, {len(pairs)} sets, {jammed} draws that jam left out")
    print(HEAD)
    agree = True
    for pair, trajectory, share in compare(pairs):
        print(line(pair, trajectory, share), flush=True)
        agree &= trajectory.agree and share.agree
    ratios = speed(pairs[0])
    spread = f"{min(ratios):.0f} to {max(ratios):.0f}, median {statistics.median(ratios):.0f}"
    print(f"times faster than Siconos on the first set at {1e6 * STEPS[0]:.0f} us: {spread}")
    print(f"{'all agree' if agree else 'NOT ALL AGREE'}, in {time.perf_counter() - began:.0f} s")
    return 0 if agree else 1


if __name__ == "__main__":
    words = arguments(__doc__)
    words.add_argument("--seed", type=int, default=SEED)
    sys.exit(main(words.parse_args().seed))
