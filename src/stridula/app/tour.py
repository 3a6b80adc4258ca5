"""Six stops of a tour for teaching, each with a setting and an explanation of the things to see and hear."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class TourStop:
    """A stop of the tour.

    Attributes
    ----------
    title, words : str
        Title, and explanation of the things to see and hear.
    look : str
        Element of the page to look at.
    case : str
        Case to play.
    overrides : dict
        Values set by key.
    compared : dict or None
        Values by key of the second setting, if two are compared.
    """

    title: str
    words: str
    look: str
    case: str
    overrides: dict[str, Any] = field(default_factory=dict)
    compared: dict[str, Any] | None = None


STOPS = (
    TourStop(
        "Stick",
        "The upper end of the slider is pulled along at a tenth of a millimetre per second, and friction holds the "
        "tip where it landed: the ribbon under the force is orange. The phase portrait is empty because the "
        "tip does not move. You hear the beams ringing from the landing.",
        "timeline",
        "stable-sliding",
        {
            "contact.friction.coefficient": 1.0,
            "drives.0.kind": "imposed velocity",
            "drives.0.velocity": 0.0001,
            "drives.0.normal_load": 20.0,
        },
    ),
    TourStop(
        "Slip",
        "With a faster pull, a smaller load and half the friction, the tip slides all the time: the ribbon is "
        "yellow. The force settles to a steady value and the sound dies away, since nothing feeds it.",
        "timeline",
        "stable-sliding",
        {"drives.0.kind": "imposed velocity", "drives.0.velocity": 0.01, "drives.0.normal_load": 1.0},
    ),
    TourStop(
        "Separate",
        "Now the slider leans into its motion and half a newton presses it down: the tip is in the air most of "
        "the time, shown in blue. Each spike of the force is a landing, and you hear them as a rattle.",
        "timeline",
        "weak-pressure",
        {"drives.0.normal_load": 0.5},
    ),
    TourStop(
        "Squeal",
        "Friction is 1.5, and above 1 it can hold a slider that leans by 45 degrees: the tip sticks most of the "
        "time, and each time it lets go it excites a tone near 860 Hz. In the spectrogram each of these bursts is an "
        "upright stripe.",
        "spectrogram",
        "squeal",
    ),
    TourStop(
        "Judder",
        "The slider is pushed along its own axis at a friction of 1.1: the tip hammers on the track, with some 600 "
        "landings a second, and never settles. Its path in the phase portrait never closes, and you hear a roar "
        "without a pitch.",
        "phase",
        "judder",
    ),
    TourStop(
        "Pressure",
        "Setting A presses with 2 N: the tip flies and lands a few hundred times a second. Setting B presses with "
        "100 N: the tip has no time to fly and sticks. The remaining sound is the fast vibration of beams in contact, "
        "above 800 Hz. The buttons A and B, or the key b, switch between them.",
        "spectrogram",
        "strong-pressure",
        {"drives.0.normal_load": 2.0},
        {"drives.0.normal_load": 100.0},
    ),
)
