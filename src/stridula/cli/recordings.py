"""`stridula signal`: channels, levels, tones, regime and squeals of recordings."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..acoustics import levels, squeals
from ..acoustics.levels import equivalent_level, sound_level
from ..analysis import tones, vibration_bursts, vibration_regime
from ..analysis.vibrations import QUIET
from ..checks import ArgumentError, counted
from ..disk import check_ending, write
from ..scenarios.quantities import quantity
from ..signals import read_signal, read_signals
from .consoles import wide_console
from .outputs import check_outputs

# Tones that are shown, and the range below the strongest in which they lie [dB].
MOST_TONES, RANGE = 3, 30.0
# Squeals that are shown.
MOST_SQUEALS = 20
OPTIONS = {
    "path": "FILE",
    "channel": "--channel",
    "channels": "--channel",
    "calibration": "--calibration",
    "units": "--units",
    "sample_rate": "--sample-rate",
    "lowest": "--lowest",
}
PASCAL = "Pa"
# Units of speeds, which do not vibrate.
SPEEDS = ("rpm", "1/min", "rad/s")
HEADS = ("file", "channel", "rate [Hz]", "time [s]", "units", "rms", "peak")
MEASURES = ("level", "tones [Hz]", "regime, confidence", "bursts")
NUMBERS = ("rate [Hz]", "time [s]", "rms", "peak", "bursts")
# Numbers of a squeal that are shown, with their decimals, and those of the table.
SHOWN = {"start": 2, "duration": 2, "frequency": 0, "level": 1}
COLUMNS = ("event_stop", "start", "end", "duration", "frequency", "level")


def print_signals(
    paths: Sequence[str], channel: str | None, options: Mapping[str, str | None], out: str | None, plot: str | None
) -> None:
    """Print what recordings are, and write their squeals.

    Parameters
    ----------
    paths : sequence of str
        The files.
    channel : str or None
        The channel to read alone.
    options : mapping
        Texts of ``--calibration``, ``--units``, ``--sample-rate`` and ``--lowest``.
    out, plot : str or None
        Table and figure of the squeals.

    Raises
    ------
    ValueError
        If a file or an option is not usable, or there is no sound for the table or the figure.
    OSError
        If a file cannot be read or written.
    """
    check_outputs(out, plot)
    if out is not None:
        check_ending("--out", out, (".csv",), "table")
    given = _given(options)
    files: dict[str, dict[str, xr.DataArray]] = {}
    sounds: dict[str, xr.DataArray] = {}
    for path in paths:
        try:
            found = _read(path, channel, given)
        except ArgumentError as error:
            raise error.renamed(OPTIONS.get(error.argument, error.argument)) from None
        files[path] = found
        for name, one in found.items():
            if one.attrs["units"] == PASCAL:
                sounds[f"{Path(path).name} {name}" if len(found) > 1 else Path(path).name] = one
    _print_channels(files)
    if sounds:
        _print_squeals(sounds, given.get("lowest", squeals.LOWEST), out, plot)
    elif out is not None or plot is not None:
        option, file = ("--out", out) if out is not None else ("--plot", plot)
        raise ArgumentError(option, "have a channel in Pa, whose squeals it shows", file, got="none")


def _given(options: Mapping[str, str | None]) -> dict[str, Any]:
    """Return the options as arguments."""
    given: dict[str, Any] = {}
    for option, unit in (("--sample-rate", "Hz"), ("--lowest", "Hz")):
        text = options[option]
        if text is not None:
            given[option[2:].replace("-", "_")] = quantity(text, unit, option)
    if options["--calibration"] is not None:
        try:
            given["calibration"] = float(options["--calibration"])
        except ValueError:
            raise ArgumentError("--calibration", "be a number", options["--calibration"]) from None
    if options["--units"] is not None:
        given["units"] = options["--units"]
    return given


def _read(path: str, channel: str | None, given: Mapping[str, Any]) -> dict[str, xr.DataArray]:
    """Return the channels of a file by name."""
    words = {key: value for key, value in given.items() if key != "lowest"}
    if channel is not None:
        return {channel: read_signal(path, channel, **words)}
    if "calibration" in words or "units" in words:
        # One value is for a file of one channel.
        one = read_signal(path, **words)
        return {str(one.name): one}
    return {str(name): one for name, one in read_signals(path, **words).items()}


def _print_channels(files: Mapping[str, Mapping[str, xr.DataArray]]) -> None:
    """Print a line for each channel of all files."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for head in (*HEADS, *MEASURES):
        table.add_column(escape(head), justify="right" if head in NUMBERS else "left")
    for path, found in files.items():
        for name, one in found.items():
            table.add_row(*map(escape, (Path(path).name, name, *_facts(one))))
    wide_console().print(table)


