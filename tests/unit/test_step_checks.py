"""A run held against the same run at half its step."""

from __future__ import annotations

import re

import numpy as np
import pytest

import stridula as st
from stridula.analysis.record_card import facts_of
from stridula.studies.step_checks import growth_of

MASS = st.PointMass(1.0)


def on_a_belt(law, **words):
    """A mass of 1 kg on a spring of 1 Hz and a belt, at its rest without friction, under 10 N."""
    contact = st.PointContact(MASS.centre, st.RigidTrack(velocity=0.3), friction=law)
    spring = st.Spring(MASS.centre, stiffness=(2 * np.pi) ** 2)
    return st.simulate(st.System(contact, [st.Force(MASS.centre, y=-10.0)], [spring]), probes=[], **words)


def test_a_fine_step_hardly_moves_the_results():
    found = st.check_step(on_a_belt(st.StaticKinetic(0.6, 0.3), duration=20.0, sample_rate=200.0))
    assert found.is_fine
    assert found.finer.attrs["step"] == 0.5 * found.step
    assert found.finer["time"].values[-1] == pytest.approx(20.0)
    assert {one.name for one in found.moved} >= {"frequency", "level", "sticking"}
    assert str(found).endswith("the step is fine enough for these results")


def test_a_coarse_step_is_named():
    """Four steps in a period."""
    found = st.check_step(on_a_belt(st.StaticKinetic(0.6, 0.3), duration=40.0, step=0.25, sample_rate=4.0))
    assert not found.is_fine
    assert "the step is too coarse for" in str(found)


def test_a_chaotic_run_is_judged_until_the_two_part():
    scenario = st.load_scenario("judder")
    found = st.check_step(scenario.simulate(duration=0.3))
    assert found.parted < 0.3
    assert found.is_fine
    assert f"forces agree until {found.parted:.4g} s" in str(found)
    assert "until then: " in str(found)


@pytest.mark.parametrize("rate", [5.0, 40.0])
def test_growth_is_that_of_a_growing_vibration(rate):
    time = np.arange(0.0, 1.0, 1e-4)
    forces = np.stack([100.0 + 1e-3 * np.exp(rate * time) * np.sin(600.0 * time), 30.0 + 0.0 * time])
    assert growth_of(forces, 1e-4) == pytest.approx(rate, rel=1e-2)
    bounded = 100.0 + np.minimum(np.exp(rate * time - 3.0), 1.0) * np.sin(600.0 * time)
    if rate > 10.0:
        assert np.isnan(growth_of(bounded[None, 4000:], 1e-4))


def test_continued_records_are_refused():
    first = on_a_belt(st.Coulomb(0.5), duration=1.0)
    contact = st.PointContact(MASS.centre, st.RigidTrack(velocity=0.3), friction=st.Coulomb(0.5))
    spring = st.Spring(MASS.centre, stiffness=(2 * np.pi) ** 2)
    system = st.System(contact, [st.Force(MASS.centre, y=-10.0)], [spring])
    second = st.simulate(system, 1.0, start=first, probes=[])
    with pytest.raises(ValueError, match=r"run must begin at its start, got one that goes on from 1 s"):
        st.check_step(second)


def test_the_card_says_where_events_last_few_steps():
    """Stick and slip in seven steps a period; in fifty there is no such line."""
    coarse, fine = (
        on_a_belt(st.StaticKinetic(0.6, 0.3), duration=60.0, step=step, sample_rate=1.0 / step) for step in (0.2, 0.02)
    )
    words = str(facts_of(coarse).get("coarse step"))
    assert re.match(r"[\d.]+ steps in a period", words)
    assert "coarse step" not in facts_of(fine)
