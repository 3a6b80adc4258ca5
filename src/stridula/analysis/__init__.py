"""Analysis of records: phases, frequencies, levels, regimes, motions of bowed strings."""

from .bowed import MOTIONS, bowed_motion
from .levels import largest_jump, peak_level, swing
from .orders import order_spectrum
from .phases import advance, bursts, complete, longest_unchanged, phases, settling_time, status_share, stops
from .poincare import poincare_section
from .regime_measures import Thresholds
from .regimes import REGIMES, regime, regime_of
from .spectra import (
    dominant_frequency,
    envelope,
    envelope_correlation,
    frequency_resolution,
    spectrum,
    tones,
)
from .surfaces import surface
from .vibrations import vibration_bursts, vibration_regime
from .wear import worn

__all__ = [
    "MOTIONS",
    "REGIMES",
    "Thresholds",
    "advance",
    "bowed_motion",
    "bursts",
    "complete",
    "dominant_frequency",
    "envelope",
    "envelope_correlation",
    "frequency_resolution",
    "largest_jump",
    "longest_unchanged",
    "order_spectrum",
    "peak_level",
    "phases",
    "poincare_section",
    "regime",
    "regime_of",
    "settling_time",
    "spectrum",
    "status_share",
    "stops",
    "surface",
    "swing",
    "tones",
    "vibration_bursts",
    "vibration_regime",
    "worn",
]
