"""Measurement files of LabVIEW (TDMS) and of cars (MDF4), read by npTDMS and asammdf (imported only here)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from ..disk import opened
from ..extras import named_extras
from .channels import UNKNOWN, Channel, Uneven, grid, plain_units, round_rate

# Properties of TDMS.
STEP, OFFSET, UNIT = "wf_increment", "wf_start_offset", "unit_string"


def read_tdms(path: Path, sample_rate: float | None) -> list[Channel]:
    """Return the channels of a TDMS file that hold numbers.

    Raises
    ------
    ValueError
        If it cannot be read, or a channel has no sample rate.
    ImportError
        If the extra ``signals`` is not installed.
    """
    with named_extras():
        import nptdms

    with opened(path) as file:
        try:
            content = nptdms.TdmsFile.read(file)
        except Exception as error:
            raise _unreadable(path, "a TDMS file", error) from error
    groups = content.groups()
    found = []
    for group in groups:
        for channel in group.channels():
            values = channel[:]
            if not len(values) or values.dtype.kind not in "iuf":
                continue
            name = f"{group.name}/{channel.name}" if len(groups) > 1 else channel.name
            said = channel.properties
            if STEP in said:
                rate = round_rate(1.0 / float(said[STEP]), 1e-12)
            elif sample_rate is None:
                raise ArgumentError("sample_rate", "be given for channels without one", got=repr(name), where=str(path))
            else:
                rate = sample_rate
            units = plain_units(str(said.get(UNIT, ""))) or UNKNOWN
            start = float(said.get(OFFSET, 0.0))
            found.append(Channel(name, units, _finite(path, name, values), rate, start))
    return found


def read_mdf(path: Path) -> list[Channel]:
    """Return the channels of an MDF file that hold numbers.

    Raises
    ------
    ValueError
        If it cannot be read, or times of a channel are uneven.
    ImportError
        If the extra ``signals`` is not installed.
    """
    with named_extras():
        import asammdf

    with opened(path):
        pass
    try:
        with asammdf.MDF(str(path)) as content:
            signals: list[Any] = list(content.iter_channels(skip_master=True))
    except Exception as error:
        raise _unreadable(path, "an MDF file", error) from error
    found = []
    for one in signals:
        if one.samples.ndim != 1 or one.samples.dtype.kind not in "iuf" or not one.samples.size:
            continue
        if one.invalidation_bits is not None and np.any(one.invalidation_bits):
            raise ArgumentError(repr(one.name), "have valid samples", got="samples marked invalid", where=str(path))
        try:
            start, rate = grid(np.asarray(one.timestamps, dtype=float), 0.0)
        except Uneven as error:
            raise ValueError(f"{path}, channel {one.name!r}: {error.words}") from None
        units = plain_units(one.unit) or UNKNOWN
        found.append(Channel(one.name, units, _finite(path, one.name, one.samples), rate, start, one.comment))
    return found


def _finite(path: Path, name: str, values: Array) -> Array:
    samples = np.asarray(values, dtype=float)
    wrong = np.flatnonzero(~np.isfinite(samples))
    if wrong.size:
        got = f"{samples[wrong[0]]} at sample {wrong[0]} (from 0)"
        raise ArgumentError(repr(name), "have finite samples", got=got, where=str(path))
    return samples


def _unreadable(path: Path, kind: str, error: Exception) -> ArgumentError:
    reason = " ".join(str(error).split())[:120] or type(error).__name__
    return ArgumentError("path", f"be {kind}", str(path), got=f"{str(path)!r}: {reason}")
