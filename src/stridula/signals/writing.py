"""Signals written to sound files, tables and universal files."""

from __future__ import annotations

import io
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, at_least, choice, positive
from ..disk import check_path, check_writable, named, write
from .channels import FULL_SCALE, UNKNOWN, round_rate
from .sound_files import FORMATS, STEPS, encoded

TABLES, UNIVERSAL = (".csv",), (".uff", ".unv")
NORMALISED = "normalised"
# Peak of a normalised file below full scale [dB].
HEADROOM = 1.0
# Fraction of the sample interval by which samples may be off an even grid.
EVEN = 1e-3
MP3_RATES = (8000, 11025, 12000, 16000, 22050, 24000, 32000, 44100, 48000)
# Types of data in universal files by their units.
KINDS = {"m": 8, "m/s": 11, "m/s2": 12, "N": 13, "Pa": 15}
TIME = 17
WIDE = 20


def write_signal(
    path: str | os.PathLike[str],
    signal: xr.DataArray | xr.Dataset,
    *,
    full_scale: float | str = NORMALISED,
    subtype: str = "PCM_24",
) -> None:
    """Write signals to a file, in the format of its ending.

    The ending of the name selects the format: ``.wav``, ``.flac`` and ``.mp3``; ``.csv``; ``.uff`` and ``.unv``
    (dataset 58 in double precision). `read_signal` and `read_signals` read the file back in the same units. A sound
    file has the value of full scale in its comment; the samples of an MP3 file are only nearly the same.

    Parameters
    ----------
    path : str or Path
        The file, written whole or not at all.
    signal : xarray.DataArray or Dataset
        A signal over ``time``, one with a second dimension of channels, or signals by name.
    full_scale : float or "normalised", optional
        Value of full scale of a sound file, in the units of the signal; or ``"normalised"``: the peak is 1 dB below it.
    subtype : {"PCM_24", "PCM_16", "FLOAT"}, optional
        Numbers of a sound file; FLAC has integers, MP3 a form of its own.

    Raises
    ------
    ValueError
        If the signal is uneven over time, has values that are not finite, or would be clipped; or if the format has not
        its sample rate.
    OSError
        If the file cannot be written.
    """
    check_path("path", path)
    ending = Path(path).suffix.lower()
    if ending not in (*FORMATS, *TABLES, *UNIVERSAL):
        known = " ".join((*FORMATS, *TABLES, *UNIVERSAL))
        raise ArgumentError("path", f"end as one of {known}", str(path), got=named(path))
    columns = _columns(signal)
    start, rate = _times(signal)
    check_writable(Path(path))
    if ending in TABLES:
        content: Any = _table(columns, start, rate)
    elif ending in UNIVERSAL:
        content = _universal(columns, start, rate)
    else:
        content = _sound(columns, start, rate, FORMATS[ending], full_scale, subtype)
    write(path, content)


def _columns(signal: Any) -> list[xr.DataArray]:
    """Return the signals to write, each over time alone, with their names and units."""
    if isinstance(signal, xr.Dataset):
        found = [signal[name] for name in signal.data_vars if signal[name].dims == ("time",)]
        left_out = [str(name) for name in signal.data_vars if signal[name].dims != ("time",)]
        if left_out or not found:
            raise ArgumentError("signal", "have variables over time alone", got=", ".join(left_out) or "none")
    elif isinstance(signal, xr.DataArray) and signal.dims[:1] == ("time",) and signal.ndim <= 2:
        found = [signal] if signal.ndim == 1 else _each(signal)
    else:
        got = f"the dimensions {', '.join(map(str, signal.dims))}" if isinstance(signal, xr.DataArray) else None
        raise ArgumentError("signal", "be a signal over time, or signals by name", signal, got=got)
    for one in found:
        if one.dtype.kind not in "fiu" or not np.isfinite(one.values).all():
            raise ArgumentError("signal", "have finite numbers", got=f"others in {one.name!r}")
    return found


def _each(signal: xr.DataArray) -> list[xr.DataArray]:
    other = str(signal.dims[1])
    names = [str(word) for word in signal[other].values] if other in signal.coords else range(1, signal.shape[1] + 1)
    return [
        signal[:, k].rename(f"{other} {name}" if str(name).isdigit() else str(name)) for k, name in enumerate(names)
    ]


def _times(signal: xr.DataArray | xr.Dataset) -> tuple[float, float]:
    if "time" not in signal.coords or signal.sizes["time"] < 2:
        raise ArgumentError("signal", "have the coordinate time [s] of at least 2 samples", got="none")
    time = signal["time"].values.astype(float)
    interval = float((time[-1] - time[0]) / (time.size - 1))
    if not interval > 0.0 or np.abs(np.diff(time) - interval).max() > EVEN * interval:
        raise ArgumentError("signal", "be evenly sampled over time", got="uneven times")
    return float(time[0]), round_rate(1.0 / interval, 1e-11)


