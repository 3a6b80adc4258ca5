"""`stridula report`: a page on one system, or on two designs side by side."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from ..checks import ArgumentError
from ..reports.reporting import check_page, report
from .points import numbers_of, ranges_of
from .probability import distributions_of_texts
from .stability import statuses, velocities


def report_scenarios(
    names: Sequence[str],
    out: str,
    overrides: dict[str, Any],
    *,
    vary: str | None,
    change: Sequence[str],
    random: Sequence[str],
    status: str | None,
    velocity: str | None,
    **options: Any,
) -> str:
    """Write a report on one or two scenarios, and return the name of the file.

    Raises
    ------
    ValueError
        If a scenario or an option is invalid; then nothing is written.
    OSError
        If the file cannot be written.
    """
    if len(names) > 2:
        raise ArgumentError("NAME-OR-FILE", "be one or two", got=str(len(names)))
    check_page("--out", out)
    if vary is not None:
        options["key"], options["values"], options["units"] = numbers_of(vary)
    if change:
        options["remedies"] = _remedies(change)
    if random:
        options["uncertain"] = distributions_of_texts(random)
    options |= {"status": statuses(status), "velocity": velocities(velocity), "progress": sys.stderr.isatty()}
    page = report(*names, overrides=overrides, **options)
    page.save(out)
    return out


def _remedies(texts: Sequence[str]) -> dict[str, tuple[float, float]]:
    """Return lowest and highest value of each parameter given by ``KEY=LOW:HIGH``.

    Raises
    ------
    ValueError
        If a text has another form, or a unit.
    """
    try:
        found = {key: (one.low, one.high) for key, one in ranges_of(list(texts)).items()}
    except ArgumentError as error:
        raise error.renamed("--change") from None
    written = next((one for ends in found.values() for one in ends if isinstance(one, str)), None)
    if written is not None:
        raise ArgumentError("--change", "be KEY=LOW:HIGH with numbers in SI", written)
    return {key: (float(low), float(high)) for key, (low, high) in found.items()}
