"""Sliding stability against closed forms, against growth in time, and kinds of equilibrium."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, radians, sin, tan

import numpy as np
import pytest
from scipy.optimize import brentq

import stridula as st
from stridula.analysis.stability import stability_of
from stridula.verification.prony import exponents
from stridula.verification.systems import mode_coupling
from stridula.verification.systems.on_belts import Slider
from stridula.verification.systems.pair import Pair

STEEL, SQUARE = st.Material(2.1e11, 7800.0), st.Rectangle(0.01, 0.01)
SLIDING = 2
WEIGHT = 10.0


def values(found) -> np.ndarray:
    return found.growth_rate.values + 2j * pi * found.frequency.values


def test_mode_coupling():
    """Hoffmann: mu 0.5 and 0.9, and flutter from 0.75 at sqrt 2; the foot rides on its belt."""
    model = mode_coupling.hoffmann()

    def fastest(friction):
        found = values(st.sliding_stability(model.system(friction)))
        return found[np.argmax(found.real)]

    known = values(st.sliding_stability(model.system(0.5)))
    assert known.imag == pytest.approx([1.192749, 1.605413], abs=5e-7)
    assert known.real == pytest.approx([0.0, 0.0], abs=1e-9)
    assert (fastest(0.9).real, fastest(0.9).imag) == pytest.approx((0.157147, 1.422918), abs=5e-7)
    assert fastest(0.7499).real < 1e-9
    assert fastest(0.7501).real > 1e-3


@pytest.mark.parametrize(
    ("damping", "limit"), [((0.0, 0.0), 0.2916667), ((0.02, 0.02), 0.289367), ((0.02, 0.06), 0.271790)]
)
def test_mode_coupling_with_damping(damping, limit):
    """Hulten: damping moves the limit, unequal damping down."""
    model = mode_coupling.sinou(damping)

    def growth(friction):
        return float(st.sliding_stability(model.system(friction)).growth_rate.max())

    if any(damping):
        assert brentq(growth, 0.2, 0.4, xtol=1e-9) == pytest.approx(limit, abs=5e-7)
    else:
        assert growth(limit - 2e-6) < 1e-3
        assert growth(limit + 2e-6) > 0.1


@pytest.mark.parametrize(("angle", "onset"), [(30.0, 0.5792), (45.0, 1.0016), (60.0, 1.7339)])
def test_flutter_begins_just_beyond_the_limit_of_a_slender_rod(angle, onset):
    """0.2 m on 0.3 m: at tan a and 0.2 % to 0.3 % more, near 1823 Hz; stated as the next multiple of 0.02."""
    pair = Pair(0.2, 0.3, angle, elements=12, bending=30, axial=15)
    assert float(pair.found(onset - 3e-4).growth_rate.max()) < 0.1
    grown = pair.found(onset + 3e-4)
    fastest = int(np.argmax(grown.growth_rate.values))
    assert float(grown.growth_rate[fastest]) > 10.0
    assert float(grown.frequency[fastest]) == pytest.approx(1823.2, abs=0.5)
    assert tan(radians(angle)) < onset < 1.004 * tan(radians(angle))


def dragged(friction: float, at: float = 0.31484):
    words = {
        "drives": [{"kind": "imposed velocity", "velocity": 0.1, "normal_load": 0.002}],
        "damping": 0.0096,
        "section": {"shape": "rectangle", "width": 0.01944, "height": 0.008624},
        "slider.length": 0.5354,
        "track.length": 1.36,
        "contact": {"at": at, "gap": 0.0, "friction": {"law": "coulomb", "coefficient": friction}},
    }
    return st.load_scenario("strong-pressure", words).system


def test_growth_of_the_moving_contact_of_two_beams():
    """It settles in sliding at 0.6; at 1.0 it grows from the remaining vibration, until it first stops sliding."""
    settled = st.simulate(dragged(0.6), 0.5, step=2e-6)
    run = st.simulate(dragged(1.0), 0.006, step=2e-6, start=settled)
    slid = int(np.argmax(run.status.values != SLIDING))
    assert slid > 400
    seen = exponents(run.normal_force.values[100 : slid - 5, None], 1e-5, 1e-4, 20)[0]
    place = float(settled.contact_position[-1])
    found = values(st.sliding_stability(dragged(1.0, place)))
    known = found[np.argmax(found.real)]
    assert known.real == pytest.approx(510.88, rel=1e-3)
    assert seen.real == pytest.approx(known.real, rel=0.02)
    assert seen.imag == pytest.approx(known.imag, rel=1e-3)
    # Negative control: at the start of the run the growth rate is different.
    elsewhere = float(st.sliding_stability(dragged(1.0)).growth_rate.max())
    assert abs(elsewhere / known.real - 1.0) > 0.05


def swings(law, stiffness: float, speed: float, skipped: float = 0.0, kick: float = 1e-5) -> tuple[complex, complex]:
    """Return the exponent of 1 kg vibrating in sliding on a belt, and that in time about the equilibrium."""
    rest = float(law.coefficient_at(speed)) * WEIGHT / stiffness
    slider = Slider(1.0, stiffness, WEIGHT, law, rest * (1.0 + kick), belt=speed)
    found = values(st.sliding_stability(slider.system()))
    known = found[np.argmax(found.imag)]
    period = 2.0 * pi / abs(known.imag)
    step = period / 4000.0
    run = slider.run(skipped + 3.0 * period, step, st.ExactModal())
    # Under a law with a state, slow sliding counts as sticking.
    assert law.state_units or bool((run.status == SLIDING).all())
    motion = run.displacement.values.reshape(run.time.size, 1)
    return complex(known), complex(exponents(motion[int(skipped / step) + 100 :: 200], 200 * step, 1.0, 1)[0])


@pytest.mark.parametrize(
    ("law", "slope"),
    [
        (st.Stribeck(0.28, 0.25, 0.5), -0.12 * np.exp(-1.0)),
        (st.Stribeck(0.28, 0.25, 0.5, viscous=0.1), 0.1 - 0.12 * np.exp(-1.0)),
        (st.ExponentialWeakening(0.28, 0.25, 0.5), -0.06 * np.exp(-1.0)),
        (st.LinearWeakening(0.28, 0.02, 0.25), -0.02),
        (st.StaticKinetic(0.28, 0.25), 0.0),
    ],
    ids=["stribeck", "viscous", "exponential", "linear", "static-kinetic"],
)
def test_a_slope_of_friction_damps_or_feeds(law, slope):
    """m x'' + N mu' x' + k x = 0: growth -N mu' / 2m, in closed form and in time."""
    known, seen = swings(law, 4.0, 0.5)
    assert known.real == pytest.approx(-WEIGHT * slope / 2.0, abs=1e-9)
    assert known.imag == pytest.approx(np.sqrt(4.0 - (WEIGHT * slope / 2.0) ** 2))
    assert seen == pytest.approx(known, rel=1e-4)


