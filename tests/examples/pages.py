"""Pages of the documentation as readers run them: blocks of code in their order, and commands.

Long runs are shortened by rules common to all pages: `shorter`, `few` and `smaller`.
"""

from __future__ import annotations

import re
import shlex
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
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


def commands(page: Path) -> list[list[str]]:
    """Return the words of each command, without its folder."""
    lines = [line.removeprefix("$ ") for _, text in blocks(page, "console") for line in text.splitlines() if line]
    return [shlex.split(line.removeprefix(".venv/bin/"), comments=True) for line in lines]


def shorter(code: str) -> str:
    """Return code with runs of half a minute or more shortened to a hundredth."""

    def hundredth(found: re.Match[str]) -> str:
        return f"{found[1]}{float(found[2]) / 100.0 if float(found[2]) >= 30.0 else found[2]}"

    return re.sub(r"(\bduration=)([\d.]+)", hundredth, code)


def few(keys: Mapping[str, Sequence[Any]]) -> dict[str, Sequence[Any]]:
    """Return a grid with keys of ten or more values reduced to their two ends."""
    return {key: values if len(values) < 10 else values[:: len(values) - 1] for key, values in keys.items()}


def smaller(words: list[str]) -> list[str]:
    """Return a command that takes less time.

    It varies two values of a key, takes four samples, films few pictures early in a run, and ends a run that is not
    kept after 20 ms.
    """
    varied = [re.sub(r"^([\w.]+=.+:.+:)\d+$", r"\g<1>2", word) for word in words]
    changed = {"--samples": "4"}
    is_film, is_run = (verb in words for verb in ("animate", "run"))
    if is_film:
        changed["--from"] = "1 ms"
    found = [changed.get(before, word) for before, word in zip(["", *varied], varied, strict=False)]
    is_short = is_run and not {"--out", "-o", "--duration"} & set(words)
    return [*found, *["--slowdown", "100"] * is_film, *["--duration", "20 ms"] * is_short]
