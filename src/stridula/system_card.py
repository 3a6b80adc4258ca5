"""Cards of systems in notebooks: a drawing of the bodies and a list of all parts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .bodies.cards import mass_words, modes_words, surface_stroke
from .cards import Stroke, card, drawing, flattened
from .connections import ends
from .lines import outlines_of

# Length to which a rigid track is drawn to either side of a tip, as a share of the extent of the bodies.
REACH = 0.25
# Largest number of lines for parts of one kind in the text of a system.
MOST_LINES = 6
# Largest gap that may be due to rounding [m].
CLOSED = 1e-12


def card_of(system: Any) -> str:
    """Return the card of a system, without a long search for modes."""
    facts = _facts(system)
    if len(facts["contacts"]) > 1:
        facts["contacts"] = [f"{len(system.contacts)} in all", *facts["contacts"]]
    strokes = _in_space(system) if system.is_spatial else _in_the_plane(system)
    return card("System", facts, drawing(strokes, "outline of the system"))


def lines_of(system: Any) -> str:
    """Return a line for each part of a system; of many parts of a kind, the first ones and the number of the others."""
    lines = ["System("]
    for kind, words in _facts(system).items():
        left = len(words) - MOST_LINES
        shown, more = (words, []) if left <= 0 else (words[:MOST_LINES], [f"and {left} other {kind}"])
        lines += [f"  {line}" for line in [*shown, *more]]
    return "\n".join([*lines, ")"])


def _facts(system: Any) -> dict[str, Sequence[str]]:
    """Return a line for each part of a system, by kind."""
    return {
        "bodies": [f"{system.body_name(body)}: {_body_words(body)}" for body in system.bodies],
        "contacts": _contacts(system),
        "connections": [connection_words(one, system) for one in system.connections],
        "drives": [_drive_words(drive, system) for drive in system.drives],
    }


def _body_words(body: Any) -> str:
    modes = modes_words(body)
    parts = [body.kind, body.dimensions, body.posture, mass_words(body), f"modes: {modes}" if modes else ""]
    return ", ".join(part for part in parts if part)


def _contacts(system: Any) -> list[str]:
    """Return a line for each contact; those of a surface share one."""
    lines, surfaces = [], set()
    for name, contact in zip(system.contact_names, system.contacts, strict=True):
        if contact.surface:
            if contact.surface in surfaces:
                continue
            surfaces.add(contact.surface)
            count = sum(one.surface == contact.surface for one in system.contacts)
            lines.append(f"{contact.surface}: surface of {count} points, {_touched(contact, system)}")
        else:
            lines.append(f"{name}: {_touched(contact, system)}")
    return lines


def _touched(contact: Any, system: Any) -> str:
    """Return both sides of a contact, its place and its friction law, in words."""
    rigid = contact.rigid_track
    other = system.body_name(contact.track_body) if rigid is None else rigid.words
    other += " with a profile" if contact.profile is not None else ""
    has_places = contact.path_body is not None or contact.circle is not None
    has_places |= contact.relief is not None
    where = f" at {contact.at:.4g} m" if has_places else ""
    gap = f", gap {contact.gap:.3g} m" if abs(contact.gap) > CLOSED else ""
    return f"{system.body_name(contact.tip.body)} on {other}{where}, {contact.friction_words}{gap}"


def _drive_words(drive: Any, system: Any) -> str:
    return str(drive) if drive.acted_on is None else f"{system.body_name(drive.acted_on)}: {drive}"


def connection_words(connection: Any, system: Any) -> str:
    """Return a connection and its bodies in words."""
    names = [system.body_name(point.body) for point in ends(connection)]
    return f"{connection} from {names[0]} to {names[1] if len(names) > 1 else 'the ground'}"


def _in_the_plane(system: Any) -> list[Stroke]:
    outlines, tips = outlines_of(system)
    sliding = {contact.tip.body for contact in system.contacts}
    strokes = []
    for one in outlines:
        if len(one.ends) > 1:
            strokes.append(Stroke([one.ends], width=3.0, opacity=1.0 if one.body in sliding else 0.5))
        else:
            strokes.append(Stroke([np.concatenate([one.ends, one.ends])], width=6.0))
    places = np.concatenate([tips, *(one.ends for one in outlines)])
    reach = REACH * (float(np.ptp(places, axis=0).max()) or 1.0)
    for contact, tip in zip(system.contacts, tips, strict=True):
        if contact.rigid_track is not None:
            normal, tangent = contact.frame
            strokes.append(Stroke([tip - contact.gap * normal + np.outer([-reach, reach], tangent)], opacity=0.5))
    return [*strokes, Stroke([tips], dots=True)]


def _in_space(system: Any) -> list[Stroke]:
    drawn = [body.drawn_at_rest for body in system.bodies if hasattr(body, "drawn_at_rest")]
    strokes = [surface_stroke(surface) for surface in drawn if surface is not None]
    touched = [end.place for contact in system.contacts if (end := contact.placed_end) is not None]
    return [*strokes, Stroke([flattened(np.array(touched))], width=0.8, dots=True)] if strokes and touched else strokes
