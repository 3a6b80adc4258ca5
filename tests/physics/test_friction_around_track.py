"""Friction over the angle of a track that turns, under the points of a face; along touched bodies, against SciPy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st

CLEAN, RUSTY = st.Coulomb(0.3), st.Coulomb(0.5)
SECTOR = st.FrictionAroundTrack([0.2, 0.4, 1.5, 1.8], [CLEAN, RUSTY, RUSTY, CLEAN])


def face(turning, friction=SECTOR, **more):
    """A pad on a disc that turns about world y."""
    disc = st.AxisymmetricBody(
        st.RectangleProfile({"disc": ((0.05, 0.15), (0.0, 0.01))}), st.Material(2.1e11, 7800.0, 0.3), 3e3, "inner",
        damping=0.02, axis=(0.0, 1.0, 0.0), turning=turning, name="disc",
    )  # fmt: skip
    mesh = st.SolidMesh.block((0.03, 0.015, 0.02), (2, 1, 2)).moved((0.095, 0.01, -0.01))
    pad = st.SolidBody(
        mesh, st.Material(5e9, 2500.0, 0.3), cutoff=15e3, damping=0.05, contact_faces={"bottom": 4}, name="pad"
    )
    return st.SurfaceContact(pad, "bottom", disc, friction=friction, stiffness=3e11, name="lining", **more)


def held(surface):
    pad = surface.body
    drives = [st.Force(pad.at("top"), y=-400.0), st.InitialEquilibrium()]
    ends = [pad.at((x, y, z)) for x in (0.095, 0.125) for y in (0.01, 0.025) for z in (-0.01, 0.01)]
    springs = [st.Spring(end, stiffness=2e6, direction=way) for end in ends for way in "xz"]
    return st.System([surface], drives, springs)


@pytest.mark.parametrize("turning", [60.0, -60.0])
@pytest.mark.parametrize("run_out", [None, st.RunOut.waves({1: 1e-9})], ids=["flat", "run-out"])
def test_points_meet_the_friction_of_the_disc_as_it_turns(turning, run_out):
    surface = face(turning, run_out=run_out)
    run = st.simulate(held(surface), 0.12, sample_rate=2e3, surface_rate="all")
    assert float(run.ledger_residual[-1]) == pytest.approx(0.0, abs=1e-9 * float(run.friction_loss[-1]))
    ratios = []
    for number, place in enumerate(surface.places):
        angle = math.atan2(place @ surface.track.frame[1], place @ surface.track.frame[0])
        ratio = np.linalg.norm(run.tangential_force.values[:, number], axis=-1) / run.normal_force.values[:, number]
        # Means over the sample interval.
        middle = run.time.values - 0.25e-3
        expected = [float(SECTOR.at(angle - turning * time).coefficient_at(1.0)) for time in middle]
        # The pad yields to the friction by micrometres, and samples are filtered.
        np.testing.assert_allclose(ratio[5:], expected[5:], atol=0.01)
        ratios.append(ratio)
    assert 0.45 < np.max(ratios) < 0.51
    assert 0.29 < np.min(np.array(ratios)[:, 5:]) < 0.35


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_laws_along_a_circle_are_those_at_the_angles(sense):
    along = SECTOR.around(0.12, sense)
    for angle in np.random.default_rng(1).uniform(-7.0, 7.0, 50):
        one, other = (law.coefficient_at(1.0) for law in (SECTOR.at(angle), along.at(sense * 0.12 * angle)))
        assert one == pytest.approx(other, rel=1e-12)
    known = np.interp([0.3, 1.65], [0.2, 0.4, 1.5, 1.8], [0.3, 0.5, 0.5, 0.3])
    np.testing.assert_allclose([SECTOR.at(angle).coefficient_at(0.1) for angle in (0.3, 1.65)], known)


@pytest.mark.parametrize("seed", range(3))
def test_two_masses_slide_over_patches_of_each_other(seed):
    random = np.random.default_rng(seed)
    mass, under, speed = random.uniform(0.1, 0.3), random.uniform(0.1, 0.5), (-1.0) ** seed * random.uniform(0.5, 2.0)
    places = np.cumsum(random.uniform(2e-3, 6e-3, 9))
    mu = [*random.uniform(0.1, 0.4, 8)]
    law = st.FrictionAlongTrack(places.tolist(), [st.Coulomb(one) for one in (*mu, mu[0])], periodic=True)
    tip, track, begin, load, side = st.PointMass(mass, "tip"), st.PointMass(under, "track"), 0.005, 40.0, (4e4, 9e4)
    contact = st.PointContact(tip.centre, track.centre, at=begin, friction=law, surface_velocity=speed)
    joints = [st.Spring(track.centre, stiffness=side[1]), st.Spring(tip.centre, stiffness=side[0])]
    joints.append(st.Spring(track.centre, stiffness=1e6, direction="y"))
    drives = [st.Force(tip.centre, y=-load), st.InitialState(tip, (0.0, -load / 1e6))]
    drives.append(st.InitialState(track, (0.0, -load / 1e6)))
    moves = [st.Displacement(point, "x") for point in (tip.centre, track.centre)]
    run = st.simulate(st.System(contact, drives, joints), 0.05, step=1e-5, sample_rate=1e5, probes=moves)

    def rates(time, state):
        x, other, *speeds = state
        place = places[0] + (begin + x - other - speed * time - places[0]) % (places[-1] - places[0])
        along = math.copysign(np.interp(place, places, [*mu, mu[0]]) * load, speed)
        return [*speeds, (along - side[0] * x) / mass, (-along - side[1] * other) / under]

    times = run.time.values
    found = solve_ivp(rates, (0.0, times[-1]), [0.0] * 4, t_eval=times, method="DOP853", rtol=1e-9, atol=1e-13,
                      max_step=1e-4)  # fmt: skip
    for motion, known in zip(run.displacement.values.T, found.y[:2], strict=True):
        np.testing.assert_allclose(motion, known, atol=2e-3 * np.ptp(known))


def test_equal_laws_all_round_are_that_law():
    even = st.FrictionAroundTrack([0.0, 2.0], [CLEAN, CLEAN])
    given = {"duration": 2e-3, "sample_rate": 20e3}
    runs = [st.simulate(held(face(60.0, law)), **given) for law in (CLEAN, even)]
    np.testing.assert_allclose(*(run.tangential_force for run in runs), rtol=1e-9, atol=1e-9)


def test_a_run_can_be_run_again():
    run = st.simulate(held(face(60.0)), 1e-3, sample_rate=20e3)
    again = st.load_scenario(run).simulate()
    np.testing.assert_array_equal(run.tangential_force, again.tangential_force)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: st.FrictionAroundTrack([0.0, 6.2832], [CLEAN, RUSTY]), "angle must lie within less than one turn"),
        (lambda: st.FrictionAroundTrack([1.0, 0.5], [CLEAN, RUSTY]), r"angle\[1\] must be above"),
        (lambda: face(0.0), "friction must not depend on the angle on a track that does not turn"),
        (lambda: face(60.0, SECTOR.around(0.1)), "friction must not depend on the place along the track, .* FrictionA"),
        (
            lambda: st.PointContact(st.PointMass(1.0).centre, st.RigidTrack(), friction=SECTOR),
            r"friction must not depend on the angle except under a face: use law.around\(radius\)",
        ),
    ],
)
def test_what_cannot_be_is_named(make, words):
    with pytest.raises(ValueError, match=words):
        make()


def test_figures_name_the_angles():
    figure = st.plot.friction(SECTOR)
    words = " ".join(text.get_text() for text in figure.findobj(match=lambda one: hasattr(one, "get_text")))
    assert "0.2 rad" in words


SCENARIO = """
[bodies.pad]
kind = "solid"
materials = { young = "5 GPa", density = 2500 }
cutoff = "15 kHz"
damping = "5 %"
contact_faces = { bottom = 4 }
[bodies.pad.mesh]
shape = "block"
lengths = ["30 mm", "15 mm", "20 mm"]
divisions = [2, 1, 2]
offset = ["95 mm", "10 mm", "-10 mm"]
[bodies.disc]
kind = "axisymmetric"
material = { young = "210 GPa", density = 7800 }
cutoff = "3 kHz"
damping = "2 %"
axis = [0, 1, 0]
held = ["inner"]
turning = "60 rad/s"
profile = { shape = "rectangle", inner = 0.05, outer = 0.15, bottom = 0.0, top = 0.01 }
[[surfaces]]
name = "lining"
body = "pad"
face = "bottom"
stiffness = "3e11 N/m3"
track = { kind = "axisymmetric", body = "disc" }
[surfaces.friction]
law = "around track"
angle = ["0 deg", "10 deg", "90 deg", "100 deg"]
laws = [
    { law = "coulomb", coefficient = 0.3 },
    { law = "coulomb", coefficient = 0.5 },
    { law = "coulomb", coefficient = 0.5 },
    { law = "coulomb", coefficient = 0.3 },
]
[[drives]]
kind = "force"
body = "pad"
point = "top"
y = "-400 N"
[simulation]
duration = "1 ms"
"""


def test_a_scenario_has_it(tmp_path):
    path = tmp_path / "sector.toml"
    path.write_text(SCENARIO)
    law = st.FrictionAroundTrack(np.radians([0.0, 10.0, 90.0, 100.0]).tolist(), [CLEAN, RUSTY, RUSTY, CLEAN])
    known = [one.friction for one in face(60.0, law).contacts]
    for one, other in zip(st.load_scenario(path).system.contacts, known, strict=True):
        np.testing.assert_allclose(one.friction.place, other.place)
        assert one.friction.laws == other.laws
    path.write_text(SCENARIO.replace('turning = "60 rad/s"\n', ""))
    with pytest.raises(st.ScenarioError, match=r"surfaces.0.friction must not depend on the angle on a track that"):
        st.load_scenario(path)
