"""The documentation: titles of the groups of names, formulas without a network, and no misunderstood phrases."""

from __future__ import annotations

import ast
import inspect
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

import stridula

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = [path for folder in (".", "tutorials") for path in sorted((ROOT / "examples" / folder).glob("*.py"))]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.rst")), *SCRIPTS]
HELP = ROOT / "src" / "stridula" / "cli" / "commands.py"
# Setting with the codes of numpydoc that the pages must not have.
CHECKS = "numpydoc_validation_checks"
# Phrases that readers did not understand, and their replacements.
RIDDLES = {
    r"\b(gone|goes|go) on from\b": "continue",
    r"\bwhat came of\b": "the result",
    r"\bagain and again\b": "several times",
    r"\bsays? what\b.*\bsays?\b": "name the thing",
    r"\bhangs on\b": "depends on",
    r"\bfor himself\b": "separately",
    r"\btakes? along\b": "save",
    r"\bfaster than sound\b": "faster than real time",
    r"^What (vibrates|pushes|it feels like|sound feels like|is heard)$": "a noun",
}


def settings() -> dict[str, Any]:
    """Return the constants of the settings of the documentation, without Sphinx."""
    found = {}
    for node in ast.parse((ROOT / "docs" / "conf.py").read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            try:
                found[node.targets[0].id] = ast.literal_eval(node.value)
            except ValueError:
                continue
    return found


def test_every_group_of_names_has_a_title():
    assert set(settings()["HOMES"]) == set(stridula._HOME)


def test_formulas_need_no_network():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    assert "sphinx-mathjax-offline" in settings()["extensions"]
    assert any(name.startswith("sphinx-mathjax-offline") for name in extras["docs"])


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.name)
def test_scripts_have_a_title_for_the_gallery_and_say_what_they_are(script):
    title, line, *words = ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))).splitlines()
    assert line == "=" * len(title)
    assert len(" ".join(words).split()) > 8


def test_the_gallery_has_all_scripts_and_stops_where_one_fails():
    words = (ROOT / "docs" / "conf.py").read_text(encoding="utf-8")
    assert r'"filename_pattern": r"\.py$"' in words
    assert '"abort_on_example_error": True' in words
    assert {script.parent.name for script in SCRIPTS} == {"examples", "tutorials"}


@pytest.mark.parametrize("page", [*PAGES, HELP], ids=lambda page: page.name)
def test_pages_and_help_texts_use_plain_phrases(page):
    text = page.read_text(encoding="utf-8")
    found = {riddle: plain for riddle, plain in RIDDLES.items() if re.search(riddle, text, re.MULTILINE)}
    assert not found


@pytest.mark.parametrize("sentence", ["it goes on from there", "Says what linear theory says", "What pushes"])
def test_the_rule_can_fail(sentence):
    assert any(re.search(riddle, sentence, re.MULTILINE | re.IGNORECASE) for riddle in RIDDLES)


def faults_of_layout(text: str) -> list[str]:
    """Return the complaints of docutils about the layout of a numpydoc docstring."""
    pytest.importorskip("docutils", reason="the extra docs is not installed")
    pytest.importorskip("numpydoc", reason="the extra docs is not installed")
    from docutils.core import publish_doctree
    from numpydoc.docscrape import NumpyDocString

    quiet = {"report_level": 5, "halt_level": 5}
    sections = NumpyDocString(text)
    items = [
        item for section in ("Parameters", "Attributes", "Returns", "Raises", "Yields") for item in sections[section]
    ]
    written = ["\n".join(sections["Extended Summary"]), *("\n".join(item.desc) for item in items)]
    trees = [publish_doctree(part, settings_overrides=quiet) for part in written]
    messages = [message.astext() for tree in trees for message in tree.parse_messages]
    return [message for message in messages if "ndent" in message]


def test_docstrings_are_laid_out_as_sphinx_reads_them():
    faults = {name: faults_of_layout(inspect.getdoc(getattr(stridula, name)) or "") for name in stridula.__all__}
    assert {name: found for name, found in faults.items() if found} == {}


def faults_of_sections(name: str) -> list[str]:
    """Return the complaints of numpydoc, of the kinds that the settings choose, about a public name."""
    validate = pytest.importorskip("numpydoc.validate", reason="the extra docs is not installed").validate
    return [f"{code} {words}" for code, words in validate(name)["errors"] if code in settings()[CHECKS]]


def test_docstrings_have_the_sections_that_sphinx_checks():
    names = [f"stridula.{name}" for name in stridula.__all__ if callable(getattr(stridula, name))]
    parts = ((part, inspect.getmodule(part)) for part in (stridula.analysis, stridula.plot))
    names += [f"{module.__name__}.{name}" for part, module in parts for name in part.__all__]
    faults = {name: faults_of_sections(name) for name in names}
    assert {name: found for name, found in faults.items() if found} == {}


def test_a_parameter_without_a_type_is_seen(monkeypatch):
    """Negative control."""
    monkeypatch.setattr(stridula.sweep, "__doc__", "Do it.\n\nParameters\n----------\nscenario\n    One.\n")
    assert any(found.startswith("PR04") for found in faults_of_sections("stridula.sweep"))


def test_a_line_that_is_indented_too_far_is_seen():
    """Negative control."""
    text = "Do it.\n\nRaises\n------\nValueError\n    If this or\n        that. The\n    rest."
    assert faults_of_layout(text)
