"""Frequency weighting A of IEC 61672-1, of sounds and of the forces that cause them."""

from __future__ import annotations

import numpy as np

from .arrays import Array

# Poles of IEC 61672-1:2013, annex E [Hz]; those at the ends are double. The gain at 1 kHz is one.
POLES = (20.598997, 107.65265, 737.86223, 12194.217)


def a_weighting(frequency: Array) -> Array:
    """Return the complex gain of the analogue A-weighting of IEC 61672-1 at frequencies [Hz], one at 1 kHz."""
    low, second, third, high = (2.0 * np.pi * pole for pole in POLES)

    def gain(hertz: Array) -> Array:
        s = 2.0j * np.pi * np.asarray(hertz, dtype=float)
        return s**4 / ((s + low) ** 2 * (s + second) * (s + third) * (s + high) ** 2)

    return np.asarray(gain(frequency) / np.abs(gain(np.array(1000.0))))