def on_floors(law, *drives, dashpot: float = 0.0, belts: tuple[float, ...] = (0.0,)) -> st.System:
    """For each floor 1 kg on a spring of 4 N/m, pressed on it with 10 N."""
    masses = [st.PointMass(1.0, name=f"mass {k}") for k in range(len(belts))]
    contacts = [
        st.PointContact(mass.centre, st.RigidTrack(velocity=belt, name=f"floor {k}"), friction=law)
        for k, (mass, belt) in enumerate(zip(masses, belts, strict=True))
    ]
    joined = [st.Spring(mass.centre, stiffness=4.0) for mass in masses]
    joined += [st.Dashpot(mass.centre, coefficient=dashpot) for mass in masses if dashpot]
    return st.System(contacts, drives=[st.Gravity(WEIGHT), *drives], connections=joined)


STRIBECK = st.Stribeck(0.28, 0.25, 0.5)


def stribeck_growth(velocity: float) -> float:
    """``-N mu' / 2m`` of `STRIBECK` at a slip velocity."""
    return WEIGHT * 0.03 * abs(velocity) / 0.25 * np.exp(-((velocity / 0.5) ** 2))


@pytest.mark.parametrize("status", [None, "sliding"])
@pytest.mark.parametrize("velocity", [0.5, -0.5, 0.2])
def test_a_given_slip_velocity_counts_where_nothing_prescribes_it(velocity, status):
    """The law falls with speed for any cause of motion; the sign of the velocity is the sense of friction."""
    found = st.sliding_stability(on_floors(STRIBECK), velocity=velocity, status=status)
    assert found.attrs["equilibrium"] == "sliding"
    assert float(found.growth_rate.max()) == pytest.approx(stribeck_growth(velocity), rel=1e-9)
    assert float(found.slip_velocity) == velocity
    drag = np.sign(velocity) * WEIGHT * float(STRIBECK.coefficient_at(velocity))
    assert float(found.tangential_force) == pytest.approx(drag)
    on_a_moving_one = st.sliding_stability(on_floors(STRIBECK, belts=(-velocity,)))
    np.testing.assert_allclose(values(found), values(on_a_moving_one), rtol=1e-12)


