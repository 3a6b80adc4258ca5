"""The README states the number of claims of the paper that hold, in one sentence."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from stridula.papers.laulagnet_2011.claims import CLAIMS

from .test_laulagnet_2011 import MISSED

ROOT = Path(__file__).resolve().parents[2]


def test_the_readme_counts_the_claims():
    of, held = Counter(claim.fitted for claim in CLAIMS), Counter(c.fitted for c in CLAIMS if c.claim not in MISSED)
    sentence = (
        f"Of {of.total()} claims, {held.total()} hold: {held[True]} of the {of[True]} to which unpublished parameters "
        f"were fitted, and {held[False]} of the {of[False]} that were predicted."
    )
    assert sentence in " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
