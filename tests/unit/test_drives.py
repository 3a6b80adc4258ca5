"""Drives and contact: refused arguments, and the directions of forces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physics.cases import SCHEMES, every_step, pair, slider, track

import stridula as st
from stridula.checks import brief
from stridula.drives import DRIVES

NAN, INF = float("nan"), float("inf")
ROD, BAR = slider(30.0), track()
FINITE = [NAN, INF, -INF, True, "1", None, [1.0]]


def contact(**changes):
    words = {"tip": ROD.tip, "track": BAR, "at": 0.2, "friction": st.Coulomb(0.5)} | changes
    return st.PointContact(**words)


MAKERS = {
    "Force.point": (lambda v: st.Force(v), "point", [None, ROD, 0.1, "root"]),
    **{
        f"Force.{name}": (lambda v, name=name: st.Force(ROD.root, **{name: v}), name, FINITE)
        for name in ("axial", "transverse", "x", "y")
    },
    "Force.history": (lambda v: st.Force(ROD.root, history=v), "history", [None, 1.0, "ramp", np.sin]),
    "ImposedVelocity.point": (
        lambda v: st.ImposedVelocity(v, 0.1),
        "point",
        [None, ROD, 0.1],
    ),
    "ImposedVelocity.velocity": (lambda v: st.ImposedVelocity(ROD.root, v), "velocity", FINITE),
    "ImposedVelocity.normal_load": (
        lambda v: st.ImposedVelocity(ROD.root, 0.1, normal_load=v),
        "normal_load",
        FINITE,
    ),
    "ImposedVelocity.history": (
        lambda v: st.ImposedVelocity(ROD.root, 0.1, history=v),
        "history",
        [None, 1.0, "ramp", np.sin],
    ),
    "Gravity.acceleration": (lambda v: st.Gravity(v), "acceleration", [*FINITE, 0.0, -9.81]),
    "InitialVelocity.body": (lambda v: st.InitialVelocity(v), "body", [None, ROD.tip, "slider"]),
    "InitialVelocity.x": (lambda v: st.InitialVelocity(ROD, x=v), "x", FINITE),
    "InitialVelocity.y": (lambda v: st.InitialVelocity(ROD, y=v), "y", FINITE),
    "InitialEquilibrium.status": (lambda v: st.InitialEquilibrium(v), "status", [3, "stuck", ""]),
    "InitialEquilibrium.velocity": (
        lambda v: st.InitialEquilibrium(velocity=v),
        "velocity",
        [NAN, INF, True, "1"],
    ),
    "InitialEquilibrium.mode": (
        lambda v: st.InitialEquilibrium(mode=v, amplitude=1e-6),
        "mode",
        [-1, 1.5, True, "fastest", [1]],
    ),
    "InitialEquilibrium.amplitude": (
        lambda v: st.InitialEquilibrium(mode=0, amplitude=v),
        "amplitude",
        [*FINITE, 0.0, -1e-6],
    ),
    "InitialEquilibrium.phase": (lambda v: st.InitialEquilibrium(phase=v), "phase", FINITE),
    "Coulomb.coefficient": (lambda v: st.Coulomb(v), "coefficient", [*FINITE, -0.1]),
    "PointContact.tip": (lambda v: contact(tip=v), "tip", [None, ROD, "tip"]),
    "PointContact.track": (lambda v: contact(track=v), "track", [None, ROD, "track"]),
    "PointContact.at": (lambda v: contact(at=v), "at", [*FINITE, 0.0, -0.1, 0.8, 0.9]),
    "PointContact.friction": (lambda v: contact(friction=v), "friction", [None, 0.5, "coulomb"]),
    "PointContact.gap": (lambda v: contact(gap=v), "gap", [*FINITE, -1e-9]),
}
CASES = [pytest.param(*rest[:2], v, id=f"{k}={v!r}"[:60]) for k, rest in MAKERS.items() for v in rest[2]]


@pytest.mark.parametrize(("make", "name", "value"), CASES)
def test_bad_arguments_are_named_with_value_and_range(make, name, value):
    with pytest.raises(ValueError, match=rf"^{name} must ") as caught:
        make(value)
    message = str(caught.value)
    assert brief(value) in message
    assert "\n" not in message


def test_imposed_velocity_is_for_the_root_of_a_slider():
    with pytest.raises(ValueError, match=r"^point must be the root"):
        st.ImposedVelocity(ROD.tip, 0.1)
    with pytest.raises(ValueError, match=r"^point\.body must be a FiniteElementBeam"):
        st.ImposedVelocity(BAR.centre, 0.1)


def test_an_initial_equilibrium_holds_tuples_and_needs_a_mode_for_an_amplitude():
    listed = st.InitialEquilibrium(status=["sliding", "separated"], velocity=np.array([0.1, 0.0]))
    assert (listed.status, listed.velocity) == (("sliding", "separated"), (0.1, 0.0))
    assert hash(listed) == hash(replace(listed))
    with pytest.raises(ValueError, match=r"^amplitude must be 0 without a mode, got 1e-06"):
        st.InitialEquilibrium(amplitude=1e-6)
    with pytest.raises(ValueError, match=r"^velocity\[1\] must be finite"):
        st.InitialEquilibrium(velocity=[0.1, NAN])


def test_contact_tip_is_a_point_of_another_body_than_the_track():
    with pytest.raises(
        ValueError, match=r"^track must be a body other than the tip's \(equal bodies need names\), got "
    ):
        contact(tip=BAR.centre)


@pytest.mark.parametrize("angle", [30.0, -50.0])
@pytest.mark.parametrize(
    ("component", "direction"),
    [
        ("axial", lambda a: (np.sin(a), np.cos(a))),
        ("transverse", lambda a: (np.cos(a), -np.sin(a))),
        ("x", lambda a: (1.0, 0.0)),
        ("y", lambda a: (0.0, 1.0)),
    ],
)
def test_a_force_accelerates_the_slider_along_its_direction(component, direction, angle):
    """Free flight, a gap of 1 m: the momentum after T is F T along the world direction, for any point."""
    rod = slider(angle)
    for position in (0.0, 0.17, 0.5):
        force = st.Force(rod.at(position), **{component: 0.4})
        run = every_step(pair(lambda _, force=force: [force], 0.5, rod=rod, gap=1.0), 400, SCHEMES[0])
        speed = run.state_modal.values[1, : rod.modes().count] / 5e-6
        momentum = rod.modes().translation @ speed
        expected = 0.4 * np.array(direction(np.radians(angle))) * 399.5 * 5e-6
        np.testing.assert_allclose(momentum, expected, atol=1e-12)


def test_components_add_and_equal_histories_are_one_load():
    """One force of two components is two forces; two forces with equal histories are one row of loads."""
    from stridula.lowering import assemble

    both = pair(lambda rod: [st.Force(rod.root, x=0.1, axial=-0.3, history=st.Ramp(0.01))], 0.5)
    apart = pair(
        lambda rod: [
            st.Force(rod.root, x=0.1, history=st.Ramp(0.01)),
            st.Force(rod.root, axial=-0.3, history=st.Ramp(0.01)),
            st.Gravity(1e-300),
        ],
        0.5,
    )
    one, other = assemble(both), assemble(apart)
    assert one.loads.shape[0] == 1
    assert other.loads.shape[0] == 2
    np.testing.assert_allclose(one.loads[0], other.loads[0], atol=1e-15)


def test_gravity_is_weight_on_both_bodies():
    """Falling, the slider's momentum is -M g T; the heavy track sags by its own 5 rho S g L^4 / 384 E I."""
    bar = track(damping=0.5, cutoff=3e3)
    rod = slider(20.0, cutoff=3e3)
    system = pair(lambda _: [st.Gravity(9.81)], 0.5, rod=rod, bar=bar, gap=1.0)
    run = st.simulate(
        system, 0.3, step=2e-5, sample_rate=1e4, probes=[st.Displacement(bar.centre), st.Velocity(rod.root)]
    )
    np.testing.assert_allclose(run.velocity.values[100:-10, 0], -9.81 * run.time.values[100:-10], rtol=1e-6)
    line = 7800 * 8e-5 * 9.81
    sag = 5 * line * 0.8**4 / (384 * 2.1e11 * 0.02 * 0.004**3 / 12)
    # Odd modes to 3 kHz, the 16th: 1/k^5 left.
    assert run.displacement.values[-1, 0] == pytest.approx(-sag, rel=1e-4)


