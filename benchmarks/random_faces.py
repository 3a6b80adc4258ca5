"""Forces of random faces of points in contact: solved or not, what they miss of the laws, steps; Siconos beside them.

    python benchmarks/random_faces.py                     the tables of 2000 faces, in a minute
    python benchmarks/random_faces.py --plot faces.png    also a figure of steps and residuals
    python benchmarks/random_faces.py --seed 1477         a line for one face
    python benchmarks/random_faces.py --short             40 faces

`face_problems.py` draws the faces, `face_laws.py` judges the forces. The first table is that of the march, whose slips
of the last steps count; *other slip* counts faces with points that obey their law only for another slip than they
should: it was found to end in the step and then goes on, or its end is forgotten. Siconos has no such law: the second
table has the same steps under the slip of the step alone, for both, from the forces of the last step, with points that
yield linearly about their gaps. Siconos sweeps (NSGS, at most 10 000 times) and uses the nonsmooth Newton method of
Alart and Curnier (NSN_AC, at most 200 steps; in the plane with a second tangent without motion). Without Siconos these
lines are left out. The exit status is 1, with a message, if more than 1 % of the faces are unsolved or miss a law by
more than 1e-9 of the largest force, or more than 2 % have another slip.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from against_siconos import PEER, installed
from face_laws import as_rigid, judge
from face_problems import KINDS, OPEN, SLIDING, STICKING, Problem, drawn, solve
from ratios import arguments, sized

FACES, ALLOWED = sized(2000, 40), sized(0.01, 0.05)
LAWFUL, WORST = 1e-9, sized(15, 5)
OURS, PEERS = "stridula", {"gauss_seidel": "Siconos NSGS", "newton": "Siconos NSN_AC"}
QUANTILES = (50.0, 95.0, 100.0)


@dataclass(frozen=True)
class Judged:
    """A face, its steps and what its forces miss, under the law of the march and without the last slips.

    Attributes
    ----------
    seed : int
        Its seed.
    kind : tuple of str
        Its start, whether it yields, and where it is.
    status : ndarray, shape (points,)
        What its points were.
    solved : bool
        Whether the kernel says so.
    other : int
        Points that obey their law in the march only for another meaning of their slip than it should have.
    steps : dict
        Sweeps or steps of Newton's method by solver; those of the march as "march".
    left : dict
        The largest residual over its points, relative to the largest force.
    rigid : Problem
        The step for Siconos.
    """

    seed: int
    kind: tuple[str, str, str]
    status: np.ndarray
    solved: bool
    other: int
    steps: dict[str, int]
    left: dict[str, float]
    rigid: Problem

    @property
    def misses(self) -> bool:
        """Whether it is unsolved, or misses a law, in the march."""
        return not (self.solved and self.left["march"] <= LAWFUL)

    @property
    def worst(self) -> float:
        """The largest residual of the package, with and without the last slips."""
        return max(self.left["march"], self.left[OURS])


def judged(seed: int) -> Judged:
    """Solve the face of a seed and judge its forces."""
    kind, problem = drawn(seed)
    plain = problem.plain()
    marched = solve(problem)
    found = solve(plain) if problem.last.any() or problem.earlier.any() else marched
    left, meant = judge(problem, marched.forces)
    other = int(((left <= LAWFUL) & (meant > LAWFUL)).sum())
    alone, _ = judge(plain, found.forces)
    steps, most = {"march": marched.sweeps, OURS: found.sweeps}, {"march": float(left.max()), OURS: float(alone.max())}
    return Judged(seed, kind, problem.status, marched.solved, other, steps, most, as_rigid(plain, found.forces))


def add_peer(faces: list[Judged]) -> None:
    """Add steps and residuals of Siconos."""
    given = {}
    for k, face in enumerate(faces):
        free = face.rigid.free.copy()
        free[:, 1:] += face.rigid.away
        parts = face.rigid.compliance, free.ravel(), face.rigid.friction, face.rigid.force.ravel()
        words = ("compliance", "free", "friction", "start")
        given.update({f"{word}_{k}": part for word, part in zip(words, parts, strict=True)})
    with tempfile.TemporaryDirectory() as folder:
        problems, answers = Path(folder) / "problems.npz", Path(folder) / "answers.npz"
        np.savez(problems, **given)
        script = Path(__file__).with_name("siconos_faces.py")
        done = subprocess.run([PEER, str(script), str(problems), str(answers)], capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(
                f"Siconos must solve the faces, ended with {done.returncode}: {done.stderr[-200:].strip()}"
            )
        with np.load(answers) as found:
            for k, face in enumerate(faces):
                for name, words in PEERS.items():
                    forces = found[f"{name}_{k}"].reshape(face.rigid.free.shape)
                    face.left[words] = float(judge(face.rigid, forces)[0].max())
                    face.steps[words] = int(found[f"{name}_steps_{k}"])


def spread(values: Iterable[float], form: str) -> str:
    """Return median, 95 % and largest of some values as columns."""
    return "".join(f"{value:>{form}}" for value in np.percentile(list(values), QUANTILES))


def cells(faces: list[Judged], solver: str) -> str:
    """Return the columns of a solver: faces above the bar, quantiles of residual and steps."""
    above = sum(not face.left[solver] <= LAWFUL for face in faces)
    residual = spread((face.left[solver] for face in faces), "9.0e")
    return f"{above:>7}{residual}{spread((face.steps[solver] for face in faces), '7.0f')}"


def of_march(faces: list[Judged]) -> Iterable[str]:
    """Yield the lines of the table of the march."""
    yield f"{'':<31}{'points before, %':^19}{'un-':>9}{'other':>7}{'above':>7}{'residual':^27}{'sweeps or steps':^21}"
    heads = ("open", "stuck", "slid", "solved", "slip", "1e-9", *("median", "95 %", "most") * 2)
    widths = (6, 7, 6, 9, 7, 7, 9, 9, 9, 7, 7, 7)
    yield f"{'faces':<31}" + "".join(f"{head:>{width}}" for head, width in zip(heads, widths, strict=True))
    for kind in (*KINDS, None):
        some = [face for face in faces if kind in (None, face.kind)]
        before = np.concatenate([face.status for face in some])
        shares = (f"{100.0 * np.mean(before == one):.0f}" for one in (OPEN, STICKING, SLIDING))
        words = f"{len(some):>4} {', '.join(kind) if kind else 'all'}"
        states = "".join(f"{share:>{width}}" for share, width in zip(shares, widths[:3], strict=True))
        unsolved, other = sum(not face.solved for face in some), sum(face.other > 0 for face in some)
        yield f"{words:<31}{states}{unsolved:>9}{other:>7}{cells(some, 'march')}"


def of_peers(faces: list[Judged]) -> Iterable[str]:
    """Yield the lines of the table of steps under the slip of the step alone."""
    yield f"{'without the last slips':<49}{'above':>7}{'residual':^27}{'iterations':^21}"
    heads = ("1e-9", *("median", "95 %", "most") * 2)
    widths = (7, 9, 9, 9, 7, 7, 7)
    yield f"{'':<49}" + "".join(f"{head:>{width}}" for head, width in zip(heads, widths, strict=True))
    for kind in (*KINDS, None):
        some = [face for face in faces if kind in (None, face.kind)]
        for solver in some[0].steps:
            if solver != "march":
                words = f"{len(some):>4} {', '.join(kind) if kind else 'all'}" if solver == OURS else ""
                yield f"{words:<33}{solver:<16}{cells(some, solver)}"


def histogram(faces: list[Judged]) -> Iterable[str]:
    """Yield numbers of faces by their number of steps, for each solver."""
    solvers = list(faces[0].steps)
    most = max(face.steps[solver] for face in faces for solver in solvers)
    ends = 2 ** np.arange(int(np.ceil(np.log2(max(most, 2)))) + 1)
    yield f"{'steps or sweeps':<16}" + "".join(f"{solver:>16}" for solver in solvers)
    for low, high in zip([-1, *ends[:-1]], ends, strict=True):
        counts = [sum(low < face.steps[solver] <= high for face in faces) for solver in solvers]
        words = f"{low + 1} to {high}" if low + 1 < high else f"{high}"
        yield f"{words:<16}" + "".join(f"{count:>16}" for count in counts)


def draw_figure(faces: list[Judged], target: Path) -> None:
    """Write a figure of the steps and of the residuals of each solver."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 3.5), layout="constrained")
    left, right = figure.subplots(1, 2)
    for solver in faces[0].steps:
        steps, residual = (np.sort([getattr(face, name)[solver] for face in faces]) for name in ("steps", "left"))
        share = 100.0 * np.arange(1, len(faces) + 1) / len(faces)
        left.step(np.maximum(steps, 1), share, where="post", label=solver)
        right.step(np.clip(residual, 1e-17, 1.0), share, where="post", label=solver)
    left.set(xscale="log", xlabel="sweeps or steps of Newton's method [1]", ylabel="faces with at most as many [%]")
    right.set(xscale="log", xlabel="residual over the largest force [1]", ylabel="faces with at most as much [%]")
    right.axvline(LAWFUL, color="0.7")
    right.legend()
    figure.savefig(target, dpi=150)


