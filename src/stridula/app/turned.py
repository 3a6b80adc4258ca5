"""Controls of a system: its own numbers, as declared in the schema of scenarios."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from fnmatch import fnmatchcase
from functools import lru_cache
from typing import Any

from ..connections import Bushing
from ..scenarios import outline
from ..scenarios.outline import Path, look_up
from ..scenarios.quantities import DEGREES, UNITS
from .controls import CHOICES, CONTROLS, DEGREE, Choice, Control, Turned

# Tables whose numbers have controls; contacts and drives come before bodies.
TURNED = ("contacts", "surfaces", "drives", "connections", "layers", "bodies")
# Positions, and numbers with little effect, have no controls.
NOT_TURNED = {"point", "points", "gap", "at", "inclination", "poisson", "profile", "mesh"}
# The settings of bodies with a mesh, whose modes take minutes to compute, have none either.
MESHES, NOT_TURNED_OF_MESHES = {"profile", "mesh"}, {"cutoff", "axis", "origin"}
# Lists whose entries have controls, of a bushing and of a contact that heats; tables over the frequency have none.
LISTS = {"stiffness", "damping", "rotational_stiffness", "rotational_damping", "capacity", "conductance", "initial"}
# Range of a slider, as a factor on the value in the scenario.
REACH = 5.0
# Least number of steps of a slider.
STEPS = 400
MOST = 40
# Keys of a pair of beams, by patterns of the keys in lists of contacts and bodies.
_PAIR = (
    (r"^(contacts|surfaces)\.(\d+|\*)\.", "contact."),
    (r"^bodies\.(slider|track)\.", r"\1."),
    (r"^drives\.\*\.", "drives.0."),
)
# Units with prefixes, for numbers that are too large or small in the units of scenario files.
PREFIXED = ("m", "N", "N/m", "N s/m", "Pa")
PREFIXES = {"G": 1e9, "M": 1e6, "k": 1e3, "m": 1e-3, "µ": 1e-6, "n": 1e-9}
FRICTION_LAW = CHOICES[0]
GROUPS = {"drives": "Drive", "connections": "Springs", "layers": "Layer", "contacts": "Contact", "surfaces": "Contact"}


def turned_of_system(tables: dict[str, Any], before: dict[str, Any]) -> Turned:
    """Return the controls of a system.

    Numbers that are the same in all entries of a list, or in all bodies whose names differ by a number, share one
    control: their key has a ``*`` in this place.

    Parameters
    ----------
    tables : dict
        Complete tables of the played scenario.
    before : dict
        The same before values were set, from which ranges are derived.
    """
    controls = []
    keys = _keys(tables, before)
    for key, path in keys:
        first = look_up(before, path)
        controls.append(_control(key, path, tables, first if _is_number(first) and first else look_up(tables, path)))
    laws = dict(_together(tables, before, _is_law))
    choices = [_law(key, path) for key, path in laws.items()]
    controls = controls[:MOST]
    values = {key: look_up(tables, path) for key, path in (*keys, *laws.items())}
    known = {one.key for one in choices} | {one.key for one in controls}
    groups = tuple(dict.fromkeys([*(one.group for one in choices), *(one.group for one in controls)]))
    return Turned(groups, tuple(controls), tuple(choices), {key: one for key, one in values.items() if key in known})


def expanded(overrides: Mapping[str, Any], tables: dict[str, Any]) -> dict[str, Any]:
    """Return values by key, with each key with a ``*`` replaced by all keys for which it stands.

    Parameters
    ----------
    overrides : mapping
        Values by key.
    tables : dict
        Complete tables of the scenario.
    """
    return {one: value for key, value in overrides.items() for one in keys_of(key, tables)}


def keys_of(key: str, tables: dict[str, Any]) -> list[str]:
    """Return the keys for which a key stands: itself, or with a ``*`` all that match."""
    return [".".join(map(str, path)) for path in places_of(key, tables)] if "*" in key else [key]


def places_of(key: str, tables: Any) -> list[Path]:
    """Return the paths that match a key: existing ones, else those in existing tables; for a plain key its own."""
    parts = tuple(key.split("."))
    matching = list(_matching(parts[:-1], tables, ()))
    there = [(*path, parts[-1]) for path in matching if look_up(tables, (*path, parts[-1])) is not None]
    return there or [(*path, parts[-1]) for path in matching]


def _matching(parts: tuple[str, ...], tables: Any, path: Path) -> Iterator[Path]:
    if not parts:
        if isinstance(tables, dict):
            yield path
        return
    entries: Any = tables.items() if isinstance(tables, dict) else ()
    if isinstance(tables, list):
        entries = enumerate(tables)
    for name, entry in entries:
        if fnmatchcase(str(name), parts[0]):
            yield from _matching(parts[1:], entry, (*path, name))


def _keys(tables: dict[str, Any], before: dict[str, Any]) -> list[tuple[str, Path]]:
    """Return the keys of numbers with controls, contacts and drives before bodies."""
    found = _together(tables, before, _is_turned)
    found = [one for one in found if not (_makes_a_mesh(one[1], tables) or _is_sample(one[1], tables))]
    return sorted(found, key=lambda item: (TURNED.index(_acts_as(item[1])), "friction" not in item[1]))


def _acts_as(path: Path) -> str:
    """Return the table with which a number is sorted: the turning of a body counts as a drive."""
    return "drives" if path[-1] == "turning" else str(path[0])


def _is_turned(path: Path, node: outline.Node) -> bool:
    return (
        path[0] in TURNED
        and (isinstance(path[-1], str) or path[-2] in LISTS)
        and not NOT_TURNED & set(path)
        and not any("." in str(part) for part in path)
        and outline.is_number(node)
        and not outline.is_whole(node)
    )


def _makes_a_mesh(path: Path, tables: dict[str, Any]) -> bool:
    """Return whether a number sets the number of modes of a body with a mesh, or its position."""
    return bool(path[0] == "bodies" and path[2] in NOT_TURNED_OF_MESHES and MESHES & set(look_up(tables, path[:2])))


def _is_sample(path: Path, tables: dict[str, Any]) -> bool:
    """Return whether a number is that of a table at one frequency."""
    return isinstance(path[-1], int) and any(
        "frequency" in look_up(tables, path[:length]) for length in range(2, len(path) - 1)
    )


def _is_law(path: Path, node: outline.Node) -> bool:
    return path[-2:] == ("friction", "law")


def _together(
    tables: dict[str, Any], before: dict[str, Any], is_wanted: Callable[[Path, outline.Node], bool]
) -> list[tuple[str, Path]]:
    """Return the existing keys, with those of equal value everywhere as one, and the first of their paths."""
    found: dict[str, Path] = {}
    for path, node in outline.paths(tables):
        value = look_up(tables, path)
        # A number that was set to zero keeps its control; one that is zero from the start gives no range.
        is_word = isinstance(value, str) and outline.is_choice(node)
        is_there = is_word or (_is_number(value) and (value or look_up(before, path)))
        if not (is_there and is_wanted(path, node)):
            continue
        common = ".".join("*" if isinstance(part, int) else re.sub(r"\d+", "*", part) for part in path)
        places = places_of(common, tables)
        same = len(places) > 1 and all(look_up(tables, one) == value for one in places)
        found.setdefault(common if same else ".".join(map(str, path)), path)
    return list(found.items())


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


@lru_cache(maxsize=1)
def _of_pairs() -> dict[str, Control]:
    return {control.key: control for control in CONTROLS}


def _control(key: str, path: Path, tables: dict[str, Any], value: float) -> Control:
    """Return the control of a number: that of the page for a pair of beams, else one derived from the value."""
    pair_key = key
    for pattern, known in _PAIR:
        pair_key = re.sub(pattern, known, pair_key)
    node = outline.node_at(path, tables)
    group = _group(key, path, tables)
    if pair_key in _of_pairs():
        known_one = _of_pairs()[pair_key]
        if known_one.low <= value / known_one.scale <= known_one.high:
            # Sentences after the first are about two beams.
            first, stop, _ = known_one.words.partition(". ")
            return replace(known_one, key=key, group=group, place="", words=first + stop.strip())
    unit, scale = _shown_in(next(iter(outline.units(node)), "1"), value)
    low, high = sorted((value / scale / REACH, value / scale * REACH))
    step = 10.0 ** math.floor(math.log10((high - low) / STEPS))
    described = node if isinstance(path[-1], str) else outline.node_at(path[:-1], tables)
    words = _sentence((described or {}).get("description", ""))
    label = _label(path, tables)
    if "materials" in path[-3:-2]:
        label = f"{label}, {path[-2]}"
    return Control(key, group, label, unit, scale, _rounded(low), _rounded(high), step, words)


def _label(path: Path, tables: dict[str, Any]) -> str:
    """Return the name of a number: its key, and which of a list it is."""
    *_, above, last = path
    name = str(above).replace("_", " ") if isinstance(above, str) else ""
    if isinstance(last, str):
        label = f"{name} along {last}".strip() if len(last) == 1 else last.replace("_", " ")
    elif look_up(tables, path[:2]).get("kind") == Bushing.kind:
        label = f"{name} {'about' if name.startswith('rotational') else 'along'} {'xyz'[last]}"
    else:
        label = f"{name} {last + 1}"
    if "laws" in path:
        label = f"{label}, law {int(path[path.index('laws') + 1]) + 1}"
    return label[:1].upper() + label[1:]


def _sentence(text: str) -> str:
    """Return a description as a sentence, without its SI unit."""
    plain = re.sub(r"\s*\[[^\]]*\]", "", text).strip()
    return f"{plain[:1].upper()}{plain[1:]}." if plain else ""


def _rounded(value: float) -> float:
    return float(f"{value:.4g}")


def _shown_in(unit: str, value: float) -> tuple[str, float]:
    """Return a unit in which a value is of convenient size, and its SI value."""
    if unit == "1":
        return "", 1.0
    known = {name: DEGREE if factor == DEGREES else float(factor) for name, factor in UNITS[unit].items()}
    if unit == "rad":
        return "°", DEGREE
    known |= {f"{prefix}{unit}": size for prefix, size in PREFIXES.items()} if unit in PREFIXED else {}
    handy = {name: factor for name, factor in known.items() if 1.0 <= abs(value) / factor < 1000.0}
    name = next(iter(handy), next(iter(known)))
    pretty = name.replace("m2", "m²").replace("m3", "m³").replace("s2", "s²").replace("um", "µm").replace("us", "µs")
    return pretty, known[name]


def _group(key: str, path: Path, tables: dict[str, Any]) -> str:
    """Return the group of a number: that of its contact, drive, connection or body."""
    if "friction" in path:
        group = "Friction"
    elif path[0] == "bodies":
        name = re.sub(r"\W*\*", "", key.split(".")[1]) or str(path[1])
        return name[:1].upper() + name[1:]
    else:
        group = GROUPS.get(str(path[0]), str(path[0]).capitalize())
    entries = look_up(tables, path[:1])
    if "*" in key or not isinstance(entries, list) or len(entries) == 1:
        return group
    entry = entries[int(path[1])]
    told = entry.get("name") or entry.get("kind") or ""
    return f"{group}: {told} {int(path[1]) + 1}".replace("  ", " ")


def _law(key: str, path: Path) -> Choice:
    """Return the control that chooses a law of friction."""
    prefix = key.rpartition(".")[0]
    begins = {
        kind: {f"{prefix}.{name.rpartition('.')[2]}": value for name, value in given.items()}
        for kind, given in FRICTION_LAW.begins.items()
    }
    group = "Friction" if "*" in key or path[1] == 0 else f"Friction {int(path[1]) + 1}"
    return replace(FRICTION_LAW, key=key, group=group, begins=begins)
