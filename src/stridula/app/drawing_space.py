"""Drawing of a system in space on the page: surfaces of bodies, their motion in modes, and their contacts."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from hashlib import blake2b
from typing import Any

import numpy as np

from ..arrays import Array, in_space
from ..bodies import BodyPoint
from ..bodies.drawn_surfaces import Drawn, drawn_table, is_drawn
from ..integration.live import LiveChunk, LiveMarch
from ..plot.rigid_surfaces import rigid_surfaces
from ..system import System
from .now import said
from .parts import Shapes, contacts_now
from .thinned import MOST_NUMBERS, thinned


@dataclass(frozen=True)
class _Body:
    """A drawn body.

    Attributes
    ----------
    name : str
        Name of the body.
    drawn : DrawnSurface or DrawnRings
        Its surface.
    rows : list of ndarray, shape (3, modes)
        Displacements of its contact points in the modes.
    basis : ndarray, shape (modes, numbers), or None
        For a body of many modes, the combinations of modes used for its surface and rows.
    """

    name: str
    drawn: Drawn
    rows: list[Array] = field(default_factory=list)
    basis: Array | None = None

    @property
    def numbers(self) -> int:
        """Number of coordinates of its position."""
        return int(self.drawn.shapes.shape[2])

    def of(self, modal: Array) -> Array:
        """Return the coordinates of its position from its modal coordinates."""
        return modal if self.basis is None else modal @ self.basis

    @property
    def described(self) -> dict[str, Any]:
        """Description for the page."""
        rows = np.array(self.rows).reshape(len(self.rows), 3, self.numbers)
        surface = {name: said(values) for name, values in drawn_table(self.drawn).items()}
        return {"name": self.name, "numbers": self.numbers, "rows": said(rows), **surface}


class Surfaces:
    """Bodies in space drawn as surfaces, as in films.

    Parameters
    ----------
    system : System
        The system.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        bodies = {
            system.body_name(body): _Body(system.body_name(body), drawn) for body, drawn in _drawn(system).items()
        }
        self.touches: list[dict[str, Any]] = []
        for contact, name in zip(system.contacts, system.contact_names, strict=True):
            end = _known_end((contact.tip, contact.touched_point), system, bodies)
            if end is None:
                self.touches.append({"name": name, "body": None})
                continue
            body = bodies[system.body_name(end.body)]
            self.touches.append({"name": name, "body": body.name, "row": len(body.rows), "place": _place(end).tolist()})
            body.rows.append(end.body.trace(end.position))
        self.bodies = [_small(body) for body in bodies.values()]

    @cached_property
    def described(self) -> dict[str, Any]:
        """Surfaces with the shapes of their modes, contacts, the upward direction, and a hash of all of them."""
        normal = in_space(self.system.contacts[0].frame[0])
        axis = int(np.argmax(np.abs(normal)))
        up = (np.sign(normal[axis]) * np.eye(3)[axis]).tolist()
        told = {"surfaces": [body.described for body in self.bodies], "touches": self.touches, "up": up}
        return {"drawn": blake2b(json.dumps(told).encode(), digest_size=8).hexdigest(), **told}

    def shapes(self, live: LiveMarch, chunk: LiveChunk) -> Shapes:
        """Return the positions of the bodies at the end of a chunk."""
        spans = [slice(*live.spans[body.name]) for body in self.bodies]
        moved = [body.of(modal[span]) for modal in live.motion for body, span in zip(self.bodies, spans, strict=True)]
        place, height = (float(chunk.contact[name][-1]) for name in ("contact_position", "contact_height"))
        return Shapes(place, height, np.zeros((0, 2)), np.concatenate([*moved, ()]), contacts_now(live, chunk))


def _drawn(system: System) -> dict[Any, Drawn]:
    """Return the surfaces of bodies that have one, and of rigid bodies in contact with or connected to them."""
    surfaces = {body: _thinned(body) for body in system.bodies if is_drawn(body)}
    if not surfaces:
        return {}
    return surfaces | rigid_surfaces(system, [drawn.at_rest for drawn in surfaces.values()])


@lru_cache(maxsize=16)
def _thinned(body: Any) -> Drawn:
    return thinned(body.drawn)


def _known_end(ends: Sequence[BodyPoint | None], system: System, bodies: dict[str, _Body]) -> BodyPoint | None:
    """Return the end of a contact whose body is drawn and whose position is known, None if there is none."""
    known = (end for end in ends if end is not None and end.place is not None)
    return next((end for end in known if system.body_name(end.body) in bodies), None)


def _place(end: BodyPoint) -> Array:
    assert end.place is not None
    return np.asarray(end.place)


def _small(body: _Body) -> _Body:
    """Return a body with at most as many shapes as the page can draw."""
    drawn, modes = body.drawn, body.numbers
    kept = MOST_NUMBERS // drawn.shapes[..., 0].size
    if modes <= kept:
        return body
    # Combinations of modes that move the surface most; the others cannot be seen.
    moved = drawn.shapes.reshape(-1, modes)
    _, combined = np.linalg.eigh(moved.T @ moved)
    basis = combined[:, ::-1][:, :kept]
    rows = [row @ basis for row in body.rows]
    return replace(body, drawn=replace(drawn, shapes=drawn.shapes @ basis), rows=rows, basis=basis)
