"""Results in the documentation, where it was built from the present sources: what takes minutes is computed once."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]


@cache
def documented(file: str) -> list[dict[str, Any]]:
    """Return the rows of a file of ``docs/_generated``, none if it is missing or older than a source."""
    written = ROOT / "docs" / "_generated" / file
    sources = (path for path in (ROOT / "src").rglob("*") if path.suffix in (".py", ".toml"))
    if not written.exists() or written.stat().st_mtime < max(path.stat().st_mtime for path in sources):
        return []
    return list(json.loads(written.read_text(encoding="utf-8")))
