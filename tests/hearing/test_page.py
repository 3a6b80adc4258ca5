"""The page on hearing: its code runs and prints what it says."""

from __future__ import annotations

import re
import textwrap
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "docs" / "hearing.rst"


def test_the_page_runs_and_prints_what_it_says(monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    page = PAGE.read_text(encoding="utf-8")
    code, (said,) = (
        [textwrap.dedent(block) for block in re.findall(rf"code-block:: {kind}\n\n((?: {{3}}.*\n|\n)+)", page)]
        for kind in ("python", "text")
    )
    names: dict = {}
    exec(code[0], names)
    assert capsys.readouterr().out.strip() == said.strip()
    for block in code[1:]:
        exec(block, names)
    written = {"ears.wav", "spectrogram.png", "spectrum.png", "squeal.gif"}
    assert {path.name for path in tmp_path.iterdir()} == written
