"""Responses of panels, added along one side after the other, against the sum over all points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from stridula.acoustics.delays import Sampling, arrivals, interpolation, response, span
from stridula.acoustics.panels import panel_of
from stridula.acoustics.rayleigh import baffled_response
from stridula.acoustics.surfaces import surface_of

AIR, RATE = st.Air(), 48e3
STEEL = st.Material(2.1e11, 7800.0, 0.3)
PLATE = st.ModalPlate(STEEL, 2e-3, 0.5, 0.3, cutoff=3e3, damping=0.01)
BEAM = st.ModalBeam(STEEL, st.Rectangle(0.05, 0.004), 0.6, cutoff=6e3, damping=0.01)


@pytest.mark.parametrize("track", [PLATE, BEAM], ids=lambda track: track.kind)
@pytest.mark.parametrize("height", [0.01, 0.8])
def test_a_panel_is_the_sum_of_its_points(track, height):
    panel, listener, sampling = panel_of(track), np.array([0.2, 0.01, height]), Sampling(1.0 / RATE, 0.3 * RATE, 0.3)
    surface = surface_of(panel, listener, 2.0 * np.pi * sampling.bandwidth / AIR.speed)
    found = baffled_response(surface, listener, AIR, sampling)
    known = baffled_response(replace(surface, panel=None), listener, AIR, sampling)
    assert found.first == known.first
    np.testing.assert_allclose(found.taps, known.taps, rtol=0.0, atol=1e-13 * np.abs(known.taps).max())


@pytest.mark.parametrize("derivative", [False, True])
@pytest.mark.parametrize("share", [0.1, 0.45])
def test_taps_are_those_of_the_interpolation(share, derivative):
    kernel, delays = interpolation(share), np.array([7.0, 7.25, 9.999999, 8.5])
    empty = response(*span(7.0, 10.0, kernel), 1)
    taps = arrivals(empty, delays, kernel, derivative=derivative).toarray()
    offsets = empty.first + np.arange(len(taps))[:, None] - delays
    within = (offsets > -kernel.half_span) & (offsets <= kernel.half_span)
    exact = (kernel.rates if derivative else kernel.values)(offsets) * within
    np.testing.assert_allclose(taps, exact, rtol=0.0, atol=1e-12)
