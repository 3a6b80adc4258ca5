"""Masses and springs of decks of Abaqus and CalculiX."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array
from .abaqus_sets import Sets
from .deck import Deck, Lump
from .keywords import Card

# Elements of a mass or a spring, with their number of nodes.
FORMS = {"MASS": 1, "SPRING1": 1, "SPRING2": 2, "SPRINGA": 2}
# Parameters of values that depend on something, or act along other axes.
OTHER_VALUES = {"NONLINEAR", "ORIENTATION", "DEPENDENCIES", "TYPE", "COMPLEX STIFFNESS"}


@dataclass
class Lumps:
    """Masses and springs of a scope.

    Attributes
    ----------
    elements : dict
        Form and nodes, as they are spelled, by the number of the element.
    sets : dict
        Numbers of elements by the name in capitals of their set.
    values : list
        Cards of ``*MASS`` and ``*SPRING``.
    """

    elements: dict[int, tuple[str, list[str]]] = field(default_factory=dict)
    sets: dict[str, list[int]] = field(default_factory=dict)
    values: list[Card] = field(default_factory=list)

    def add(self, card: Card, form: str) -> None:
        """Add the elements of a card."""
        for row in card.rows:
            number, nodes = card.whole(row, 0), row.words[1:]
            if len(nodes) != FORMS[form]:
                raise card.wrong(f"{form} has {FORMS[form]} nodes, got {len(nodes)}", row)
            self.elements[number] = (form, nodes)
            self.sets.setdefault(card.parameters.get("ELSET", "").upper(), []).append(number)

    def copied(self) -> Lumps:
        """Return a copy."""
        return Lumps(dict(self.elements), {name: [*those] for name, those in self.sets.items()}, [*self.values])

    def of_set(self, name: str, sets: Sets, within: tuple[str, ...] = ()) -> set[int]:
        """Return the numbers of those in a set."""
        key = name.upper()
        found = set(self.sets.get(key, []))
        for entry in sets.elements.entries.get(key, []) if key not in within else []:
            if entry.named is None:
                found |= {number for number in self.elements if number in entry.numbers}
            else:
                found |= self.of_set(entry.named.name, sets, (*within, key))
        return found


# Lumps of a scope, its sets, the points of its nodes and the function that places them.
OfScope = tuple[Lumps, Sets, Mapping[int, int], Callable[[Array], Array]]


def add_lumps(
    deck: Deck, scopes: Iterable[OfScope], instances: Mapping[str, Mapping[int, int]], has_transform: bool
) -> None:
    """Add masses and springs to a deck; those that have no plain value in its directions are counted.

    Parameters
    ----------
    deck : Deck
        The deck.
    scopes : iterable
        Scopes with lumps.
    instances : mapping
        Points of the nodes of each instance by its name in capitals.
    has_transform : bool
        Whether the deck gives directions of nodes, which those of springs then follow.
    """
    for lumps, sets, point_of, moved in scopes:
        value_of = {number: card for card in lumps.values for number in lumps.of_set(_set_of(card), sets)}
        corners = moved(np.vstack([np.zeros(3), np.eye(3)]))
        is_turned = has_transform or not np.array_equal(corners[1:] - corners[0], np.eye(3))
        for number, (form, words) in lumps.elements.items():
            nodes = [_node(word, point_of, instances) for word in words]
            points = [point for point, _ in nodes if point is not None]
            value = _value(value_of.get(number), form)
            found = None
            if value is not None and len(points) == len(words):
                found = _way(value[0], form, deck.points[points], is_turned)
            if value is None or found is None:
                deck.left_out[form] += 1
            else:
                labels = tuple(f"node {label}" for _, label in nodes)
                deck.lumps.append(Lump(form, tuple(points), labels, value[1], found))


def _set_of(card: Card) -> str:
    return card.parameters.get("ELSET", "")


def _node(word: str, point_of: Mapping[int, int], instances: Mapping[str, Mapping[int, int]]) -> tuple[int | None, str]:
    """Return the point of a node and its number in its scope."""
    of, _, number = word.strip('"').rpartition(".")
    points = instances.get(of.upper(), {}) if of else point_of
    return (points.get(int(number)) if number.isdigit() else None), number


def _value(card: Card | None, form: str) -> tuple[list[int], float] | None:
    """Return directions and value of a mass or a spring; None without one positive number."""
    if card is None or (card.keyword == "MASS") != (form == "MASS") or OTHER_VALUES & card.parameters.keys():
        return None
    rows = [row for row in card.rows if any(row.words)]
    has_directions = form in ("SPRING1", "SPRING2")
    if len(rows) != 1 + has_directions:
        return None
    value = card.number(rows[-1], 0)
    if not 0.0 < value < np.inf:
        return None
    return ([card.whole(rows[0], at) for at in range(FORMS[form])] if has_directions else []), value


def _way(directions: list[int], form: str, places: Array, is_turned: bool) -> tuple[float, ...] | None:
    """Return the direction of a spring, nothing for a mass; None if it has none."""
    if form == "MASS":
        return ()
    if form == "SPRINGA":
        along = places[1] - places[0]
        return tuple((along / np.linalg.norm(along)).tolist()) if along.any() else None
    if is_turned or len(set(directions)) != 1 or directions[0] not in (1, 2, 3):
        return None
    return tuple(np.eye(3)[directions[0] - 1].tolist())
