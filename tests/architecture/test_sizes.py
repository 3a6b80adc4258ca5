"""Functions that read from top to bottom: not too long, not too many arguments."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import stridula

FILES = sorted(Path(stridula.__file__).parent.rglob("*.py"))
LINES, ARGUMENTS = 60, 8
# Options of a command are its arguments.
COMMANDS = "commands.py"


def too_large(text: str) -> list[str]:
    """Functions with too many lines of code, or too many arguments that are not keyword-only."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            first = node.body[1] if ast.get_docstring(node) and len(node.body) > 1 else node.body[0]
            lines, given = node.end_lineno - first.lineno + 1, len(node.args.posonlyargs) + len(node.args.args)
            if lines > LINES or given > ARGUMENTS:
                found.append(f"{node.name}: {lines} lines, {given} arguments")
    return found


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_no_function_is_too_large(path):
    if path.name != COMMANDS:
        assert too_large(path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("text", [f"def f({', '.join('abcdefghi')}): pass", "def f():\n" + "    g()\n" * 61])
def test_harness_finds_a_function_that_is_too_large(text):
    """Negative control."""
    assert too_large(text)
