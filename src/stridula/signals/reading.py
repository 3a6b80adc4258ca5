"""Signals from files of other programs, with units, calibration and names of channels."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..checks import ArgumentError, listed, positive
from ..disk import check_path, named
from . import sound_files
from .channels import TIMES, Channel, checked_rate, chosen
from .conversions import factor_of

TABLES = (".csv", ".tsv", ".txt", ".dat", ".asc")
UNIVERSAL = (".uff", ".unv", ".uf", ".58")
TDMS, MDF = (".tdms",), (".mf4", ".mdf")
# Words before the endings in messages.
FORMATS = {"sounds": sound_files.READABLE, "tables": TABLES, "universal files": UNIVERSAL, "others": (*TDMS, *MDF)}


def read_signal(
    path: str | os.PathLike[str],
    channel: str | None = None,
    *,
    calibration: float | str | Mapping[str, float | str] | None = None,
    units: str | Mapping[str, str] | None = None,
    sample_rate: float | None = None,
    decimal: str = ".",
) -> xr.DataArray:
    """Read a channel of a file as a signal.

    The ending of the name selects the format: ``.wav``, ``.flac`` and other sound files; ``.csv``, ``.tsv``, ``.txt``
    and ``.dat``; ``.uff`` and ``.unv`` (dataset 58); ``.tdms`` and ``.mf4`` with the extra ``signals``. Measures and
    figures of signals take the result.

    Parameters
    ----------
    path : str or Path
        The file.
    channel : str, optional
        Name of a channel; needed if the file has several.
    calibration : float, str or mapping, optional
        Value of a sample of 1, in `units`: for a sound file the value of full scale. Or the sensitivity of the sensor
        of a channel in volts, amperes or coulombs: ``"100 mV/g"``. A mapping has one for each channel by its name.
    units : str or mapping, optional
        Units of the result; those of the file or of the sensitivity if left out. Needed with another calibration.
        Units of the same quantity, such as ``m/s2`` for ``g``, are converted. A mapping may also have the units of
        ``time``.
    sample_rate : float, optional
        Sample rate [Hz] of a file that does not state one.
    decimal : {".", ","}, optional
        Decimal mark of a table.

    Returns
    -------
    xarray.DataArray, shape (time,)
        The signal. Its units are ``unknown`` if the file does not state them, and ``FS``, of full scale, for a sound
        file without calibration: levels refuse both.

    Raises
    ------
    ValueError
        If the file cannot be read, or has several channels and `channel` does not choose one; the message has file and
        line.
    OSError
        If the file cannot be opened.
    """
    found = _channels(path, sample_rate, units, decimal)
    names = [one.name for one in found]
    if channel is None and len(found) > 1:
        raise ArgumentError("channel", f"be chosen from {listed(map(repr, names))}", got="none", where=named(path))
    one = found[0] if channel is None else found[chosen(named(path), names, channel)]
    (calibrated,) = _calibrated(path, names, [one], calibration, units)
    return _signal(calibrated)


def read_signals(
    path: str | os.PathLike[str],
    channels: Sequence[str] | None = None,
    *,
    calibration: float | str | Mapping[str, float | str] | None = None,
    units: str | Mapping[str, str] | None = None,
    sample_rate: float | None = None,
    decimal: str = ".",
) -> xr.Dataset:
    """Read all channels of a file, each with its units.

    Parameters
    ----------
    path : str or Path
        The file, as for `read_signal`.
    channels : sequence of str, optional
        Names of the channels; all of them if left out.
    calibration : float, str or mapping, optional
        Value of a sample of 1 or sensitivity, as for `read_signal`.
    units : str or mapping, optional
        Units of the result, as for `read_signal`.
    sample_rate : float, optional
        Sample rate [Hz] of a file that does not state one.
    decimal : {".", ","}, optional
        Decimal mark of a table.

    Returns
    -------
    xarray.Dataset
        A variable over ``time`` for each channel, by its name: ``measured["acceleration"]``.

    Raises
    ------
    ValueError
        If the file cannot be read, or its channels have different times.
    OSError
        If the file cannot be opened.
    """
    found = _channels(path, sample_rate, units, decimal)
    names = [one.name for one in found]
    if channels is not None:
        if isinstance(channels, str) or not isinstance(channels, Sequence) or not channels:
            raise ArgumentError("channels", "be a list of names", channels)
        found = [found[chosen(named(path), names, name)] for name in channels]
    times = {(one.rate, one.start, one.values.size) for one in found}
    if len(times) > 1:
        got = listed(f"{one.name!r} with {one.values.size} at {one.rate:g} Hz from {one.start:g} s" for one in found)
        raise ArgumentError("channels", "have the same times", got=got, where=named(path))
    return xr.Dataset({one.name: _signal(one) for one in _calibrated(path, names, found, calibration, units)})


def _channels(path: Any, sample_rate: float | None, units: Any, decimal: str) -> list[Channel]:
    check_path("path", path)
    file = Path(path)
    ending = file.suffix.lower()
    rate = None if sample_rate is None else positive("sample_rate", sample_rate)
    if units is not None and not isinstance(units, (str, Mapping)):
        raise ArgumentError("units", "be a text, or texts by channel", units)
    by_name = units if isinstance(units, Mapping) else {}
    readers: dict[tuple[str, ...], Callable[[], list[Channel]]] = {
        sound_files.READABLE: lambda: sound_files.read_sound(file),
        TABLES: lambda: _table(file, rate, by_name, decimal),
        UNIVERSAL: lambda: _universal(file),
        TDMS: lambda: _tdms(file, rate),
        MDF: lambda: _mdf(file),
    }
    for endings, reader in readers.items():
        if ending in endings:
            found = reader()
            break
    else:
        known = "; ".join(f"{kind} {' '.join(words)}" for kind, words in FORMATS.items())
        raise ArgumentError("path", f"end as one of {known}", str(path), got=named(path))
    if not found:
        raise ArgumentError("path", "have a channel of numbers", str(path), got=f"none in {named(path)}")
    if ending not in TABLES:
        found = [replace(one, rate=checked_rate(named(path), one.rate, rate)) for one in found]
    return _apart(found)


def _apart(found: list[Channel]) -> list[Channel]:
    """Return channels with different names, none of them that of the times."""
    taken: list[str] = ["time"]
    for one in found:
        name, number = one.name, 1
        while name in taken:
            number += 1
            name = f"{one.name} ({number})"
        taken.append(name)
    return [replace(one, name=name) for one, name in zip(found, taken[1:], strict=True)]


def _table(file: Path, rate: float | None, units: Mapping[str, str], decimal: str) -> list[Channel]:
    from .tables import read_table

    return read_table(file, rate, units, decimal)


def _universal(file: Path) -> list[Channel]:
    from .universal_files import read_universal_signals

    return read_universal_signals(file)


def _tdms(file: Path, rate: float | None) -> list[Channel]:
    from .measurement_files import read_tdms

    return read_tdms(file, rate)


def _mdf(file: Path) -> list[Channel]:
    from .measurement_files import read_mdf

    return read_mdf(file)


def _calibrated(path: Any, names: list[str], found: list[Channel], calibration: Any, units: Any) -> list[Channel]:
    """Return some of the channels of a file in the units of the user."""
    factors = _by_name("calibration", calibration, names, named(path))
    words = _by_name("units", units, [*names, *TIMES], named(path))
    calibrated = []
    for one in found:
        given, word = factors.get(one.name), words.get(one.name)
        factor, plain = factor_of(one.name, one.units, given, word)
        meaning = one.meaning if given is None else ""
        one = replace(one, values=one.values if factor == 1.0 else one.values * factor, units=plain, meaning=meaning)
        calibrated.append(one)
    return calibrated


def _by_name(argument: str, given: Any, names: list[str], path: str) -> dict[str, Any]:
    """Return values by channel from one for all, or from a mapping."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        return dict.fromkeys(names, given)
    for name in given:
        if name not in names and str(name).lower() not in names:
            known = [one for one in names if one not in TIMES]
            raise ArgumentError(argument, f"be by names of channels, {', '.join(map(repr, known))}", got=repr(name))
    return dict(given)


def _signal(one: Channel) -> xr.DataArray:
    time = one.start + np.arange(one.values.size) / one.rate
    words = {"units": one.units, "long_name": one.meaning or one.name}
    return xr.DataArray(one.values, {"time": ("time", time, {"units": "s"})}, ("time",), one.name, words)
