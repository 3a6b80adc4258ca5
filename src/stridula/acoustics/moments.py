"""How loud the moment of friction about the middle plane of a track would be, which the model leaves out.

Friction T acts at the surface, half the depth h from the middle plane, and so bends the track by a moment ``T h / 2``:
its force on a mode with the shape ``phi`` is ``T h / 2 dphi/dx``. The model has friction move axial modes alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy  # its parts are imported on first use
import xarray as xr

from ..arrays import Array
from .delays import Response
from .panels import Panel
from .recorded import sampled

# Samples from which a spectrum of friction is computed, and places of a contact along its path.
SEGMENT, PLACES = 4096, 5
# Level relative to the sound above which a note states it [dB].
SAID = -40.0
# Distance over which a shape is differentiated, over the length of the track.
APART = 1e-5


def moment_note(run: xr.Dataset, track: Any, panel: Panel, response: Response, pressure: Array) -> list[str]:
    """Return a note on the moments of the friction of a record if they would be heard.

    Parameters
    ----------
    run : xarray.Dataset
        The record, with the contacts along the track.
    track : ModalBeam or ModalPlate
        The track.
    panel : Panel
        The modes heard.
    response : Response
        Their impulse responses at a listener.
    pressure : ndarray, shape (samples,)
        The sound there [Pa].
    """
    if "tangential_force" not in run or not panel.wavenumbers.size:
        return []
    _, interval, _, (friction, places) = sampled(run, "tangential_force", "contact_position")
    arm = 0.5 * (track.thickness if hasattr(track, "thickness") else track.section.depth)
    power = 0.0
    for rubbed, place in zip(_by_tangents(friction), _by_tangents(places), strict=True):
        for along in rubbed:
            power += arm**2 * _power(along, place[0], panel, response, interval)
    size, heard = np.sqrt(power), float(np.sqrt(np.mean(pressure**2)))
    if size <= 10.0 ** (SAID / 20.0) * heard:
        return []
    level = f"{20.0 * np.log10(size / heard):.0f} dB relative to what is heard" if heard else f"{size:.2g} Pa"
    return [f"the moment of friction about the middle plane, {1e3 * arm:.3g} mm below, is not included: about {level}"]


def _by_tangents(values: Array) -> Array:
    """Return variables along tangents, shape (contacts, tangents, samples)."""
    return values if values.ndim == 3 else values[:, None]


def _power(friction: Array, place: Array, panel: Panel, response: Response, interval: float) -> float:
    """Return the mean square of the sound of friction with an arm of one metre [Pa²].

    The spectrum of friction is multiplied by the response from moment to pressure, at some places along its path.
    """
    length = min(SEGMENT, friction.size)
    size = scipy.fft.next_fast_len(max(length, len(response.taps)), real=True)
    frequency, density = scipy.signal.welch(friction, 1.0 / interval, nperseg=length, nfft=size)
    sent = scipy.fft.rfft(response.taps, size, axis=0) * _resonances(panel, frequency, interval, friction.size)
    apart = APART * panel.length
    ways = np.quantile(place, (np.arange(PLACES) + 0.5) / PLACES)
    after, before = (panel.shapes(*panel.place(np.clip(ways + side * apart, *panel.ends))) for side in (1.0, -1.0))
    answer = np.mean(np.abs(sent @ ((after - before) / (2.0 * apart)).T) ** 2, axis=1)
    return float(np.sum(density * answer) * frequency[1])


def _resonances(panel: Panel, frequency: Array, interval: float, samples: int) -> Array:
    """Return the accelerations of modes over forces, shape (frequencies, modes).

    Where the resonance of a mode is narrower than the spectrum resolves, it is widened with the same mean square.
    """
    angular, resolved = 2.0 * np.pi * frequency[:, None], 2.0 * np.pi / (interval * min(SEGMENT, samples))
    # In a short record, resonances do not build up.
    damping = np.maximum(panel.damping_rate, 1.0 / (interval * samples))
    wide = np.maximum(damping, resolved)
    stiff = panel.angular_frequency**2 - angular**2 + 1j * angular * wide
    near = np.abs(angular * wide / stiff) ** 2
    return np.asarray(-(angular**2) / stiff * np.sqrt(1.0 + (wide / damping - 1.0) * near))
