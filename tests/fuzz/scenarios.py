"""Shipped scenarios with wrong keys, values, units, nesting and types; runs of 1 ms if they load."""

from __future__ import annotations

import copy
import random
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import tomli_w

import stridula as st
from stridula.scenarios.read import read_tables

from .numbers import ODD, flipped, number, plain
from .outcomes import folder, outcome, watcher

KEYS = (
    "length",
    "friction",
    "kind",
    "cutoff",
    "bodies",
    "contacts",
    "drives",
    "base",
    "name",
    "points",
    "history",
    "xyz",
)
UNITS = ("m", "mm", "deg", "kHz", "GPa", "kg", "%", "m/s", "cm/s", "N", "s", "ms", "furlong", "")

Given = tuple[bytes, dict[str, Any]]


def inputs(seed: int, count: int) -> Iterator[Given]:
    """Return scenarios as the bytes of their files, and overrides."""
    return wrong("scenarios", seed, count, is_meshed=False)


def wrong(kind: str, seed: int, count: int, is_meshed: bool) -> Iterator[Given]:
    """Return wrong scenarios with or without meshes, as the bytes of their files, and overrides."""
    for k in range(count):
        dice = random.Random(f"{kind} {seed} {k}")
        tables = copy.deepcopy(dice.choice(_shipped(is_meshed)))
        for _ in range(dice.choice((1, 1, 1, 1, 2, 3))):
            _changed(dice, tables)
        content = tomli_w.dumps(tables).encode()
        if dice.random() < 0.12:
            content = flipped(dice, content)
        keys = {_key(dice, tables): plain(dice) for _ in range(dice.choice((0,) * 12 + (1, 1, 2, 200)))}
        yield content, keys


def check(given: Given) -> str:
    """Return the outcome of a scenario."""
    content, overrides = given
    with folder():
        Path("case.toml").write_bytes(content)

        def run() -> None:
            scenario = st.load_scenario("case.toml", overrides)
            str(scenario.system)
            scenario.simulate(duration=1e-3, watchers=[watcher()])

        return outcome(run)


@cache
def _shipped(is_meshed: bool) -> tuple[dict[str, Any], ...]:
    every = [read_tables(case.name) for case in st.list_scenarios()]
    return tuple(tables for tables in every if is_meshed == _has_mesh(tables))


def _has_mesh(tables: dict[str, Any]) -> bool:
    return any({"mesh", "profile"} & body.keys() for body in tables.get("bodies", {}).values())


def _changed(dice: random.Random, tables: dict[str, Any]) -> None:
    """Change one thing in tables."""
    places = list(_places(tables))
    numbers = [(holder, key) for holder, key in places if type(holder[key]) in (int, float)]
    holder, key = dice.choice(numbers if numbers and dice.random() < 0.5 else places)
    draw = dice.random()
    if draw < 0.4 and type(holder[key]) in (int, float):
        holder[key] = type(holder[key])(holder[key] * 10.0 ** dice.uniform(*dice.choice(((-0.5, 0.5), (-4, 4)))))
    elif draw < 0.5:
        holder[key] = number(dice) if type(holder[key]) in (int, float) else plain(dice)
    elif draw < 0.55:
        holder[key] = f"{number(dice)!r} {dice.choice(UNITS)}"
    elif draw < 0.7:
        del holder[key]
    elif draw < 0.8:
        other, its = dice.choice(places)
        holder[key] = copy.deepcopy(other[its])
    elif draw < 0.9 and isinstance(holder, dict):
        holder[dice.choice(KEYS + ODD)] = plain(dice)
    elif draw < 0.94 and isinstance(holder, dict):
        holder |= {f"key {k}": k for k in range(dice.choice((30, 3000)))}
    elif draw < 0.97 and isinstance(holder, list):
        holder += [copy.deepcopy(holder[key]) for _ in range(dice.choice((1, 5, 30)))]
    else:
        for _ in range(dice.choice((1, 30, 100))):
            holder[key] = [holder[key]] if dice.random() < 0.5 else {"x": holder[key]}


def _places(tables: Any) -> Iterator[tuple[Any, Any]]:
    """Iterate over every place of nested tables and lists."""
    for key in list(tables) if isinstance(tables, dict) else range(len(tables)):
        yield tables, key
        if isinstance(tables[key], (dict, list)):
            yield from _places(tables[key])


def _key(dice: random.Random, tables: dict[str, Any]) -> str:
    """Return a key, in full or abbreviated, or an unknown one."""
    if dice.random() < 0.3:
        return dice.choice(KEYS + ODD) + str(dice.randrange(1000))
    table, parts = tables, []
    while isinstance(table, dict) and table:
        parts.append(dice.choice(list(table)))
        table = table[parts[-1]]
    return ".".join(parts[dice.randrange(len(parts)) :]) if parts else "x"
