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


def effects_title(found: xr.Dataset) -> str:
    """Return the mode that grows fastest and the change of each parameter in words."""
    one = mode_of(found, None)
    kind = str(one["kind"].item())
    words = "" if kind == "alone" else f", {kind}"
    mode = f"mode at {float(one['frequency']):.5g} Hz, growth {float(one['growth_rate']):.5g} 1/s{words}"
    return f"{mode}; {100.0 * found.attrs['change']:g} % more:"


def effect_columns(found: xr.Dataset) -> dict[str, list[str]]:
    """Return the columns of a table of the effects on the mode that grows fastest, by their headings."""
    effects = what_helps(found)
    sizes = zip(effects["value"].values, effects["units"].values, strict=True)
    return {
        "parameter": [str(name) for name in effects["parameter"].values],
        "value": [f"{value:.5g} {'' if units == '1' else units}".rstrip() for value, units in sizes],
        "growth rate [1/s]": [_signed(change) for change in effects["growth_rate_change"].values],
        "frequency [Hz]": [_signed(change) for change in effects["frequency_change"].values],
        "for less growth": [str(word) for word in effects["better"].values],
    }


def _signed(change: float) -> str:
    return f"{change:+.4g}" if np.isfinite(change) else ""
