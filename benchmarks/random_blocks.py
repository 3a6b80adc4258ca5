"""Equilibria of random blocks on points of a belt, against every set of points tried by hand.

    python benchmarks/random_blocks.py                  the table of 1000 blocks, in a quarter of an hour
    python benchmarks/random_blocks.py --short          three blocks of each kind

Blocks in the plane and in space have 3 to 6 points, some with gaps, and friction from 0.1 to 0.8; `tests/physics`
draws them. *Wrong* counts unique equilibria whose forces or growth differ from those of the set by hand, or that are
called something else than one; *unsaid* counts the cases of several sets or none that are called one.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

import stridula as st
from ratios import arguments, sized

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tests.physics.blocks import random_block
from tests.physics.test_equilibria import different

KINDS = ("linear", "power")
SEEDS, WORKERS = sized((250, 2), (3, 1))


def compared(kind: str, spatial: bool, seed: int) -> tuple[int, str, bool]:
    """Return the number of sets by hand, the number found in words, and whether forces and growth are those by hand."""
    block = random_block(np.random.default_rng(seed), spatial, kind)
    by_hand, found = different(block), st.sliding_stability(block.system())
    if len(by_hand) != 1:
        return len(by_hand), found.attrs["equilibria"], True
    ((closed, _, forces),) = by_hand
    if np.abs(found.normal_force.values - forces).max() > 1e-8 * np.abs(block.load).max():
        return 1, found.attrs["equilibria"], False
    growth, seen = block.growth(closed, forces), float(found.growth_rate.max())
    right = found.attrs["violated"] == "" and abs(seen - growth) <= max(1e-6 * abs(growth), 1e-3)
    return 1, found.attrs["equilibria"], right


def all_compared() -> Iterator[tuple[str, bool, list[tuple[int, str, bool]]]]:
    """Yield kind, whether in space, and the results of the blocks of each."""
    seeds = range(SEEDS)
    with ProcessPoolExecutor(WORKERS) as pool:
        for kind in KINDS:
            for spatial in (False, True):
                asked = ([kind] * SEEDS, [spatial] * SEEDS, seeds)
                yield kind, spatial, list((pool.map if WORKERS > 1 else map)(compared, *asked))


def main() -> None:
    """Print the table."""
    arguments(__doc__).parse_args()
    print(
        f"{'points':<8} {'block':<6}{'blocks':>7}{'unique':>8}{'wrong':>7}{'unsaid':>8}  sets by hand, found",
        flush=True,
    )
    failed = []
    for kind, spatial, results in all_compared():
        unique = [one for one in results if one[0] == 1]
        wrong = sum(not right for _, _, right in unique)
        unsaid = sum(count != 1 and word == "one" for count, word, _ in results)
        words = ", ".join(f"{a} {b}: {n}" for (a, b), n in sorted(Counter(one[:2] for one in results).items()))
        where = "space" if spatial else "plane"
        print(f"{kind:<8} {where:<6}{len(results):>7}{len(unique):>8}{wrong:>7}{unsaid:>8}  {words}", flush=True)
        if wrong or unsaid:
            failed.append(f"{wrong} and {unsaid} of {kind} points in the {where}")
    if failed:
        raise SystemExit(f"forces and growth must be those by hand, and other cases named, not {'; '.join(failed)}")


if __name__ == "__main__":
    sys.exit(main())
