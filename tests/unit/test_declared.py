"""Declared fields of descriptions: checked, and used as the keys of a table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import pytest
from pydantic import TypeAdapter, ValidationError

import stridula as st
from stridula.declared import Choice, Each, Length, Number, Speed, check_declared, declared, texts
from stridula.scenarios.derived import one_of, table_of


@dataclass(frozen=True)
class Brake:
    """Slows what turns.

    Some words : of no parameter.

    Parameters
    ----------
    radius, width : float
        Size of it [m], across and along.
    speed : float, optional
        Poisson's speed [m/s]; where it stops `radius`.
    kind : {"disc", "drum"}, optional
        What it is. And more of it.
    wear : sequence of float
        Ratios [1].

    Raises
    ------
    ValueError : never
        Not here.
    """

    radius: Length
    width: Length
    speed: Speed | None = None
    kind: Annotated[str, Choice(("disc", "drum"))] = "disc"
    wear: Annotated[Sequence[float], Each(Number(least=0.0, below=1.0, meaning="worn through"))] = ()
    free: float = 0.0

    def __post_init__(self) -> None:
        check_declared(self)


@dataclass(frozen=True)
class Clutch:
    """Joins what turns.

    Parameters
    ----------
    radius : float
        Size of it [m].
    """

    radius: Length


def test_fields_that_are_declared_are_found_in_order():
    assert [field.name for field in declared(Brake)] == ["radius", "width", "speed", "kind", "wear"]
    assert [field.is_optional for field in declared(Brake)] == [False, False, True, False, False]


def test_texts_are_the_beginnings_of_the_docstring():
    assert texts(Brake) == {
        "radius": "size of it, across and along [m]",
        "width": "size of it, across and along [m]",
        "speed": "Poisson's speed [m/s]",
        "kind": "what it is",
        "wear": "ratios",
    }


def test_lists_become_tuples():
    assert Brake(1.0, 1.0, wear=[0.0, 0.5]).wear == (0.0, 0.5)


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        ({"radius": 0.0}, "radius must be above 0, got 0.0"),
        ({"width": "1"}, "width must be a number, got '1'"),
        ({"speed": -1.0}, "speed must be above 0, got -1.0"),
        ({"kind": "drums"}, "kind must be one of disc, drum, got 'drums'; did you mean 'drum'?"),
        ({"wear": 0.5}, "wear must be a list of numbers, got 0.5"),
        ({"wear": [0.0, 1.0]}, "wear[1] must be below 1 (worn through), got 1.0"),
        ({"wear": [-0.1]}, "wear[0] must be 0 or above, got -0.1"),
    ],
)
def test_each_field_is_checked(words, problem):
    with pytest.raises(st.ArgumentError) as caught:
        Brake(**{"radius": 1.0, "width": 1.0} | words)
    assert str(caught.value) == problem


READ = TypeAdapter(
    one_of(
        "turns",
        [table_of(Brake, "turns", "brake", "a part", is_usual=True), table_of(Clutch, "turns", "clutch", "a part")],
    )
)


def test_a_table_reads_what_is_declared():
    table = READ.validate_python(
        {"turns": "brake", "radius": "20 mm", "width": 0.1, "speed": "1 cm/s", "wear": ["1 %"]}
    )
    assert table.model_dump(exclude_unset=True) == {
        "turns": "brake",
        "radius": 0.02,
        "width": 0.1,
        "speed": 0.01,
        "wear": [0.01],
    }
    assert READ.validate_python({"turns": "clutch", "radius": 1}).radius == 1.0


@pytest.mark.parametrize(
    "table",
    [
        {"turns": "brake", "radius": "20 Hz", "width": 0.1},
        {"turns": "brake", "radius": 1.0},
        {"turns": "brake", "radius": 1.0, "width": 0.0},
        {"turns": "brake", "radius": 1.0, "width": 1.0, "kind": "drums"},
        {"turns": "clutch", "radius": 1.0, "width": 1.0},
        {"turns": "gear", "radius": 1.0},
    ],
)
def test_a_table_refuses_the_rest(table):
    with pytest.raises(ValidationError):
        READ.validate_python(table)


def test_the_schema_of_a_table_says_what_is_declared():
    known = READ.json_schema()["$defs"]["Brake"]["properties"]
    assert known["turns"]["description"] == "a part"
    assert known["speed"]["description"] == "Poisson's speed [m/s]"
    assert {"type": "number", "exclusiveMinimum": 0.0} in known["radius"]["anyOf"]
    assert known["kind"] == {
        "default": "disc",
        "enum": ["disc", "drum"],
        "title": "Kind",
        "type": "string",
        "description": "what it is",
    }
