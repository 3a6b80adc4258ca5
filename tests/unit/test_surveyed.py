"""Surveys from the outcomes of points: tracked modes, named tones, tables and maps, the command line."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import QuadMesh

import stridula as st
from stridula import plot
from stridula.studies.points import laid_out
from stridula.studies.surveyed import followed, neighbours, surveyed
from stridula.studies.tables import survey_table
from stridula.studies.tones_of_modes import tones_of

FREQUENCIES = [[], [900.0], [910.0, 2000.0], [300.0, 2050.0], [930.0, 2100.0]]


def modes(*frequencies):
    return [{"frequency": frequency} for frequency in frequencies]


def test_modes_keep_their_names_from_point_to_point():
    """One appears later, one pauses, and all are named by increasing frequency."""
    before = [[], [0], [1], [2], [3]]
    names = followed([modes(*one) for one in FREQUENCIES], before)
    assert names == [[], [1], [1, 2], [0, 2], [1, 2]]
    # A mode farther away than a fifth is another one.
    assert followed([modes(1000.0), modes(1250.0)], [[], [0]]) == [[0], [1]]
    assert followed([modes(1000.0), modes(1150.0)], [[], [0]]) == [[0], [0]]
    # Two modes never merge.
    assert followed([modes(1000.0), modes(990.0, 1010.0)], [[], [0]]) == [[1], [0, 1]]


def test_neighbours_are_one_back_on_each_axis_or_the_nearest_before():
    grid = laid_out({"a": [1.0, 2.0], "b": [1.0, 2.0]})
    assert neighbours(grid, {}) == [[], [0], [1 - 1], [1, 2]]
    points = laid_out([{"a": value} for value in (0.0, 10.0, 1.0, 9.0)])
    places = {"a": ("point", np.array([0.0, 10.0, 1.0, 9.0]), {})}
    assert neighbours(points, places) == [[], [0], [0], [1]]


def test_tones_are_named_after_modes_that_grow_then_as_multiples_then_after_others():
    time = np.arange(20_000) * 1e-5
    sizes = {980.0: 1.0, 1960.0: 0.5, 490.0: 0.4, 3300.0: 0.3, 4777.0: 0.2, 6000.0: 1e-3}
    values = 5.0 + sum(size * np.sin(2.0 * np.pi * f * time) for f, size in sizes.items())
    signal = xr.DataArray(values, {"time": time}, ("time",))
    exponents = np.array([10.0, 300.0 - 1.0, 2j * np.pi * 1000.0 + 50.0, 2j * np.pi * 3200.0 - 40.0])
    found = tones_of(signal, exponents, np.array([2]), 0.1)
    assert [round(tone.frequency, -1) for tone in found] == [980.0, 1960.0, 490.0, 3300.0, 4780.0]
    assert [tone.mode for tone in found] == [2, 2, 2, 3, -1]
    assert [tone.order for tone in found] == [1.0, 2.0, 0.5, 1.0, 1.0]
    assert found[1].level == pytest.approx(20.0 * np.log10(0.5), abs=0.5)
    assert tones_of(signal, exponents, np.array([2]), 0.01)[0].mode == -1


def told(number, frequency, fate, **words):
    first = {"frequency": 0.97 * frequency, "level": 0.0, "mode": frequency, "order": 1.0}
    start = {
        "number": number,
        "frequency": frequency,
        "growth_rate": 10.0,
        "fate": fate,
        "joined": -1,
        "tones": [first],
    }
    return start | {"regime": "squeal", "normal_force_rms": 1.0, "sound_level": 60.0} | words


def a_survey() -> xr.Dataset:
    """Six points by hand: stable, held, living, joining, not reached, failed."""
    layout = laid_out({"friction": [0.1, 0.2, 0.3], "load": [1.0, 2.0]})
    both = [told(4, 1000.0, "lives"), told(7, 3000.0, "joins", joined=4)]
    kinds = [("stable", []), ("held", []), ("unstable", [told(5, 1010.0, "lives")]), ("unstable", both)]
    kinds += [("unstable", [told(4, 990.0, "not reached", tones=[])]), ("not built", [])]
    outcomes = [
        {"ended": kind, "message": "", "values": {"equilibrium": "sliding", "unstable_modes": len(some), "modes": some}}
        for kind, some in kinds
    ]
    outcomes[-1] |= {"message": "no", "values": {}}
    keys = [
        type("Key", (), {"key": key, "coordinate": lambda self, values: (list(values), {"units": "1"})})()
        for key in layout.keys
    ]
    return surveyed(layout, keys, layout.values, outcomes, {"title": "By hand"})


def test_a_mode_that_joins_another_has_its_name():
    found = a_survey()
    assert found.frequency.dims == ("friction", "load", "mode")
    assert found.frequency.sel(mode=0).values.ravel()[2:5].tolist() == [1010.0, 1000.0, 990.0]
    assert float(found.joined.sel(friction=0.2, load=2.0, mode=1)) == 0.0
    assert np.isnan(found.joined.sel(mode=0)).all()
    assert found.living_modes.values.ravel()[:5].tolist() == [0.0, 0.0, 1.0, 1.0, 0.0]
    assert np.isnan(found.living_modes.values[2, 1])
    assert found.tone_frequency.sel(friction=0.2, load=1.0, mode=0, tone=0).item() == pytest.approx(0.97 * 1010.0)


def test_a_table_has_a_row_for_each_mode_and_for_points_without():
    rows = list(csv.DictReader(io.StringIO(survey_table(a_survey()))))
    assert [row["fate"] for row in rows] == ["", "", "lives", "lives", "joins", "not reached", ""]
    assert [row["mode"] for row in rows] == ["", "", "0", "0", "1", "0", ""]
    assert (rows[4]["friction"], rows[4]["load"], rows[4]["frequency"]) == ("0.2", "2.0", "3000.0")
    assert rows[-1]["message"] == "no"
    with pytest.raises(ValueError, match="found must be a survey, got variables"):
        survey_table(a_survey().drop_vars("fate"))


def test_a_map_has_tones_by_colour_and_what_is_quiet_beside_them():
    figure = plot.squeal_map(a_survey())
    figure.canvas.draw()
    axes = figure.axes[0]
    mesh = [one for one in axes.collections if isinstance(one, QuadMesh)][-1]
    shown = np.ma.filled(mesh.get_array(), np.nan).T
    np.testing.assert_allclose(shown, [[np.nan, np.nan], [0.97 * 1010.0, 970.0], [np.nan, np.nan]])
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    quiet = ["stable (1)", "no steady sliding (1)", "unstable, not reached (1)", "failed (1)"]
    assert words == [
        *quiet,
        "n modes live",
        "linear theory: bound of growth",
        "linear theory: bound of steady sliding",
    ]
    assert [text.get_text() for text in axes.texts] == ["1", "1"]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("friction", "load")
    with pytest.raises(ValueError, match="found must be a survey over two parameters of at least 2 values each"):
        plot.squeal_map(a_survey().isel(load=[0]))
    with pytest.raises(ValueError, match="found must be a survey"):
        plot.squeal_map(a_survey().drop_vars("fate"))


def test_the_command_line_prints_the_fate_of_each_mode(stridula, tmp_path):
    words = ("survey", "weak-pressure", "--vary", "friction=0.3,0.9", "-o", "found.nc", "--table", "found.csv")
    code, out, _ = stridula(*words)
    assert code == 0
    found = st.load("found.nc")
    assert f"{float(found.frequency.max()):.4g}" in out
    assert "friction = 0.9" in out
    assert "squeal" in out
    assert "linear theory: stable at 1 point, unstable at 1 point" in out
    assert out.endswith("2 points: 2 done; written to found.nc\n")
    assert len((tmp_path / "found.csv").read_text().splitlines()) == 3
    assert stridula(*words)[1] == out
    assert found.attrs["title"].startswith("Judder at imposed velocity")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-o", "a.nc"], "points must be given by --vary or by --points, got neither"),
        (
            ["--vary", "friction=0.3,0.9", "-o", "a.nc", "--plot", "a.png"],
            "--plot must be used with a grid of two keys",
        ),
        (["--vary", "friction=0.3,0.9", "-o", "a.nc", "--table", "a.nc"], "--table must differ from --out"),
        (["--vary", "friction=0.3,0.9", "-o", "a.nc", "--table", "a.txt"], "--table must end in .csv, got 'a.txt'"),
        (["--vary", "friction=0.3,0.9", "-o", "a.nc", "--velocity", "x"], "--velocity must be a number in m/s"),
        (["--vary", "friction=0.3,0.9", "-o", "a.nc", "--longest", "0"], "longest must be above 0"),
    ],
)
def test_bad_options_are_one_line(stridula, tmp_path, words, message):
    code, _, error = stridula("survey", "weak-pressure", *words)
    assert code == 2
    assert error.startswith("stridula: ")
    assert message in error
    assert error.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_the_command_line_prints_derivatives(stridula, tmp_path):
    words = ("survey", "weak-pressure", "--vary", "friction=0.9,1.2", "--duration", "1 ms", "--no-cycles")
    code, out, _ = stridula(*words, "--by", "friction", "-o", "found.nc", "--table", "found.csv")
    assert code == 0
    found = st.load("found.nc")
    assert "d growth by" in out
    for number in found["mode"].values:
        slopes = found.d_growth_rate.sel(mode=number, parameter="friction").values
        low, high = (format(pick(slopes), ".4g") for pick in (np.nanmin, np.nanmax))
        assert (low if low == high else f"{low} to {high}") in out
    rows = list(csv.DictReader((tmp_path / "found.csv").read_text().splitlines()))
    assert float(rows[0]["d_growth_rate by friction"]) == np.nanmin(found.d_growth_rate.values[0])
    assert stridula(*words, "--by", "none", "-o", "other.nc")[0] == 2
    assert not (tmp_path / "other.nc").exists()
