"""The demonstration as a part of a page."""

from __future__ import annotations

import json
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
# Scripts, in the order in which they build on one another.
SCRIPTS = ("sound", "body", "map", "main")


def html() -> str:
    """Return the demonstration, with its settings in it, since browsers load none from files beside a page."""
    settings = (FOLDER / "settings.json").read_text(encoding="utf-8")
    choices = []
    for number, one in enumerate(json.loads(settings)["instruments"]):
        chosen = "" if number else " checked"
        button = f'<input type="radio" name="demonstration-case" value="{one["name"]}"{chosen}>'
        choices.append(f"<label>{button} {one['title']}</label>")
    whole = (FOLDER / "demonstration.html").read_text(encoding="utf-8")
    parts = [whole.replace("<!-- cases -->", "\n    ".join(choices))]
    parts += [f'<script type="application/json" id="demonstration-data">\n{settings}</script>']
    parts += [f'<script defer src="_static/demonstration/{name}.js"></script>' for name in SCRIPTS]
    return "\n".join([*parts, ""])
