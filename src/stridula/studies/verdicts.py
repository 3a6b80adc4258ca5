"""Agreement of linear theory and runs on a map."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..analysis.regimes import REGIMES
from ..checks import ArgumentError, instance, listed

UNSTABLE = "unstable"
VERDICTS = (UNSTABLE, "sliding", "held", "lifted off", "jammed")
# Regimes that agree with each verdict; the other verdicts predict nothing.
VIBRATING = ("stick-slip", "squeal", "judder")
EXPECTED = {UNSTABLE: VIBRATING, "sliding": ("stable sliding",), "held": ("sticking",)}
# A run that leaves its track ends early.
UNDECIDED = "off the track"


def agreement(found: xr.Dataset) -> xr.Dataset:
    """Return the number of runs in each regime by verdict of linear theory.

    They agree if a mode grows and the run vibrates (stick-slip, squeal or judder), if all modes of steady sliding
    decay and the run slides, and if friction holds the contact and the run sticks. Runs off the track, failed runs,
    and points that are jammed or lifted off by linear theory are not counted.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `sweep` with the measure ``regime``.

    Returns
    -------
    xarray.Dataset
        ``runs`` over ``verdict`` and ``regime``; ``agree`` and ``compared``, numbers of runs, and the numbers of runs
        ``missed`` (vibration without growth by linear theory) and of ``false_alarms`` (growth without vibration).

    Raises
    ------
    ValueError
        If the sweep has no regimes or no linear analysis.
    """
    instance("found", found, xr.Dataset)
    for name in ("regime", "unstable_modes", "equilibrium"):
        if name not in found:
            raise ArgumentError(
                "found", f"have {name}, which the measure regime gives", found, got=listed(map(str, found.data_vars))
            )
    regime = found["regime"].values.ravel()
    grows = np.nan_to_num(found["unstable_modes"].values.ravel()) > 0
    verdict = np.where(grows, UNSTABLE, found["equilibrium"].values.ravel())
    runs = np.array([[np.count_nonzero((verdict == v) & (regime == r)) for r in REGIMES] for v in VERDICTS])
    table = xr.DataArray(runs, {"verdict": list(VERDICTS), "regime": list(REGIMES)}, ("verdict", "regime"))
    compared = table.sel(verdict=list(EXPECTED)).drop_sel(regime=UNDECIDED)
    right = sum(int(table.sel(verdict=v, regime=list(words)).sum()) for v, words in EXPECTED.items())
    return xr.Dataset(
        {
            "runs": table,
            "agree": ((), right),
            "compared": ((), int(compared.sum())),
            "missed": ((), int(compared.drop_sel(verdict=UNSTABLE).sel(regime=list(VIBRATING)).sum())),
            "false_alarms": ((), int(compared.sel(verdict=UNSTABLE).drop_sel(regime=list(VIBRATING)).sum())),
        }
    )
