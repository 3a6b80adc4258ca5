"""The page of a report from its sections."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from importlib.resources import files
from typing import Any

import jinja2

from ..version import __version__
from .blocks import Facts, Section

PACKAGES = ("numpy", "scipy", "numba", "xarray", "matplotlib")


def page_of(titles: Sequence[str], designs: Sequence[Sequence[Section]]) -> str:
    """Return the page of one design or of two side by side, as HTML.

    Parameters
    ----------
    titles : sequence of str
        Title of each design.
    designs : sequence of sequence of Section
        Sections of each, the same ones in the same order.
    """
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    template = environment.from_string(files(__package__).joinpath("page.html").read_text(encoding="utf-8"))
    answers = [{name: words for one in sections for name, words in one.answers.items()} for sections in designs]
    now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    versions = {"stridula": __version__, "Python": platform.python_version()} | {one: version(one) for one in PACKAGES}
    return template.render(
        titles=titles,
        made=f"Report of stridula {__version__}, {now}",
        answers=_side_by_side(answers),
        rows=[_row(sections) for sections in zip(*designs, strict=True)],
        versions=_side_by_side([versions]),
    )


def _row(sections: Sequence[Section]) -> dict[str, Any]:
    """Return a section of all designs: facts in one table, other parts side by side."""
    facts = [_facts(one) for one in sections]
    others = [[block for block in one.blocks if block.kind != "facts"] for one in sections]
    lines: list[dict[str, Any]] = []
    if any(facts):
        lines.append({"facts": _side_by_side(facts), "blocks": None})
    if any(others):
        lines.append({"facts": None, "blocks": others})
    return {"title": sections[0].title, "lines": lines}


def _facts(section: Section) -> dict[str, str]:
    found: list[Facts] = [block for block in section.blocks if block.kind == "facts"]
    return {name: words for block in found for name, words in block.facts.items()}


def _side_by_side(columns: Sequence[Mapping[str, str]]) -> list[tuple[str, list[str], bool]]:
    """Return for each name of facts, in order, the words of each design, and whether these differ."""
    names = dict.fromkeys(name for column in columns for name in column)
    rows = [(name, [column.get(name, "") for column in columns]) for name in names]
    return [(name, words, len(set(words)) > 1) for name, words in rows]
