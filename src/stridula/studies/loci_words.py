"""Changes of stability along root loci in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..analysis.stability_words import KINDS
from .loci import parameter_of


def lines_of_changes(loci: xr.Dataset, critical: Sequence[xr.Dataset], unit: str = "") -> list[str]:
    """Return a line for each value at which stability changes, or one about a range without a change.

    Parameters
    ----------
    loci : xarray.Dataset
        Result of `root_loci`.
    critical : sequence of xarray.Dataset
        Results of `critical_value`.
    unit : str, optional
        Unit of the parameter.
    """
    return [_change(one, parameter_of(loci), unit) for one in critical] or [_unchanged(loci)]


def _change(one: xr.Dataset, key: str, unit: str) -> str:
    """Return a line with the critical value and the state beyond it."""
    width, beyond = abs(float(one["unstable"]) - float(one["stable"])), str(one.attrs["beyond"])
    place = f"{key} = {float(one['value']):.7g} {unit}".rstrip() + f" (within {width:.1g}) on"
    if float(one["unstable"]) > float(one["stable"]):
        before = "" if beyond == "stable" else f"; {beyond} before"
        return f"unstable from {place}, at {float(one['frequency']):.5g} Hz{before}"
    # A system that is jammed or held has no frequency.
    return f"{beyond} from {place}" + (f", at {float(one['frequency']):.5g} Hz" if beyond == "stable" else "")


def _unchanged(loci: xr.Dataset) -> str:
    """Return a line about a parameter range without a change of stability."""
    key, kinds = parameter_of(loci), loci["equilibrium"].values
    if bool((loci["unstable_modes"] > 0).all()):
        return f"unstable at all {kinds.size} values of {key}"
    words = [f"{KINDS[kind].partition(':')[0]} at {np.count_nonzero(kinds == kind)}" for kind in dict.fromkeys(kinds)]
    return f"no mode grows at any of the {kinds.size} values of {key}: {', '.join(words)}"
