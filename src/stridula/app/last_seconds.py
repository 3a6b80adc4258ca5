"""What was played last, to be saved."""

from __future__ import annotations

import io
import json
from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..acoustics.wav import encoded, normalised_scale, scale_comment
from ..arrays import Array
from ..checks import ArgumentError
from ..records.variables import (
    CONTACT,
    PROBES,
    STATUS,
    STATUS_SHARE,
    STATUS_WORDS,
    attributes_of,
    described,
    status_attributes,
)
from ..version import __version__
from .parts import Part
from .playable import Playable
from .sources import SOURCES

KEPT = 10.0


@dataclass(frozen=True)
class _Kept:
    """A part, in single precision and without its shapes."""

    source: str
    clock: float
    stroke: int
    sound: Array
    contact: dict[str, Array]
    status_share: Array
    acceleration: Array


class LastSeconds:
    """The last ten seconds that were played.

    Parameters
    ----------
    rate : int
        Samples per second [Hz].
    """

    def __init__(self, rate: int) -> None:
        self.rate = rate
        self._parts: deque[_Kept] = deque()
        self._samples = 0
        self._changes: deque[tuple[float, str]] = deque()

    def keep(self, part: Part, source: str) -> None:
        """Keep a part and let go of what is too old."""
        small = {variable.name: part.chunk.contact[variable.name].astype("f4") for variable in (*CONTACT, STATUS)}
        shares, acceleration = part.chunk.status_share.astype("f4"), part.chunk.probes[:, 0].astype("f4")
        kept = _Kept(source, part.clock, part.stroke, part.sound.astype("f4"), small, shares, acceleration)
        self._parts.append(kept)
        self._samples += len(kept.sound)
        while self._samples - len(self._parts[0].sound) >= KEPT * self.rate:
            self._samples -= len(self._parts.popleft().sound)
        while len(self._changes) > 1 and self._changes[1][0] < self._parts[0].clock:
            self._changes.popleft()

    def changed(self, clock: float, toml: str) -> None:
        """Keep what is played from a time on, in place of what would be from the same time on."""
        if self._changes and self._changes[-1][0] == clock:
            self._changes.pop()
        self._changes.append((clock, toml))

    def record(self, played: Playable, steps: int) -> bytes:
        """Return a record of what was played last, as NetCDF.

        Parameters
        ----------
        played : Playable
            What is played now.
        steps : int
            Steps of the march in a sample.

        Raises
        ------
        ValueError
            If nothing was played yet.
        """
        self._check()
        parts = self._parts
        first = round(parts[-1].clock * self.rate) - self._samples
        time = (first + np.arange(1, self._samples + 1)) / self.rate
        shares = np.concatenate([part.status_share for part in parts])
        data: dict[str, Any] = {
            variable.name: (
                "time",
                np.concatenate([part.contact[variable.name] for part in parts]),
                attributes_of(variable),
            )
            for variable in CONTACT
        }
        status = np.concatenate([part.contact[STATUS.name] for part in parts]).astype(np.int8)
        data[STATUS.name] = ("time", status, status_attributes())
        data[STATUS_SHARE.name] = (("time", "contact_status"), shares, attributes_of(STATUS_SHARE))
        probe = np.concatenate([part.acceleration for part in parts])[:, None]
        data["acceleration"] = (("time", "acceleration_probe"), probe, attributes_of(PROBES["acceleration"]))
        strokes = np.concatenate([np.full(len(part.sound), part.stroke, dtype="i4") for part in parts])
        data["stroke"] = ("time", strokes, described("1", "number of the stroke"))
        coordinates: dict[str, Any] = {
            "time": ("time", time, described("s", "time played at the end of the sample interval")),
            "contact_status": ("contact_status", list(STATUS_WORDS)),
            "acceleration_probe": ("acceleration_probe", ["track centre y"]),
        }
        attributes = {
            "title": f"played on the page: {played.scenario.title}",
            "source": f"stridula {__version__}",
            "stridula_version": __version__,
            "scenario": played.toml,
            "changes": json.dumps([{"time": clock, "scenario": toml} for clock, toml in self._changes]),
            "scheme": played.scenario.scheme.name,
            "steps_per_sample": steps,
            "sample_interval": 1.0 / self.rate,
            "ended": "interrupted",
        }
        encoding: Any = {name: {"zlib": True, "complevel": 1, "shuffle": True} for name in data}
        content = io.BytesIO()
        xr.Dataset(data, coordinates, attributes).to_netcdf(content, engine="h5netcdf", encoding=encoding)
        return content.getvalue()

    def wav(self) -> bytes:
        """Return what was heard last as a sound file of 24 bits, 1 dB below full scale, which its comment states.

        Raises
        ------
        ValueError
            If nothing was played yet.
        """
        self._check()
        name = self._parts[-1].source
        heard: list[Array] = []
        for part in reversed(self._parts):
            if part.source != name:
                break
            heard.append(part.sound)
        sound = np.concatenate(heard[::-1]).astype(float)
        sound -= sound.mean() if name == "force" else 0.0
        scale = normalised_scale(float(np.abs(sound).max()))
        if name == "pressure":
            comment = scale_comment(scale, self._parts[-1].clock - len(sound) / self.rate)
        else:
            source = SOURCES[name]
            comment = f"stridula: {source.name.lower()}, full scale is {scale!r} {source.unit}"
        return bytes(encoded(sound[:, None] / scale, self.rate, "PCM_24", comment))

    def _check(self) -> None:
        if not self._parts:
            raise ArgumentError("something", "have been played before it can be saved", got="nothing yet")
