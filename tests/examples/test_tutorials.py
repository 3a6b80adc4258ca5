"""Tutorials: from its files alone comes the friction of a rig, and from matrices of CalculiX the pad of its mesh."""

from __future__ import annotations

import runpy
from dataclasses import replace

import numpy as np
import pytest

import stridula as st

from .pages import EXAMPLES


def test_the_friction_of_the_tribometer_comes_back_from_its_files(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = EXAMPLES[0].parent / "tutorials" / "07_tribometer.py"
    names = runpy.run_path(str(path), run_name="__main__")
    found, true = names["found"], names["TRUE"]
    for name, value in (("static", true.static), ("velocity", true.velocity)):
        one = found.sel(parameter=name)
        assert float(one["low"]) < value < float(one["high"])
        assert bool(one["determined"])
    assert abs(names["fit"].law.kinetic - true.kinetic) < 0.005
    assert all(model == rig for model, rig in names["regimes"].values())
    assert len(set(map(tuple, names["regimes"].values()))) > 1
    assert "a harmonic of cycles at 98.0" in capsys.readouterr().out
    # From files to a calibrated model.
    used = path.read_text(encoding="utf-8").partition("reads files only.")[2]
    assert len([line for line in used.splitlines() if line and not line.startswith("#")]) < 60


def test_the_pad_of_matrices_is_that_of_its_mesh(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = EXAMPLES[0].parent / "tutorials" / "08_matrices.py"
    names = runpy.run_path(str(path), run_name="__main__")
    assert np.abs(names["apart"]).max() < 1e-9
    # With the mesh in place of the matrices the brake is the same.
    deck, face, load, materials = path.parent / "pad.inp", names["face"], names["load"], names["materials"]
    held, faces = {"BACK": "xz"}, {"RUB": 12}
    pad = st.SolidBody.read(deck, materials, fixed=held, contact_faces=faces, cutoff=30e3, damping=0.005, name="pad")
    other = st.System(replace(face, body=pad), [replace(load, point=pad.at((0.0, 0.016, 0.105)))])
    theory, again = names["theory"], st.sliding_stability(other)
    growing = theory.growth_rate.values > 0.0
    np.testing.assert_allclose(again.growth_rate.values[growing], theory.growth_rate.values[growing], rtol=1e-3)
    run = names["run"]
    assert float(run.normal_force.mean()) == pytest.approx(-load.y, rel=0.01)
    assert float(np.abs(run.ledger_residual).max()) < 1e-11 * float(np.abs(run.drive_work).max())
    assert "Hz grows by" in capsys.readouterr().out
    assert (tmp_path / "pad.html").stat().st_size > 100_000
