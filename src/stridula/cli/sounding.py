"""`stridula sound` and `stridula run --wav`: what one hears of a run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from ..acoustics.listeners import ears
from ..acoustics.radiate import radiate
from ..acoustics.wav import NORMALISED, SUBTYPES, write_wav
from ..bodies import ModalBeam, ModalPlate
from ..checks import suggestion
from ..records.files import load
from ..scenarios.load import load_scenario
from ..scenarios.quantities import quantity
from .hearing import print_levels
from .running import check_outputs


def sound_of_record(
    name: str,
    listeners: Sequence[str],
    wav: str | None,
    plot: str | None,
    sample_rate: str,
    full_scale: str,
    subtype: str,
    baffled: bool,
) -> None:
    """Print what is heard of a record, and write it as a sound file and as a spectrogram if asked to.

    Raises
    ------
    ValueError
        If the record, a listener or an output is not usable; nothing is written then.
    OSError
        If an output cannot be written.
    """
    check_outputs(wav, plot, "--wav")
    options = wav_options(sample_rate, full_scale, subtype)
    record = load(name)
    track = track_of(load_scenario(name).system)
    places = [place_of(text) for text in listeners] or ears(track)
    pressure = radiate(record, track, places, baffled=baffled)
    if wav is not None:
        print(write_wav(wav, pressure, **options))
    if plot is not None:
        _draw(pressure, record, plot)
    if pressure.attrs["notes"]:
        print(pressure.attrs["notes"])
    print_levels(pressure)


def write_sound(record: xr.Dataset, system: Any, wav: str) -> str:
    """Write what a pair of ears a metre above the track hears of a record, and return what was written, in words."""
    track = track_of(system)
    return str(write_wav(wav, radiate(record, track, ears(track))))


def track_of(system: Any) -> ModalBeam | ModalPlate:
    """Return the track of a system if it can be heard.

    Raises
    ------
    ValueError
        If it is no beam and no plate.
    """
    track = system.track
    if not isinstance(track, (ModalBeam, ModalPlate)):
        raise ValueError(f"track must be a modal beam or a modal plate to be heard, got a {type(track).__name__}")
    return track


def place_of(text: str) -> tuple[float, ...]:
    """Return the place that ``X,Y,Z`` says, in metres or with a unit each."""
    try:
        place = tuple(quantity(part.strip(), "m") for part in text.split(","))
    except ValueError:
        place = ()
    if len(place) != 3:
        raise ValueError(f"--listener must be X,Y,Z in m, got {text!r}")
    return place


def wav_options(sample_rate: str, full_scale: str, subtype: str) -> dict[str, Any]:
    """Return the arguments of `write_wav` that options ask for."""
    try:
        rate = quantity(sample_rate, "Hz")
    except ValueError:
        raise ValueError(f"--sample-rate must be a number in Hz or kHz, got {sample_rate!r}") from None
    scale: float | str = full_scale
    if full_scale != NORMALISED:
        try:
            scale = quantity(full_scale, "Pa")
        except ValueError:
            raise ValueError(f"--full-scale must be a pressure in Pa or {NORMALISED}, got {full_scale!r}") from None
    if subtype not in SUBTYPES:
        raise ValueError(
            f"--subtype must be one of {', '.join(SUBTYPES)}, got {subtype!r}{suggestion(subtype, SUBTYPES)}"
        )
    return {"sample_rate": int(rate) if rate == int(rate) else rate, "full_scale": scale, "subtype": subtype}


def _draw(pressure: xr.DataArray, record: xr.Dataset, path: str) -> None:
    from ..plot import save, spectrogram

    one = pressure.isel(listener=0)
    save(spectrogram(one, record if "contact" not in record.dims else None, title=Path(path).stem), path)
