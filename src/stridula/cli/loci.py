"""`stridula stability --vary`: modes of sliding over a parameter, and the values at which stability changes."""

from __future__ import annotations

from typing import Any

from ..records.files import save as save_file
from ..studies.loci import critical_value, critical_values, root_loci
from ..studies.loci_words import lines_of_changes
from .outputs import check_outputs, check_record
from .points import numbers_of


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
    for line in lines_of_changes(loci, critical, unit):
        print(line)
    if out is not None:
        save_file(loci, out)
    if plot is not None:
        from ..plot import root_loci as draw
        from ..plot import save

        save(draw(loci, critical), plot)
