"""Friction that depends on the place along the track, against integrations of the same equations."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st


def test_the_text_shows_a_patch_between_equal_ends():
    dry, oily = st.Coulomb(0.5), st.Coulomb(0.1)
    assert str(st.FrictionAlongTrack([0.0, 0.1, 0.2], [dry, oily, dry])) == "0.5, 0.1, 0.5 at 3 places from 0 to 0.2 m"
    patch = st.FrictionAlongTrack([0.0, 0.01, 0.1, 0.11, 2.0], [dry, oily, oily, dry, dry])
    assert str(patch) == "0.5 to 0.5, held by 0.1 to 0.5, at 5 places from 0 to 2 m"


def law_of(random, periodic, kind):
    """A law of a kind at random places, with a function of place and slip speed."""
    count = int(random.integers(3, 7))
    places = np.cumsum(random.uniform(0.05, 0.3, count)) - 0.4
    shares = random.uniform(0.3, 1.0, count)
    if periodic:
        shares[-1] = shares[0]
    laws = [kind(float(share)) for share in shares]
    law = st.FrictionAlongTrack(places.tolist(), laws, periodic=periodic)

    def coefficient(place, speed):
        there = places[0] + np.mod(place - places[0], np.ptp(places)) if periodic else place
        return np.interp(there, places, shares) * float(kind(1.0).coefficient_at(speed))

    return law, coefficient


KINDS = {
    "coulomb": lambda share: st.Coulomb(0.5 * share),
    "static-kinetic": lambda share: st.StaticKinetic(0.5 * share, 0.4 * share),
    "stribeck": lambda share: st.Stribeck(0.5 * share, 0.35 * share, 2.0),
    "table": lambda share: st.TabulatedFriction([0.0, 1.0, 3.0], [0.5 * share, 0.4 * share, 0.45 * share]),
}


def motion(rates, start, times):
    return solve_ivp(rates, (0.0, times[-1]), start, "DOP853", times, rtol=1e-10, atol=1e-13, max_step=2e-3).y


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(4))
def test_a_mass_slides_over_patches_as_its_equation_says(kind, seed):
    """On a belt that is too fast for it to stick, in either sense, periodic or not, with both schemes."""
    random = np.random.default_rng(seed)
    law, coefficient = law_of(random, bool(seed % 2), KINDS[kind])
    mass, load, stiffness = (
        st.PointMass(random.uniform(0.5, 2.0)),
        random.uniform(5.0, 20.0),
        random.uniform(50.0, 400.0),
    )
    speed = random.choice([-1.0, 1.0]) * random.uniform(1.5, 2.5)
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=speed), friction=law)
    system = st.System(contact, [st.Force(mass.centre, y=-load)], [st.Spring(mass.centre, stiffness=stiffness)])
    scheme = (st.ExactModal(), st.CentralDifference())[seed // 2]
    probes = [st.Displacement(mass.centre, "x")]
    run = st.simulate(system, 1.0, step=1e-4, sample_rate=1e3, scheme=scheme, probes=probes)

    def rates(t, y):
        slip = y[1] - speed
        friction = -np.sign(slip) * load * coefficient(y[0] - speed * t, abs(slip))
        return [y[1], (friction - stiffness * y[0]) / mass.mass]

    exact = motion(rates, [0.0, 0.0], run["time"].values)[0]
    assert np.abs(run["displacement"].values[:, 0] - exact).max() < 1e-5 * np.abs(exact).max()
    assert float(np.abs(run["ledger_residual"]).max()) < 1e-9 * float(np.abs(run["drive_work"]).max())
    ratio = np.abs(run["tangential_force"].values) / run["normal_force"].values
    assert ratio.max() <= max(float(one.coefficient_at(1e-9)) for one in law.laws) * (1.0 + 1e-9)


def test_it_sticks_and_slips_over_patches_as_its_equation_says():
    """Stick-slip on a slow belt from event to event: it sticks until the spring pulls as hard as the patch holds."""
    mass, speed, load, stiffness = 0.5, 0.2, 10.0, 80.0
    places, shares = [0.0, 0.03, 0.06, 0.09], [0.4, 0.4, 0.15, 0.4]
    law = st.FrictionAlongTrack(places, [st.Coulomb(share) for share in shares], periodic=True)
    body = st.PointMass(mass)
    contact = st.PointContact(body.centre, st.RigidTrack(velocity=speed), friction=law)
    system = st.System(contact, [st.Force(body.centre, y=-load)], [st.Spring(body.centre, stiffness=stiffness)])
    run = st.simulate(system, 4.0, step=2e-4, sample_rate=1e3, probes=[st.Displacement(body.centre, "x")])
    times = run["time"].values
    expected = event_driven(
        mass, speed, load, stiffness, lambda place: np.interp(np.mod(place, 0.09), places, shares), times
    )
    assert 0.05 < float(run["status_share"].sel(contact_status="sticking").mean()) < 0.95
    assert np.abs(run["displacement"].values[:, 0] - expected).max() < 2e-3 * np.abs(expected).max()


def event_driven(mass, speed, load, stiffness, coefficient, times):
    """Place of a mass on a belt over time, from stick to slip and back."""
    place, velocity, now, sticks = 0.0, 0.0, 0.0, False
    found = np.zeros_like(times)

    def spare(t, y):
        return load * coefficient(y[0] - speed * t) - stiffness * abs(y[0])

    while now < times[-1]:
        sense = 1.0 if velocity < speed or (velocity == speed and place > 0.0) else -1.0

        def rates(t, y, sense=sense, sticks=sticks):
            if sticks:
                return [speed, 0.0]
            return [y[1], (sense * load * coefficient(y[0] - speed * t) - stiffness * y[0]) / mass]

        def meets(t, y):
            return y[1] - speed

        event = spare if sticks else meets
        event.terminal, event.direction = True, -1.0 if sticks else sense
        words = {"events": event, "rtol": 1e-10, "atol": 1e-13, "max_step": 1e-3, "dense_output": True}
        leg = solve_ivp(rates, (now, times[-1] + 1e-9), [place, velocity], "DOP853", **words)
        inside = (times >= now) & (times <= leg.t[-1])
        found[inside] = leg.sol(times[inside])[0]
        now, (place, velocity) = leg.t[-1], leg.y[:, -1]
        if leg.status == 1 and not sticks:
            velocity, sticks = speed, spare(now, [place]) > 0.0
        elif leg.status == 1:
            sticks = False
            velocity = speed - 1e-9 * np.sign(place)
    return found


def test_on_a_beam_the_place_is_its_abscissa():
    bar = st.ModalBeam(st.Material(2.1e11, 7800.0, 0.3), st.Rectangle(0.02, 0.02), 1.0, cutoff=500.0)
    mass = st.PointMass(0.01)
    law = st.FrictionAlongTrack([0.3, 0.31, 0.5, 0.51], [st.Coulomb(mu) for mu in (0.1, 0.4, 0.4, 0.2)])
    drives = [st.Force(mass.centre, y=-1.0), st.InitialVelocity(mass, x=9.0)]
    system = st.System(st.PointContact(mass.centre, bar, at=0.2, friction=law), drives)
    run = st.simulate(system, 0.05, sample_rate=1e4)
    place = run["contact_position"].values
    ratio = run["tangential_force"].values / run["normal_force"].values
    # Forces are means over an interval, at whose end the place is.
    place = place - 0.5 * np.diff(place, prepend=0.2)
    sliding = np.isfinite(ratio) & (run["slip_velocity"].values > 0.1) & (run["normal_force"].values > 0.1)
    assert place[sliding].max() > 0.5
    expected = np.interp(place[sliding], law.place, [0.1, 0.4, 0.4, 0.2])
    assert np.abs(ratio[sliding] - expected).max() < 2e-3


def patched(k=0, law=None):
    mass = st.PointMass(1.0)
    laws = [st.StaticKinetic(0.5, 0.3), st.StaticKinetic(0.3 + 0.02 * k, 0.2), st.StaticKinetic(0.5, 0.3)]
    law = law or st.FrictionAlongTrack([0.0, 0.2, 0.5], laws, periodic=True)
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=0.5), friction=law)
    return st.System(contact, [st.Force(mass.centre, y=-10.0)], [st.Spring(mass.centre, stiffness=60.0)])


WORDS = {"step": 1e-3, "sample_rate": 1e3}


def test_equal_laws_everywhere_are_that_law():
    one = st.StaticKinetic(0.5, 0.3)
    along = st.simulate(patched(law=st.FrictionAlongTrack([0.0, 0.2], [one, one], periodic=True)), 3.0, **WORDS)
    alone = st.simulate(patched(law=one), 3.0, **WORDS)
    np.testing.assert_allclose(along["contact_position"], alone["contact_position"], rtol=0.0, atol=1e-12)


def test_a_run_continues_bit_by_bit_and_can_be_run_again():
    whole = st.simulate(patched(), 4.0, **WORDS)
    assert 0.02 < float(whole["status_share"].sel(contact_status="sticking").mean()) < 0.9
    rest = st.simulate(patched(), 2.0, start=st.simulate(patched(), 2.0, **WORDS), **WORDS)
    last = whole["contact_position"].values[-rest.sizes["time"] :]
    np.testing.assert_array_equal(last, rest["contact_position"].values)
    again = st.load_scenario(whole).simulate()
    np.testing.assert_array_equal(again["contact_position"], whole["contact_position"])
    assert "temperature" not in whole


def test_runs_side_by_side_are_those_alone():
    systems = [patched(k) for k in range(8)]
    for system, found in zip(systems, st.simulate_many(systems, 1.0, **WORDS), strict=True):
        alone = st.simulate(system, 1.0, **WORDS)
        np.testing.assert_allclose(found["contact_position"], alone["contact_position"], rtol=0.0, atol=1e-10)


def test_linear_theory_takes_friction_at_the_start():
    law = st.FrictionAlongTrack([0.0, 1.0], [st.Stribeck(0.5, 0.3, 0.4), st.Stribeck(0.3, 0.1, 0.4)])
    system = patched(law=law)
    for place in (0.0, 0.25, 0.6):
        moved = replace(system.contacts[0], at=place)
        along = st.sliding_stability(replace(system, contact=moved))
        alone = st.sliding_stability(replace(system, contact=replace(moved, friction=law.at(place))))
        np.testing.assert_allclose(along["growth_rate"], alone["growth_rate"], rtol=1e-12)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (
            lambda: st.FrictionAlongTrack([0.0, 1.0], [st.Coulomb(0.1), st.Coulomb(0.2)], periodic=True),
            r"^laws\[1\] must be that of the first place a period later",
        ),
        (lambda: st.FrictionAlongTrack([0.0, 0.0], [st.Coulomb(0.1)] * 2), r"^place\[1\] must be above 0.0"),
        (
            lambda: st.FrictionAlongTrack([0.0, 1.0], [st.Coulomb(0.1)]),
            r"^laws must have as many laws as places, 2, got 1",
        ),
        (
            lambda: st.FrictionAlongTrack([0.0, 1.0], [st.Coulomb(0.1)] * 2, periodic="yes"),
            r"^periodic must be True or F",
        ),
        (
            lambda: st.limit_cycle(patched(), st.simulate(patched(), 1.0)),
            "have friction that is the same along the track",
        ),
    ],
)
def test_what_cannot_be_is_named(make, words):
    with pytest.raises(ValueError, match=words):
        make()


def test_a_temperature_beside_the_place_is_refused():
    one = st.PointMass(1.0, "one")
    law = patched().contacts[0].friction
    with pytest.raises(ValueError, match=r"^heating must be left out under friction that depends on the place"):
        st.PointContact(one.centre, st.RigidTrack(), friction=law, heating=st.HeatedLayers(1.0))


def test_figures_name_the_places():
    figure = st.plot.friction(patched().contacts[0].friction)
    words = " ".join(text.get_text() for text in figure.findobj(match=lambda one: hasattr(one, "get_text")))
    assert "0.2 m" in words


SCENARIO = """
[bodies.block]
kind = "point mass"
mass = 1.0
[[contacts]]
tip = { body = "block" }
track = { kind = "rigid", velocity = 0.5 }
[contacts.friction]
law = "along track"
place = [0, "20 cm", 0.5]
laws = [
    { law = "coulomb", coefficient = 0.5 },
    { law = "coulomb", coefficient = 0.3 },
    { law = "coulomb", coefficient = 0.5 },
]
periodic = true
[[drives]]
kind = "force"
body = "block"
y = -10.0
[simulation]
duration = 0.1
"""


def test_a_scenario_has_it(tmp_path):
    path = tmp_path / "patches.toml"
    path.write_text(SCENARIO)
    law = st.load_scenario(path).system.contacts[0].friction
    assert law == st.FrictionAlongTrack([0.0, 0.2, 0.5], [st.Coulomb(mu) for mu in (0.5, 0.3, 0.5)], periodic=True)
    path.write_text(SCENARIO.replace('    { law = "coulomb", coefficient = 0.3 },\n', ""))
    with pytest.raises(ValueError, match="laws must have as many laws as places, 3, got 2"):
        st.load_scenario(path)
