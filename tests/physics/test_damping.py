"""Every form of damping against closed forms: decay of a mode, energy lost a cycle, on every body, in both schemes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st

STEEL = st.Material(2.1e11, 7800.0, 0.3)
STRIP = st.Rectangle(0.02, 0.005)
SAMPLES = ([0.0, 300.0, 2000.0], [0.002, 0.01, 0.05])

# Damping ratio of a mode of frequency f [Hz] under each form.
FORMS = {
    "ratio": (0.013, lambda f: 0.013 + 0.0 * f),
    "rayleigh": (st.Rayleigh(30.0, 2e-6), lambda f: 30.0 / (4 * np.pi * f) + 2e-6 * np.pi * f),
    "Kelvin-Voigt": (st.Rayleigh(0.0, 2e-6), lambda f: 2e-6 * np.pi * f),
    "rising": (st.RisingDamping(0.003, 1e-5), lambda f: 0.003 + 1e-5 * f),
    "sampled": (st.SampledDamping(*SAMPLES), lambda f: np.interp(f, *SAMPLES)),
}


def rod(damping, **changes):
    return st.FiniteElementBeam(STEEL, STRIP, 0.4, elements=6, damping=damping, root_support="pinned", **changes)


def bar(damping):
    return st.ModalBeam(STEEL, STRIP, 0.8, bending_modes=5, axial_modes=2, damping=damping)


def sheet(damping):
    return st.ModalPlate(
        STEEL, 0.002, 0.4, 0.3, bending_modes=(3, 2), in_plane=True, in_plane_modes=(1, 1), damping=damping
    )


def block(damping):
    stiffness = 1e5 * np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    return st.ReducedBody(0.3 * np.eye(3), stiffness, {"tip": (0, 1)}, damping=damping)


BODIES = {"finite-element beam": rod, "modal beam": bar, "plate": sheet, "reduced body": block}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("body", BODIES)
def test_modes_have_the_ratio_of_their_frequency(body, form):
    damping, ratio = FORMS[form]
    modes = BODIES[body](damping).modes()
    elastic = modes.angular_frequency > 0.0
    f = modes.frequency[elastic]
    np.testing.assert_allclose(modes.damping[elastic], ratio(f), rtol=1e-12)
    np.testing.assert_allclose(modes.damping_rate[elastic], 4 * np.pi * f * ratio(f), rtol=1e-12)
    assert modes.damping_matrix is None
    # No force is needed to translate or to turn a beam, but mass-proportional damping brakes it.
    np.testing.assert_allclose(modes.damping_rate[~elastic], 30.0 if form == "rayleigh" else 0.0, rtol=1e-12)


def decayed(w, rate, t):
    """Displacement and velocity after t of a mode released at 1 with no velocity, for any damping."""
    roots = np.roots([1.0, rate, w**2]).astype(complex)
    if abs(roots[0] - roots[1]) < 1e-6 * w:
        return np.exp(-w * t) * (1 + w * t), -np.exp(-w * t) * w**2 * t
    first, second = roots
    position = (first * np.exp(second * t) - second * np.exp(first * t)) / (first - second)
    velocity = first * second * (np.exp(second * t) - np.exp(first * t)) / (first - second)
    return position.real, velocity.real


def far(body):
    """A system whose contact never closes, started with a displacement of the body."""
    wall = st.RigidTrack()
    return st.PointContact(body.at("tip"), wall, at=0.0, gap=1e3)


def oscillator(ratio, w=300.0, mass=0.2):
    """A mass on two springs with a damping ratio from a law; one and above by a law only."""
    damping = st.RisingDamping(0.0, ratio / (w / (2 * np.pi)))
    return st.ReducedBody(mass * np.eye(2), mass * w**2 * np.eye(2), {"tip": (0, 1)}, damping=damping)


@pytest.mark.parametrize("scheme", [st.ExactModal(), st.CentralDifference()], ids=lambda s: s.name)
@pytest.mark.parametrize("ratio", [0.02, 0.5, 1.0, 1.3, 8.0])
def test_a_mode_decays_as_the_closed_form(ratio, scheme):
    body = oscillator(ratio)
    np.testing.assert_allclose(body.modes().damping, ratio, rtol=1e-12)
    system = st.System(far(body), [st.InitialState(body, displacement=[0.0, 1e-3])])
    probes = [st.Displacement(body.at("tip"), "y"), st.Velocity(body.at("tip"), "y")]
    errors = []
    for step in (2e-5, 1e-5):
        run = st.simulate(system, 0.02, scheme=scheme, step=step, sample_rate=1 / step, probes=probes)
        t = run.time.values
        position, _ = decayed(300.0, 600.0 * ratio, t)
        errors.append(float(np.abs(run["displacement"].values[:, 0] / 1e-3 - position).max()))
    if scheme.name == "exact modal":
        assert max(errors) < 1e-9
    else:
        assert errors[1] < 2e-4
        assert 3.5 < errors[0] / errors[1] < 4.5


@pytest.mark.parametrize("wrong", [1.01, 0.99])
def test_a_ratio_off_by_a_percent_is_detected(wrong):
    body = oscillator(1.3)
    system = st.System(
        far(oscillator(1.3 * wrong)), [st.InitialState(oscillator(1.3 * wrong), displacement=[0.0, 1e-3])]
    )
    run = st.simulate(system, 0.02, step=1e-5, sample_rate=5e4, probes=[st.Displacement(system.contact.tip, "y")])
    position, _ = decayed(300.0, 2 * 300.0 * float(body.modes().damping[0]), run.time.values)
    assert np.abs(run["displacement"].values[:, 0] / 1e-3 - position).max() > 1e-4


def test_mass_proportional_damping_brakes_free_flight():
    """v = v0 exp(-alpha t) for a free body."""
    body = st.ReducedBody(0.2 * np.eye(2), np.zeros((2, 2)), {"tip": (0, 1)}, damping=st.Rayleigh(40.0, 0.0))
    system = st.System(far(body), [st.InitialState(body, velocity=[0.7, 0.0])])
    run = st.simulate(system, 0.1, step=1e-4, probes=[st.Displacement(body.at("tip"), "x")])
    t = run.time.values
    np.testing.assert_allclose(run["displacement"].values[:, 0], 0.7 * -np.expm1(-40.0 * t) / 40.0, rtol=1e-10)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("scheme", [st.ExactModal(), st.CentralDifference()], ids=lambda s: s.name)
def test_energy_lost_a_cycle_of_a_forced_mode(form, scheme):
    """In the steady state damping takes ``pi d w X²`` a cycle from each mode of amplitude X, as does the ledger."""
    damping, ratio = FORMS[form]
    track = st.ModalBeam(STEEL, STRIP, 0.8, bending_modes=1, axial_modes=0, damping=damping)
    own = track.modes().angular_frequency[0]
    forced = 0.8 * own
    tip = st.PointMass(1.0)
    force = st.Force(track.centre, y=3.0, history=st.Harmonic(forced / (2 * np.pi)))
    lift = st.Spring(tip.centre, stiffness=1.0)
    system = st.System(st.PointContact(tip.centre, track, at=0.4, gap=1e3), [force], [lift])
    zeta = float(ratio(own / (2 * np.pi)))
    period = 2 * np.pi / forced
    settled = max(20, int(np.ceil(14.0 / (zeta * own * period))))
    cycles = 20
    run = st.simulate(system, (settled + cycles) * period, scheme=scheme, step=period / 800, sample_rate=8.0 / period)
    lost = float(run["damping_loss"][-1] - run["damping_loss"].interp(time=settled * period)) / cycles
    modal = 3.0 * track.amplitude
    amplitude = modal / abs(own**2 - forced**2 + 2j * zeta * own * forced)
    expected = np.pi * 2 * zeta * own * forced * amplitude**2
    assert lost == pytest.approx(expected, rel=5e-4)


def test_overdamped_modes_of_a_track_in_contact_keep_the_ledger():
    """High modes of a beam under strong material damping are overdamped; contact and energy are as exact as ever."""
    squeal = st.load_scenario("squeal", {"damping": {"form": "rayleigh", "mass": 0.0, "stiffness": 5e-5}})
    ratios = squeal.system.track.modes().damping
    assert ratios[0] < 0.05
    assert ratios.max() > 2.0
    run = st.simulate(squeal.system, 0.1)
    assert run.attrs["ended"] == "finished"
    scale = float(np.abs(run["drive_work"]).max())
    assert float(np.abs(run["ledger_residual"]).max()) < 1e-10 * scale
    cone = np.abs(run.tangential_force) - 1.5 * run.normal_force
    assert float(cone.max()) < 1e-9 * float(run.normal_force.max())


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: st.RisingDamping(-0.1, 0.0), "ratio must be 0 or above, got -0.1"),
        (lambda: st.RisingDamping(1.0, 0.0), r"ratio must be below 1 \(critical\), got 1.0"),
        (lambda: st.RisingDamping(0.1, float("nan")), "rise must be finite, got nan"),
        (lambda: st.SampledDamping([1.0, 1.0], [0.1, 0.1]), r"frequency\[1\] must be above 1.0"),
        (lambda: st.SampledDamping([1.0, 2.0], [0.1]), "ratio must have as many values as frequency"),
        (lambda: st.SampledDamping([], []), "ratio must have as many values as frequency, one or more"),
        (lambda: st.SampledDamping([1.0], [1.5]), r"ratio\[0\] must be below 1"),
        (lambda: st.SampledDamping(3.0, [0.5]), "frequency must be a list of numbers, got 3.0"),
        (lambda: rod(st.Rayleigh), "damping must be a number"),
        (lambda: rod([0.1] * 3).modes(), "damping must have one ratio or 19, one for each mode kept, got 3"),
    ],
)
def test_bad_laws_are_named(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_laws_are_compared_by_content():
    assert bar(st.RisingDamping(0.1, 1e-6)) == bar(st.RisingDamping(0.1, 1e-6))
    assert bar(st.RisingDamping(0.1, 1e-6)) != bar(st.RisingDamping(0.1, 2e-6))
    assert hash(rod(st.SampledDamping(*SAMPLES))) == hash(rod(st.SampledDamping(*map(np.array, SAMPLES))))
    assert block(st.RisingDamping(0.1, 1e-6)) != block(st.Rayleigh(0.1, 1e-6))


@pytest.mark.parametrize("form", FORMS)
def test_a_record_runs_again_under_every_form(form):
    base = st.load_scenario("squeal", {"duration": "5 ms"}).system
    damping = FORMS[form][0]
    track = replace(base.track, damping=damping)
    slider = replace(base.slider, damping=damping)
    contact = replace(base.contact, tip=slider.tip, track=track)
    system = replace(base, contact=contact, drives=[replace(base.drives[0], point=slider.root)])
    run = st.simulate(system, 5e-3)
    again = st.load_scenario(run)
    assert again.system == system
    np.testing.assert_array_equal(again.simulate()["normal_force"], run["normal_force"])
