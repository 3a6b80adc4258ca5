"""Instructions to install use the sources: there is no distribution of this name on the index."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FILES = [
    *(ROOT / "src").rglob("*.py"),
    *(path for suffix in ("rst", "md") for path in (ROOT / "docs").glob(f"*.{suffix}")),
    *ROOT.glob("*.md"),
]
# A name with extras, or a name to install, which would have to be on the index.
FROM_THE_INDEX = r"stridula\[\w+\]|pip install\s+stridula\b"


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_nothing_is_installed_by_name(path):
    assert not re.search(FROM_THE_INDEX, path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("text", ["pip install stridula[video]", "pip install\nstridula", "the extra stridula[cuda]"])
def test_the_rule_can_fail(text):
    assert re.search(FROM_THE_INDEX, text)
