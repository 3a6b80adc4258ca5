"""`stridula stability --vary`: modes of sliding over a parameter, and where stability changes."""

from __future__ import annotations

from typing import Any

from ..records.files import save as save_file
from ..scenarios.quantities import parts
from ..studies.loci import critical_value, critical_values, root_loci
from .points import grid_of
from .running import check_outputs


def print_loci(
    name: str,
    vary: str,
    overrides: dict[str, Any],
    highest: float | None,
    out: str | None,
    plot: str | None,
    **options: Any,
) -> None:
    """Print where stability changes over a parameter, and draw or write the modes over it if asked to."""
    check_outputs(out, plot)
    ((key, values),) = grid_of([vary], yes=False).values.items()
    known = [parts(value) for value in values]
    numbers, units = [found[0] for found in known if found], {found[1] for found in known if found}
    if None in known or len(units) != 1 or len(numbers) < 2:
        raise ValueError(f"--vary must give at least 2 numbers of one unit here, got {vary!r}")
    unit = units.pop()
    about = {"units": unit, "overrides": overrides, **options}
    loci = root_loci(name, key, numbers, highest=highest, **about)
    critical = critical_values(loci, lambda low, high: critical_value(name, key, low, high, **about))
    for one in critical:
        value, width = float(one["value"]), abs(float(one["unstable"]) - float(one["stable"]))
        rises = float(one["unstable"]) > float(one["stable"])
        print(
            f"{'unstable' if rises else one.attrs['beyond']} from {key} = {value:.7g} {unit}".rstrip()
            + f" (within {width:.1g}) on, at {float(one['frequency']):.5g} Hz"
        )
    if not critical:
        grows = bool(loci["unstable"].any())
        print(f"{'unstable' if grows else 'stable'} at all {len(numbers)} values of {key}")
    if out is not None:
        save_file(loci, out)
    if plot is not None:
        from ..plot import root_loci as draw
        from ..plot import save

        save(draw(loci, critical), plot)
