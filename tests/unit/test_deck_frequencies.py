"""Frequencies of decks of CalculiX' own tests against the results that come with them."""

from __future__ import annotations

import gzip
import re
from pathlib import Path

import numpy as np
import pytest

import stridula as st
from stridula.bodies.solids import elements

# As Debian's calculix-ccx-test installs them.
DECKS = Path("/usr/share/doc/calculix-ccx-test/examples/test")
NAMES = ["beam8f", "beamf", *(f"beamdy{k}" for k in range(1, 20) if k != 7)]
# Points of integration of C3D8 and C3D20R, two along each side.
REDUCED = (2, 3, 4)


def text_of(name):
    for path in (DECKS / name, DECKS / f"{name}.gz"):
        if path.exists():
            content = path.read_bytes()
            return (gzip.decompress(content) if path.suffix == ".gz" else content).decode("latin-1")
    return pytest.skip(f"takes {name} of Debian's calculix-ccx-test, which is not installed: it was not read")


def held(deck):
    """Return the directions held before the first step by the name of their set."""
    found = {}
    for block in re.findall(r"(?im)^\*boundary[^\n]*\n((?:[^*\n][^\n]*\n)+)", re.split(r"(?im)^\*step", deck)[0]):
        for line in block.splitlines():
            name, first, *last = (word.strip() for word in line.split(",") if word.strip())
            found[name] = found.get(name, "") + "xyz"[int(first) - 1 : int(last[0]) if last else int(first)]
    return found


@pytest.mark.parametrize("name", NAMES)
def test_frequencies_are_those_of_calculix(name, tmp_path, monkeypatch):
    deck = text_of(f"{name}.inp")
    rows = [line.split() for line in text_of(f"{name}.dat.ref").partition("P A R T I C I P")[0].splitlines()]
    wanted = np.array([float(row[3]) for row in rows if len(row) == 5 and row[0].isdigit()])
    assert wanted.size == 10
    path = tmp_path / f"{name}.inp"
    path.write_text(deck, encoding="utf-8")
    (part,) = st.read_parts(path, scale=1e-3).values()
    monkeypatch.setattr(elements, "DEGREES", REDUCED)
    body = st.SolidBody(
        part.mesh,
        part.materials,
        fixed=held(deck),
        linear=True,
        cutoff=1.01 * wanted.max(),
        name=f"as CalculiX: {name}",
    )
    # The results have seven digits.
    np.testing.assert_allclose(body.modes().frequency[:10], wanted, rtol=5e-7)