def test_initial_velocity_moves_the_whole_body():
    rod = slider(20.0)
    system = pair(lambda _: [st.InitialVelocity(rod, x=0.2, y=0.1)], 0.5, rod=rod, gap=1.0)
    probes = [st.Velocity(rod.at(s), d) for s in (0.0, 0.2, 0.5) for d in ("x", "y")]
    run = every_step(system, 100, SCHEMES[1], probes=probes)
    np.testing.assert_allclose(run.velocity, np.tile([0.2, 0.1], (100, 3)), rtol=1e-9)


def test_frozen_and_replaceable():
    force = st.Force(ROD.root, x=1.0)
    assert replace(force, x=2.0).x == 2.0
    with pytest.raises(AttributeError):
        force.x = 3.0


EVERY_DRIVE = {
    "force": st.Force(ROD.root, x=1.0, y=-2.0),
    "imposed velocity": st.ImposedVelocity(ROD.root, 0.1, normal_load=3.0),
    "gravity": st.Gravity(),
    "initial velocity": st.InitialVelocity(ROD, 0.2, 0.3),
    "initial state": st.InitialState(st.PointMass(1.0), velocity=[0.4, 0.0]),
    "initial equilibrium": st.InitialEquilibrium(velocity=0.5),
}


def test_every_drive_is_tested():
    assert {drive.kind: type(drive) for drive in EVERY_DRIVE.values()} == {kind.kind: kind for kind in DRIVES}
    assert list(EVERY_DRIVE) == [kind.kind for kind in DRIVES]


def test_a_drive_has_its_effect_and_its_target():
    said = {name: (drive.place, drive.acted_on, drive.velocities) for name, drive in EVERY_DRIVE.items()}
    assert said == {
        "force": ("point", ROD, ()),
        "imposed velocity": ("root", ROD, (0.1,)),
        "gravity": ("", None, ()),
        "initial velocity": ("body", ROD, (0.2, 0.3)),
        "initial state": ("body", st.PointMass(1.0), ()),
        "initial equilibrium": ("", None, (0.5,)),
    }
    pushes = {name: drive.push[2].tolist() for name, drive in EVERY_DRIVE.items() if drive.push is not None}
    assert pushes == {"force": [1.0, -2.0, 0.0], "imposed velocity": [0.0, -3.0, 0.0]}
    assert [name for name, drive in EVERY_DRIVE.items() if drive.fall is not None] == ["gravity"]
    assert [name for name, drive in EVERY_DRIVE.items() if drive.uniform_velocity is not None] == ["initial velocity"]
    assert [name for name, drive in EVERY_DRIVE.items() if drive.vectors] == ["initial state"]


@pytest.mark.parametrize("drive", EVERY_DRIVE.values(), ids=EVERY_DRIVE)
def test_a_drive_is_named_in_one_line(drive):
    assert str(drive).startswith(drive.kind)
    assert "\n" not in str(drive)