@pytest.mark.parametrize(
    ("belts", "velocity", "slips"),
    [
        ((0.0, 0.0), 0.3, (0.3, 0.3)),
        ((0.0, 0.0), [0.3, -0.6], (0.3, -0.6)),
        ((-0.2, 0.0), 0.3, (0.2, 0.3)),
        ((-0.2, 0.0), np.array([0.0, -0.3]), (0.2, -0.3)),
    ],
)
def test_several_contacts_have_each_its_own_slip_velocity(belts, velocity, slips):
    found = st.sliding_stability(on_floors(STRIBECK, belts=belts), velocity=velocity)
    np.testing.assert_array_equal(found.slip_velocity, slips)
    known = sorted(stribeck_growth(slip) for slip in slips)
    assert sorted(found.growth_rate.values) == pytest.approx(known, rel=1e-9)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_given_velocity_gives_the_sense_of_mode_coupling(sense):
    """Hoffmann's mass on a floor at rest, sliding as it would on its belt: flutter one way, none the other."""
    system = mode_coupling.hoffmann().system(0.9)
    contact, *_ = system.contacts
    still = st.System(replace(contact, track=st.RigidTrack()), drives=system.drives)
    slip = -contact.track.velocity
    found = st.sliding_stability(still, velocity=sense * slip)
    turned = replace(contact.track, velocity=sense * contact.track.velocity)
    known = st.sliding_stability(st.System(replace(contact, track=turned), drives=system.drives))
    np.testing.assert_allclose(values(found), values(known), rtol=1e-12)
    assert bool(found.unstable.any()) == (sense > 0.0)


def test_a_free_mass_that_friction_slows_down_is_held():
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack(), friction=STRIBECK)
    for push, velocity, kind in (
        (0.0, 0.5, "held"),
        (3.0, 0.5, "sliding"),
        (3.0, -0.5, "held"),
        (-3.0, -0.5, "sliding"),
    ):
        system = st.System(contact, drives=[st.Gravity(WEIGHT), st.Force(mass.centre, x=push)])
        assert st.sliding_stability(system, velocity=velocity).attrs["equilibrium"] == kind


def test_maps_and_loci_take_a_slip_velocity():
    """Growth ``-N mu' / 2m - c / 2m`` passes zero at ``c = -N mu'``."""
    growth = stribeck_growth(0.4)
    assert stability_of(on_floors(STRIBECK), velocity=0.4)["growth_rate"] == pytest.approx(growth, rel=1e-9)

    def braked(coefficient: float) -> st.System:
        return on_floors(STRIBECK, dashpot=coefficient)

    loci = st.root_loci(braked, "coefficient", [0.01, 0.05], velocity=0.4)
    np.testing.assert_allclose(loci.growth_rate[:, 0], [growth - 0.005, growth - 0.025], rtol=1e-9)
    critical = st.critical_value(braked, "coefficient", 0.01, 1.0, velocity=[-0.4])
    assert float(critical["value"]) == pytest.approx(2.0 * growth, rel=1e-5)


def test_a_dashpot_drags_on_a_motion_that_follows_an_inclined_track():
    """A root drawn at v up a slope rises at v tan a against c along y: N = (P + c v tan a) / cos a without friction."""
    rise, velocity, braking = 0.3, 0.2, 50.0
    rod = st.FiniteElementBeam(STEEL, SQUARE, 0.15, elements=4)
    contact = st.PointContact(rod.tip, st.RigidTrack(), inclination=rise)
    drive = st.ImposedVelocity(rod.root, velocity, normal_load=2.0)
    brake = st.Dashpot(rod.root, coefficient=braking, direction="y")
    found = st.sliding_stability(st.System(contact, drives=[drive], connections=[brake]))
    assert float(found.normal_force) == pytest.approx((2.0 + braking * velocity * tan(rise)) / cos(rise), rel=1e-9)


AGE = {"reference": 0.5, "a": 0.01, "b": 0.015, "slip_distance": 1e-3, "velocity": 1e-2}


