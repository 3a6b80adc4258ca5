"""The outline of a scenario file: its possible keys, read from its JSON schema."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import wraps
from typing import Any, TypeVar

from .quantities import UNITS
from .schema import TOUCHING, json_schema
from .tables import FORMS, holds_tables

Node = dict[str, Any]
Path = tuple[str | int, ...]
Answer = TypeVar("Answer")
SHARED = ("material", "section", "damping", "cutoff")
SHARED_BY_CONTACTS = ("friction",)
TAGS = ("shape", "law", "kind", "form", "quantity")
BEAMS = ("finite-element beam", "modal beam")
PLATES = ("modal plate",)
# Entries of longer lists of numbers, such as samples, are not keys; tables in lists always are.
LONGEST_LIST = 64


def once(answer: Callable[..., Answer]) -> Callable[..., Answer]:
    """Compute an answer about nodes once: those of the schema, and those joined from them, never change."""
    # Nodes are kept with their answers, so that no other node has their identity.
    known: dict[tuple[int, ...], tuple[tuple[Node, ...], Answer]] = {}

    @wraps(answer)
    def looked_up(*nodes: Node) -> Answer:
        key = tuple(map(id, nodes))
        if key not in known:
            known[key] = nodes, answer(*nodes)
        return known[key][1]

    return looked_up


def properties(node: Node | None, table: Any = None) -> dict[str, Node]:
    """Return the keys known in a table: those of its own kind if it has a tag, else of all kinds.

    For a table whose keys are names, such as the bodies, return those present.
    """
    if node is None:
        return {}
    return _of_all_kinds(node) if table is None else _properties(node, table)


@once
def _of_all_kinds(node: Node) -> dict[str, Node]:
    return _properties(node, None)


def _properties(node: Node, table: Any) -> dict[str, Node]:
    variants = _variants(node)
    kinds = [variant["properties"] for variant in variants if "properties" in variant]
    named = [variant["additionalProperties"] for variant in variants if variant.get("additionalProperties")]
    if kinds and named:
        # One table, or one for each name.
        kinds, named = ([], named) if holds_tables(table) else (kinds, [])
    known: dict[str, Node] = dict.fromkeys(table, named[0]) if named and isinstance(table, dict) else {}
    for kind in [kind for kind in kinds if not _differs(kind, table)] or kinds:
        for name, child in kind.items():
            known[name] = _joined(known[name], child) if name in known else child
    return known


def is_number(node: Node) -> bool:
    """Return whether a key holds a number."""
    return any(variant.get("type") in ("number", "integer") for variant in _variants(node))


def units(node: Node | None) -> list[str]:
    """Return the SI units of the numbers that a key accepts, none if it accepts no number with a unit."""
    known = {variant.get("unit") for variant in _variants(node)}
    return [unit for unit in UNITS if unit in known]


def is_choice(node: Node | None) -> bool:
    """Return whether a key accepts only words of a list."""
    variants = _variants(node)
    return bool(variants) and all("enum" in variant or "const" in variant for variant in variants)


def is_whole(node: Node | None) -> bool:
    """Return whether a key accepts only whole numbers."""
    return {variant.get("type") for variant in _variants(node)} == {"integer"}


def words(node: Node | None) -> list[str]:
    """Return the words that a key accepts, none if it is not a choice."""
    chosen = [variant.get("enum", [variant["const"]] if "const" in variant else []) for variant in _variants(node)]
    return list(dict.fromkeys(word for group in chosen for word in group))


def beams(tables: Any) -> list[Path]:
    """Return the paths of beams and plates, which inherit values of the top level; plates have no section."""
    bodies = look_up(tables, ("bodies",))
    named = bodies if isinstance(bodies, dict) else {}
    kinds = [("bodies", name) for name, body in named.items() if look_up(body, ("kind",)) in (*BEAMS, *PLATES)]
    return [path for path in (("slider",), ("track",), *kinds) if isinstance(look_up(tables, path), dict)]


def contacts(tables: Any) -> list[Path]:
    """Return the paths of contacts, which inherit the friction of the top level."""
    places: list[Path] = [("contact",)]
    for key in TOUCHING:
        listed = look_up(tables, (key,))
        places += [(key, number) for number in range(len(listed) if isinstance(listed, list) else 0)]
    return [path for path in places if isinstance(look_up(tables, path), dict)]


def node_at(path: Path, tables: Any) -> Node | None:
    """Return the node at a path, or None if there is no such key."""
    node: Node | None = json_schema()
    for part in path:
        node = _entry(node, tables, part) if isinstance(part, int) else properties(node, tables).get(part)
        tables = look_up(tables, (part,))
    return node


def paths(tables: Any, node: Node | None = None, path: Path = ()) -> Iterator[tuple[Path, Node]]:
    """Yield every key that can be set, whether present or not."""
    for name, child in properties(json_schema() if node is None else node, tables).items():
        yield (*path, name), child
        value = look_up(tables, (name,))
        if value is None:
            yield from (((*path, name, *below), node) for below, node in _left_out(child))
        else:
            yield from _below(value, child, (*path, name))


def look_up(tables: Any, path: Sequence[str | int]) -> Any:
    """Return the value at a path, or None if there is none."""
    for part in path:
        if isinstance(tables, dict):
            tables = tables.get(part)
        elif isinstance(tables, list) and isinstance(part, int) and part < len(tables):
            tables = tables[part]
        else:
            return None
    return tables


def plain(location: Sequence[str | int], tables: Any) -> Path:
    """Return the path of an error's location, without the kinds that pydantic inserts after tables of several kinds."""
    path: list[str | int] = []
    tag: Any = None
    for part in location:
        if tag is not None and part == tag:
            tag = None
            continue
        if part in FORMS and look_up(tables, (*path, part)) is None:
            continue
        path.append(part)
        table = look_up(tables, path)
        tag = next((table[name] for name in TAGS if name in table), None) if isinstance(table, dict) else None
    return tuple(path)


