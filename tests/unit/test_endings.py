"""A run whose result is not valid is a failed one everywhere."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.analysis.record_card import ENDINGS
from stridula.integration.stops import CAUSE, WHAT
from stridula.records.endings import FAILED


def test_all_places_know_the_same_failures():
    assert set(WHAT) == set(CAUSE) == set(FAILED)
    assert set(FAILED) <= set(ENDINGS)


def test_a_run_that_ends_at_a_spring_too_stiff_is_failed():
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=50.0))
    spring = st.CubicSpring(mass.centre, stiffness=100.0, cubic=1e8)
    pushed = st.Force(mass.centre, x=1e4, history=st.Ramp(0.5))
    drives = [st.Force(mass.centre, y=-1.0), pushed]
    with pytest.raises(st.Diverged) as stopped:
        st.simulate(st.System(contact, drives, [spring]), 1.0, step=1e-3)
    record = stopped.value.record
    assert record.attrs["ended"] == "spring too stiff"
    assert np.isfinite(record["kinetic_and_elastic"]).all()
    # Its regime is a guess; the negative control is a run of the same samples that reached its end.
    assert float(st.regime(record).confidence) == 0.5
    assert float(st.regime(record.assign_attrs(ended="finished")).confidence) > 0.5