@pytest.mark.parametrize("evolution", ["aging", "slip"])
@pytest.mark.parametrize("share", [0.9, 0.99, 1.01, 1.1])
def test_rate_and_state_swings_below_its_critical_stiffness(share, evolution):
    """``k_c = (b - a) N / D (1 + m V² / a N D)`` (Rice & Ruina 1983), by Hurwitz on m s³ + ..."""
    speed, distance = 0.02, AGE["slip_distance"]
    critical = (AGE["b"] - AGE["a"]) * WEIGHT / distance
    critical *= 1.0 + speed**2 / (AGE["a"] * WEIGHT * distance)
    law = st.RateAndState(**AGE, evolution=evolution, initial_state=distance / speed)
    known, seen = swings(law, share * critical, speed, skipped=1.0, kick=1e-6)
    assert (known.real > 0.0) == (share < 1.0)
    assert seen.real == pytest.approx(known.real, rel=0.02)
    assert seen.imag == pytest.approx(known.imag, rel=1e-4)


@pytest.mark.parametrize(("speed", "grows"), [(0.008, True), (0.02, True), (0.025, False)])
def test_bristles_swing_where_their_friction_falls(speed, grows):
    """The cubic of m x'' + k x + N r = 0 with r = s0 z + s1 z' + s2 v, z' = v - s0 |v| z / g, and in time."""
    s0, s1, s2, stiffness = 1e6, 1.0, 0.02, 1e4
    known, seen = swings(st.LuGre(0.32, 0.3, 0.01, s0, s1, s2), stiffness, speed, skipped=0.03)
    curve = 0.3 + 0.02 * np.exp(-((speed / 0.01) ** 2))
    weakening = -0.02 * 2.0 * speed / 1e-4 * np.exp(-((speed / 0.01) ** 2)) * speed / curve
    rate = s0 * speed / curve
    # z = weakening s x / (s + rate), and the force N ((s0 + s1 s) z + s2 s x).
    cubic = [1.0, rate + WEIGHT * s2 + WEIGHT * s1 * weakening]
    cubic += [stiffness + WEIGHT * s2 * rate + WEIGHT * s0 * weakening, stiffness * rate]
    roots = np.roots(cubic)
    swing = roots[np.argmax(roots.imag)]
    assert known == pytest.approx(complex(swing), rel=1e-6)
    assert (known.real > 0.0) == grows
    assert seen.real == pytest.approx(known.real, rel=0.02)
    assert seen.imag == pytest.approx(known.imag, rel=1e-3)


def pushed(degrees: float, friction: float, **force) -> st.System:
    rod = st.FiniteElementBeam(STEEL, SQUARE, 0.15, angle=radians(degrees), elements=8)
    track = st.ModalBeam(STEEL, SQUARE, 0.4, bending_modes=15, axial_modes=8)
    contact = st.PointContact(rod.tip, track, at=0.15, friction=st.Coulomb(friction))
    return st.System(contact, drives=[st.Force(rod.root, **force)])


@pytest.mark.parametrize("degrees", [20.0, 45.0, 60.0])
@pytest.mark.parametrize(("force", "limit"), [({"transverse": 2.0}, "cot"), ({"axial": -2.0}, "tan")])
def test_a_pushed_rod_slides_below_its_quasi_static_limit(degrees, force, limit):
    """N = F sin a across and F cos a along; below cot a or tan a it accelerates by (F_x - mu N) / M, above it holds."""
    a = radians(degrees)
    across = "transverse" in force
    down, along = (2.0 * sin(a), 2.0 * cos(a)) if across else (2.0 * cos(a), -2.0 * sin(a))
    edge = 1.0 / tan(a) if limit == "cot" else tan(a)
    below = st.sliding_stability(pushed(degrees, 0.99 * edge, **force))
    assert below.attrs["equilibrium"] == "sliding"
    assert float(below.normal_force) == pytest.approx(down)
    sense = np.sign(along)
    assert float(below.tangential_force) == pytest.approx(sense * 0.99 * edge * down)
    rate = (along - sense * 0.99 * edge * down) / (7800.0 * 1e-4 * 0.15)
    assert float(below.slip_acceleration) == pytest.approx(rate, rel=1e-6)
    above = st.sliding_stability(pushed(degrees, 1.01 * edge, **force))
    assert above.attrs["equilibrium"] == "held"
    assert str(above.status.values) == "sticking"
    assert float(above.tangential_force) == pytest.approx(along)