@once
def _left_out(node: Node) -> list[tuple[Path, Node]]:
    """Return the keys below one that is left out."""
    return list(_below(None, node, ()))


def _below(value: Any, node: Node, path: Path) -> Iterator[tuple[Path, Node]]:
    """Yield the keys of a value that is a table, and the entries of one that is a list."""
    yield from paths(value, node, path)
    for number, element in enumerate(value if isinstance(value, list) else ()):
        is_key = isinstance(element, dict) or len(value) <= LONGEST_LIST
        entry = _entry(node, value, number) if is_key else None
        if entry is not None:
            if is_number(entry):
                yield (*path, number), entry
            yield from _below(element, entry, (*path, number))


def _entry(node: Node | None, table: Any, number: int) -> Node | None:
    """Return the node of an entry of a list, None if it cannot have one."""
    length = len(table) if isinstance(table, list) else number + 1
    for variant in _variants(node):
        if variant.get("minItems", 0) <= length <= variant.get("maxItems", length):
            each = variant.get("prefixItems", ())
            if number < len(each) or "items" in variant:
                entry: Node = each[number] if number < len(each) else variant["items"]
                return entry
    return None


def _variants(node: Node | None) -> list[Node]:
    return [] if node is None else _choices(node)


@once
def _choices(node: Node) -> list[Node]:
    if "$ref" in node:
        node = json_schema()["$defs"][node["$ref"].rpartition("/")[2]]
    choices = node.get("oneOf", node.get("anyOf"))
    return [node] if choices is None else [variant for choice in choices for variant in _variants(choice)]


def _differs(known: dict[str, Node], table: Any) -> bool:
    """Return whether the tag of a table names another kind than the one with these keys."""
    if not isinstance(table, dict):
        return False
    return any(tag in known and tag in table and table[tag] not in words(known[tag]) for tag in TAGS)


@once
def _joined(one: Node, other: Node) -> Node:
    return one if one == other else {**one, "anyOf": [_bare(one), _bare(other)]}


def _bare(node: Node) -> Node:
    return {name: value for name, value in node.items() if name != "description"}
