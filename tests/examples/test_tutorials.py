"""The tutorial of a tribometer: from its files alone comes the friction of the rig that wrote them."""

from __future__ import annotations

import runpy

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
