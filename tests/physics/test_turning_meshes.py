"""Meshed discs that turn under a face: against bodies of revolution, and point by point."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stridula as st

STEEL, LINING = st.Material(2.1e11, 7800.0, 0.3), st.Material(5e9, 2500.0, 0.3)
INNER, OUTER, THICK = 0.05, 0.15, 0.01
AXIS, ORIGIN = (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)


def meshed():
    mesh = st.SolidMesh.sector((INNER, OUTER), (0.0, 2.0 * math.pi), THICK, (4, 24, 1))
    return st.SolidBody(mesh, STEEL, fixed=["inner"], cutoff=6e3, damping=1e-3, contact_faces=["top"], name="disc")


def revolved(turning):
    profile = st.RectangleProfile({"disc": ((INNER, OUTER), (0.0, THICK))})
    return st.AxisymmetricBody(
        profile, STEEL, 6e3, "inner", damping=1e-3, axis=AXIS, origin=ORIGIN, turning=turning, name="disc"
    )


def braked(track, angle=0.0, friction=0.5, **words):
    """Return a pad pressed on a disc, at an angle about its axis."""
    mesh = (
        st.SolidMesh.block((0.03, 0.015, 0.02), (2, 1, 2))
        .moved((0.095, THICK, -0.01))
        .moved(rotation=(0.0, angle, 0.0))
    )
    pad = st.SolidBody(
        mesh, LINING, fixed={"top": "xz"}, cutoff=2e4, damping=1e-3, contact_faces=["bottom"], name="pad"
    )
    face = st.SurfaceContact(
        pad, "bottom", track, "top" if track.kind == "solid" else "", st.Coulomb(friction), stiffness=5e11, **words
    )
    return st.System(face, [st.Force(pad.at("top"), y=-200.0)])


def test_a_meshed_disc_grows_as_a_body_of_revolution_that_turns_as_slowly():
    speed = 0.5
    ours = st.sliding_stability(braked(meshed(), turning=(AXIS, ORIGIN, speed)))
    theirs = st.sliding_stability(braked(revolved(speed)))
    assert ours.attrs["equilibrium"] == theirs.attrs["equilibrium"] == "sliding"
    for found in (ours, theirs):
        assert int(found["unstable"].sum()) > 0
    for name, tolerance in (("frequency", 0.01), ("growth_rate", 0.1)):
        ours_fastest, theirs_fastest = (found[name].values[found["growth_rate"].argmax()] for found in (ours, theirs))
        assert ours_fastest == pytest.approx(theirs_fastest, rel=tolerance)
    # All points along world x are another system.
    along_x = st.sliding_stability(braked(meshed(), tangent=(1.0, 0.0, 0.0)), velocity=1.0)
    assert abs(along_x["growth_rate"].max() / theirs["growth_rate"].max() - 1.0) > 0.3


@pytest.mark.parametrize("turns", [1, 7, 12])
def test_a_pad_turned_with_the_elements_of_the_disc_is_the_same(turns):
    plain, turned = (
        st.sliding_stability(braked(meshed(), angle=angle, turning=(AXIS, ORIGIN, 3.0)))
        for angle in (0.0, 2.0 * math.pi * turns / 24)
    )
    for name in ("frequency", "growth_rate"):
        np.testing.assert_allclose(np.sort(turned[name]), np.sort(plain[name]), rtol=1e-6, atol=1e-3)


def test_the_sense_of_turning_matters_as_the_mirrored_pad():
    speeds = [st.sliding_stability(braked(meshed(), turning=(AXIS, ORIGIN, one))) for one in (3.0, -3.0)]
    # The pad is symmetric about the plane of x and y, as is the disc.
    np.testing.assert_allclose(*(np.sort(one["growth_rate"]) for one in speeds), rtol=1e-6, atol=1e-3)


@pytest.mark.parametrize("seed", range(4))
def test_points_slide_at_the_speed_of_the_material_under_them(seed):
    dice = np.random.default_rng(seed)
    speed, origin = dice.uniform(-20.0, 20.0), (*dice.uniform(-0.02, 0.02, 2), 0.01)
    system = braked(meshed(), turning=((0.0, dice.uniform(0.5, 2.0), 0.0), origin, speed))
    run = st.simulate(system, 1e-3, surface_rate="all")
    places = np.array([one.tip.place for one in system.contacts]) - origin
    velocity = speed * np.cross((0.0, 1.0, 0.0), places)
    sizes = np.linalg.norm(velocity, axis=1)
    tangents = np.array([one.frame[1] for one in system.contacts])
    np.testing.assert_allclose(tangents * sizes[:, None], velocity, rtol=1e-9, atol=1e-12)
    # The pad moves little in comparison, and friction has the direction of the material.
    first = run["slip_velocity"].values[..., 0].mean(axis=0)
    np.testing.assert_allclose(np.abs(first), sizes, rtol=0.1)
    friction, normal = run["tangential_force"].values[-1], run["normal_force"].values[-1]
    closed = normal > 1e-3
    assert closed.any()
    np.testing.assert_allclose(np.linalg.norm(friction[closed], axis=1), 0.5 * normal[closed], rtol=1e-9)


def test_a_growing_mode_grows_in_time_as_in_theory():
    system = braked(meshed(), turning=(AXIS, ORIGIN, 3.0))
    theory = st.sliding_stability(system)
    mode = int(theory["growth_rate"].argmax())
    growth, frequency = float(theory["growth_rate"][mode]), float(theory["frequency"][mode])
    started = st.System(
        system.contact, [*system.drives, st.InitialEquilibrium(mode=mode, amplitude=1e-9)], system.connections
    )
    run = st.simulate(started, 40.0 / frequency, probes=[st.Velocity(system.slider.at("bottom"), "y")])
    signal = run["velocity"].values[:, 0]
    half = signal.size // 2
    measured = math.log(np.std(signal[half:]) / np.std(signal[:half])) / (half * run.attrs["sample_interval"])
    assert measured == pytest.approx(growth, rel=0.05)


def test_a_mesh_without_a_direction_of_sliding_is_refused():
    system = braked(meshed())
    message = r"^velocity must be left out for surface, .*; give its SurfaceContact turning=\(axis, origin, speed\), or a tangent$"
    with pytest.raises(ValueError, match=message):
        st.sliding_stability(system, velocity=1.0)
    started = st.System(system.contact, [*system.drives, st.InitialEquilibrium(velocity=1.0)])
    with pytest.raises(ValueError, match=message):
        st.simulate(started, 1e-4)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"turning": 3.0}, "^turning must be an axis, an origin and a speed, got 3.0"),
        ({"turning": (AXIS, ORIGIN, 0.0)}, r"^turning\[2\] must not be 0"),
        ({"turning": ((0.0, 0.0, 0.0), ORIGIN, 1.0)}, r"^turning\[0\] must be a direction"),
        ({"turning": (AXIS, (0.0, 0.0), 1.0)}, r"^turning\[1\] must be three numbers"),
        ({"turning": ((1.0, 0.0, 0.0), (0.0, 0.0, 0.5), 1.0)}, "^turning must move the track along its surface"),
        ({"turning": (AXIS, ORIGIN, 1.0), "tangent": (1.0, 0.0, 0.0)}, "^tangent must be left out with turning"),
    ],
)
def test_turnings_out_of_range_are_refused(words, message):
    with pytest.raises(ValueError, match=message):
        braked(meshed(), **words)


def test_tracks_that_turn_themselves_take_no_turning():
    with pytest.raises(ValueError, match="^turning must be left out except on a SolidBody"):
        braked(revolved(1.0), turning=(AXIS, ORIGIN, 1.0))
