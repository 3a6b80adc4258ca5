"""Playable sound for notebooks."""

from __future__ import annotations

import base64
from dataclasses import dataclass, field
from html import escape

import xarray as xr

from ..checks import choice
from .wav import NORMALISED, SoundFile, wav_of

# Integer formats, which every browser plays.
PLAYED = ("PCM_16", "PCM_24")


@dataclass(frozen=True)
class PlayableSound:
    """A sound that notebooks show as a player and print as a one-line summary.

    Attributes
    ----------
    wav : bytes
        The content of a WAV file.
    sound : SoundFile
        Description of the content.
    """

    wav: bytes = field(repr=False)
    sound: SoundFile

    def __str__(self) -> str:
        return str(self.sound)

    def _repr_html_(self) -> str:
        """Return a player of the sound that needs no file, and its one-line summary."""
        content = base64.b64encode(self.wav).decode("ascii")
        player = f'<audio controls preload="metadata" src="data:audio/wav;base64,{content}"></audio>'
        return f'<div>{player}<div style="font-size: smaller; opacity: 0.75">{escape(str(self))}</div></div>'


def listen(
    pressure: xr.DataArray,
    *,
    sample_rate: int = 48000,
    full_scale: float | str = NORMALISED,
    subtype: str = "PCM_16",
) -> PlayableSound:
    """Return a sound that a notebook plays: as the last line of a cell it shows a player.

    The sound is kept in the notebook, 0.26 MB for a second of two channels at 48 kHz and 16 bits. Two listeners, the
    left ear first, are heard in stereo. Nothing is ever clipped.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa], at any sample rate, such as `radiate` and `read_wav` return.
    sample_rate : {48000, 44100, 96000}, optional
        Sample rate at which it is played [Hz].
    full_scale : float or "normalised", optional
        Pressure of full scale [Pa]: sounds of the same full scale have the right loudness relative to each other. Or
        ``"normalised"``: the peak is 1 dB below full scale.
    subtype : {"PCM_16", "PCM_24"}, optional
        Integers of 16 or 24 bits.

    Returns
    -------
    PlayableSound
        The sound, shown with a player in notebooks.

    Raises
    ------
    ValueError
        If an argument is out of its range, or the pressure would be clipped at this full scale.
    """
    choice("subtype", subtype, PLAYED)
    content, said = wav_of("sound", pressure, sample_rate, full_scale, subtype)
    return PlayableSound(bytes(content), said)
