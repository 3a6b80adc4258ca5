"""Controls of the page: a table of keys of the scenario, with ranges, units and texts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from ..scenarios.outline import look_up

DEGREE = math.pi / 180.0


@dataclass(frozen=True)
class Control:
    """A number with a slider on the page.

    Attributes
    ----------
    key : str
        Key of the scenario that it sets.
    place : str
        Key of its value in the full scenario, if different.
    group, label, unit : str
        Group, label and unit in which it is shown.
    scale : float
        SI value of one such unit.
    low, high, step : float
        Ends and step of its slider, in the unit shown; a typed number may lie beyond.
    words : str
        Explanation in one line.
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
        "contact.friction.kinetic", "Friction", "Kinetic friction", "", 1.0, 0.01, 2.0, 0.01,
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
        "Velocity at which the root is pulled along the track.",
    ),
    Control(
        "drives.0.normal_load", "Drive", "Pressing force", "N", 1.0, 0.0, 100.0, 0.1,
        "Presses the root towards the track.",
    ),
    Control(
        "slider.angle", "Slider", "Angle", "°", DEGREE, -80.0, 80.0, 0.5,
        "Inclination of the slider from the track's normal; above zero the root is ahead, to the right.",
    ),
    Control(
        "slider.length", "Slider", "Slider length", "mm", 1e-3, 100.0, 1500.0, 1.0,
        "Length from tip to root. A longer slider vibrates at lower frequencies.",
    ),
    Control(
        "section.height", "Beams", "Thickness", "mm", 1e-3, 1.0, 30.0, 0.05,
        "Height of both sections, in the plane of bending. Thicker beams vibrate at higher frequencies.",
        "slider.section.height",
    ),
    Control(
        "section.width", "Beams", "Width", "mm", 1e-3, 1.0, 60.0, 0.1,
        "Width of both sections, across the plane of bending.",
        "slider.section.width",
    ),
    Control(
        "damping", "Beams", "Damping ratio", "%", 1e-2, 0.0, 10.0, 0.01,
        "Fraction of critical damping of every mode: how fast vibrations die away.",
        "slider.damping",
    ),
    Control(
        "damping.ratio", "Beams", "Damping at low frequency", "%", 1e-2, 0.0, 10.0, 0.01,
        "Fraction of critical damping of slow modes: how fast they die away.",
        "slider.damping.ratio",
    ),
    Control(
        "damping.rise", "Beams", "Rise of damping", "%/kHz", 1e-5, 0.0, 10.0, 0.01,
        "Additional damping of a mode for each kilohertz of its frequency.",
        "slider.damping.rise",
    ),
    Control(
        "track.length", "Track", "Track length", "mm", 1e-3, 200.0, 2500.0, 1.0,
        "Length of the simply supported beam on which the tip slides.",
    ),
    Control(
        "contact.at", "Track", "Contact position", "mm", 1e-3, 10.0, 2490.0, 1.0,
        "Start of the stroke, from the left end of the track. A change while playing moves the tip by as much.",
    ),
)  # fmt: skip
GROUPS = ("Friction", "Drive", "Slider", "Track", "Beams")


@dataclass(frozen=True)
class Choice:
    """One of several kinds.

    Attributes
    ----------
    key : str
        Key of the scenario that distinguishes the kinds.
    group, label, words : str
        Group and label under which it is shown, and explanation.
    kinds : dict
        Name of each kind on the page.
    begins : dict
        Initial values by key of each kind, when it replaces another.
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
        "Dependence of friction: none, on whether the tip sticks, or on its slip velocity.",
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
        "Time integration: both schemes agree if steps are short.",
        {"exact modal": "Exact modal", "central difference": "Central differences"},
        {"exact modal": {}, "central difference": {}},
    ),
)
KEYS = tuple(one.key for one in (*CONTROLS, *CHOICES))


@dataclass(frozen=True)
class Turned:
    """Controls of a scenario.

    Attributes
    ----------
    groups : tuple of str
        Groups of controls, in their order.
    controls : tuple of Control
        Controls of numbers.
    choices : tuple of Choice
        Controls of kinds.
    values : dict
        Present values by key, in SI; controls that a scenario lacks have none.
    """

    groups: tuple[str, ...]
    controls: tuple[Control, ...]
    choices: tuple[Choice, ...]
    values: dict[str, Any]

    @property
    def described(self) -> dict[str, Any]:
        """Description for the page, in plain numbers and texts, without the values."""
        return {
            "groups": self.groups,
            "controls": [asdict(control) for control in self.controls],
            "choices": [asdict(choice) for choice in self.choices],
        }


def turned_of_pair(tables: dict[str, Any]) -> Turned:
    """Return the controls of one beam on another: all controls of the page, and the values in a full scenario."""
    return Turned(GROUPS, CONTROLS, CHOICES, values(tables))


def values(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the values of all controls and choices in a full scenario, in SI, by key."""
    places = {control.key: control.place or control.key for control in CONTROLS}
    places |= {choice.key: choice.key for choice in CHOICES}
    found = {key: look_up(tables, _path(place)) for key, place in places.items()}
    return {key: value for key, value in found.items() if value is not None and not isinstance(value, dict)}


def _path(place: str) -> Sequence[Any]:
    return tuple(int(part) if part.isdigit() else part for part in place.split("."))
