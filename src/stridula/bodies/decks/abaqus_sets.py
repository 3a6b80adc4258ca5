"""Sets of nodes and elements of Abaqus and CalculiX: given in several blocks, by ranges, or by other sets."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from ...arrays import Array
from .keywords import Card


@dataclass(frozen=True)
class Named:
    """Another set.

    Attributes
    ----------
    name : str
        Its name.
    instance : str
        Instance that has it, empty for the same scope.
    is_elements : bool
        Whether it is a set of elements from which the nodes are taken.
    """

    name: str
    instance: str = ""
    is_elements: bool = False


@dataclass(frozen=True)
class Entry:
    """A part of a set.

    Attributes
    ----------
    numbers : range
        Numbers of nodes or elements.
    named : Named or None
        Another set in their place.
    instance : str
        Instance of the numbers, empty for the same scope.
    where : Card or None
        Keyword that has it, for messages.
    """

    numbers: range = range(0)
    named: Named | None = None
    instance: str = ""
    where: Card | None = None


def entries_of(card: Card) -> list[Entry]:
    """Return the entries below ``*NSET`` or ``*ELSET``."""
    instance, found = card.parameters.get("INSTANCE", ""), []
    for row in card.rows:
        if "GENERATE" in card.parameters:
            first, last = card.whole(row, 0), card.whole(row, 1)
            by = card.whole(row, 2) if len(row.words) > 2 and row.words[2] else 1
            if by <= 0 or last < first:
                raise card.wrong(f"GENERATE needs a range that rises, got {', '.join(row.words)}", row)
            found.append(Entry(range(first, last + 1, by), None, instance, card))
            continue
        for word in row.words:
            of, _, name = word.strip('"').rpartition(".")
            if word and name.lstrip("-").isdigit():
                found.append(Entry(_one(int(name)), None, of or instance, card))
            elif word:
                plain = word.strip('"')
                named = Named(name, of) if of else Named(plain, instance)
                found.append(Entry(named=named, where=card))
    return found


@dataclass
class Family:
    """Sets of one kind: entries by the name in capitals, and the first spelling of each.

    Attributes
    ----------
    entries : dict
        Entries by name in capitals.
    names : dict
        First spelling by name in capitals.
    internal : set
        Names in capitals of sets that a program made for itself.
    """

    entries: dict[str, list[Entry]] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)
    internal: set[str] = field(default_factory=set)

    def add(self, name: str, numbers: Iterable[int]) -> None:
        """Add numbers to a set."""
        self.extend(name, [Entry(_one(number)) for number in numbers], is_internal=False)

    def extend(self, name: str, entries: list[Entry], is_internal: bool) -> None:
        """Add entries to a set, which may exist."""
        key = name.upper()
        self.names.setdefault(key, name)
        self.entries.setdefault(key, []).extend(entries)
        if is_internal:
            self.internal.add(key)

    @property
    def shown(self) -> list[str]:
        """Names of the sets that a user gave."""
        return [name for key, name in self.names.items() if key not in self.internal]

    def spelling(self, name: str) -> str:
        """Return the first spelling of a name."""
        return self.names.get(name.upper(), name)

    def copied(self) -> Family:
        """Return a copy."""
        return Family({key: [*one] for key, one in self.entries.items()}, dict(self.names), set(self.internal))


@dataclass
class Sets:
    """Sets of a scope.

    Attributes
    ----------
    nodes, elements : Family
        Sets of nodes and of elements.
    """

    nodes: Family = field(default_factory=Family)
    elements: Family = field(default_factory=Family)

    def copied(self) -> Sets:
        """Return a copy."""
        return Sets(self.nodes.copied(), self.elements.copied())

    def finder(
        self,
        elements: Mapping[int, tuple[str, list[int]]],
        point_of: dict[int, int],
        element_of: dict[int, int],
        instances: Mapping[str, tuple[Sets, dict[int, int], dict[int, int]]],
        read: Counting,
    ) -> Finder:
        """Return what finds the members of these sets, for the numbers in the whole deck of nodes and elements."""
        nodes_of = {number: nodes for number, (_, nodes) in elements.items()}
        return Finder(self, nodes_of, point_of, element_of, instances, read)


class Counting(Protocol):
    """Reader that counts what is left out."""

    left_out: Counter[str]
    instances: list[Any]


@dataclass(frozen=True)
class Finder:
    """Members of the sets of a scope, as indices of points and numbers of elements of the whole deck.

    Attributes
    ----------
    sets : Sets
        The sets.
    nodes_of : dict
        Nodes of each element of the scope.
    point_of, element_of : dict
        Index in the deck of each node and of each element of the scope.
    instances : mapping
        Sets of each instance by its name in capitals, and indices of its nodes and elements.
    read : Counting
        The reader, which counts what is left out.
    """

    sets: Sets
    nodes_of: dict[int, list[int]]
    point_of: dict[int, int]
    element_of: dict[int, int]
    instances: Mapping[str, tuple[Sets, dict[int, int], dict[int, int]]]
    read: Counting

    def nodes(self, name: str, within: tuple[str, ...] = ()) -> Array:
        """Return the points of a set of nodes; one that contains itself gains nothing by that."""
        entries = [] if name.upper() in within else self.sets.nodes.entries[name.upper()]
        found = [self._nodes_of(entry, (*within, name.upper())) for entry in entries]
        return np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *found]))

    def elements(self, name: str, within: tuple[str, ...] = ()) -> Array:
        """Return the elements of a set."""
        entries = [] if name.upper() in within else self.sets.elements.entries[name.upper()]
        found = [self.entry_elements(entry, (*within, name.upper())) for entry in entries]
        return np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *found]))

    def entry_elements(self, entry: Entry, within: tuple[str, ...] = ()) -> Array:
        """Return the elements of an entry."""
        named = entry.named
        if named is None:
            return _members(entry.numbers, self._of(entry.instance, entry).element_of)
        other = self._of(named.instance, entry)
        if named.name.upper() not in other.sets.elements.entries:
            return self._missing(named, "element")
        return other.elements(named.name, () if named.instance else within)

    def _nodes_of(self, entry: Entry, within: tuple[str, ...]) -> Array:
        named = entry.named
        if named is None:
            return _members(entry.numbers, self._of(entry.instance, entry).point_of)
        other, key = self._of(named.instance, entry), named.name.upper()
        if named.is_elements:
            if key not in other.sets.elements.entries:
                return self._missing(named, "element")
            chosen = set(other.elements(named.name).tolist())
            nodes = [node for number, at in other.element_of.items() if at in chosen for node in other.nodes_of[number]]
            return np.array(sorted({other.point_of[node] for node in nodes}), dtype=np.int64)
        if key not in other.sets.nodes.entries:
            return self._missing(named, "node")
        return other.nodes(named.name, () if named.instance else within)

    def _of(self, instance: str, entry: Entry) -> Finder:
        """Return the finder of an instance, itself for none."""
        if not instance:
            return self
        if instance.upper() not in self.instances:
            words = f"the deck has no instance {instance!r}"
            raise entry.where.wrong(words) if entry.where else ValueError(words)
        sets, points, elements = self.instances[instance.upper()]
        scope = next(one.scope for one in self.read.instances if one.name.upper() == instance.upper())
        nodes_of = {number: nodes for number, (_, nodes) in scope.elements.items()}
        return Finder(sets, nodes_of, points, elements, {}, self.read)

    def _missing(self, named: Named, kind: str) -> Array:
        """Count a set that the deck does not have: programs warn of it and go on."""
        self.read.left_out[f"{kind} set {named.name!r}, which is not there,"] += 1
        return np.zeros(0, dtype=np.int64)


def _members(given: range, numbers: dict[int, int]) -> Array:
    """Return the numbers in the deck of those of a range that exist."""
    chosen = (
        (one for one in given if one in numbers) if len(given) < len(numbers) else filter(given.__contains__, numbers)
    )
    return np.array([numbers[one] for one in chosen], dtype=np.int64)


def _one(number: int) -> range:
    return range(number, number + 1)
