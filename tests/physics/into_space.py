"""Systems of the plane as systems in space, under a rotation of the world."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import xarray as xr

import stridula as st
from stridula.connections import ends, unit
from stridula.system import System


@dataclass
class IntoSpace:
    """Converter of systems of the plane: bodies placed in space, all that acts on them along rotated directions.

    A point mass becomes a rigid body, which also moves across the plane; a reduced body stays one, tracks lie in
    another plane, and other bodies are placed there. `across` is the largest force across the plane over the largest
    normal force, of all runs.
    """

    rotation: np.ndarray
    runs: int = 0
    across: float = 0.0
    _bodies: dict[Any, Any] = field(default_factory=dict)

    def system(self, flat: System, probes: Sequence[Any] = ()) -> tuple[System, list[Any]]:
        """Return a system and probes of the plane as those in space."""
        self._bodies = {body: self._body(body, points) for body, points in _points(flat, probes).items()}
        contacts = [self._contact(one) for one in flat.contacts]
        drives = [self._drive(one) for one in flat.drives]
        return System(contacts, drives, [self._joint(one) for one in flat.connections]), [
            self._probe(one) for one in probes
        ]

    def simulate(self, flat: System, *args: Any, probes: Any = None, **words: Any) -> xr.Dataset:
        """Run a system of the plane in space, and return a record as of the plane."""
        system, turned = self.system(flat, probes or ())
        run = st.simulate(system, *args, probes=turned, **words)
        self.runs += 1
        pressed = float(run["normal_force"].max())
        if pressed > 0.0:
            pulled = float(np.abs(run["tangential_force"].isel(tangent=1)).max())
            self.across = max(self.across, pulled / pressed)
        return run.isel(tangent=0, drop=True)

    def sliding_stability(self, flat: System, **words: Any) -> xr.Dataset:
        """Return the small motions of a system of the plane in space."""
        self.runs += 1
        return st.sliding_stability(self.system(flat)[0], **words)

    def mode_sensitivity(self, flat: System, *args: Any, **words: Any) -> xr.Dataset:
        """Return the derivatives of the small motions of a system of the plane in space."""
        self.runs += 1
        return st.mode_sensitivity(self.system(flat)[0], *args, **words)

    def mode_probability(self, flat: Any, *args: Any, **words: Any) -> xr.Dataset:
        """Return the probabilities of the systems that a function makes in the plane, in space."""
        self.runs += 1

        def made(**values: float) -> System:
            return self.system(flat(**values))[0]

        return st.mode_probability(made, *args, **words)

    def turned(self, components: Any) -> tuple[float, ...]:
        """Return the components in space of a vector of the plane."""
        given = np.asarray(components, dtype=float)
        return tuple((self.rotation[:, : given.size] @ given).tolist())

    def _along(self, components: Any) -> dict[str, float]:
        return dict(zip("xyz", self.turned(components), strict=True))

    def _body(self, body: Any, points: dict[str, Any]) -> Any:
        if isinstance(body, st.PointMass):
            return st.RigidBody(body.mass, name=body.name)
        if isinstance(body, st.ReducedBody):
            rows = {name: self.rotation[:, :2] @ given for name, given in body.points.items()}
            moved = None if body.translation is None else self.rotation[:, :2] @ body.translation
            return replace(body, points=rows, translation=moved)
        x, y = self.rotation[:, 0].tolist(), self.rotation[:, 1].tolist()
        if st.bodies.is_track(body):
            return replace(body, plane=(x, y))
        return st.ModalBody.placed(body, points, x, y)

    def _point(self, point: Any) -> Any:
        body = self._bodies[point.body]
        return body.at(point.position if body.has_positions else point.label)

    def _contact(self, contact: Any) -> Any:
        tip = self._point(contact.tip)
        if contact.path_body is not None:
            return replace(contact, tip=tip, track=self._bodies[contact.path_body])
        track = contact.track if contact.touched_point is None else self._point(contact.track)
        normal, tangent = (self.turned(along) for along in contact.frame)
        return replace(contact, tip=tip, track=track, inclination=0.0, normal=normal, tangent=tangent)

    def _drive(self, drive: Any) -> Any:
        if drive.push is not None:
            history, point, components = drive.push
            return st.Force(self._point(point), history=history, **self._along(components))
        if drive.fall is not None:
            return st.Gravity(float(np.linalg.norm(drive.fall)), direction=self.turned(drive.fall))
        if drive.acted_on is None:
            return drive
        body = self._bodies[drive.acted_on]
        if drive.uniform_velocity is not None:
            return st.InitialVelocity(body, **self._along(drive.uniform_velocity))
        turns = isinstance(drive.acted_on, st.PointMass)
        vectors = {name: self.turned(given) if turns else given for name, given in drive.vectors.items()}
        return st.InitialState(body, **vectors)

    def _joint(self, joint: Any) -> Any:
        second = None if joint.second is None else self._point(joint.second)
        return replace(joint, first=self._point(joint.first), second=second, direction=self.turned(unit(joint)))

    def _probe(self, probe: Any) -> Any:
        if isinstance(probe, st.SupportForce):
            return replace(probe, body=self._bodies[probe.body])
        return replace(probe, point=self._point(probe.point), direction=self.turned(probe.along))


def _points(flat: System, probes: Sequence[Any]) -> dict[Any, dict[str, Any]]:
    """Return the positions used on each body, by their names in space."""
    found: dict[Any, dict[str, Any]] = {body: {} for body in flat.bodies}
    points = [point for contact in flat.contacts for point in (contact.tip, contact.touched_point) if point is not None]
    points += [drive.push[1] for drive in flat.drives if drive.push is not None]
    points += [point for joint in flat.connections for point in ends(joint)]
    for point in points + [probe.point for probe in probes if hasattr(probe, "point")]:
        found[point.body][point.label] = point.position
    return found
