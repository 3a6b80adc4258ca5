"""Systems at the limits of the equations, each with a known answer."""

from __future__ import annotations

import os
import signal

import numpy as np
import pytest

import stridula as st

LAWS = [
    st.Coulomb(0.3),
    st.StaticKinetic(0.4, 0.3),
    st.Stribeck(0.4, 0.3, 0.1),
    st.LinearWeakening(0.4, 1.0, 0.3),
    st.LuGre(0.4, 0.3, 0.1, 1e4),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
def test_a_tip_that_moves_along_the_normal_only(law):
    """It lands and stays; the belt slides under it as prescribed, and pulls it by the ratio at that speed."""
    body = st.ReducedBody([[1.0]], [[1e4]], {"tip": (None, 0)})
    contact = st.PointContact(body.at("tip"), st.RigidTrack(velocity=0.2), friction=law)
    hold = st.System(contact, [st.Force(body.at("tip"), y=-5.0)])
    run = st.simulate(hold, 0.2, step=1e-4, sample_rate=1e4)
    # An impulse a step moves the rest point of the exact scheme's spring by (w h)² / 12.
    assert run.normal_force.values[-1] == pytest.approx(5.0, rel=1.01 * (100.0 * 1e-4) ** 2 / 12.0)
    ratio = float(run.tangential_force[-1] / run.normal_force[-1])
    assert ratio == pytest.approx(-float(law.coefficient_at(0.2)), rel=1e-6)
    assert run.slip_velocity.values[-1] == pytest.approx(-0.2, rel=1e-9)


def test_a_tip_that_cannot_move_along_the_normal_is_refused():
    body = st.ReducedBody([[1.0]], [[1e4]], {"tip": (0, None)})
    system = st.System(st.PointContact(body.at("tip"), st.RigidTrack(), name="floor"))
    with pytest.raises(ValueError, match=r"^contact floor must have a tip or a track that moves along its normal"):
        st.simulate(system, 0.01)


@pytest.mark.parametrize("coefficient", [5e4, 1e6, 1e9])
def test_a_dashpot_stronger_than_a_step_leaves_the_ledger_readable(coefficient):
    """A mass dragged by friction through oil: all of the drag, 0.3 * 10 N, times c / v goes into the dashpot."""
    mass = st.PointMass(1.0)
    system = st.System(
        st.PointContact(mass.centre, st.RigidTrack(velocity=0.5), friction=st.Coulomb(0.3)),
        [st.Force(mass.centre, y=-10.0)],
        [st.Dashpot(mass.centre, coefficient=coefficient)],
    )
    run = st.simulate(system, 0.1, step=1e-4)
    assert run.damping_loss.values[-1] == pytest.approx(3.0**2 / coefficient * 0.1, rel=2e-3)
    assert abs(run.attrs["initial_energy"]) < 1e-6
    assert np.abs(run.ledger_residual.values).max() < 1e-12


def test_a_mass_pushed_against_a_wall_shares_the_load_with_the_floor():
    """Any wall force from F - mu N to F + mu N is admissible, with the floor's that balances it."""
    mass, push, weight, mu = st.PointMass(1.0), 8.0, 9.81, 0.6
    contacts = [
        st.PointContact(mass.centre, st.RigidTrack(), friction=st.Coulomb(mu), name="floor"),
        st.PointContact(mass.centre, st.RigidTrack(), gap=0.01, inclination=np.pi / 2, name="wall"),
    ]
    run = st.simulate(st.System(contacts, [st.Force(mass.centre, x=push, y=-weight)]), 0.3, step=1e-5)
    wall, floor = (run.sel(contact=name).isel(time=-1) for name in ("wall", "floor"))
    # Round-off of the place, 1e-2 m, times mass over step squared.
    round_off = 2.2e-16 * 1e-2 / 1e-5**2
    assert float(wall.normal_force) == pytest.approx(push - float(floor.tangential_force), abs=round_off)
    assert abs(float(floor.tangential_force)) <= mu * weight + round_off
    assert float(floor.normal_force) == pytest.approx(weight, abs=round_off)


def test_a_ledger_that_is_no_number_stops_the_run():
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack(), gap=1.0)
    with pytest.raises(st.Diverged, match="no longer finite"):
        st.simulate(st.System(contact, [st.Force(mass.centre, y=-1e160)]), 0.1, step=1e-4)


def test_an_interrupt_in_the_last_chunk_is_not_lost():
    """The run is complete, and the interrupt is still raised."""

    class Pressed(st.Constant):
        def factor(self, time):
            if time.size > 3:
                os.kill(os.getpid(), signal.SIGINT)
            return super().factor(time)

    mass = st.PointMass(1.0)
    system = st.System(
        st.PointContact(mass.centre, st.RigidTrack()), [st.Force(mass.centre, y=-1.0, history=Pressed())]
    )
    with pytest.raises(st.Interrupted) as caught:
        st.simulate(system, 1e-3, step=1e-5, sample_rate=1e5)
    assert caught.value.record.sizes["time"] == 100
    assert caught.value.record.attrs["ended"] == "finished"
