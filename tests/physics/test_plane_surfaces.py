"""The surfaces of planar bodies: closed, moving with the bodies, and suitable for sound in open air."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

import stridula as st
from stridula.acoustics.panels import panel_of
from stridula.acoustics.surface_pressures import SurfacePressures

from .test_open_air import closed
from .test_radiation import AIR, baffled_spectrum

STEEL = st.Material(2.1e11, 7850.0, 0.3)
BAR, ROUND = st.Rectangle(0.02, 0.01), st.Circle(0.02)
TILTED = [[0.6, 0.0, 0.8], [0.0, 1.0, 0.0]]
PANE = st.ModalPlate(st.Material(7e10, 2700.0), 3e-3, 0.3, 0.25, bending_modes=(2, 2))


@pytest.mark.parametrize(
    ("body", "area", "volume"),
    [
        (st.ModalBeam(STEEL, BAR, 0.2, 5, 3), 0.0124, 4e-5),
        (st.ModalBeam(STEEL, ROUND, 0.2, 5, 3, plane=TILTED), None, pi * 1e-4 * 0.2),
        (st.FiniteElementBeam(STEEL, BAR, 0.05, 0.3, elements=4, cutoff=60e3), 0.0034, 1e-5),
        (st.ModalPlate(STEEL, 2e-3, 0.3, 0.2, (3, 2), in_plane=True, in_plane_modes=(2, 1)), 0.122, 1.2e-4),
        (st.ModalPlate(STEEL, 2e-3, 0.3, 0.2, (3, 2), line=st.Line((0.05, 0.1), 0.4), plane=TILTED), 0.122, 1.2e-4),
    ],
    ids=lambda given: type(given).__name__,
)
def test_a_surface_is_closed_and_moves_as_traces_say(body, area, volume):
    surface = body.surface()
    found, flow = closed(surface)
    assert found == pytest.approx(volume, rel=1e-9)
    assert np.abs(flow).max() < 1e-9 * surface.areas.sum()
    assert area is None or surface.areas.sum() == pytest.approx(area, rel=1e-9)
    assert surface.shapes.shape == (len(surface.points), body.modes().count)
    along, across = (np.pad(axis, (0, 3 - len(axis))) for axis in body.axes)
    for point, normal, shapes in list(zip(surface.points, surface.normals, surface.shapes, strict=True))[::7]:
        if hasattr(body, "section"):
            place = float(np.clip(point @ along, 0.0, body.length))
        else:
            line = body.track_line
            sideways = float(point @ np.cross(along, across))
            (cosine, sine), (x, y) = line.tangent, line.point(float(point @ along))
            place = (float(np.clip(x + sine * sideways, 0.0, 0.3)), float(np.clip(y - cosine * sideways, 0.0, 0.2)))
        row = body.trace(place)
        if abs(normal @ across) < 1e-9 and body.kind == "modal plate":
            # In the world's axes a trace is along the line only: edges do not move along their normals.
            np.testing.assert_allclose(shapes, 0.0, atol=1e-3 * body.amplitude)
            continue
        known = normal[: len(row)] @ row
        np.testing.assert_allclose(shapes, known, atol=0.02 * np.abs(surface.shapes).max())


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (st.PointMass(1.0), "body must have a surface that its modes move, got a PointMass, which has no modes"),
        (st.RigidBody(1.0), "body must have a surface that its modes move, got a RigidBody, which has no modes"),
        (
            st.ModalBeam(STEEL, st.Section(1e-6, 1e-13), 0.3, tension=60.0),
            "section must be a Rectangle or a Circle for a beam to have a surface; the sound of strings needs an "
            "st.Bridge",
        ),
        (
            st.ReducedBody(np.eye(2), np.eye(2), {"tip": (0, 1)}),
            "body must have a surface that its modes move, got a ReducedBody, whose matrices do not contain its shape",
        ),
    ],
)
def test_bodies_without_a_surface_say_why(body, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        body.surface()


def test_a_plate_in_open_air_shorts_out_below_and_sounds_as_in_a_baffle_far_above():
    """At 4 kHz the sound is that with a wall to 0.7 dB; at 50 Hz the air flows round the edges."""
    place, radiator = np.array([0.1, 0.2, 0.5]), SurfacePressures(PANE.surface())
    # World x is along its line, in the middle of its width, y along its normal, z across to the right.
    seen = np.array([place[0], place[2], -(place[1] - 0.125)])
    shares = []
    for frequency in (50.0, 4000.0):
        wavenumber = 2.0 * pi * frequency / AIR.speed
        found = AIR.density * radiator.heard(radiator.fit(wavenumber), wavenumber, seen[None])[0]
        known = baffled_spectrum(panel_of(PANE), place, np.array([frequency, frequency + 1.0]))[:, 0]
        shares.append(np.abs(found / known))
    assert shares[0].max() < 0.5
    np.testing.assert_allclose(shares[1], 1.0, atol=0.08)
