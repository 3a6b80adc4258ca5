"""What one turns on the page: one table of keys of the scenario, with ranges, units and words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from ..scenarios.outline import look_up

DEGREE = math.pi / 180.0


@dataclass(frozen=True)
class Control:
    """A number that one turns.

    Attributes
    ----------
    key : str
        Key of the scenario that it sets.
    place : str
        Where its value stands in the full scenario, if elsewhere.
    group, label, unit : str
        Where it is shown, what it is called and the unit it is shown in.
    scale : float
        SI value of one such unit.
    low, high, step : float
        Ends and step of its slider, in the unit shown; a number typed in may lie beyond.
    words : str
        What it does, in a line.
    """

    key: str
    group: str
    label: str
    unit: str
    scale: float
    low: float
    high: float
    step: float
    words: str
    place: str = ""


CONTROLS = (
    Control(
        "contact.friction.coefficient", "Friction", "Friction coefficient", "", 1.0, 0.0, 2.0, 0.01,
        "Largest tangential over normal force. Above cot(angle) a force cannot keep the tip sliding.",
    ),
    Control(
        "contact.friction.static", "Friction", "Static friction", "", 1.0, 0.0, 2.0, 0.01,
        "Friction coefficient that must be overcome before the tip slips.",
    ),
    Control(
        "contact.friction.kinetic", "Friction", "Kinetic friction", "", 1.0, 0.0, 2.0, 0.01,
        "Friction coefficient while the tip slides.",
    ),
    Control(
        "contact.friction.velocity", "Friction", "Stribeck velocity", "mm/s", 1e-3, 0.1, 100.0, 0.1,
        "Slip velocity over which friction falls from static to kinetic.",
    ),
    Control(
        "drives.0.transverse", "Drive", "Force across the slider", "N", 1.0, -20.0, 20.0, 0.01,
        "Pushes the root across the slider: presses the tip down and drags it along.",
    ),
    Control(
        "drives.0.axial", "Drive", "Force along the slider", "N", 1.0, -20.0, 20.0, 0.01,
        "Pushes the root along the slider; below zero, towards the track.",
    ),
    Control(
        "drives.0.velocity", "Drive", "Velocity", "cm/s", 1e-2, -10.0, 10.0, 0.01,
        "Velocity at which the root is drawn along the track.",
    ),
    Control(
        "drives.0.normal_load", "Drive", "Pressing force", "N", 1.0, 0.0, 100.0, 0.1,
        "Presses the root towards the track.",
    ),
    Control(
        "slider.angle", "Slider", "Angle", "°", DEGREE, -80.0, 80.0, 0.5,
        "How far the slider leans from the track's normal; above zero the root is ahead, to the right.",
    ),
    Control(
        "slider.length", "Slider", "Slider length", "mm", 1e-3, 100.0, 1500.0, 1.0,
        "From tip to root. A longer slider vibrates lower.",
    ),
    Control(
        "section.height", "Beams", "Thickness", "mm", 1e-3, 1.0, 30.0, 0.05,
        "Height of both sections, in the plane of bending. Thicker beams vibrate higher.",
        "slider.section.height",
    ),
    Control(
        "section.width", "Beams", "Width", "mm", 1e-3, 1.0, 60.0, 0.1,
        "Width of both sections, across the plane of bending.",
        "slider.section.width",
    ),
    Control(
        "damping", "Beams", "Damping ratio", "%", 1e-2, 0.0, 10.0, 0.01,
        "Share of critical damping of every mode: how fast vibrations die away.",
        "slider.damping",
    ),
    Control(
        "damping.ratio", "Beams", "Damping at low frequency", "%", 1e-2, 0.0, 10.0, 0.01,
        "Share of critical damping of slow modes: how fast swings die away.",
        "slider.damping.ratio",
    ),
    Control(
        "damping.rise", "Beams", "Rise of damping", "%/kHz", 1e-5, 0.0, 10.0, 0.01,
        "How much more damping a mode has for each kilohertz of its frequency.",
        "slider.damping.rise",
    ),
    Control(
        "track.length", "Track", "Track length", "mm", 1e-3, 200.0, 2500.0, 1.0,
        "Length of the simply supported beam on which the tip slides.",
    ),
    Control(
        "contact.at", "Track", "Contact position", "mm", 1e-3, 10.0, 2490.0, 1.0,
        "Where the stroke begins, from the left end of the track. Turned on the way, the tip is put as much farther.",
    ),
)  # fmt: skip
GROUPS = ("Friction", "Drive", "Slider", "Track", "Beams")


@dataclass(frozen=True)
class Choice:
    """One of several kinds.

    Attributes
    ----------
    key : str
        Key of the scenario that tells the kinds apart.
    group, label, words : str
        Where it is shown, what it is called, what it is about.
    kinds : dict
        What each kind is called on the page.
    begins : dict
        Values by key, with which a kind begins that takes the place of another.
    """

    key: str
    group: str
    label: str
    words: str
    kinds: dict[str, str]
    begins: dict[str, dict[str, Any]]


CHOICES = (
    Choice(
        "contact.friction.law",
        "Friction",
        "Law of friction",
        "What friction depends on: nothing, whether the tip sticks, or how fast it slips.",
        {"coulomb": "Coulomb", "static-kinetic": "Static and kinetic", "stribeck": "Stribeck"},
        {
            "coulomb": {"contact.friction.coefficient": 0.5},
            "static-kinetic": {"contact.friction.static": 0.6, "contact.friction.kinetic": 0.4},
            "stribeck": {
                "contact.friction.static": 0.6,
                "contact.friction.kinetic": 0.4,
                "contact.friction.velocity": 0.01,
            },
        },
    ),
    Choice(
        "drives.0.kind",
        "Drive",
        "Driven by",
        "A force on the root, or a velocity of the root under a pressing force.",
        {"force": "Force", "imposed velocity": "Velocity and pressure"},
        {
            "force": {"drives.0.transverse": 3.676, "drives.0.axial": 0.0},
            "imposed velocity": {"drives.0.velocity": 0.01, "drives.0.normal_load": 2.0},
        },
    ),
    Choice(
        "simulation.scheme",
        "Beams",
        "Time scheme",
        "How time goes on: both agree where steps are short.",
        {"exact modal": "Exact modal", "central difference": "Central differences"},
        {"exact modal": {}, "central difference": {}},
    ),
)
KEYS = tuple(one.key for one in (*CONTROLS, *CHOICES))


@dataclass(frozen=True)
class Turned:
    """What one turns of a scenario.

    Attributes
    ----------
    groups : tuple of str
        Where controls are shown, in their order.
    controls : tuple of Control
        Numbers.
    choices : tuple of Choice
        Kinds.
    values : dict
        What each is now, in SI, by key; of controls that a scenario has not nothing.
    """

    groups: tuple[str, ...]
    controls: tuple[Control, ...]
    choices: tuple[Choice, ...]
    values: dict[str, Any]

    @property
    def described(self) -> dict[str, Any]:
        """All of it for the page, in plain numbers and texts, but for the values."""
        return {
            "groups": self.groups,
            "controls": [asdict(control) for control in self.controls],
            "choices": [asdict(choice) for choice in self.choices],
        }


def turned_of_pair(tables: dict[str, Any]) -> Turned:
    """Return what one turns of one beam on another: all that the page knows, and the values in a full scenario."""
    return Turned(GROUPS, CONTROLS, CHOICES, values(tables))


def values(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the value of every control that a full scenario has, in SI, and of every choice, by key."""
    places = {control.key: control.place or control.key for control in CONTROLS}
    places |= {choice.key: choice.key for choice in CHOICES}
    found = {key: look_up(tables, _path(place)) for key, place in places.items()}
    return {key: value for key, value in found.items() if value is not None and not isinstance(value, dict)}


def _path(place: str) -> Sequence[Any]:
    return tuple(int(part) if part.isdigit() else part for part in place.split("."))
