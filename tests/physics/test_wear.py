"""Wear of a face between runs: Archard's volume, and the pressure of a pad that is worn in."""

from __future__ import annotations

import re

import numpy as np
import pytest

import stridula as st

LONG, HIGH, WIDE = 0.06, 0.02, 0.03
FRICTION, LOAD, SPEED = 0.4, 500.0, 1.0
RATE = 1e-12


@pytest.fixture(scope="module")
def pad():
    lining = st.Material(1e9, 2000.0, 0.3)
    size, parts = (LONG, HIGH, WIDE), (4, 2, 2)
    return st.SolidBody.block(size, parts, lining, cutoff=2e4, damping=0.2, contact_faces=["bottom"], name="pad")


def face_of(pad, **arguments):
    floor = st.RigidTrack(velocity=SPEED)
    return st.SurfaceContact(pad, "bottom", floor, friction=st.Coulomb(FRICTION), stiffness=2e11, **arguments)


def sliding(pad, face):
    """Steady sliding of the pad, pressed in the middle of its top and held there."""
    held = [st.Spring(pad.at("top"), stiffness=1e6, direction=way) for way in "xz"]
    system = st.System([face], [st.Force(pad.at("top"), y=-LOAD), st.InitialEquilibrium()], held)
    return st.simulate(system, 2e-3)


def pressure_of(face, run):
    found = st.analysis.surface(run, face)["pressure"]
    return found.isel({found.dims[0]: -1}).values


def test_the_volume_worn_off_is_that_of_archard(pad):
    """Rate times force times distance, whatever the distribution; two halves wear as the whole."""
    face = face_of(pad)
    run = sliding(pad, face)
    once = st.worn(face, run, RATE, times=100)
    assert np.dot(once.wear, once.areas) == pytest.approx(RATE * 100 * LOAD * SPEED * 2e-3, rel=1e-6)
    np.testing.assert_allclose(st.worn(st.worn(face, run, RATE, 50), run, RATE, 50).wear, once.wear, rtol=1e-12)
    gaps = [contact.gap for contact in once.contacts]
    np.testing.assert_allclose(gaps, once.wear, rtol=1e-12)


def test_a_pad_that_is_worn_in_has_the_pressure_of_a_rigid_body(pad):
    """At the same speed everywhere it wears as a rigid motion: pressure becomes linear, with the moment of friction.

    An elastic pad that is new presses with its edges: more than half of the mean away from that.
    """
    face = face_of(pad)
    along = face.places[:, 0] - 0.5 * LONG
    expected = LOAD / (LONG * WIDE) * (1.0 - 12.0 * FRICTION * HIGH * along / LONG**2)
    away = []
    for _ in range(41):
        run = sliding(pad, face)
        away.append(np.abs(pressure_of(face, run) / expected.mean() - expected / expected.mean()).max())
        face = st.worn(face, run, RATE, times=2000)
    assert away[0] > 0.5
    assert away[-1] < 0.02
    assert (np.diff(away) < 0.0).all()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda pad, run: face_of(pad, wear=[1e-6]), "wear must have 32 depths, one for each point, got 1"),
        (lambda pad, run: face_of(pad, wear=[-1e-6] * 32), "wear[0] must be 0 or above, got -1e-06"),
        (lambda pad, run: st.worn(face_of(pad), run, 0.0), "coefficient must be above 0, got 0.0"),
        (lambda pad, run: st.worn(face_of(pad), run, 1e-12, -1.0), "times must be above 0, got -1.0"),
        (
            lambda pad, run: st.worn(face_of(pad, name="other"), run, 1e-12),
            "run must be a record with all points of the",
        ),
    ],
)
def test_what_cannot_wear_is_refused(pad, call, message):
    run = sliding(pad, face_of(pad))
    with pytest.raises(ValueError, match=f"^{re.escape(message)}"):
        call(pad, run)