def _facts(one: xr.DataArray) -> tuple[str, ...]:
    """Return rate, duration, units and measures of a channel in words."""
    values = one.values - one.values.mean()
    size = f"{np.sqrt(np.mean(values**2)):.4g}", f"{np.abs(values).max():.4g}"
    rate = _rate(one)
    known = f"{rate:.6g}", f"{one.size / rate:.4g}", one.attrs["units"], *size
    if one.attrs["units"] in SPEEDS:
        return *known, *["-"] * len(MEASURES)
    return *known, _level(one), _tones(one), _regime(one), _bursts(one)


def _rate(one: xr.DataArray) -> float:
    """Return the sample rate of a signal [Hz]."""
    return (one.size - 1) / float(one["time"].values[-1] - one["time"].values[0])


def _or_dash(measure: Callable[[], str]) -> str:
    """Return a measure in words, a dash where the signal is too short or too coarse for it."""
    try:
        return measure()
    except ArgumentError:
        return "-"


def _level(one: xr.DataArray) -> str:
    """Return the levels of a sound, or those that its rate allows."""
    if one.attrs["units"] != PASCAL:
        return "-"
    if _rate(one) < levels.LOWEST_RATE:
        return _or_dash(lambda: f"Leq {float(equivalent_level(one)):.1f} dB")
    return _or_dash(
        lambda: f"LAeq {float(equivalent_level(one, 'A')):.1f}, LAFmax {float(sound_level(one).max()):.1f} dB"
    )


def _tones(one: xr.DataArray) -> str:
    def words() -> str:
        frequency, level = tones(one)
        kept = frequency[level > -RANGE][:MOST_TONES]
        return ", ".join(f"{value:.5g}" for value in kept) or "none"

    return _or_dash(words)


def _regime(one: xr.DataArray) -> str:
    def words() -> str:
        found = vibration_regime(one)
        # A stop that squeals early is quiet in the end.
        late = " in the end" if found["regime"].item() == QUIET and float(found["growth"]) < 1.0 else ""
        return f"{found['regime'].item()}{late}, {float(found['confidence']):.2f}"

    return _or_dash(words)


def _bursts(one: xr.DataArray) -> str:
    return _or_dash(lambda: str(len(vibration_bursts(one))))


def _print_squeals(sounds: Mapping[str, xr.DataArray], lowest: float, out: str | None, plot: str | None) -> None:
    """Print the squeals of sounds, a stop each, and write them."""
    reach = min(_reach(one) for one in sounds.values())
    if reach <= lowest:
        print(f"no squeals are sought: the sound is known up to {reach:.5g} Hz only")
        return
    highest = min(squeals.HIGHEST, reach)
    try:
        found = squeals.squeal_events(sounds, lowest=lowest, highest=highest)
    except ArgumentError as error:
        raise error.renamed(OPTIONS.get(error.argument, error.argument)) from None
    few = f", {MOST_SQUEALS} of them are shown" if found.sizes["event"] > MOST_SQUEALS else ""
    stops = f"{int(found['squeals'].sum())} of {counted(len(sounds), 'sound')}"
    band = f"{found.attrs['threshold']:g} dB(A) or more from {lowest:.5g} to {highest:.5g} Hz"
    print(f"{counted(found.sizes['event'], 'squeal')} in {stops}, {band}{few}")
    if found.sizes["event"]:
        table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
        for head in ("sound", "start [s]", "duration [s]", "frequency [Hz]", "level [dB(A)]"):
            table.add_column(escape(head), justify="left" if head == "sound" else "right")
        loudest = np.sort(np.argsort(-found["level"].values, kind="stable")[:MOST_SQUEALS])
        for number in loudest:
            one = found.isel(event=number)
            numbers = (f"{float(one[word]):.{digits}f}" for word, digits in SHOWN.items())
            table.add_row(escape(str(one["event_stop"].item())), *numbers)
        wide_console().print(table)
    if out is not None:
        write(out, _table(found))
        print(out)
    if plot is not None:
        from ..plot import save, squeal_events

        save(squeal_events(found), plot)
        print(plot)


def _reach(one: xr.DataArray) -> float:
    """Return the frequency up to which squeals of a sound can be sought [Hz]."""
    return float(np.floor(0.5 * _rate(one) - (squeals.LOBE + 1) / squeals.FRAME))


def _table(found: xr.Dataset) -> bytes:
    """Return squeals as a table with units."""
    text = io.StringIO(newline="")
    lines = csv.writer(text, lineterminator="\n")
    lines.writerow(["sound", "start [s]", "end [s]", "duration [s]", "frequency [Hz]", "level [dB(A)]"])
    lines.writerows(zip(*(found[word].values.tolist() for word in COLUMNS), strict=True))
    return text.getvalue().encode("utf-8")
