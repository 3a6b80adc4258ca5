"""The last seconds played, for saving."""

from __future__ import annotations

import io
import json
from collections import deque
from copy import copy
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..acoustics.wav import normalised_scale, scale_comment
from ..arrays import Array
from ..checks import ArgumentError
from ..records.by_surface import groups
from ..records.dataset import probe_label
from ..records.variables import (
    ALONG_TANGENTS,
    CONTACT,
    ENERGY,
    PROBES,
    STATUS,
    STATUS_SHARE,
    STATUS_WORDS,
    TANGENTS,
    attributes_of,
    described,
    status_attributes,
)
from ..signals.sound_files import encoded
from ..version import __version__
from .parts import Part
from .playable import Playable
from .sources import Source

KEPT = 10.0
# Largest number of values kept for contacts: with many contacts, fewer seconds are kept.
MOST_NUMBERS = 60_000_000
# Energies that decide a regime: those that are computed, and those that are kept.
MARCHED = ("damping_loss", "friction_loss", "convection_work", "contact_work")
LOSSES = ("damping_loss", "friction_loss", "impact_loss")


@dataclass(frozen=True)
class _Kept:
    """A part in single precision without its shapes; contacts come before samples, tangents in space last."""

    source: Source
    clock: float
    stroke: int
    sound: Array
    contacts: dict[str, Array]
    status_shares: Array
    probes: Array
    # Energy lost in each sample, and energy lost from the start or last change of the march to the end of the part.
    losses: Array
    lost: Array


