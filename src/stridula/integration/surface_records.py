"""Compact records of surfaces: sums over their points at every sample, maps of the points at a lower rate."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from .._kernels.layout import columns as at
from ..arrays import Array
from ..records.by_surface import groups
from ..records.dataset import OVER_TIME
from ..records.resultants import AXES, RESULTANTS, resultants
from ..records.variables import (
    STATUS,
    STATUS_SHARE,
    TEMPERATURE,
    attributes_of,
    described,
    dominant_status,
    status_attributes,
)
from ..system import System
from .point_records import PointRecord

# Columns that are summed over the points of a surface; all others are averaged.
SUMMED = (at.NORMAL_FORCE, at.TANGENTIAL_FORCE, at.TANGENTIAL_FORCE_B, at.JAMMED, at.LANDINGS)
SLIPS = [at.SLIP_VELOCITY, at.SLIP_VELOCITY_B]
SHARES = slice(at.SEPARATED, at.SLIDING + 1)
# Variables of maps, means over an interval; that of the temperature where a contact is heated.
MAPPED = ("normal_force", "tangential_force", "slip_velocity", STATUS_SHARE.name, STATUS.name)
MAP = "map_"
# Value in place of a rate of maps to record all points of surfaces as contacts.
ALL_POINTS = "all"


class SurfaceRecord:
    """The compact record of the surfaces of a run, chunk by chunk.

    Parameters
    ----------
    system : System
        The system.
    every : int
        Samples in an interval of maps.
    points : PointRecord, optional
        Record of the points at every sample, if wanted.
    """

    def __init__(self, system: System, every: int, points: PointRecord | None = None) -> None:
        self.every, self.points = every, points
        members = groups(system.contact_names, system.surface_names)
        self.shown = tuple(one[0] for one in members)
        self.names = tuple(system.surface_names[one[0]] or system.contact_names[one[0]] for one in members)
        self._members = [np.array(one) for one in members]
        self._points = np.flatnonzero(np.array([bool(name) for name in system.surface_names]))
        self._surfaces = [system.surface_names[number] for number in self._points]
        self._point_names = [system.contact_names[number] for number in self._points]
        self._faces = system.faces
        is_heated = any(contact.heating is not None for contact in system.contacts)
        self._mapped = (*MAPPED, TEMPERATURE.name) if is_heated else MAPPED
        numbers = {name: number for number, name in enumerate(system.contact_names)}
        self._of_face = [[numbers[point.name] for point in face.contacts] for face in self._faces]
        self._resultants: list[list[dict[str, Array]]] = [[] for _ in self._faces]
        self._maps: list[dict[str, Array]] = []
        self._waiting = np.empty((0, len(system.contacts), at.COLUMNS))
        # A run may be interrupted before its first chunk.
        self.take(self._waiting)

    def take(self, contacts: Array) -> Array:
        """Record a chunk, (samples, contacts, columns), and return it with each surface as one contact."""
        for face, numbers, kept in zip(self._faces, self._of_face, self._resultants, strict=True):
            normal, tangential, slip, share = self._of_points(contacts, np.array(numbers))
            kept.append(resultants(face, normal, tangential, share, slip))
        if self.points is not None:
            normal, tangential, _, share = self._of_points(contacts, self._points)
            landings = contacts[:, self._points, at.LANDINGS]
            self.points.take(normal, tangential, share, landings)
        self._keep_maps(contacts)
        found = np.stack([contacts[:, one].mean(axis=1) for one in self._members], axis=1)
        for column in SUMMED:
            found[..., column] = np.stack([contacts[:, one, column].sum(axis=1) for one in self._members], axis=1)
        found[..., at.DOMINANT] = dominant_status(found[..., SHARES])
        return found

    def _of_points(self, contacts: Array, numbers: Array) -> tuple[Array, Array, Array, Array]:
        """Return normal and tangential forces, slip velocities and status shares of some contacts."""
        own = contacts[:, numbers]
        tangential, slip = own[..., [at.TANGENTIAL_FORCE, at.TANGENTIAL_FORCE_B]], own[..., SLIPS]
        return own[..., at.NORMAL_FORCE], tangential, slip, own[..., SHARES]

    def _keep_maps(self, contacts: Array) -> None:
        waiting = np.concatenate([self._waiting, contacts])
        whole = len(waiting) // self.every
        for interval in waiting[: whole * self.every].reshape(whole, self.every, *waiting.shape[1:]):
            normal, tangential, slip, share = (one.mean(axis=0) for one in self._of_points(interval, self._points))
            temperature = interval[:, self._points, at.HOT].mean(axis=0)
            found = (normal, tangential, slip, share, dominant_status(share), temperature)
            self._maps.append(dict(zip(self._mapped, found, strict=False)))
        self._waiting = waiting[whole * self.every :].copy()

    def add_to(self, record: xr.Dataset, start: float, interval: float) -> xr.Dataset:
        """Return a record with the maps, over ``map_time``, and the resultants of surfaces, over ``face``.

        `start` is the time at which the run begins and `interval` its sample interval [s].
        """
        times = start + interval * self.every * np.arange(1, len(self._maps) + 1)
        beyond = {"tangential_force": "tangent", "slip_velocity": "tangent", STATUS_SHARE.name: "contact_status"}
        data: dict[str, Any] = {}
        for name in self._mapped:
            after = (beyond[name],) if name in beyond else ()
            empty = np.empty((0, len(self._points), *(record.sizes[one] for one in after)))
            values = np.stack([one[name] for one in self._maps]) if self._maps else empty
            words = status_attributes() if name == STATUS.name else attributes_of(OVER_TIME[name])
            data[MAP + name] = (("map_time", "point", *after), values, words)
        if self.points is not None:
            data |= self.points.variables()
        coordinates: dict[str, Any] = {
            "map_time": ("map_time", times, described("s", "time at the end of the interval of a map")),
            "point": ("point", self._point_names),
            "point_surface": ("point", self._surfaces),
        }
        if self._faces:
            coordinates |= {"face": ("face", [face.name for face in self._faces]), "axis": ("axis", list(AXES))}
            for name, meaning in RESULTANTS.items():
                values = np.stack([np.concatenate([part[name] for part in kept]) for kept in self._resultants], axis=1)
                data[f"surface_{name}"] = (("time", "face", "axis")[: values.ndim], values, described(*meaning))
        return record.assign(data).assign_coords(coordinates)