@pytest.mark.parametrize("degrees", [30.0, -30.0])
def test_a_rod_that_is_pulled_away_lifts_off(degrees):
    found = st.sliding_stability(pushed(degrees, 0.3, axial=2.0))
    assert found.attrs["equilibrium"] == "lifted off"
    assert float(found.normal_force) == 0.0
    assert np.sum(found.frequency.values == 0.0) == 2


@pytest.mark.parametrize("velocity", [0.7, -0.7])
@pytest.mark.parametrize("friction", [0.3, 0.5])
def test_a_hinged_rod_on_a_belt_carries_its_lever(velocity, friction):
    """Moments about the hinge: N (s -+ mu c) = F s, F down at the tip; a belt that comes along its lean digs in."""
    degrees, load = 40.0, 5.0
    rod = st.FiniteElementBeam(STEEL, SQUARE, 0.15, angle=radians(degrees), elements=6, root_support="pinned")
    contact = st.PointContact(rod.tip, st.RigidTrack(velocity=velocity), friction=st.Coulomb(friction))
    found = st.sliding_stability(st.System(contact, drives=[st.Force(rod.tip, y=-load)]))
    a, sense = radians(degrees), np.sign(velocity)
    assert found.attrs["equilibrium"] == "sliding"
    assert float(found.normal_force) == pytest.approx(load * sin(a) / (sin(a) - sense * friction * cos(a)), rel=1e-9)
    assert float(found.slip_velocity) == -velocity


def test_a_hinged_rod_jams_where_its_lever_runs_out():
    """Digging in beyond mu = tan a no force balances; the other way it slides at any friction."""

    def verdict(friction, velocity):
        rod = st.FiniteElementBeam(STEEL, SQUARE, 0.15, angle=radians(40.0), elements=6, root_support="pinned")
        contact = st.PointContact(rod.tip, st.RigidTrack(velocity=velocity), friction=st.Coulomb(friction))
        found = st.sliding_stability(st.System(contact, drives=[st.Force(rod.tip, y=-5.0)]))
        return found.attrs["equilibrium"], found.sizes["mode"] > 0

    limit = tan(radians(40.0))
    assert verdict(0.99 * limit, 0.7) == ("sliding", True)
    assert verdict(1.01 * limit, 0.7) == ("jammed", False)
    assert verdict(1.01 * limit, -0.7) == ("sliding", True)


@pytest.mark.parametrize("degrees", [30.0, 45.0, 60.0, 75.0])
def test_painleves_rod_jams_at_its_limit(degrees):
    """A uniform rigid rod at this angle to a belt that drags its tip into digging in."""
    to_ground = radians(degrees)
    limit = (tan(to_ground) + 4.0 / tan(to_ground)) / 3.0
    rod = st.FiniteElementBeam(
        STEEL, SQUARE, 0.4, angle=pi / 2.0 - to_ground, elements=1, cutoff=1.0, root_support="free"
    )

    def verdict(friction):
        contact = st.PointContact(rod.tip, st.RigidTrack(velocity=3.0), friction=st.Coulomb(friction))
        return st.sliding_stability(st.System(contact, drives=[st.Gravity()])).attrs["equilibrium"]

    assert verdict(0.999 * limit) != "jammed"
    assert verdict(1.001 * limit) == "jammed"


def test_weight_alone_is_held_and_a_push_beyond_friction_slides():
    """A guided rod under its weight: it slides above mu m g, with the acceleration of the excess force."""
    rod = st.FiniteElementBeam(STEEL, SQUARE, 0.15, angle=0.2, elements=6)
    weight = rod.total_mass * 9.80665

    def found(push):
        contact = st.PointContact(rod.tip, st.RigidTrack(), friction=st.Coulomb(0.4))
        return st.sliding_stability(st.System(contact, drives=[st.Gravity(), st.Force(rod.root, x=push)]))

    assert found(0.0).attrs["equilibrium"] == "held"
    assert found(0.39 * weight).attrs["equilibrium"] == "held"
    for sign in (1.0, -1.0):
        slides = found(0.45 * sign * weight)
        assert slides.attrs["equilibrium"] == "sliding"
        assert float(slides.slip_acceleration) == pytest.approx(0.05 * sign * 9.80665, rel=1e-6)
        assert float(slides.normal_force) == pytest.approx(weight)
