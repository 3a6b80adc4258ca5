"""Time of a step of Siconos over that of Stridula (against_siconos.py): the same modal system and steps, in turn."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import against_siconos as peer
from ratios import Ratio, show

TITLE = "time of a step of Siconos over that of stridula"


def rows() -> Iterator[Ratio | str]:
    """Yield the ratio, or a line that Siconos is missing."""
    if not peer.installed():
        yield "skipped: Siconos is not installed (Debian: python3-siconos)"
        return
    pairs, _ = peer.draw(np.random.default_rng(peer.SEED))
    if not peer.trajectories(pairs[0]).agree:
        raise SystemExit("Siconos and Stridula must agree on the first system: see against_siconos.py")
    peer.ours(pairs[0], peer.GAP, peer.SPEED_DURATION, peer.STEPS[0])
    modes = pairs[0].rows.shape[1]
    yield Ratio(f"{modes} modes, first system of the comparison, 1 us", peer.speed(pairs[0]))


if __name__ == "__main__":
    show(TITLE, rows())
