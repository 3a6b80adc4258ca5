"""`stridula sound` and `stridula run --wav`: the sound of a run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from ..acoustics.hearable import body_named, hearable
from ..acoustics.level_words import loudest
from ..acoustics.listeners import FARTHEST
from ..acoustics.radiate import radiate
from ..acoustics.wav import NORMALISED, RATES, SUBTYPES, write_wav
from ..checks import ArgumentError, at_most, listed, suggestion
from ..extras import require
from ..records.changes import check_one_system, played
from ..records.files import load
from ..scenarios.load import Scenario, load_scenario, scenario_of_tables
from ..scenarios.quantities import quantity
from ..scenarios.read import tables_of_text
from ..system import System
from .hearing import print_levels
from .outputs import check_outputs

# Window of a spectrogram [s].
SHORTEST_FIGURE = 0.02
# Arguments of `write_wav` as options.
OPTIONS = {"full_scale": "--full-scale", "sample_rate": "--sample-rate", "subtype": "--subtype"}


def sound_of_record(
    name: str,
    listeners: Sequence[str],
    bodies: Sequence[str],
    *,
    wav: str | None,
    figures: dict[str, str | None],
    sample_rate: str,
    full_scale: str,
    subtype: str,
    baffled: bool | None,
) -> None:
    """Print the sound levels of a record, and optionally write the sound and draw figures, keyed by their options.

    Raises
    ------
    ValueError
        If the record, a listener or an output is invalid; then nothing is written.
    OSError
        If an output cannot be written.
    """
    wanted = {option: path for option, path in figures.items() if path is not None}
    check_outputs(wav, figures["--plot"], "--wav")
    check_outputs(wav, figures["--bands"], "--wav", "--bands")
    check_outputs(figures["--plot"], figures["--bands"], "--plot", "--bands")
    for option, path in (("--wav", wav), *figures.items()):
        if path is not None and Path(path).resolve() == Path(name).resolve():
            raise ArgumentError(option, "differ from the record", path, got=f"{path!r} for both")
    if wav is not None:
        check_ending(wav)
    options = wav_options(sample_rate, full_scale, subtype)
    places: Any = [place_of(text) for text in listeners] or None
    record = load(name)
    scenario = _played(record)
    system = scenario.system
    named = [_body_of(system, name) for name in bodies]
    alone = [] if named else _left_alone(record, system)
    pressure = radiate(record, system, places, bodies=named or alone or None, baffled=baffled)
    if alone:
        print(f"{listed([system.body_name(one) for one in alone])} alone: the record was changed while it was played")
    title = scenario.title or Path(name).stem
    drawn = {path: FIGURES[option](pressure, record, title) for option, path in wanted.items()}
    if wav is not None:
        print(_written(wav, pressure, options))
    if drawn:
        from ..plot import save

        for path, figure in drawn.items():
            save(figure, path)
    if pressure.attrs["notes"]:
        print(pressure.attrs["notes"])
    print_levels(pressure)


def _played(record: xr.Dataset) -> Scenario:
    """Return the scenario of a record; if it was changed while it was played, the last one within the record."""
    changes = played(record)
    return scenario_of_tables(tables_of_text(changes[-1][1], "changes")) if changes else load_scenario(record)


def write_sound(record: xr.Dataset, system: System, wav: str) -> tuple[str, str, str]:
    """Write the sound of a record at two ears a metre above its sources; return the path, levels and notes as text."""
    pressure = radiate(record, system)
    return str(write_wav(wav, pressure)), loudest(pressure), pressure.attrs["notes"]


def check_ending(wav: str) -> None:
    """Raise ValueError unless the name of a sound file ends in .wav, ImportError if sound files cannot be written."""
    require("soundfile")
    if not wav.lower().endswith(".wav"):
        raise ArgumentError("--wav", "end in .wav", wav)


def _left_alone(record: xr.Dataset, system: System) -> list[Any]:
    """Return the tracks if bodies or drives were changed during the record, which then holds the tracks only."""
    try:
        check_one_system(record)
    except ArgumentError:
        tracks = {contact.path_body for contact in system.contacts}
        return [body for body in hearable(system) if body in tracks]
    return []


def _body_of(system: System, name: str) -> Any:
    """Return the body with this name; errors name the option."""
    try:
        return body_named(system, name)
    except ArgumentError as error:
        raise error.renamed("--body") from None


def _written(wav: str, pressure: xr.DataArray, options: dict[str, Any]) -> str:
    """Write the sound file; errors name the option."""
    try:
        return str(write_wav(wav, pressure, **options))
    except ArgumentError as error:
        raise error.renamed(OPTIONS.get(error.argument, error.argument)) from None


def place_of(text: str) -> tuple[float, ...]:
    """Return the position given by ``X,Y,Z``, each in metres or with a unit."""
    try:
        place = tuple(quantity(part.strip(), "m") for part in text.split(","))
    except ValueError:
        place = ()
    if len(place) != 3 or max(map(abs, place)) > FARTHEST:
        raise ArgumentError("--listener", f"be X,Y,Z in m, each within {FARTHEST:g} m", text)
    return place


def wav_options(sample_rate: str, full_scale: str, subtype: str) -> dict[str, Any]:
    """Return the arguments of `write_wav` given by options."""
    try:
        rate = quantity(sample_rate, "Hz")
    except ValueError:
        raise ArgumentError("--sample-rate", "be a number in Hz or kHz", sample_rate) from None
    if rate not in RATES:
        raise ArgumentError("--sample-rate", f"be one of {', '.join(map(str, RATES))} Hz", sample_rate)
    scale: float | str = full_scale
    if full_scale != NORMALISED:
        try:
            scale = quantity(full_scale, "Pa")
        except ValueError:
            raise ArgumentError("--full-scale", f"be a pressure in Pa or {NORMALISED}", full_scale) from None
        if scale <= 0.0:
            raise ArgumentError("--full-scale", "be above 0 Pa", full_scale)
    if subtype not in SUBTYPES:
        raise ArgumentError(
            "--subtype", f"be one of {', '.join(SUBTYPES)}", subtype, got=f"{subtype!r}{suggestion(subtype, SUBTYPES)}"
        )
    return {"sample_rate": int(rate), "full_scale": scale, "subtype": subtype}


def _spectrogram(pressure: xr.DataArray, record: xr.Dataset, title: str) -> Any:
    from ..plot import spectrogram

    lasts = pressure.sizes["time"] * float(record.attrs["sample_interval"])
    if lasts < SHORTEST_FIGURE:
        raise ArgumentError("--plot", f"have a sound of at least {SHORTEST_FIGURE:g} s", got=f"{at_most(lasts, 3)} s")
    return spectrogram(pressure.isel(listener=0), record if "contact" not in record.dims else None, title=title)


def _bands(pressure: xr.DataArray, _record: xr.Dataset, title: str) -> Any:
    from ..plot import third_octaves

    try:
        return third_octaves(pressure, title=title)
    except ArgumentError as error:
        raise error.renamed("--bands") from None


# Drawing functions by option.
FIGURES = {"--plot": _spectrogram, "--bands": _bands}
