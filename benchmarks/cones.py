"""Closed contacts in space, solved by Siconos' `FrictionContact(3)` and by Stridula: forces and residuals side by side.

``python benchmarks/cones.py --seed 2`` draws problems like those of FCLIB: contacts between bodies of random modes,
with more modes than rows, under random displacements. Both solve the same complementarity between gaps, slips and
forces. The residual is computed in the same way for both. The exit status is 1 if forces differ or a residual of
Stridula is too large. Without Siconos the comparison is skipped with a message.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from against_siconos import PEER
from ratios import arguments, sized
from stridula._kernels.layout import columns as at
from stridula._kernels.layout.laws import LAW_COLUMNS, STATIC
from stridula.integration.contact_solve import GaussSeidel
from stridula.integration.forces import forces_of

SEED = 2011
COUNTS = sized((1, 2, 4, 8, 16, 32), (1, 3))
EACH = sized(5, 2)
# Modes for each row of the contacts, enough for a regular compliance.
MODES = 1.5
# Both solve to 1e-12; the condition of the compliance, some hundreds, multiplies the difference of the forces.
FORCES, RESIDUAL = 1e-8, 1e-9

Case = tuple[np.ndarray, np.ndarray, np.ndarray]


def drawn(random: np.random.Generator, count: int) -> Case:
    """Return compliance, displacements without forces and coefficients of friction of contacts."""
    rows = random.standard_normal((3 * count, int(MODES * 3 * count) + 3))
    compliance = rows @ rows.T / rows.shape[1] + 0.05 * np.eye(3 * count)
    free = random.standard_normal(3 * count)
    free[::3] -= 1.0
    # At least one contact is closed.
    free[0] = -1.0 - abs(free[0])
    return compliance, free, random.uniform(0.1, 0.7, count)


def here(case: Case) -> np.ndarray:
    """Return the forces of the march, with the signs of the push, shape (3 contacts,)."""
    compliance, free, friction = case
    count = len(friction)
    laws = np.zeros((count, LAW_COLUMNS))
    laws[:, STATIC] = friction
    given = free.reshape(-1, 3)
    codes, carried = np.full(count, at.COULOMB), np.zeros((count, at.CARRIED))
    solve = GaussSeidel(1e-13, 10000)
    found = forces_of(given[:, 0], given[:, 1:], compliance, (codes, laws), carried, 1.0, solve)
    return np.asarray(found * [1.0, -1.0, -1.0]).ravel()


def residual(case: Case, forces: np.ndarray) -> float:
    """Return the residual of the complementarity: forces less the projection of forces minus displacements."""
    compliance, free, friction = case
    moved = (free + compliance @ forces).reshape(-1, 3)
    pushed = forces.reshape(-1, 3)
    moved[:, 0] += friction * np.hypot(moved[:, 1], moved[:, 2])
    tried = pushed - moved
    return float(np.abs(pushed - projected(tried, friction)).max() / np.abs(pushed).max())


def projected(forces: np.ndarray, friction: np.ndarray) -> np.ndarray:
    """Return the nearest forces inside the cones, shape (contacts, 3)."""
    normal, size = forces[:, 0], np.hypot(forces[:, 1], forces[:, 2])
    inside, dual = size <= friction * normal, friction * size <= -normal
    along = np.where(inside | dual, 0.0, (normal + friction * size) / (1.0 + friction**2))
    onto = np.column_stack([along, (friction * along / np.where(size > 0.0, size, 1.0))[:, None] * forces[:, 1:]])
    return np.where(inside[:, None], forces, np.where(dual[:, None], 0.0, onto))


def there(cases: list[Case]) -> list[np.ndarray]:
    """Return the forces of Siconos."""
    with tempfile.TemporaryDirectory() as folder:
        given, answers = Path(folder) / "cases.npz", Path(folder) / "answers.npz"
        words = ("compliance", "free", "friction")
        np.savez(
            given, **{f"{w}_{k}": part for k, case in enumerate(cases) for w, part in zip(words, case, strict=True)}
        )
        script = Path(__file__).with_name("siconos_cones.py")
        subprocess.run([PEER, str(script), str(given), str(answers)], check=True)
        with np.load(answers) as found:
            return [found[f"forces_{number}"] for number in range(len(cases))]


def main() -> int:
    """Compare all problems of a seed, and print a line for each number of contacts."""
    words = arguments(__doc__ or "")
    words.add_argument("--seed", type=int, default=SEED, help="seed of the problems")
    seed = words.parse_args().seed
    if not Path(PEER).exists() or subprocess.run([PEER, "-c", "import siconos"], capture_output=True).returncode:
        print(f"skipped: no Siconos in {PEER}, nothing was compared (Debian: apt-get install python3-siconos)")
        return 0
    random = np.random.default_rng(seed)
    cases = [drawn(random, count) for count in COUNTS for _ in range(EACH)]
    worst = 0
    answers = there(cases)
    for k, count in enumerate(COUNTS):
        some = range(k * EACH, (k + 1) * EACH)
        ours = [here(cases[one]) for one in some]
        apart = max(
            float(np.abs(mine - answers[one]).max() / np.abs(mine).max()) for one, mine in zip(some, ours, strict=True)
        )
        left = [max(residual(cases[one], mine) for one, mine in zip(some, ours, strict=True))]
        left.append(max(residual(cases[one], answers[one]) for one in some))
        missed = apart > FORCES or left[0] > RESIDUAL
        worst |= missed
        print(
            f"{count:3d} contacts, {EACH} problems: forces apart by {apart:.1e}, residual here {left[0]:.1e}, "
            f"Siconos {left[1]:.1e}{'  MISSED' if missed else ''}"
        )
    return int(worst)


if __name__ == "__main__":
    sys.exit(main())