def described(face: Judged) -> str:
    """Return a line of a face: its seed, what it is, whether it is solved, residuals and steps."""
    results = ", ".join(f"{solver} {left:.1e} in {face.steps[solver]}" for solver, left in face.left.items())
    solved = "solved" if face.solved else "unsolved"
    return f"--seed {face.seed}: {', '.join(face.kind)}, {len(face.status)} points, {solved}; {results}"


def main() -> None:
    """Print the tables, the histogram and the worst faces."""
    words = arguments(__doc__ or "")
    words.add_argument("--seed", type=int, help="describe the face of this seed alone")
    words.add_argument("--plot", type=Path, metavar="FILE", help="write a figure of steps and residuals")
    asked = words.parse_args()
    faces = [judged(seed) for seed in (range(FACES) if asked.seed is None else [asked.seed])]
    if installed():
        add_peer(faces)
    else:
        print("no Siconos, nothing is compared with it (Debian: apt-get install python3-siconos)")
    if asked.plot:
        draw_figure(faces, asked.plot)
    if asked.seed is not None:
        print(described(faces[0]))
        return
    for lines in (of_march(faces), of_peers(faces), histogram(faces)):
        print("\n".join(lines), end="\n\n")
    worst = sorted(faces, key=lambda face: (face.misses, face.worst), reverse=True)[:WORST]
    print("\n".join(["worst:", *map(described, worst)]))
    missed, other = sum(face.misses for face in faces), sum(face.other > 0 for face in faces)
    if missed > ALLOWED * len(faces) or other > 2 * ALLOWED * len(faces):
        raise SystemExit(f"forces of all faces but {ALLOWED:.0%} must obey the laws: {missed} do not, {other} in part")


if __name__ == "__main__":
    sys.exit(main())
