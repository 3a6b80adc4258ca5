"""Motion of many modes into few signals: convolution in blocks, summed over the modes as spectra."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy.fft

from ..arrays import Array
from .delays import Response

SHORTEST_TRANSFORM = 4096
# Modes transformed at once.
MODES_AT_ONCE = 8


class Convolution:
    """Signals at listeners, from modes that are added a few at a time.

    Parameters
    ----------
    responses : sequence of Response
        Impulse responses of all modes at each listener.
    samples : int
        Samples of each signal.
    """

    def __init__(self, responses: Sequence[Response], samples: int) -> None:
        self.responses, self.samples = responses, samples
        self.taps = max(len(one.taps) for one in responses)
        self.size = scipy.fft.next_fast_len(max(8 * self.taps, SHORTEST_TRANSFORM), real=True)
        self.block = self.size - self.taps + 1
        self.blocks = -(-samples // self.block)
        self.spectra = np.zeros((len(responses), self.blocks, self.size // 2 + 1), dtype=complex)

    def add(self, motion: Array, modes: slice) -> None:
        """Add the sound of some modes, their motion of shape (modes, samples)."""
        numbers = range(*modes.indices(self.responses[0].taps.shape[1]))
        for first in range(0, len(numbers), MODES_AT_ONCE):
            part = slice(first, first + MODES_AT_ONCE)
            self._add(motion[part], list(numbers)[part])

    def _add(self, motion: Array, modes: Any) -> None:
        padded = np.zeros((len(motion), self.blocks * self.block))
        padded[:, : self.samples] = motion
        sent = scipy.fft.rfft(padded.reshape(len(motion), self.blocks, self.block), self.size)
        for spectrum, one in zip(self.spectra, self.responses, strict=True):
            paths = scipy.fft.rfft(one.taps[:, modes].T, self.size)
            for moved, path in zip(sent, paths, strict=True):
                spectrum += moved * path

    def signals(self) -> Array:
        """Return the signals at the times of the motion, shape (listeners, samples)."""
        heard = scipy.fft.irfft(self.spectra, self.size)
        found = np.zeros((len(self.responses), self.samples))
        for signal, pieces, one in zip(found, heard, self.responses, strict=True):
            whole = np.zeros(self.blocks * self.block + self.taps)
            for number, piece in enumerate(pieces):
                start = number * self.block
                whole[start : start + self.size] += piece
            low, high = max(one.first, 0), min(self.samples, one.first + len(whole))
            if high > low:
                signal[low:high] = whole[low - one.first : high - one.first]
        return found
