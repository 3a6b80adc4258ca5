"""Loudness of the tone that defines the sone."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..acoustics.levels import REFERENCE
from ..acoustics.sensation import is_available, loudness, loudness_over_time
from ..extras import missing
from .case import Case, Curve, Outcome, Row, Sketch

RATE = 48000
# Levels [dB] and durations [s]. The stationary method filters from silence: at 80 dB that onset alone accounts for 5 %.
STEADY, STEADY_LASTS = (40.0, 60.0), 2.0
VARYING, VARYING_LASTS = (40.0, 60.0, 80.0), 1.0
TOLERANCE = "ISO 532-1, the larger of 5 % and 0.1 sone"


def tone(level: float, duration: float) -> xr.DataArray:
    """Return 1 kHz at a sound pressure level [dB]."""
    time = np.arange(round(duration * RATE)) / RATE
    amplitude = np.sqrt(2.0) * REFERENCE * 10.0 ** (level / 20.0)
    return xr.DataArray(amplitude * np.sin(2.0 * np.pi * 1000.0 * time), {"time": time}, "time")


def sones(level: float) -> float:
    """Return the loudness of 1 kHz at a level above 40 dB [sone]: doubled every 10 dB."""
    return float(2.0 ** ((level - 40.0) / 10.0))


def tones() -> Outcome:
    """1 kHz at 40 dB is 1 sone, and doubles every 10 dB."""
    known = np.array([sones(level) for level in VARYING])
    curves = [Curve(np.array(VARYING), known, "definition")]
    notes: list[str] = []
    rows: list[Row] = []
    if is_available():
        steady = [float(loudness(tone(level, STEADY_LASTS))) for level in STEADY]
        varying = [float(loudness_over_time(tone(level, VARYING_LASTS))[-1]) for level in VARYING]
        rows = [
            *(_row("stationary method", level, found) for level, found in zip(STEADY, steady, strict=True)),
            *(_row("time-varying method", level, found) for level, found in zip(VARYING, varying, strict=True)),
        ]
        curves.append(Curve(np.array(STEADY), np.array(steady), "stationary method", marks=True))
        curves.append(Curve(np.array(VARYING), np.array(varying), "time-varying method", marks=True))
    else:
        notes.append(f"Not run: {missing('mosqito')}.")
    return Outcome(rows, Sketch("level of 1 kHz [dB]", "loudness [sone]", curves), notes)


def _row(method: str, level: float, found: float) -> Row:
    known = sones(level)
    return Row(f"1 kHz at {level:.0f} dB, {method}", known, found, max(0.05 * known, 0.1), TOLERANCE, "sone")


CASES = (
    Case(
        "loudness-tone",
        "Loudness of 1 kHz",
        "Definition of the sone: 1 kHz at 40 dB from the front is 1 sone, doubled every 10 dB (ISO 532-1:2017)",
        tones,
    ),
)
