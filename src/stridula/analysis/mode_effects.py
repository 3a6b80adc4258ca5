"""Effects of parameters on a mode of sliding, in the order of their size."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..checks import ArgumentError, instance, listed

EFFECTS = ("d_growth_rate", "d_frequency", "growth_rate_change", "frequency_change")
NEITHER = "neither"


def what_helps(found: xr.Dataset, mode: int | None = None) -> xr.Dataset:
    """Return the derivatives of a mode, that which changes its growth most first.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `mode_sensitivity`.
    mode : int, optional
        Number of the mode; that which grows fastest if left out.

    Returns
    -------
    xarray.Dataset
        Over ``parameter`` its derivatives, changes, values and units, and ``better``: whether to ``raise`` the
        parameter for less growth, to ``lower`` it, towards 0, or ``neither``, where its effect is round-off.
        ``to_dataframe()`` makes it a table.

    Raises
    ------
    ValueError
        If `found` is anything else, or has no such mode.
    """
    one = mode_of(found, mode)
    size = np.abs(one["growth_rate_change"].values)
    order = np.argsort(-np.nan_to_num(size, nan=-np.inf), kind="stable")
    table = one[list(EFFECTS)].isel(parameter=order)
    by_size = table["d_growth_rate"].values * np.nan_to_num(table["value"].values, nan=np.inf)
    slight = np.abs(by_size) <= found.attrs["round_off"]
    better = np.where(slight, NEITHER, np.where(by_size > 0.0, "lower", "raise"))
    return table.assign(better=("parameter", better))


def mode_of(found: xr.Dataset, mode: int | None) -> xr.Dataset:
    """Return the derivatives of one mode, of that which grows fastest if none is named.

    Raises
    ------
    ValueError
        If they are not those of `mode_sensitivity`, or there is no such mode.
    """
    instance("found", found, xr.Dataset)
    if any(name not in found for name in EFFECTS):
        raise ArgumentError("found", "be the result of mode_sensitivity", found, got=listed(map(str, found.data_vars)))
    if mode is None:
        return found.isel(mode=int(found["growth_rate"].values.argmax()))
    if mode not in found["mode"].values:
        raise ArgumentError("mode", f"be one of {listed(map(str, found['mode'].values))}", mode)
    return found.sel(mode=mode)
