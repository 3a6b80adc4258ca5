"""All code and commands in the documentation, page by page, each in an empty folder."""

from __future__ import annotations

import itertools
import re
import tomllib
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pytest

import stridula as st

from .checks import CHECKS, GIVEN, SCENARIOS, WRITTEN, pad
from .pages import PAGES, ROOT, blocks, commands, few, shorter, smaller, without_examples


@pytest.fixture
def page(request, tmp_path, monkeypatch):
    """A page, in a folder with only the files that it assumes."""
    monkeypatch.chdir(tmp_path)
    GIVEN.get(request.param.name, lambda: None)()
    return request.param


def of_pages(language: str) -> pytest.MarkDecorator:
    """Run a test for each page with blocks in a language."""
    pages = [page for page in PAGES if blocks(page, language)]
    return pytest.mark.parametrize("page", pages, indirect=True, ids=[page.name for page in pages])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_no_code_is_missed(page):
    written = re.findall(
        r"code-block:: python|literalinclude:: \S+\.py\b|^```python", page.read_text("utf-8"), re.MULTILINE
    )
    assert len(blocks(page, "python")) == len(written)


def test_shortening_rules_leave_the_rest():
    assert shorter("f(duration=60.0, step=60.0, duration=20.0)") == "f(duration=0.6, step=60.0, duration=20.0)"
    assert shorter("f(duration=0.2); g(span=(0.1, 0.2))") == "f(duration=0.02); g(span=(0.01, 0.02))"
    assert few({"a": [*range(12)], "b": ["x", "y", "z"]}) == {"a": [0, 11], "b": ["x", "y", "z"]}
    words = ["sweep", "--vary", "a=1deg:2deg:40", "--vary", "b=1:2:log", "--samples", "64", "--duration", "40"]
    assert smaller(words) == ["sweep", "--vary", "a=1deg:2deg:2", *words[3:6], "4", *words[7:]]
    film = ["animate", "case", "--from", "1 s", "--out", "a.gif"]
    assert smaller(film) == ["animate", "case", "--from", "1 ms", "--out", "a.gif", "--slowdown", "80"]
    assert smaller(["run", "case", "--plot", "a.png"])[4:] == ["--duration", "20 ms"]
    assert smaller(["run", "case", "--out", "a.nc"])[4:] == ["--duration", "200 ms"]
    assert smaller(["run", "case", "--duration", "2", "-o", "a.nc"]) == [
        "run",
        "case",
        "--duration",
        "200 ms",
        "-o",
        "a.nc",
    ]
    survey = ["survey", "case", "--vary", "a=1:2:40", "-o", "a.nc"]
    assert smaller(survey)[3] == "a=1:2:1"
    assert smaller([*survey, "--plot", "a.png"])[3] == "a=1:2:2"


def test_values_that_the_rules_replace_are_good():
    replaced = {"--duration": [], "--slowdown": []}
    for words in (words for page in PAGES for words in commands(page) if {"run", "animate"} & set(words)):
        for name, values in replaced.items():
            values += [value for before, value in itertools.pairwise(words) if before == name]
    assert all(replaced.values())
    for value in replaced["--duration"]:
        assert st.load_scenario("squeal", {"simulation.duration": value}).duration > 0.0
    assert all(float(value) > 0.0 for value in replaced["--slowdown"])


def test_examples_that_code_continues_are_kept():
    example = ("python", (ROOT / "examples" / "ten_lines.py").read_text(encoding="utf-8"))
    output, more, other = ("text", "1\n"), ("python", "print(run)\n"), ("python", "import stridula as st\n")
    assert without_examples([example, output, more]) == [example, output, more]
    assert without_examples([example, output, other, more]) == [example, output, other, more]
    assert without_examples([example, output, other, output]) == [other, output]
    assert without_examples([other, output, example, output]) == [other, output]


@of_pages("python")
def test_code(page, tmp_path, monkeypatch, capsys):
    """Text after code is its output."""
    grid = st.Grid
    monkeypatch.setattr(st, "Grid", lambda keys: grid(few(keys)))
    names: dict[str, Any] = {}
    printed = [""]
    for language, text in without_examples(blocks(page, "python", "text")):
        if language == "text":
            assert printed[-1].strip() == text.strip()
        else:
            exec(compile(shorter(text), page.name, "exec"), names)
            printed.append(capsys.readouterr().out)
    plt.close("all")
    if page.name in CHECKS:
        CHECKS[page.name](names, "".join(printed))
    if page.name in WRITTEN:
        assert {path.name for path in tmp_path.iterdir()} == WRITTEN[page.name]


@of_pages("console")
def test_commands(page, stridula, monkeypatch):
    """Each succeeds, including a comparison of two different records. `stridula app` is not waited for."""
    monkeypatch.setattr("stridula.app.serve.serve", lambda *words: None)
    targets = (ROOT / "Makefile").read_text(encoding="utf-8")
    for words in commands(page):
        program, *arguments = smaller(words)
        if program == "make":
            assert f"\n{arguments[0]}:" in targets
            continue
        assert program == "stridula"
        *arguments, to, file = arguments if ">" in arguments else (*arguments, "", "")
        code, out, error = stridula(*arguments)
        assert code == 0 or (code, arguments[0]) == (1, "compare"), (words, error)
        if to:
            Path(file).write_text(out, encoding="utf-8")


def test_the_run_that_the_readme_shows_squeals(stridula):
    shown = [words for words in commands(ROOT / "README.md") if words[1] in ("show", "run") and "mine.toml" in words]
    assert [words[1] for words in shown] == ["show", "run"]
    for _, *arguments in shown:
        assert stridula(*arguments)[0] == 0
    assert st.regime(st.load("mine.nc")).regime == "squeal"


def test_whole_scenarios_of_a_page_are_good_and_parts_are_toml(tmp_path):
    pages = (SCENARIOS, SCENARIOS.with_name("scenarios-space.rst"))
    texts = [text for page in pages for _, text in blocks(page, "toml")]
    assert all(tomllib.loads(text) for text in texts)
    whole = [text for text in texts if text.startswith("title")]
    assert len(whole) == 2
    pad(tmp_path / "pad.npz", "leading", "back")
    for text in whole:
        file = tmp_path / "scenario.toml"
        file.write_text(text, encoding="utf-8")
        assert st.load_scenario(file).system.contacts
