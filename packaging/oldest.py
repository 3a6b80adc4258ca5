"""Print the oldest release of each dependency that pyproject.toml allows, as constraints for pip."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[1] / "pyproject.toml"
# What users install; tools of developers may be new.
EXTRAS = ("scenarios", "files", "sound", "plot", "cli", "page")


def oldest(requirements: Iterable[str]) -> list[str]:
    """Return ``name==release`` for each ``name>=release``; what stands for other extras is left out."""
    found = []
    for text in requirements:
        if text.startswith("stridula["):
            continue
        match = re.fullmatch(r"([\w.-]+)>=([\w.]+)", text)
        if match is None:
            raise SystemExit(f"a dependency must be name>=release, got {text!r}")
        found.append(f"{match[1]}=={match[2]}")
    return found


def main() -> None:
    project = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]
    optional = project["optional-dependencies"]
    for line in oldest([*project["dependencies"], *(text for extra in EXTRAS for text in optional[extra])]):
        print(line)


if __name__ == "__main__":
    main()
