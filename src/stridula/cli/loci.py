"""`stridula stability --vary`: modes of sliding over a parameter, and the values at which stability changes."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from ..records.files import save as save_file
from ..studies.loci import critical_value, critical_values, parameter_of, root_loci
from .outputs import check_outputs, check_record
from .points import numbers_of
from .stability import KINDS


def print_loci(
    name: str,
    vary: str,
    overrides: dict[str, Any],
    highest: float | None,
    out: str | None,
    plot: str | None,
    **options: Any,
) -> None:
    """Print the parameter values at which stability changes, and optionally draw or write the modes."""
    check_outputs(out, plot)
    check_record(out)
    key, numbers, unit = numbers_of(vary)
    about = {"units": unit, "overrides": overrides, **options}
    loci = root_loci(name, key, numbers, highest=highest, **about)
    critical = critical_values(loci, lambda low, high: critical_value(name, key, low, high, **about))
    for one in critical:
        print(_change(one, key, unit))
    if not critical:
        print(_unchanged(loci))
    if out is not None:
        save_file(loci, out)
    if plot is not None:
        from ..plot import root_loci as draw
        from ..plot import save

        save(draw(loci, critical), plot)


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
