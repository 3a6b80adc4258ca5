"""Files of films: their properties, formats and the encoder."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Protocol

import matplotlib
import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.figure import Figure

from ..checks import ArgumentError
from ..disk import check_writable, read, write
from ..extras import how_to_install

FRAMES_PER_SECOND = 25
FEWEST_FRAMES, MOST_FRAMES = 2, 5000
KINDS = (".mp4", ".gif")
# Pixels of the picture, both even as encoders want them.
WIDTH, HEIGHT, DPI = 960, 600, 100


@dataclass(frozen=True)
class Film:
    """Properties of a film that was written; `str` gives a one-line summary.

    Attributes
    ----------
    path : str
        The file.
    frames : int
        Number of frames, 25 a second.
    start, duration : float
        The window of time shown [s].
    slowdown : float
        Slow-motion factor.
    exaggeration : float or None
        Factor by which the vibration is drawn larger; None if no vibration is drawn.
    """

    path: str
    frames: int
    start: float
    duration: float
    slowdown: float
    exaggeration: float | None = None

    def __str__(self) -> str:
        drawn = "" if self.exaggeration is None else f", vibration drawn {self.exaggeration:.6g} times"
        return (
            f"{self.path}: {self.frames} frames, {1e3 * self.duration:.4g} ms from {self.start:.6g} s, "
            f"slowed down {self.slowdown:.6g} times{drawn}"
        )


class Drawn(Protocol):
    """A picture that is drawn frame by frame.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    frames : int
        Number of frames.
    """

    figure: Figure
    frames: int

    def show(self, frame: int) -> None:
        """Draw one frame."""


def still(number: int, of: int) -> None:
    """Report no progress."""


def check_frames(duration: float, frame: float) -> int:
    """Return the number of frames in a window of time [s]; raise if there are too few or too many."""
    frames = duration / frame
    if not FEWEST_FRAMES <= round(frames) <= MOST_FRAMES:
        raise ArgumentError(
            "duration",
            f"give from {FEWEST_FRAMES} to {MOST_FRAMES} frames of {frame:.3g} s",
            duration,
            got=f"{duration!r} s ({frames:.0f} frames): change the slowdown",
        )
    return round(frames)


def writer_for(out: str | Path) -> AbstractMovieWriter:
    """Return a writer of films in the format of the file suffix, after checking that the file can be written.

    Raises
    ------
    ValueError
        If the format is not known, or there is no encoder for it.
    OSError
        If the file cannot be written.
    """
    writer = _writer(out)
    check_writable(out)
    return writer


def write_film(
    picture: Drawn, out: str | Path, writer: AbstractMovieWriter, progress: Callable[[int, int], None]
) -> None:
    """Write all frames of a picture as a film, whole or not at all."""
    write(out, _filmed(picture, writer, Path(out).suffix.lower(), progress))


def _encoder() -> str | None:
    """Return the path of ffmpeg: that of the Python package, or that on the path."""
    if find_spec("imageio_ffmpeg") is None:
        return shutil.which("ffmpeg")
    import imageio_ffmpeg

    return str(imageio_ffmpeg.get_ffmpeg_exe())


def _writer(out: str | Path) -> AbstractMovieWriter:
    kind = Path(out).suffix.lower()
    if kind not in KINDS:
        raise ArgumentError("out", f"end in one of {', '.join(KINDS)}", str(out), got=f"{str(out)!r}")
    if kind == ".gif":
        return PillowWriter(fps=FRAMES_PER_SECOND)
    encoder = _encoder()
    if encoder is None:
        raise ArgumentError(
            "out", f"end in .gif without an encoder ({how_to_install('video')})", str(out), got=f"{str(out)!r}"
        )
    return FFMpegWriter(
        fps=FRAMES_PER_SECOND, codec="libx264", extra_args=["-pix_fmt", "yuv420p", "-crf", "20", "-threads", "1"]
    )


def rounded(number: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is not above a number, or 1 for 0."""
    if not np.isfinite(number):
        return 1.0
    power = 10.0 ** np.floor(np.log10(number))
    return float(power * max(factor for factor in (1.0, 2.0, 5.0) if factor <= number / power * (1.0 + 1e-9)))


@contextmanager
def _encoding() -> Iterator[None]:
    """Let matplotlib find the encoder."""
    with matplotlib.rc_context():
        matplotlib.rcParams["animation.ffmpeg_path"] = _encoder() or "ffmpeg"
        yield


def _filmed(picture: Drawn, writer: AbstractMovieWriter, kind: str, progress: Callable[[int, int], None]) -> bytes:
    """Return the film as the bytes of its file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"film{kind}"
        try:
            with _encoding(), writer.saving(picture.figure, str(path), DPI):
                for frame in range(picture.frames):
                    picture.show(frame)
                    writer.grab_frame()
                    progress(frame + 1, picture.frames)
        except subprocess.CalledProcessError as error:
            raise OSError(f"the encoder failed: {str(error.stderr or error).strip().splitlines()[-1]}") from error
        return read(path)
