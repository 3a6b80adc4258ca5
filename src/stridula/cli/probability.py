"""`stridula stability --random`: probability that modes of sliding grow, for uncertain parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import scipy.stats
import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..checks import ArgumentError, counted
from ..records.files import save as save_file
from ..scenarios.quantities import parts
from ..scenarios.read import read_tables
from ..studies.growth_probability import mode_probability
from .consoles import wide_console
from .outputs import check_outputs, check_record
from .points import ranges_of
from .sweeping import points_done

NORMAL = "normal"
FORMS = "be KEY=LOW:HIGH, KEY=LOW:HIGH:log or KEY=normal:MEAN:DEVIATION with numbers in SI"


def print_probability(
    name: str,
    random: Sequence[str],
    correlation: Sequence[str],
    overrides: dict[str, Any],
    out: str | None,
    plot: str | None,
    **options: Any,
) -> None:
    """Print the probability of growth in each band of frequency, and optionally draw or write it."""
    check_outputs(out, plot)
    check_record(out)
    uncertain, pairs = distributions_of_texts(random), correlations_of(correlation)
    title = str(read_tables(name).get("title", name))
    with points_done(title) as watch:
        found = mode_probability(name, uncertain, correlations=pairs, overrides=overrides, watchers=[watch], **options)
    console = wide_console()
    console.print(_table(found, title))
    for line in _closing(found):
        console.print(escape(line), highlight=False)
    if out is not None:
        save_file(found, out)
    if plot is not None:
        from ..plot import mode_probability as draw
        from ..plot import save

        save(draw(found), plot)


def distributions_of_texts(texts: Sequence[str]) -> dict[str, Any]:
    """Return the distributions given by ``KEY=LOW:HIGH``, ``KEY=LOW:HIGH:log`` or ``KEY=normal:MEAN:DEVIATION``.

    Raises
    ------
    ValueError
        If a text has another form, or a key appears twice.
    """
    found: dict[str, Any] = {}
    for text in texts:
        key, _, values = (part.strip() for part in text.partition("="))
        pieces = [piece.strip() for piece in values.split(":")]
        try:
            one = _normal(text, pieces) if pieces[0] == NORMAL else ranges_of([text])[key]
        except ArgumentError as error:
            raise error.renamed("--random") from None
        if key in found:
            raise ArgumentError("--random", "name each key once", key, got=f"{key!r} twice")
        found[key] = one
    return found


def _normal(text: str, pieces: Sequence[str]) -> Any:
    known = [parts(piece) for piece in pieces[1:]]
    numbers = [one[0] for one in known if one is not None and not one[1]]
    if len(pieces) != 3 or len(numbers) != 2 or not numbers[1] > 0.0:
        raise ArgumentError("--random", FORMS, text)
    return scipy.stats.norm(*numbers)


def correlations_of(texts: Sequence[str]) -> dict[tuple[str, str], float]:
    """Return the correlations given by ``KEY,KEY=NUMBER``.

    Raises
    ------
    ValueError
        If a text has another form.
    """
    found: dict[tuple[str, str], float] = {}
    for text in texts:
        keys, _, number = text.rpartition("=")
        pair, known = [key.strip() for key in keys.split(",")], parts(number.strip())
        if len(pair) != 2 or known is None or known[1]:
            raise ArgumentError("--correlation", "be KEY,KEY=NUMBER", text)
        found[pair[0], pair[1]] = known[0]
    return found


def _table(found: xr.Dataset, title: str) -> Table:
    table = Table(title=escape(title), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    level = f"{100.0 * found.attrs['confidence']:g} % interval"
    for head in ("growing modes [Hz]", "from", "to", "probability", level, "median growth [1/s]"):
        table.add_column(head, justify="right", overflow="fold")
    for number in range(found.sizes["band"]):
        one = found.isel(band=number)
        low, high = one["probability_interval"].values
        seen = [float(one["frequency"]), *one["frequency_range"].values.tolist()]
        cells = [f"{value:.5g}" if value == value else "" for value in seen]
        growth = float(one["band_growth_rate"].median())
        cells += [f"{float(one['probability']):.3f}", f"{low:.3f} to {high:.3f}"]
        table.add_row(*cells, f"{growth:.4g}" if growth == growth else "")
    return table


def _closing(found: xr.Dataset) -> list[str]:
    low, high = found["any_probability_interval"].values
    lines = [f"Any mode grows: {float(found['any_probability']):.3f}, {low:.3f} to {high:.3f}."]
    kinds = [(str(one), float(found["kind_probability"].sel(kind=one))) for one in found["kind"].values]
    lines.append("Verdicts: " + ", ".join(f"{word} {share:.3f}" for word, share in kinds if share) + ".")
    if count := int(found["beyond_cutoff"].sum()):
        lines.append(f"{counted(count, 'band')} above the cutoff of every body, without the modes left out.")
    if found.attrs["notes"]:
        lines.append(f"Note: {found.attrs['notes']}.")
    samples, failed = int(found["samples"]), int(found["failed"])
    if failed:
        lines.append(found.attrs["failure"])
    return [*lines, f"{samples} points: {samples - failed} done, {failed} failed"]
