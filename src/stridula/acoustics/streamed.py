"""Sound pressure of a track in real time: the sum of `radiate`, part by part."""

from __future__ import annotations

from copy import copy
from fractions import Fraction

import numpy as np
import scipy  # its parts are imported on first use
import scipy.fft

from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from .air import Air
from .delays import Sampling
from .driven import DEGREE, FASTEST, LEAD, filters, undo_mean
from .listeners import check_in_front, listeners_of
from .panels import panel_of
from .recorded import BEFORE
from .resampling import ATTENUATION, BANDWIDTH, bandwidth_of
from .responses import Baffled
from .sample_rates import low_pass

# Response of a mode, relative to that of the loudest, that rounding may cause.
ROUND_OFF = 1e-12
# Samples from the middle of the first interval to the first acceleration.
EARLY = 0.5 - LEAD


class StreamedSound:
    """The pressure of a baffled track at one listener, from forces given part by part.

    Equals the result of `radiate` for the same forces, up to rounding.

    Parameters
    ----------
    track : ModalBeam or ModalPlate
        The track.
    listener : tuple of float
        Place of the listener, as in `radiate` [m].
    interval : float
        Time between samples [s].
    steps : int
        Steps of the march in it.
    air : Air, optional
        The air, `Air()` if left out.

    Attributes
    ----------
    delay : int
        Samples by which the sound is late; zero for listeners farther than about 0.2 m.

    Raises
    ------
    ValueError
        As `radiate`.
    """

    def __init__(
        self,
        track: ModalBeam | ModalPlate,
        listener: tuple[float, float, float],
        interval: float,
        steps: int,
        air: Air | None = None,
    ) -> None:
        way, air = Baffled(panel_of(track)), Air() if air is None else air
        listeners = listeners_of(listener)
        check_in_front(listeners)
        kept = np.flatnonzero(way.panel.angular_frequency * interval < FASTEST)
        panel = way.panel.only(kept)
        self.steps, self.taps = steps, undo_mean(steps)
        bandwidth = bandwidth_of(Fraction(1), 1.0 / interval)
        sampling = Sampling(interval, bandwidth, EARLY - 0.5 / steps)
        (path,) = way.heard(kept, listeners, air, sampling).responses
        taps = low_pass(Fraction(1), 2.0 * BANDWIDTH, ATTENUATION)
        first = path.first - len(taps) // 2
        # An acceleration is known DEGREE samples after its force.
        self.delay = max(0, DEGREE - first)
        self.path = np.apply_along_axis(np.convolve, 1, path.taps.T, taps)
        # Over the middle of a track most modes cancel out.
        loudest = np.abs(self.path).max(axis=1)
        audible = np.flatnonzero(loudest > ROUND_OFF * loudest.max())
        self.panel, self.path = panel.only(audible), self.path[audible]
        self.spectra: dict[int, Array] = {}
        self.filters = filters(self.panel, interval)
        self.reach = self.path.shape[1] - 1 + first + self.delay - DEGREE
        self.begin()

    def begin(self) -> None:
        """Start from silence."""
        self.memory = [np.zeros(len(taps) - 1) for taps, _ in self.filters]
        self.force, self.position = np.zeros(2 * LEAD), np.zeros(LEAD)
        self.moved = np.zeros((len(self.filters), self.reach))
        self.has_begun = False

    def copy(self) -> StreamedSound:
        """Return a sound that continues on its own from the same state."""
        other = copy(self)
        other.memory, other.position = list(self.memory), self.position.copy()
        return other

    def feed(self, force: Array, position: Array) -> Array:
        """Return the pressure at the next samples, from the normal forces and their places.

        Parameters
        ----------
        force : ndarray, shape (samples,)
            Means over the sample intervals [N], compressive.
        position : ndarray, shape (samples,)
            Abscissas in the middle of the intervals [m].

        Returns
        -------
        ndarray, shape (samples,)
            Pressure [Pa], `delay` samples late.
        """
        if len(position) and not self.has_begun:
            self.position[:], self.has_begun = position[0], True
            force = np.concatenate([(1.0 - BEFORE / self.steps) * force[:1], force[1:]])
        force, self.force = np.concatenate([self.force, force]), np.concatenate([self.force, force])[-2 * LEAD :]
        places = np.concatenate([self.position, position])
        self.position = places[-LEAD:]
        pressing = np.convolve(force, self.taps, mode="valid")
        shapes = self.panel.shapes(*self.panel.place(places[: len(position)]))
        modal = -(shapes * pressing[:, None]).T
        moved = np.empty_like(modal)
        for k, row in enumerate(modal):
            moved[k], self.memory[k] = scipy.signal.lfilter(*self.filters[k], row, zi=self.memory[k])
        return self._heard(moved)

    def _heard(self, moved: Array) -> Array:
        """Return the pressure from the modes, by one transform of all samples that still reach the listener."""
        count, taps = moved.shape[1], self.path.shape[1]
        whole = np.concatenate([self.moved, moved], axis=1)
        self.moved = whole[:, count:]
        audible = count + taps - 1
        size = scipy.fft.next_fast_len(audible, real=True)
        if size not in self.spectra:
            self.spectra = {size: scipy.fft.rfft(self.path, size)}
        sent = scipy.fft.rfft(whole[:, :audible], size)
        return np.asarray(scipy.fft.irfft(np.sum(sent * self.spectra[size], axis=0), size)[taps - 1 : audible])
