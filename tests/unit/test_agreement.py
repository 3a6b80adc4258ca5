"""Agreement of linear theory and runs: counts on a sweep made by hand."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import stridula as st

# Regime, modes that grow, equilibrium.
RUNS = [
    ("squeal", 2.0, "sliding"),
    ("judder", 1.0, "sliding"),
    ("stable sliding", 1.0, "sliding"),
    ("stable sliding", 0.0, "sliding"),
    ("squeal", 0.0, "sliding"),
    ("sticking", 0.0, "held"),
    ("stick-slip", 0.0, "held"),
    ("stable sliding", 0.0, "held"),
    ("off the track", 3.0, "sliding"),
    ("squeal", np.nan, "jammed"),
    ("judder", 0.0, "lifted off"),
    ("", np.nan, ""),
]


def swept(runs=RUNS):
    regime, modes, kind = (np.array(column, dtype=object) for column in zip(*runs, strict=True))
    shape = (3, len(runs) // 3)
    both = ("a", "b")
    return xr.Dataset(
        {
            "regime": (both, regime.reshape(shape)),
            "unstable_modes": (both, modes.astype(float).reshape(shape)),
            "equilibrium": (both, kind.reshape(shape)),
        }
    )


def test_runs_are_counted_under_each_verdict():
    counts = st.agreement(swept())
    runs = counts["runs"]
    assert int(runs.sum()) == 11, "the one that failed is left out"
    assert runs.sel(verdict="unstable").to_series().loc[lambda row: row > 0].to_dict() == {
        "squeal": 1,
        "judder": 1,
        "stable sliding": 1,
        "off the track": 1,
    }
    assert int(runs.sel(verdict="held", regime="stick-slip")) == 1
    assert int(runs.sel(verdict="jammed", regime="squeal")) == 1
    assert {name: int(counts[name]) for name in ("agree", "compared", "missed", "false_alarms")} == {
        # Squeal and judder that grow, a stable one, one that is held.
        "agree": 4,
        # All but off the track, jammed, lifted off and failed.
        "compared": 8,
        "missed": 2,
        "false_alarms": 1,
    }


def test_without_runs_to_compare_all_counts_are_zero():
    counts = st.agreement(swept([("", np.nan, "")] * 3))
    assert int(counts["runs"].sum()) == int(counts["compared"]) == int(counts["agree"]) == 0


@pytest.mark.parametrize("name", ["regime", "unstable_modes", "equilibrium"])
def test_a_sweep_without_regimes_or_linear_theory_is_refused(name):
    with pytest.raises(ValueError, match=f"found must have {name}, which the measure regime gives, got "):
        st.agreement(swept().drop_vars(name))
    with pytest.raises(ValueError, match="found must be a Dataset, got 3"):
        st.agreement(3)
