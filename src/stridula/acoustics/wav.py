"""Sound files that store the pressure of full scale."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from ..checks import ArgumentError, at_least, choice, positive
from ..disk import check_ending, check_writable, write
from ..signals.sound_files import SCALE, STEPS, decoded, encoded
from .pressures import channels
from .sample_rates import resampled

ENDINGS = (".wav", ".wave")
RATES = (44100, 48000, 96000)
SUBTYPES = ("PCM_24", "FLOAT")
NORMALISED = "normalised"
# Peak of a normalised file below full scale [dB]: the signal that players make may exceed its samples.
HEADROOM = 1.0


@dataclass(frozen=True)
class SoundFile:
    """A sound file that was written; it prints as a one-line summary.

    Attributes
    ----------
    path : str
        The file.
    channels : int
        Number of channels, one for each listener in their order.
    sample_rate : int
        Sample rate [Hz].
    duration : float
        Duration [s].
    peak : float
        Largest sound pressure of its samples [Pa], which differs slightly from that at another sample rate.
    full_scale : float
        Sound pressure of a sample of 1 [Pa]; the gain is one over it.
    normalised : bool
        Whether the full scale was chosen by the peak.
    """

    path: str
    channels: int
    sample_rate: int
    duration: float
    peak: float
    full_scale: float
    normalised: bool

    def __str__(self) -> str:
        plural = "" if self.channels == 1 else "s"
        form = f"{self.path}: {self.channels} channel{plural}, {self.sample_rate / 1000:g} kHz, {self.duration:.4g} s"
        if self.peak == 0.0:
            return f"{form}, silence (full scale {self.full_scale:.4g} Pa)"
        kind = f"normalised by a gain of {1.0 / self.full_scale:.4g} /Pa" if self.normalised else "calibrated"
        return f"{form}, peak as written {self.peak:.4g} Pa, full scale {self.full_scale:.4g} Pa, {kind}"


def write_wav(
    path: str | Path,
    pressure: xr.DataArray,
    *,
    sample_rate: int = 48000,
    full_scale: float | str = NORMALISED,
    subtype: str = "PCM_24",
) -> SoundFile:
    """Write sound pressures to a WAV file, one channel for each listener, with the pressure of full scale.

    Two listeners, the left ear first, make a binaural file. Nothing is ever clipped. The pressure of full scale is
    stored in the file's comment (RIFF INFO ICMT), so that `read_wav` returns pascals.

    Parameters
    ----------
    path : str or Path
        The file, written whole or not at all.
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa], at any sample rate.
    sample_rate : {48000, 44100, 96000}, optional
        Sample rate of the file [Hz]; see `resampled` for the low-pass.
    full_scale : float or "normalised", optional
        Pressure of full scale [Pa], for a calibrated file: files of the same full scale have the right loudness
        relative to each other. Or ``"normalised"``: the peak over all channels is 1 dB below full scale, and silence,
        which stays silence, has a full scale of 1 Pa.
    subtype : {"PCM_24", "FLOAT"}, optional
        24-bit integers, or 32-bit floats of pressure over full scale, which also hold values beyond it.

    Returns
    -------
    SoundFile
        Description of the file, with its pressure of full scale.

    Raises
    ------
    ValueError
        If an argument is out of its range, if the pressure would be clipped at this full scale, or if `path` has the
        ending of another format, such as ``.mp3``.
    OSError
        If the file cannot be written.
    """
    check_ending("path", path, ENDINGS, "WAV file")
    check_writable(path)
    choice("subtype", subtype, SUBTYPES)
    content, written = wav_of(str(path), pressure, sample_rate, full_scale, subtype)
    write(path, content)
    return written


def wav_of(
    name: str, pressure: xr.DataArray, sample_rate: int, full_scale: float | str, subtype: str
) -> tuple[memoryview, SoundFile]:
    """Return a sound as the content of a WAV file and its description; arguments are as in `write_wav`.

    Parameters
    ----------
    name : str
        Name of the sound in its summary.
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa].
    sample_rate : int
        Sample rate of the file [Hz].
    full_scale : float or "normalised"
        Pressure of full scale [Pa].
    subtype : {"PCM_16", "PCM_24", "FLOAT"}
        Integers or floats.

    Raises
    ------
    ValueError
        If an argument is out of its range, or the pressure would be clipped at this full scale.
    """
    if sample_rate not in RATES:
        raise ArgumentError("sample_rate", f"be one of {', '.join(map(str, RATES))} Hz", sample_rate)
    scale = full_scale if isinstance(full_scale, str) else positive("full_scale", full_scale)
    if isinstance(scale, str):
        choice("full_scale", scale, (NORMALISED,))
    values, rate = channels(pressure)
    sound = resampled(values, rate, float(sample_rate))
    peak = float(np.abs(sound).max())
    if isinstance(scale, str):
        scale = normalised_scale(peak)
    share = 1.0 - 1.0 / STEPS.get(subtype, np.inf)
    if subtype in STEPS and peak > scale * share:
        least = at_least(peak / share)
        raise ArgumentError(
            "full_scale",
            f"be at least {least} Pa for a peak of {peak:.6g} Pa",
            scale,
            got=f"{scale!r} Pa: it would be clipped",
        )
    content = encoded(sound / scale, sample_rate, subtype, scale_comment(scale, float(pressure["time"][0])))
    duration = sound.shape[0] / sample_rate
    return content, SoundFile(name, sound.shape[1], sample_rate, duration, peak, scale, full_scale == NORMALISED)


def normalised_scale(peak: float) -> float:
    """Return the full scale that puts a peak `HEADROOM` below it, 1 for silence."""
    return peak * 10.0 ** (HEADROOM / 20.0) or 1.0


def scale_comment(scale: float, start: float) -> str:
    """Return the comment of a file with a pressure of full scale [Pa] and a start time [s]."""
    return f"stridula: full_scale_pascal={scale!r} start_second={start!r}"


def read_wav(path: str | Path, full_scale: float | None = None) -> xr.DataArray:
    """Read a sound file back in pascals.

    Parameters
    ----------
    path : str or Path
        A WAV file.
    full_scale : float, optional
        Pressure of full scale [Pa]; that stored in the file if left out.

    Returns
    -------
    xarray.DataArray, shape (time, listener)
        Sound pressure [Pa]; its attribute ``full_scale`` is the pressure of full scale.

    Raises
    ------
    ValueError
        If it is not a sound file, if its samples have more than 4 GiB, or if neither the file nor `full_scale` has its
        full scale.
    OSError
        If the file cannot be read.
    """
    samples, rate, comment = decoded(path)
    found = SCALE.search(comment)
    if full_scale is None and found is None:
        raise ArgumentError(
            "full_scale", "be given for a file without a stated full scale", str(path), got=f"{str(path)!r} alone"
        )
    scale = float(found[1]) if full_scale is None and found else positive("full_scale", full_scale)
    start = float(found[2]) if found else 0.0
    return xr.DataArray(
        samples * scale,
        dims=("time", "listener"),
        coords={"time": ("time", start + np.arange(len(samples)) / rate, {"units": "s"})},
        name="pressure",
        attrs={"units": "Pa", "long_name": "sound pressure", "full_scale": scale},
    )
