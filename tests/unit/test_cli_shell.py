"""The command line between other programs: scenarios from a pipe, and shell completion."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

import stridula as st
from stridula.scenarios import read

PROGRAM = "import sys; sys.argv[0] = 'stridula'; from stridula.cli import main; main()"


@pytest.fixture
def piped(monkeypatch):
    """Set standard input."""

    def put(content: bytes) -> None:
        monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=io.BytesIO(content)))
        read._standard_input.cache_clear()

    yield put
    read._standard_input.cache_clear()


def test_run_accepts_the_output_of_show(stridula, piped):
    piped(stridula("show", "belt")[1].encode())
    code, out, _ = stridula("run", "-", "--duration", "0.5", "--out", "piped.nc")
    assert (code, out.splitlines()[0].strip()) == (0, "Stick-slip on a belt")
    stridula("run", "belt", "--duration", "0.5", "--out", "named.nc")
    assert np.array_equal(st.load("piped.nc").tangential_force, st.load("named.nc").tangential_force)


def test_commands_read_standard_input_once(stridula, piped):
    piped(st.scenario_text("belt").encode())
    words = ["--vary", "v=0.4,0.5", "--measure", "mean_force", "--out", "a.nc", "--duration", "0.1", "--workers", "1"]
    code, _, error = stridula("sweep", "-", *[word.replace("v=", "velocity=") for word in words])
    assert code == 0, error


def test_files_that_it_names_are_found_from_here(stridula, piped, tmp_path):
    (tmp_path / "mine.toml").write_text(st.scenario_text("belt"), encoding="utf-8")
    piped(b'title = "on a base"\nbase = "mine.toml"\n')
    assert "on a base" in stridula("run", "-", "--duration", "0.1")[1]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "scenario must not be empty, got 'standard input'"),
        (b"title = ", "scenario must be TOML, got 'standard input': "),
        (b"\xff\xfe\x00", "scenario must be text in UTF-8 or, with a byte order mark, UTF-16, got 'standard input'"),
    ],
)
def test_errors_of_piped_scenarios_are_one_line(stridula, piped, content, message):
    piped(content)
    code, _, error = stridula("run", "-")
    assert code == 2
    assert error.startswith(f"stridula: {message}")
    assert error.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "completed"),
    [
        ("stridula sta", ["stability"]),
        ("stridula run squ", ["squeal", "squeal-on-plate"]),
        ("stridula run --du", ["--duration"]),
    ],
)
def test_the_shell_completes_verbs_scenarios_and_options(words, completed):
    asked = {"_STRIDULA_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    found = subprocess.run(
        [sys.executable, "-c", PROGRAM], env=os.environ | asked, capture_output=True, text=True, check=False
    )
    assert found.stdout.split() == completed, found.stderr
