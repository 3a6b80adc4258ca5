"""Sound files, read and written by libsndfile."""

from __future__ import annotations

import io
import os
import re
from pathlib import Path

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, at_least
from ..disk import read
from ..extras import named_extras
from .channels import FULL_SCALE, Channel

# Formats of libsndfile by their endings.
FORMATS = {".wav": "WAV", ".wave": "WAV", ".flac": "FLAC", ".mp3": "MP3"}
READABLE = (*FORMATS, ".ogg", ".opus", ".aif", ".aiff", ".au", ".caf", ".w64", ".rf64")
# Most bytes of the samples of a file that is read, as floats.
LARGEST = 4 * 1024**3
# Full scale of integers, one step beyond the largest value.
STEPS = {"PCM_16": 2**15, "PCM_24": 2**23}
# Comment of files whose full scale is known, in pascals or in other units.
SCALE = re.compile(r"stridula: full_scale_pascal=(\S+) start_second=(\S+)")
SCALES = re.compile(r"stridula: full_scale=(\S+) units=(.*) start_second=(\S+)")


def encoded(samples: Array, rate: int, subtype: str, comment: str, form: str = "WAV") -> memoryview:
    """Return samples over full scale, shape (samples, channels), as a sound file with a comment."""
    with named_extras():
        import soundfile

    content = io.BytesIO()
    options = {"samplerate": rate, "channels": samples.shape[1], "format": form, "subtype": subtype}
    with soundfile.SoundFile(content, "w", **options) as file:
        file.comment = comment
        # Integers rounded here, which lie in the upper bytes.
        steps = STEPS.get(subtype)
        file.write(np.rint(samples * steps).astype(np.int32) * (2**31 // steps) if steps else samples)
    return content.getbuffer()


def decoded(path: str | os.PathLike[str]) -> tuple[Array, int, str]:
    """Return the samples of a sound file over full scale, shape (samples, channels), its rate [Hz] and its comment.

    Raises
    ------
    ValueError
        If it is not a sound file, has more than 4 GiB of samples, or samples that are not finite.
    OSError
        If it cannot be read.
    """
    with named_extras():
        import soundfile

    content = read(path)
    try:
        with soundfile.SoundFile(io.BytesIO(content)) as file:
            size = 8 * file.frames * file.channels
            if size > LARGEST:
                got = f"{at_least(size / 1024**3, 3)} GiB in {str(path)!r}"
                raise ArgumentError("path", f"have samples of at most {LARGEST // 1024**3} GiB", str(path), got=got)
            comment, rate, samples = file.comment, file.samplerate, file.read(dtype="float64", always_2d=True)
    except (soundfile.SoundFileError, TypeError) as error:
        # The full message also names the bytes in memory.
        reason = getattr(error, "error_string", error)
        raise ArgumentError("path", "be a sound file", str(path), got=f"{str(path)!r}: {reason}") from error
    wrong = np.argwhere(~np.isfinite(samples))
    if wrong.size:
        at, channel = wrong[0].tolist()
        got = f"{samples[at, channel]} in {str(path)!r} at {at / rate:.6g} s"
        raise ArgumentError("path", "have finite samples", str(path), got=got)
    return samples, rate, comment


def read_sound(path: Path) -> list[Channel]:
    """Return the channels of a sound file, relative to full scale unless its comment has the value of full scale."""
    samples, rate, comment = decoded(path)
    scale, units, start = 1.0, FULL_SCALE, 0.0
    if found := SCALE.search(comment):
        scale, units, start = float(found[1]), "Pa", float(found[2])
    elif found := SCALES.search(comment):
        scale, units, start = float(found[1]), found[2], float(found[3])
    if len(samples) < 2:
        raise ArgumentError("path", "have at least 2 samples", str(path), got=f"{len(samples)} in {str(path)!r}")
    meaning = "signal over full scale" if units == FULL_SCALE else ""
    return [
        Channel(f"channel {number}", units, values * scale, float(rate), start, meaning)
        for number, values in enumerate(samples.T, 1)
    ]
