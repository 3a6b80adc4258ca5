"""Pages of the documentation as readers run them: blocks of code in their order, and commands.

Long runs are shortened by rules common to all pages: `shorter`, `few` and `smaller`.
"""

from __future__ import annotations

import itertools
import re
import shlex
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.rst"), *(ROOT / "docs").glob("*.md")])
BLOCK = {
    ".md": r"^```(?P<language>\w+)\n(?P<text>(?:(?!```).*\n)+)",
    ".rst": r"^\.\. (?:code-block:: (?P<language>\w+)\n\n(?P<text>(?: {3}.*\n|\n)+)"
    r"|literalinclude:: (?P<file>\S+\.py)$)",
}


def blocks(page: Path, *languages: str) -> list[tuple[str, str]]:
    """Return language and text of each block in some languages, including Python files shown whole."""
    found = []
    for block in re.finditer(BLOCK[page.suffix], page.read_text(encoding="utf-8"), re.MULTILINE):
        words = block.groupdict()
        if words.get("file"):
            found.append(("python", (page.parent / words["file"]).read_text(encoding="utf-8")))
        else:
            found.append((words["language"], textwrap.dedent(words["text"])))
    return [(language, text) for language, text in found if language in languages]


def without_examples(found: list[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return blocks without examples and their output, unless later code continues them.

    Code that imports the package does not. `test_examples` runs all examples and compares their output.
    """
    examples = {path.read_text(encoding="utf-8") for path in EXAMPLES}
    kept, left_out = [], False
    for number, (language, text) in enumerate(found):
        if language == "python":
            later = [code for other, code in found[number + 1 :] if other == "python"]
            left_out = text in examples and all(code.startswith("import stridula as st\n") for code in later)
        if not left_out:
            kept.append((language, text))
    return kept


def output_shown(example: Path) -> list[str]:
    """Return the text after an example on each page that shows it whole."""
    code = ("python", example.read_text(encoding="utf-8"))
    found = [blocks(page, "python", "text") for page in PAGES]
    pairs = [pair for page in found for pair in itertools.pairwise(page)]
    return [text for first, (language, text) in pairs if first == code and language == "text"]


def commands(page: Path) -> list[list[str]]:
    """Return the words of each command, without its folder."""
    lines = [line.removeprefix("$ ") for _, text in blocks(page, "console") for line in text.splitlines() if line]
    return [shlex.split(line.removeprefix(".venv/bin/"), comments=True) for line in lines]


def shorter(code: str) -> str:
    """Return code with shorter runs.

    Runs of half a minute or more are shortened to a hundredth, those with spans to show to a tenth, with the spans.
    """

    def hundredth(found: re.Match[str]) -> str:
        return f"{found[1]}{float(found[2]) / 100.0 if float(found[2]) >= 30.0 else found[2]}"

    def tenth(found: re.Match[str]) -> str:
        return re.sub(r"[\d.]+", lambda number: f"{float(number[0]) / 10.0:g}", found[0])

    if "span=(" in code:
        code = re.sub(r"\bduration=[\d.]+|\bspan=\([\d., ]+\)", tenth, code)
    return re.sub(r"(\bduration=)([\d.]+)", hundredth, code)


def few(keys: Mapping[str, Sequence[Any]]) -> dict[str, Sequence[Any]]:
    """Return a grid with keys of ten or more values reduced to their two ends."""
    return {key: values if len(values) < 10 else values[:: len(values) - 1] for key, values in keys.items()}


def smaller(words: list[str]) -> list[str]:
    """Return a command that takes less time.

    It varies two values of a key, in a survey without a map one; takes four samples; films few pictures early in a
    run; and ends a run after 20 ms, after 200 ms if it is kept.
    """
    is_film, is_run, is_kept = "animate" in words, "run" in words, bool({"--out", "-o"} & set(words))
    values = 1 if "survey" in words and "--plot" not in words else 2
    varied = [re.sub(r"^([\w.]+=.+:.+:)\d+$", rf"\g<1>{values}", word) for word in words]
    changed = {"--samples": "4"}
    if is_film:
        changed["--from"] = "1 ms"
    if is_run:
        changed["--duration"] = "200 ms" if is_kept else "20 ms"
    found = [changed.get(before, word) for before, word in zip(["", *varied], varied, strict=False)]
    if is_run and "--duration" not in words:
        found += ["--duration", changed["--duration"]]
    return [*found, *["--slowdown", "80"] * is_film]
