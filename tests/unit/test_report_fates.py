"""Fates in the table of modes of a report: those of a survey of the same system, or the reason why there are none."""

from __future__ import annotations

import numpy as np
import pytest
from test_system_reports import columns

import stridula as st

BARE = {"run": False, "effects": False, "check": False, "key": "friction", "values": [0.3, 0.9]}
HEAD = "frequency [Hz]"


def test_the_table_of_modes_has_the_fates_of_a_survey():
    """Two modes grow at this friction; each row has what the survey of the point finds for its mode."""
    given = {"friction": 1.2}
    table = columns(st.report("weak-pressure", overrides=given, fates=True, **BARE).html, HEAD)
    survey = st.squeal_survey("weak-pressure", [given], kicks=0).isel(point=0)
    grows = [row for row, rate in enumerate(table["growth rate [1/s]"]) if float(rate) > 0.0]
    assert len(grows) == survey.sizes["mode"] == 2
    for row in grows:
        mode = survey.isel(mode=int(np.abs(survey.frequency.values - float(table[HEAD][row])).argmin()))
        assert table["becomes"][row].split(",")[0] == mode.regime.item()
        assert table["pitch"][row] == f"{float(mode.tone_frequency[0]):.4g} Hz"
        assert table["level"][row] == f"{float(mode.sound_level):.1f} dB(A)"
        if mode.fate.item() == "joins":
            other = survey.sel(mode=int(mode.joined))
            assert f"joins the mode at {float(other.frequency):.4g} Hz" in table["becomes"][row]
        assert ("joins" in table["becomes"][row]) == (mode.fate.item() == "joins")
    for row in set(range(len(table[HEAD]))) - set(grows):
        assert [table[name][row] for name in ("becomes", "pitch", "level")] == ["", "", ""]


def test_without_fates_the_table_has_no_such_columns():
    assert "becomes" not in columns(st.report("weak-pressure", overrides={"friction": 1.2}, **BARE).html, HEAD)
    stable = st.report("weak-pressure", overrides={"friction": 0.3}, fates=True, **BARE).html
    assert "becomes" not in columns(stable, HEAD)


def test_fates_that_cannot_be_found_have_a_reason():
    html = st.report("weak-pressure", overrides={"friction": 1.2}, fates=True, status="sliding", **BARE).html
    assert "Without fates: runs do not take given statuses." in html
    ramped = st.report("pin-on-disc", fates=True, **BARE | {"values": [0.1, 0.152]}).html
    assert "Without fates: drives must press from the start" in ramped
    with pytest.raises(ValueError, match="fates must be a bool"):
        st.report("weak-pressure", fates=1, **BARE)
