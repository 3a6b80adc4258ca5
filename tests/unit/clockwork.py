"""Records of clockwork: contacts that stick and slip at a known pitch, cut anywhere, in bursts and in noise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

STATIC, KINETIC = 0.4, 0.25
SLIDING, STICKING = 2, 1


@dataclass(frozen=True)
class Clockwork:
    """A contact that sticks for a share of each period, while its friction rises, and slips for the rest.

    Attributes
    ----------
    pitch : float
        Frequency of its cycles [Hz].
    stick : float
        Share of a period in which it sticks [1].
    phase : float
        Part of a cycle that is over where the record begins [1].
    rate, duration : float
        Sample rate [Hz] and duration [s].
    noise : float
        Noise of both forces over the fluctuation of friction [1].
    burst, stop : float
        Durations of bursts of whole cycles, and of the stops between, in which it sticks [s]; no stops if zero.
    swing : float
        Fluctuation of the normal force over its mean, which rises in each stick phase and falls in each slip [1].
    seed : int
        Seed of the noise.
    """

    pitch: float
    stick: float
    phase: float = 0.0
    rate: float = 48e3
    duration: float = 0.6
    noise: float = 0.0
    burst: float = 0.0
    stop: float = 0.0
    swing: float = 0.0
    seed: int = 0

    @property
    def cycles(self) -> int:
        """Number of cycles in a burst."""
        return max(1, round(self.burst * self.pitch))

    def turned(self, time: np.ndarray) -> np.ndarray:
        """Return the number of cycles until some times [1]; it stands still in stops."""
        if not self.stop:
            return self.pitch * time + self.phase
        burst = self.cycles / self.pitch
        every = burst + self.stop
        since = time + self.phase * every
        return self.cycles * np.floor(since / every) + self.pitch * np.minimum(since % every, burst)

    def sticking(self, turns: np.ndarray) -> np.ndarray:
        """Return the cycles spent sticking until some numbers of cycles [1]."""
        whole = np.floor(turns)
        return whole * self.stick + np.minimum(turns - whole, self.stick)

    def rising(self, turns: np.ndarray) -> np.ndarray:
        """Return the integral over cycles of a wave from -1 to 1 in each stick phase, and 0 in each slip."""
        inside = np.minimum(turns % 1.0, self.stick)
        return inside * (inside / self.stick - 1.0)

    def record(self) -> xr.Dataset:
        """Return its record, with means over the sample intervals in closed form."""
        edges = np.arange(round(self.duration * self.rate) + 1) / self.rate
        turns = self.turned(edges)
        in_stops = 1.0 - np.diff(turns) * self.rate / self.pitch if self.stop else 0.0
        sticking = np.clip(np.diff(self.sticking(turns)) * self.rate / self.pitch + in_stops, 0.0, 1.0)
        wave = np.diff(self.rising(turns)) * self.rate / self.pitch
        random, loud = np.random.default_rng(self.seed), self.noise * wave.std()
        noise = (STATIC - KINETIC) * loud * random.normal(size=(2, wave.size))
        share = np.stack([np.zeros(wave.size), sticking, 1.0 - sticking], axis=1)
        time = edges[1:]
        data = {
            "status_share": (("time", "contact_status"), share),
            "normal_force": ("time", 1.0 + self.swing * wave + noise[0]),
            "tangential_force": ("time", KINETIC + (STATIC - KINETIC) * wave + noise[1]),
            "damping_loss": ("time", 0.0 * time),
            "impact_loss": ("time", 0.0 * time),
            "friction_loss": ("time", time),
            "contact_position": ("time", 0.01 * time),
        }
        words = ["separated", "sticking", "sliding"]
        attributes = {"ended": "finished", "sample_interval": 1.0 / self.rate}
        return xr.Dataset(data, {"time": time, "contact_status": words}, attributes)