class LastSeconds:
    """The last ten seconds played.

    Parameters
    ----------
    rate : int
        Samples per second [Hz].
    played : Playable
        Scenario that is played.
    """

    def __init__(self, rate: int, played: Playable) -> None:
        self.rate, self.played = rate, played
        self._parts: deque[_Kept] = deque()
        self._samples = 0
        self._changes: deque[tuple[float, Playable]] = deque()

    def copy(self) -> LastSeconds:
        """Return the same seconds, to which later parts are not added."""
        other = copy(self)
        other._parts, other._changes = copy(self._parts), copy(self._changes)
        return other

    def goes_on_as(self, played: Playable) -> None:
        """Change the scenario; if its contacts or probes differ, discard everything kept so far."""
        before, after = self.played, played
        if (_labels(before), before.system.has_two_tangents) != (_labels(after), after.system.has_two_tangents):
            self._parts.clear()
            self._samples = 0
        self.played = played

    @property
    def seconds(self) -> float:
        """Duration that is kept [s]."""
        numbers = (len(CONTACT) + 4) * len(self.played.system.contacts) * self.rate
        return min(KEPT, MOST_NUMBERS / numbers)

    @property
    def steady(self) -> float:
        """Time played since the last change [s]."""
        return self._parts[-1].clock - self._changes[-1][0] if self._parts else 0.0

    def keep(self, part: Part, source: Source) -> None:
        """Keep a part in place of any kept for the same time, and discard those that are too old."""
        begins = part.clock - part.samples / self.rate
        while self._parts and self._parts[-1].clock > begins + 0.5 / self.rate:
            self._samples -= len(self._parts.pop().sound)
        chunk = part.chunk
        recorded = chunk.contacts | chunk.along_tangents
        small = {variable.name: recorded[variable.name].astype("f4") for variable in (*CONTACT, STATUS)}
        shares, probes = chunk.status_shares.astype("f4"), chunk.probes.astype("f4")
        damping, rubbed, convected, contact = (chunk.energies[name] for name in MARCHED)
        lost = np.stack([damping, rubbed, convected - rubbed - contact])
        losses = np.diff(lost, prepend=self._lost_before(part, begins)[:, None])
        sound = part.sound.astype("f4")
        kept = _Kept(source, part.clock, part.stroke, sound, small, shares, probes, losses, lost[:, -1].copy())
        self._parts.append(kept)
        self._samples += len(kept.sound)
        while self._samples - len(self._parts[0].sound) >= self.seconds * self.rate:
            self._samples -= len(self._parts.popleft().sound)
        while len(self._changes) > 1 and self._changes[1][0] < self._parts[0].clock:
            self._changes.popleft()

    def _lost_before(self, part: Part, begins: float) -> Array:
        """Return the energies lost before a part since the march began or was changed."""
        is_changed = self._changes[-1][0] > begins - 0.5 / self.rate
        if is_changed or not self._parts or self._parts[-1].stroke != part.stroke:
            return np.zeros(len(LOSSES))
        return self._parts[-1].lost

    def changed(self, clock: float, played: Playable) -> None:
        """Keep the scenario played from a time on, in place of an earlier one for the same time."""
        while self._changes and self._changes[-1][0] >= clock:
            self._changes.pop()
        self._changes.append((clock, played))

    def record(self, played: Playable, steps: int) -> bytes:
        """Return a record of the last seconds, as NetCDF.

        Parameters
        ----------
        played : Playable
            Scenario that is played now.
        steps : int
            Time steps per sample.

        Raises
        ------
        ValueError
            If nothing has been played yet.
        """
        self._check()
        parts, (contacts, probes) = self._parts, _labels(played)
        first = round(parts[-1].clock * self.rate) - self._samples
        time = (first + np.arange(1, self._samples + 1)) / self.rate
        over = ("time", "contact") if len(contacts) > 1 else ("time",)
        is_spatial = played.system.has_two_tangents
        data: dict[str, Any] = {}
        for variable in CONTACT:
            along = ("tangent",) if is_spatial and variable.name in ALONG_TANGENTS else ()
            data[variable.name] = ((*over, *along), self._joined(variable.name), attributes_of(variable))
        data[STATUS.name] = (over, self._joined(STATUS.name).astype(np.int8), status_attributes())
        shares = np.concatenate([part.status_shares for part in parts], axis=1).swapaxes(0, 1)
        shares = shares if len(contacts) > 1 else shares[:, 0]
        data[STATUS_SHARE.name] = ((*over, "contact_status"), shares, attributes_of(STATUS_SHARE))
        lost = np.cumsum(np.concatenate([part.losses for part in parts], axis=1), axis=1)
        known = {variable.name: attributes_of(variable) for variable in ENERGY}
        data |= {name: ("time", values, known[name]) for name, values in zip(LOSSES, lost, strict=True)}
        coordinates: dict[str, Any] = {
            "time": ("time", time, described("s", "time played at the end of the sample interval")),
            "contact_status": ("contact_status", list(STATUS_WORDS)),
        }
        if len(contacts) > 1:
            coordinates["contact"] = ("contact", list(contacts))
        if played.system.surface_names:
            coordinates["surface"] = ("contact", list(played.system.surface_names))
        if is_spatial:
            coordinates["tangent"] = ("tangent", list(TANGENTS))
        probed = np.concatenate([part.probes for part in parts])
        for quantity in dict.fromkeys(quantity for quantity, _ in probes):
            of_it = [k for k, (other, _) in enumerate(probes) if other == quantity]
            data[quantity] = (("time", f"{quantity}_probe"), probed[:, of_it], attributes_of(PROBES[quantity]))
            coordinates[f"{quantity}_probe"] = (f"{quantity}_probe", [probes[k][1] for k in of_it])
        strokes = np.concatenate([np.full(len(part.sound), part.stroke, dtype="i4") for part in parts])
        data["stroke"] = ("time", strokes, described("1", "number of the stroke"))
        attributes = {
            "title": f"played on the page: {played.scenario.title}",
            "source": f"stridula {__version__}",
            "stridula_version": __version__,
            "scenario": played.toml,
            "changes": json.dumps([{"time": clock, "scenario": one.toml} for clock, one in self._changes]),
            "scheme": played.scenario.scheme.name,
            "steps_per_sample": steps,
            "sample_interval": 1.0 / self.rate,
            "ended": "interrupted",
        }
        encoding: Any = {name: {"zlib": True, "complevel": 1, "shuffle": True} for name in data}
        content = io.BytesIO()
        xr.Dataset(data, coordinates, attributes).to_netcdf(content, engine="h5netcdf", encoding=encoding)
        return content.getvalue()

    def moment(self, seconds: float) -> tuple[dict[str, Array], Array]:
        """Return the variables that decide the regime of the last seconds of this stroke, and their sound pressure.

        Parameters
        ----------
        seconds : float
            Largest duration [s].

        Returns
        -------
        variables : dict
            By the names of records, over time, and over contacts if there are several; each surface is one.
        pressure : ndarray, shape (samples,)
            Sound pressure [Pa], empty if another source was played.
        """
        parts: deque[_Kept] = deque()
        samples = 0
        for part in reversed(self._parts):
            if part.stroke != self._parts[-1].stroke or samples >= seconds * self.rate:
                break
            parts.appendleft(part)
            samples += len(part.sound)
        if not parts:
            return {}, np.zeros(0)
        lost = np.cumsum(np.concatenate([one.losses for one in parts], axis=1), axis=1)
        variables: dict[str, Array] = dict(zip(LOSSES, lost, strict=True))
        members = groups(self.played.system.contact_names, self.played.system.surface_names)
        for name in ("normal_force", "tangential_force", "landings"):
            of_contacts = np.concatenate([one.contacts[name] for one in parts], axis=1)
            variables[name] = np.stack([of_contacts[those].sum(axis=0) for those in members], axis=1)
        shares = np.concatenate([one.status_shares for one in parts], axis=1)
        variables["status_share"] = np.stack([shares[those].mean(axis=0) for those in members], axis=1)
        if len(members) == 1:
            for name in ("normal_force", "tangential_force", "landings", "status_share"):
                variables[name] = variables[name][:, 0]
        sound = [one.sound for one in parts if one.source.unit == "Pa"]
        return variables, np.concatenate(sound) if len(sound) == len(parts) else np.zeros(0)

    def wav(self) -> bytes:
        """Return the last sound as a file of 24 bits, 1 dB below full scale, which its comment states.

        Raises
        ------
        ValueError
            If nothing has been played yet.
        """
        self._check()
        source = self._parts[-1].source
        heard: list[Array] = []
        for part in reversed(self._parts):
            if part.source != source:
                break
            heard.append(part.sound)
        sound = np.concatenate(heard[::-1]).astype(float)
        sound -= sound.mean() if source.unit == "N" else 0.0
        scale = normalised_scale(float(np.abs(sound).max()))
        if source.unit == "Pa":
            comment = scale_comment(scale, self._parts[-1].clock - len(sound) / self.rate)
        else:
            comment = f"stridula: {source.name.lower()}, full scale is {scale!r} {source.unit}"
        return bytes(encoded(sound[:, None] / scale, self.rate, "PCM_24", comment))

    def _joined(self, name: str) -> Array:
        """Return a variable of the contacts over time, over contacts if there are several, and over tangents last."""
        found = np.concatenate([part.contacts[name] for part in self._parts], axis=1)
        return found.swapaxes(0, 1) if len(found) > 1 else found[0]

    def _check(self) -> None:
        if not self._parts:
            raise ArgumentError("page", "have played something before it can save", got="nothing yet")


def _labels(played: Playable) -> tuple[tuple[str, ...], tuple[tuple[str, str], ...]]:
    """Return the names of the contacts, and quantity and label of each probe."""
    system = played.system
    if played.before is None:
        return system.contact_names, (("acceleration", "track centre y"),)
    probes = tuple((probe.quantity, probe_label(probe, system)) for probe in played.probes)
    return system.contact_names, probes
