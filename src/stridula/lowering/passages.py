"""Notes on the passage of tips over the profiles of their tracks."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..arrays import Array
from ..contact import Profile

# Steps in the passage of a wave below which its forces are out by a percent.
FEW_STEPS = 20


def notes_of_passage(
    name: str, profile: Profile, begin: float, speeds: Array, step: float, times: Array
) -> Iterator[str]:
    """Yield notes on a contact that passed the waves of a profile in few steps, or left it.

    Parameters
    ----------
    name : str
        Name of the contact.
    profile : Profile
        Profile of its track.
    begin : float
        Place along the track at the start [m].
    speeds : ndarray, shape (samples,)
        Slip velocity [m/s].
    step : float
        Time step [s].
    times : ndarray, shape (samples,)
        Time at the end of each sample [s].
    """
    fastest = float(np.abs(speeds).max(initial=0.0))
    steps = profile.wavelength / (fastest * step) if fastest > 0.0 else np.inf
    if steps < FEW_STEPS:
        yield f"{name} passed the shortest waves of its profile in {steps:.3g} steps: a smaller step resolves them"
    interval = times[1] - times[0] if times.size > 1 else 0.0
    beyond = profile.beyond(begin + np.cumsum(speeds) * interval)
    if beyond.any():
        yield f"{name} left the profile of its track, which is flat beyond, at {times[beyond.argmax()]:.4g} s"
