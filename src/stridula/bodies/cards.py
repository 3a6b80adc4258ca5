"""Cards of bodies in notebooks: the outline and the main properties."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..cards import Stroke, band, card, drawing, edges_seen, flattened, spoken
from .sections import Material

# Degrees of freedom up to which modes are computed in less than a tenth of a second.
FEW = 300


class HasCard:
    """Mixin for bodies that notebooks show as a card."""

    @property
    def has_modes_at_hand(self) -> bool:
        """Whether its modes are already computed, or quick to compute."""
        return True

    @property
    def has_mass_at_hand(self) -> bool:
        """Whether its mass is quick to compute."""
        return True

    def _repr_html_(self) -> str:
        """Return a card with its outline and its properties, without a long search for modes."""
        name = getattr(self, "name", "")
        title = type(self).__name__ + (f" {name!r}" if name else "")
        return card(title, facts_of(self), drawing(outline_of(self), f"outline of the {title}"))


def facts_of(body: Any) -> dict[str, str | Sequence[str]]:
    """Return the properties of a body by name, in words."""
    found: dict[str, str | Sequence[str]] = {
        "material": _materials(body),
        "section": section_words(body.section) if hasattr(body, "section") else "",
        "size": body.dimensions,
        "posture": body.posture,
        "supports": _supports(body),
        "tension": spoken(body.tension, "N") if getattr(body, "tension", 0.0) else "",
        "mass": mass_words(body),
        "modes": modes_words(body),
        "damping": _damping(body),
    }
    if not body.has_positions:
        found["points"] = _listed(body.point_names)
    return found


def materials_of(body: Any) -> dict[str, Material]:
    """Return the materials of a body by the names of its regions; a material of all regions has an empty name."""
    given = getattr(body, "materials", None) or getattr(body, "material", None) or {}
    by_name = dict(given) if isinstance(given, Mapping) else {"": given}
    different = list(dict.fromkeys(by_name.values()))
    return {"": different[0]} if len(different) == 1 else by_name


def _materials(body: Any) -> list[str]:
    by_name = materials_of(body)
    lines = []
    for name, one in by_name.items():
        words = f"{spoken(one.young, 'Pa')}, {one.density:.4g} kg/m³, Poisson's ratio {one.poisson:.3g}"
        lines.append(f"{name}: {words}" if name and len(by_name) > 1 else words)
    return list(dict.fromkeys(lines))


def section_words(section: Any) -> str:
    """Return a cross-section in words."""
    if hasattr(section, "width"):
        return f"rectangle, {section.width:.4g} m wide and {section.height:.4g} m high"
    if hasattr(section, "diameter"):
        return f"circle of {section.diameter:.4g} m"
    return f"{section.area:.4g} m², second moment {section.second_moment:.4g} m⁴"


def _supports(body: Any) -> str:
    if hasattr(body, "root_support"):
        return f"tip {body.tip_support}, root {body.root_support}"
    if hasattr(body, "harmonics"):
        return "simply supported"
    places = getattr(body, "fixed", ()) or [one.place for one in getattr(body, "held", ())]
    return _listed([f"{one} held" for one in places])


def mass_words(body: Any) -> str:
    """Return the mass of a body in words, empty where it is not known."""
    known = getattr(body, "has_mass_at_hand", True) and math.isfinite(body.total_mass)
    return f"{body.total_mass:.4g} kg" if known else ""


def modes_words(body: Any) -> str:
    """Return the number of modes of a body and their range of frequencies in words, if they are known."""
    if not getattr(body, "has_modes_at_hand", True):
        cutoff = getattr(body, "cutoff", None)
        return "found on first use" + ("" if cutoff is None else f", up to {spoken(cutoff, 'Hz')}")
    modes = body.modes()
    elastic = modes.frequency[~modes.massless & (modes.angular_frequency > 0.0)]
    rigid, residual = int((modes.angular_frequency == 0.0).sum()), int(modes.massless.sum())
    parts = [f"{elastic.size} {band(elastic)}"] if elastic.size else []
    parts += [f"{rigid} rigid"] if rigid else []
    parts += [f"{residual} residual shapes"] if residual else []
    return "; ".join(parts)


def _damping(body: Any) -> str:
    given = getattr(body, "damping", None)
    if isinstance(given, float | int):
        return f"{given:.3g} of critical" if given else "none"
    if not body.has_modes_at_hand:
        return str(given) if hasattr(given, "form") else ""
    modes = body.modes()
    ratios = modes.damping[~modes.massless & (modes.angular_frequency > 0.0)]
    if not ratios.size:
        return ""
    low, high = float(ratios.min()), float(ratios.max())
    words = f"{low:.3g}" if low == high else f"{low:.3g} to {high:.3g}"
    coupled = ", coupling modes" if modes.damping_matrix is not None else ""
    return f"{words} of critical{coupled}" if high else "none"


def _listed(names: Sequence[str], most: int = 6) -> str:
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more


def outline_of(body: Any) -> list[Stroke]:
    """Return the drawing of a body alone: a line, a rectangle, a surface or its points; empty if there is none."""
    if hasattr(body, "drawn_at_rest"):
        surface = body.drawn_at_rest
        return [] if surface is None else [surface_stroke(surface)]
    if hasattr(body, "track_line"):
        return _plate(body)
    if hasattr(body, "drawn_places"):
        return [Stroke([np.outer(body.drawn_places[[0, -1]], _flat(body.axes[0]))], width=3.0)]
    if hasattr(body, "offset") and len(body.point_names) > 1:
        places = flattened(np.array([body.offset(name) for name in body.point_names]))
        return [Stroke([np.stack([places[0], one]) for one in places[1:]], opacity=0.5), Stroke([places], dots=True)]
    return []


def surface_stroke(surface: Any) -> Stroke:
    """Return the edges of a surface in space as a stroke."""
    return Stroke(list(edges_seen(surface.place, surface.polygons, surface.normals)), width=1.0)


def _flat(axis: Any) -> Any:
    return axis if len(axis) == 2 else flattened(axis)


def _plate(plate: Any) -> list[Stroke]:
    """Return a plate seen from above, with the line along which bodies slide on it."""
    x, y = plate.length, plate.width
    corners = np.array([[0.0, 0.0], [x, 0.0], [x, y], [0.0, y], [0.0, 0.0]])
    line = np.column_stack(plate.track_line.point(np.array(plate.ends)))
    return [Stroke([corners]), Stroke([line], width=3.0, opacity=0.5)]
