"""Texts and systems that tests of scenarios share."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import stridula as st

CASES = ["axial-sliding", "judder", "squeal", "stable-sliding", "strong-pressure", "weak-pressure"]
MASSES = ["belt", "lugre"]
PLATES = ["judder-on-plate", "squeal-on-plate"]


def problems(text: str, folder: Path, overrides: dict[str, object] | None = None) -> tuple[str, ...]:
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(st.ScenarioError) as caught:
        st.load_scenario(path, overrides)
    return caught.value.problems


def chain(size: int, **options) -> st.ReducedBody:
    """Return a chain of equal masses on springs, along x and y, its last one the tip."""
    line = 2.1e5 * np.eye(size) - 1e5 * (np.eye(size, k=1) + np.eye(size, k=-1))
    stiffness = np.kron(line, np.diag([1.0, 1.7]))
    points = {
        "tip": (2 * size - 2, 2 * size - 1),
        "20 mm": np.full((2, 2 * size), 1.0 / 3.0),
        "x only": (0, None),
        "y half": [[0.0] * 2 * size, [0.0, 0.5] + [0.0] * (2 * size - 2)],
    }
    return st.ReducedBody(np.eye(2 * size) * 0.1, stiffness, **{"points": points} | options)


MASS_ON_FLOOR = (
    '[bodies.a]\nkind = "point mass"\nmass = 1\n[[contacts]]\ntip = {body = "a"}\ntrack = {kind = "rigid"}\n'
    "[simulation]\nduration = 1\n"
)