def _units(one: xr.DataArray) -> str:
    return str(one.attrs.get("units", "Pa" if "listener" in one.coords else UNKNOWN))


def _names(columns: Sequence[xr.DataArray]) -> list[str]:
    return [str(one.name or f"channel {number}") for number, one in enumerate(columns, 1)]


def _table(columns: Sequence[xr.DataArray], start: float, rate: float) -> bytes:
    heads = [f"{name} [{_units(one)}]" for name, one in zip(_names(columns), columns, strict=True)]
    for head in heads:
        if any(mark in head for mark in ',;\t"\n'):
            raise ArgumentError("signal", "have names without commas, semicolons and quotes", head)
    text = io.StringIO(newline="")
    text.write(",".join(["time [s]", *heads]) + "\n")
    time = start + np.arange(columns[0].size) / rate
    series = [time.tolist(), *(one.values.tolist() for one in columns)]
    text.writelines(",".join(map(repr, row)) + "\n" for row in zip(*series, strict=True))
    return text.getvalue().encode("utf-8")


def _universal(columns: Sequence[xr.DataArray], start: float, rate: float) -> bytes:
    lines: list[str] = []
    for number, (name, one) in enumerate(zip(_names(columns), columns, strict=True), 1):
        units = "NONE" if _units(one) == UNKNOWN else _units(one)
        if len(name.encode()) > 80 or len(units.encode()) > WIDE:
            raise ArgumentError("signal", "have a name of 80 and units of 20 bytes at most", name)
        kind = KINDS.get(units, 0)
        lines += ["    -1", f"{58:6d}", f"{name:<80}", *["NONE".ljust(80)] * 4]
        lines.append(f"{1:5d}{0:10d}{1:5d}{0:10d} {'NONE':<10}{number:10d}{0:4d} {'NONE':<10}{0:10d}{0:4d}")
        lines.append(f"{4:10d}{one.size:10d}{1:10d}{start:13.6E}{1.0 / rate:13.6E}{0.0:13.5E}")
        lines.append(_axis(TIME, "time", "s"))
        lines.append(_axis(kind, "NONE", units))
        lines += [_axis(0, "NONE", "NONE")] * 2
        words = [f"{value:20.12E}" for value in one.values.astype(float)]
        lines += ["".join(words[k : k + 4]) for k in range(0, len(words), 4)]
        lines.append("    -1")
    return ("\n".join(lines) + "\n").encode("utf-8")


def _axis(kind: int, label: str, units: str) -> str:
    return f"{kind:10d}{0:5d}{0:5d}{0:5d} {label:<20} {units:<20}"


def _sound(
    columns: Sequence[xr.DataArray], start: float, rate: float, form: str, full_scale: float | str, subtype: str
) -> memoryview:
    choice("subtype", subtype, ("PCM_24", "PCM_16", "FLOAT"))
    units = {_units(one) for one in columns}
    if len(units) > 1:
        raise ArgumentError("signal", "have one unit in a sound file", got=", ".join(sorted(units)))
    (unit,) = units
    if rate != round(rate) or (form == "MP3" and rate not in MP3_RATES):
        allowed = "be sampled at a whole number of hertz" if form != "MP3" else f"be sampled at one of {MP3_RATES} Hz"
        raise ArgumentError("signal", allowed, got=f"{rate:.9g} Hz")
    values: Array = np.stack([one.values.astype(float) for one in columns], axis=1)
    peak = float(np.abs(values).max())
    if isinstance(full_scale, str):
        choice("full_scale", full_scale, (NORMALISED,))
        scale = peak * 10.0 ** (HEADROOM / 20.0) or 1.0
    else:
        scale = positive("full_scale", full_scale)
    if unit == FULL_SCALE:
        scale = 1.0
    if form == "FLAC" and subtype == "FLOAT":
        raise ArgumentError("subtype", "be PCM_24 or PCM_16 for FLAC", subtype)
    subtype = "MPEG_LAYER_III" if form == "MP3" else subtype
    share = 1.0 - 1.0 / STEPS.get(subtype, np.inf)
    if subtype != "FLOAT" and peak > scale * share:
        least = at_least(peak / share)
        raise ArgumentError("full_scale", f"be at least {least} {unit} for a peak of {peak:.6g} {unit}", scale)
    comment = f"stridula: full_scale={scale!r} units={unit} start_second={start!r}"
    if unit == "Pa":
        comment = f"stridula: full_scale_pascal={scale!r} start_second={start!r}"
    return encoded(values / scale, round(rate), subtype, comment if unit != FULL_SCALE else "", form)
