"""`stridula stability --random`: probability that modes of sliding grow, for uncertain parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import scipy.stats
import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..checks import ArgumentError
from ..records.files import save as save_file
from ..scenarios.quantities import parts
from ..scenarios.read import read_tables
from ..studies.growth_probability import mode_probability
from ..studies.probability_words import probability_columns, probability_lines
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
    for line in probability_lines(found):
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
    columns = probability_columns(found)
    for head in columns:
        table.add_column(head, justify="right", overflow="fold")
    for cells in zip(*columns.values(), strict=True):
        table.add_row(*cells)
    return table
