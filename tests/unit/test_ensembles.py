"""Ensembles: perturbed starts, means and their intervals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from stridula.studies import mean_and_interval, share_of
from stridula.studies.ensembles import _perturbed

STEEL = st.Material(2.1e11, 7800.0)


def sliding_block(velocity: float = 1.0, **options) -> st.System:
    """Return a mass that slides out on a floor: it stops at v²/(2 mu g)."""
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack(), friction=st.Coulomb(0.5), **options)
    return st.System(contact, [st.Gravity(10.0), st.InitialVelocity(mass, x=velocity)])


def last_place(run) -> float:
    return float(run["contact_position"][-1])


def test_the_mean_of_perturbed_starts_and_its_interval_are_those_of_the_runs():
    found = st.ensemble(sliding_block(), 0.3, {"place": last_place}, runs=5, perturbation=1e-2, sample_rate=1e4)
    shares, places = found["perturbation"].values, found["place"].values
    assert shares[0] == 0.0
    assert 0.0 < np.abs(shares[1:]).max() <= 1e-2
    # Pushed to v (1 + s), it stops at v² (1 + s)² / (2 mu g).
    np.testing.assert_allclose(places, (1.0 + shares) ** 2 / (2.0 * 0.5 * 10.0), rtol=2e-3)
    np.testing.assert_allclose(places / places[0], (1.0 + shares) ** 2, rtol=1e-4)
    mean, half = mean_and_interval(places)
    assert float(found["place_mean"]) == mean == pytest.approx(places.mean())
    np.testing.assert_allclose(found["place_interval"], [mean - half, mean + half])
    assert list(found["ended"].values) == ["finished"] * 5


def test_a_closed_start_is_pushed_in_proportion_to_the_velocity_prescribed():
    for velocity, scale in ((-3.0, 3.0), (0.0, 1.0)):
        push = _perturbed(sliding_block(velocity), 1e-3).drives[-1]
        assert (push.x, push.y) == (pytest.approx(1e-3 * scale), 0.0)
    belt = st.System(st.PointContact(st.PointMass(1.0).centre, st.RigidTrack(velocity=5.0), inclination=np.pi / 2))
    push = _perturbed(belt, 1e-3).drives[-1]
    assert (push.x, push.y) == (0.0, pytest.approx(5e-3))


def test_equal_seeds_give_equal_ensembles_whatever_the_workers():
    measures = {"place": last_place, "sliding": share_of("sliding")}
    options = {"runs": 3, "perturbation": 1e-2, "sample_rate": 1e4}
    one, two, other = (
        st.ensemble(sliding_block(), 0.3, measures, seed=seed, workers=workers, **options)
        for seed, workers in ((1, 1), (1, 3), (2, 3))
    )
    assert one.equals(two)
    assert not one.equals(other)


def test_the_interval_is_students():
    mean, half = mean_and_interval([1.0, 2.0, 3.0, np.nan, np.inf])
    # t(0.975, 2) = 4.3027 (e.g. Abramowitz & Stegun, table 26.10).
    assert mean == 2.0
    assert half == pytest.approx(4.302653 / np.sqrt(3.0), rel=1e-6)
    assert mean_and_interval([1.0, 2.0, 3.0], confidence=0.99)[1] > 2.0 * half
    assert np.isnan(mean_and_interval([1.0])[1])
    assert np.isnan(mean_and_interval([])).all()


def starts(system: st.System) -> tuple[st.System, np.ndarray]:
    moved = _perturbed(system, 1e-3)
    runs = [st.simulate(each, 2e-3, sample_rate=5e4) for each in (system, moved)]
    return moved, np.abs([runs[1][name] - runs[0][name] for name in ("contact_position", "contact_height")])


def beams(**contact):
    section = st.Rectangle(0.02, 0.01)
    rod = st.FiniteElementBeam(STEEL, section, 0.5, angle=-0.3, elements=4, cutoff=5e3)
    return st.PointContact(rod.tip, st.ModalBeam(STEEL, section, 0.9, cutoff=5e3), at=0.3, **contact)


REDUCED = st.ReducedBody(np.eye(2), np.diag([1e6, 2e6]), {"tip": (0, 1)})
SYSTEMS = {
    "open": st.System(beams(gap=1e-6, friction=st.Coulomb(0.3)), [st.Gravity()]),
    "closed": st.System(beams(friction=st.Coulomb(0.3)), [st.Gravity()]),
    "dragged": st.System(
        contact := beams(friction=st.Coulomb(0.3)), [st.ImposedVelocity(contact.tip.body.root, 0.1, normal_load=5.0)]
    ),
    "on a belt": st.System(
        st.PointContact(st.PointMass(1.0).centre, st.RigidTrack(velocity=2.0), inclination=0.4),
        [st.Gravity(), st.InitialVelocity(st.PointMass(1.0), x=np.cos(0.4), y=np.sin(0.4))],
    ),
    "reduced": st.System(st.PointContact(REDUCED.at("tip"), st.RigidTrack(), friction=st.Coulomb(0.1)), []),
}


@pytest.mark.parametrize("name", SYSTEMS)
def test_any_system_can_be_perturbed_a_little(name):
    moved, apart = starts(SYSTEMS[name])
    assert moved != SYSTEMS[name]
    assert moved.contacts[0].tip == SYSTEMS[name].contacts[0].tip
    assert 0.0 < apart.max() < 1e-4
    assert _perturbed(SYSTEMS[name], 0.0) is SYSTEMS[name]


def test_of_several_contacts_only_the_first_gap_moves():
    mass, floor = st.PointMass(1.0), st.RigidTrack()
    contacts = [st.PointContact(mass.centre, floor, gap=1e-3), st.PointContact(mass.centre, floor, gap=2.0, name="b")]
    moved = _perturbed(st.System(contacts), 0.01)
    assert [contact.gap for contact in moved.contacts] == [1e-3 * 1.01, 2.0]


def test_a_run_that_diverged_is_reported_and_the_others_continue(monkeypatch):
    """A force that overflows in one run of four."""
    from stridula.studies import ensembles

    huge = st.Force(sliding_block().slider.centre, y=-1e300)

    def perturbed(system, share):
        return replace(system, drives=(*system.drives, huge)) if share == shares[2] else system

    options = {"runs": 4, "sample_rate": 1e4}
    shares = st.ensemble(sliding_block(), 0.1, {"place": last_place}, **options)["perturbation"].values
    monkeypatch.setattr(ensembles, "_perturbed", perturbed)
    found = st.ensemble(sliding_block(), 0.1, {"place": last_place}, **options)
    assert list(np.isnan(found["place"].values)) == [False, False, True, False]
    assert list(found["ended"].values) == ["finished", "finished", "not finite", "finished"]
    assert "no longer finite" in str(found["message"].values[2])
    assert float(found["place_mean"]) == pytest.approx(np.nanmean(found["place"].values))


def test_shares_of_states_are_those_of_the_record():
    system = sliding_block()
    run = st.simulate(system, 0.3, sample_rate=1e4)
    assert share_of("sliding")(run) == pytest.approx(2.0 / 3.0, abs=1e-3)
    two = st.System([*system.contacts, st.PointContact(system.slider.centre, st.RigidTrack(), gap=1.0, name="high")])
    run = st.simulate(two, 1e-3)
    assert share_of("separated", "high")(run) == 1.0
    with pytest.raises(ValueError, match=r"choose one with run\.sel\(contact=\.\.\.\)"):
        share_of("sliding")(run)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"system": 3}, "system must be a System, got 3"),
        ({"duration": 0.0}, "duration must be above 0"),
        ({"measures": {}}, "measures must hold at least one function"),
        ({"measures": [last_place]}, "measures must be a Mapping"),
        ({"measures": {"a": 3}}, "measures must be functions of a record by name, got 'a': 3"),
        ({"measures": {"a": last_place, "a_mean": last_place}}, "results of others, got 'a_mean'"),
        ({"measures": {"a": lambda run: run}}, r"measures\['a'\] must return a number, got a Dataset"),
        ({"runs": 1}, "runs must be at least 2"),
        ({"perturbation": 0.5}, "perturbation must be from 0 to 0.1"),
        ({"confidence": 1.0}, "confidence must be strictly between 0 and 1"),
        ({"seed": -1}, "seed must be at least 0"),
        ({"workers": 0}, "workers must be at least 1"),
        ({"start": None}, "start must be left out"),
        ({"step": -1.0}, "step must be above 0"),
    ],
)
def test_bad_arguments_are_reported(change, message):
    arguments = {"system": sliding_block(), "duration": 1e-3, "measures": {"place": last_place}, "runs": 2} | change
    system, duration, measures = (arguments.pop(name) for name in ("system", "duration", "measures"))
    with pytest.raises(ValueError, match=message):
        st.ensemble(system, duration, measures, **arguments)
