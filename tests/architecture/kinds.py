"""Type checks of the package on its own classes, in place of methods of these classes."""

from __future__ import annotations

import ast
from collections import Counter
from pathlib import Path

import stridula

ROOT = Path(stridula.__file__).parent


def own_names(tree: ast.Module) -> set[str]:
    """Return the classes, and tuples or unions of them, that a module has from the package or defines."""
    found = {node.name for node in tree.body if isinstance(node, ast.ClassDef)}
    for node in ast.walk(tree):
        is_own = isinstance(node, ast.ImportFrom) and (node.level or (node.module or "").startswith("stridula"))
        found |= {alias.asname or alias.name for alias in node.names} if is_own else set()
    return found


def asked_kinds(source: str) -> list[tuple[int, str]]:
    """Return the lines that ask for a class of the package, by ``isinstance`` or ``match``, and the classes."""
    tree = ast.parse(source)
    own = own_names(tree)
    found = []
    for node in ast.walk(tree):
        asked: ast.AST | None = None
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "isinstance":
            asked = node.args[1]
        elif isinstance(node, ast.MatchClass):
            asked = node.cls
        names = (
            {part.id for part in ast.walk(asked) if isinstance(part, ast.Name)} & own if asked is not None else set()
        )
        if names:
            found.append((node.lineno, ", ".join(sorted(names))))
    return found


def counts(root: Path = ROOT) -> Counter[str]:
    """Return their number in each file."""
    files = sorted(path for path in root.rglob("*.py") if "__pycache__" not in path.parts)
    return Counter({str(path.relative_to(root)): len(asked_kinds(path.read_text(encoding="utf-8"))) for path in files})


if __name__ == "__main__":
    for name, number in counts().most_common():
        if number:
            print(f"{number:4d} {name}")
    print(f"{counts().total():4d} in all")
