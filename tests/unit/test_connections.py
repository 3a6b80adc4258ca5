"""Springs, dashpots and rigid tracks: refused arguments, and their use in systems."""

from __future__ import annotations

import numpy as np
import pytest
from physics.cases import dragged, pair, slider, track

import stridula as st
from stridula.checks import brief
from stridula.lowering import assemble

NAN, INF = float("nan"), float("inf")
NUMBERS = [NAN, INF, True, "1", None]
ONE, TWO = st.PointMass(0.4, "one"), st.PointMass(0.7, "two")
ROD, BAR = slider(30.0), track()

MAKERS = {
    "Spring.first": (lambda v: st.Spring(v, stiffness=1.0), "first", [None, ONE, 0.1, "centre"]),
    "Spring.second": (lambda v: st.Spring(ONE.centre, v, stiffness=1.0), "second", [ONE, 0.1, ONE.centre]),
    "Spring.stiffness": (lambda v: st.Spring(ONE.centre, stiffness=v), "stiffness", [*NUMBERS, 0.0, -1.0]),
    "Spring.direction": (
        lambda v: st.Spring(ONE.centre, stiffness=1.0, direction=v),
        "direction",
        [None, "w", "axial", 1, (1.0, 0.0), (0.0, 0.0, 0.0)],
    ),
    "CubicSpring.stiffness": (lambda v: st.CubicSpring(ONE.centre, stiffness=v, cubic=1.0), "stiffness", NUMBERS),
    "CubicSpring.cubic": (lambda v: st.CubicSpring(ONE.centre, stiffness=1.0, cubic=v), "cubic", NUMBERS),
    "CubicSpring.second": (
        lambda v: st.CubicSpring(ONE.centre, v, stiffness=1.0, cubic=1.0),
        "second",
        [ONE, 0.1, ONE.centre],
    ),
    "RigidJoint.axes": (lambda v: st.RigidJoint(ONE.centre, axes=v), "axes", ["w", (), 1.0, None]),
    "RigidJoint.rotations": (lambda v: st.RigidJoint(ONE.centre, rotations=v), "rotations", [1, "x", None]),
    "RigidJoint.second": (lambda v: st.RigidJoint(ONE.centre, v), "second", [ONE, ONE.centre]),
    **{
        f"Bushing.{name}": (
            lambda v, name=name: st.Bushing(ONE.centre, **{"stiffness": (1.0, 1.0, 0.0), name: v}),
            name,
            [3.0, "ab", None],
        )
        for name in ("stiffness", "damping", "rotational_stiffness", "rotational_damping")
    },
    "TabulatedSpring.direction": (
        lambda v: st.TabulatedSpring(ONE.centre, displacement=[0.0, 1.0], force=[0.0, 1.0], direction=v),
        "direction",
        ["w", None],
    ),
    "Dashpot.first": (lambda v: st.Dashpot(v, coefficient=1.0), "first", [None, ONE]),
    "Dashpot.coefficient": (lambda v: st.Dashpot(ONE.centre, coefficient=v), "coefficient", [*NUMBERS, 0.0, -1.0]),
    "Dashpot.direction": (lambda v: st.Dashpot(ONE.centre, coefficient=1.0, direction=v), "direction", ["w", None]),
    "RigidTrack.velocity": (lambda v: st.RigidTrack(v), "velocity", NUMBERS),
    "RigidTrack.normal_velocity": (lambda v: st.RigidTrack(0.0, v), "normal_velocity", NUMBERS),
    "RigidTrack.acceleration": (lambda v: st.RigidTrack(acceleration=v), "acceleration", NUMBERS),
    "RigidTrack.normal_acceleration": (
        lambda v: st.RigidTrack(normal_acceleration=v),
        "normal_acceleration",
        NUMBERS,
    ),
    "RigidTrack.history": (lambda v: st.RigidTrack(history=v), "history", [None, 1.0, np.sin]),
    "RigidTrack.normal_history": (lambda v: st.RigidTrack(normal_history=v), "normal_history", [None, 1.0]),
    "RigidTrack.name": (lambda v: st.RigidTrack(name=v), "name", [None, 3]),
    "PointContact.inclination": (
        lambda v: st.PointContact(ONE.centre, st.RigidTrack(), inclination=v),
        "inclination",
        [*NUMBERS, 7.0, -7.0],
    ),
    "PointContact.at": (lambda v: st.PointContact(ONE.centre, st.RigidTrack(), at=v), "at", NUMBERS),
    "PointContact.name": (lambda v: st.PointContact(ONE.centre, st.RigidTrack(), name=v), "name", [None, 3]),
    "InitialState.body": (lambda v: st.InitialState(v), "body", [None, ROD, BAR, ONE.centre]),
    "InitialState.displacement": (
        lambda v: st.InitialState(ONE, v),
        "displacement",
        [1.0, (1.0,), (1.0, NAN), "ab", (True, "x")],
    ),
    "InitialState.velocity": (lambda v: st.InitialState(ONE, None, v), "velocity", [(1.0, 2.0, 3.0), (INF, 0.0)]),
    "GaussSeidel.tolerance": (lambda v: st.GaussSeidel(tolerance=v), "tolerance", [*NUMBERS, 0.0, 1e-3]),
    "GaussSeidel.sweeps": (lambda v: st.GaussSeidel(sweeps=v), "sweeps", [0, -1, 1.5, None]),
}
CASES = [pytest.param(*rest[:2], v, id=f"{k}={v!r}"[:60]) for k, rest in MAKERS.items() for v in rest[2]]


@pytest.mark.parametrize(("make", "name", "value"), CASES)
def test_bad_arguments_are_named_with_value_and_range(make, name, value):
    with pytest.raises(ValueError, match=rf"^{name} must ") as caught:
        make(value)
    assert "\n" not in str(caught.value)
    assert brief(value) in str(caught.value)


@pytest.mark.parametrize(
    ("displacement", "force", "words"),
    [
        ([0.0], [0.0], r"^displacement must have two values or more, got 1"),
        ([0.0, 1.0, 1.0], [0.0, 1.0, 2.0], r"^displacement\[2\] must be above 1.0, the one before it, got 1.0"),
        ([0.0, NAN], [0.0, 1.0], r"^displacement\[1\] must be finite, got nan"),
        ([0.0, 1.0], [0.0, 1.0, 2.0], r"^force must have as many values as displacement, 2, got 3"),
        ([0.0, 1.0], "ab", r"^force must be a list of numbers, got 'ab'"),
    ],
)
def test_tables_of_springs_are_checked(displacement, force, words):
    with pytest.raises(ValueError, match=words):
        st.TabulatedSpring(ONE.centre, displacement=displacement, force=force)


@pytest.mark.parametrize(
    ("velocity", "force", "words"),
    [
        ([0.0], [0.0], r"^velocity must have two values or more, got 1"),
        ([0.0, -1.0], [0.0, 1.0], r"^velocity\[1\] must be above 0.0, the one before it, got -1.0"),
        ([0.0, 1.0], [0.0], r"^force must have as many values as velocity, 2, got 1"),
        (
            [0.0, 1.0, 2.0],
            [0.0, -1.0, 3.0],
            r"^force\[1\] must brake: at 1 m/s have the sign of the velocity, .* -1.0$",
        ),
        ([-1.0, 0.0, 1.0], [4.0, 3.0, 4.0], r"^force\[0\] must brake: at -1 m/s .*, beyond 3 N at rest, got 4.0"),
        ([0.0, 1.0, 2.0], [0.0, 3.0, 2.0], r"^force must not fall over its last two velocities, .* got -1 N s/m there"),
    ],
)
def test_tables_of_dashpots_are_checked(velocity, force, words):
    with pytest.raises(ValueError, match=words):
        st.TabulatedDashpot(ONE.centre, velocity=velocity, force=force)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ({"stiffness": (1.0, 2.0)}, r"^stiffness must be three numbers, for x, y and z, got 2"),
        ({"damping": (1.0, -1.0, 0.0)}, r"^damping\[1\] must be 0 or above, got -1.0"),
        ({"rotational_damping": (1.0, 0.0, NAN)}, r"^rotational_damping\[2\] must be finite, got nan"),
        (
            {"stiffness": (0.0, 0.0, 0.0)},
            r"^stiffness must have a number above 0, or the damping, got \(0.0, 0.0, 0.0\)",
        ),
    ],
)
def test_bushings_are_checked(words, said):
    with pytest.raises(ValueError, match=said):
        st.Bushing(ONE.centre, **{"stiffness": (1.0, 1.0, 1.0)} | words)


def test_a_beam_track_lies_flat():
    with pytest.raises(ValueError, match=r"^inclination must be 0 on a ModalBeam, got 0.1"):
        st.PointContact(ROD.tip, BAR, at=0.2, inclination=0.1)


@pytest.mark.parametrize("quarters", range(-4, 5))
def test_frames_along_the_axes_are_exact(quarters):
    contact = st.PointContact(ONE.centre, st.RigidTrack(), inclination=quarters * np.pi / 2)
    c, s = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[quarters % 4]
    np.testing.assert_array_equal(contact.frame, [[-s, c], [c, s]])


@pytest.mark.parametrize("angle", [0.3, -1.2, 3.0])
def test_frames_are_right_handed(angle):
    normal, tangent = st.PointContact(ONE.centre, st.RigidTrack(), inclination=angle).frame
    assert tangent == pytest.approx([np.cos(angle), np.sin(angle)])
    assert tangent[0] * normal[1] - tangent[1] * normal[0] == pytest.approx(1.0)


def test_lists_of_systems():
    contact = st.PointContact(ONE.centre, st.RigidTrack())
    spring = st.Spring(ONE.centre, TWO.centre, stiffness=1.0)
    for value in (None, spring, "spring", 3):
        with pytest.raises(ValueError, match=r"^connections must be a list of connections, got "):
            st.System(contact, (), value)
    springs = "Spring or Dashpot or CubicSpring or TabulatedSpring or TabulatedDashpot or ViscoelasticSpring"
    kinds = f"{springs} or Bushing or RigidJoint"
    with pytest.raises(ValueError, match=rf"^connections\[0\] must be a {kinds}, got "):
        st.System(contact, (), [contact])
    with pytest.raises(ValueError, match=r"^contact must hold at least one PointContact, got none"):
        st.System([])
    with pytest.raises(ValueError, match=r"^contacts must have different names, got 'a' twice"):
        st.System([st.PointContact(m.centre, st.RigidTrack(), name="a") for m in (ONE, TWO)])
    other = st.PointMass(9.0, "one")
    with pytest.raises(ValueError, match=r"^bodies must have different names, got 'one' twice"):
        st.System([contact, st.PointContact(other.centre, st.RigidTrack())])
    assert st.System(contact, (), [spring]).bodies == (ONE, TWO)


def test_a_drive_reaches_bodies_that_only_a_connection_names():
    contact, spring = (
        st.PointContact(ONE.centre, st.RigidTrack()),
        st.Spring(ONE.centre, TWO.centre, stiffness=1.0),
    )
    st.System(contact, [st.Force(TWO.centre, x=1.0)], [spring])
    with pytest.raises(ValueError, match=r"^drives\[0\] must act on a body of this system"):
        st.System(contact, [st.Force(TWO.centre, x=1.0)])


def test_a_spring_along_a_prescribed_motion_is_refused():
    system = pair(dragged(), 0.5)
    joint = st.Spring(system.slider.root, stiffness=10.0)
    with pytest.raises(ValueError, match=r"^connections\[0\] must not act along x on a body under an imposed velocity"):
        st.System(system.contact, system.drives, [joint])
    st.System(system.contact, system.drives, [st.Spring(system.slider.root, stiffness=10.0, direction="y")])


def test_a_reaction_needs_a_body_without_connections():
    system = pair(lambda rod: [st.Force(rod.root, y=-1.0)], 0.5)
    joined = st.System(system.contact, system.drives, [st.Spring(system.slider.root, stiffness=1.0)])
    with pytest.raises(ValueError, match=r"^connections must not join a body whose Reaction is recorded"):
        st.simulate(joined, 1e-3, probes=[st.Reaction(system.slider)])


def test_only_joined_bodies_are_coupled():
    """A spring on a mass alone keeps its modes apart; one between bodies couples theirs, and theirs only."""
    contact = st.PointContact(ROD.tip, BAR, at=0.2)
    own = [st.Spring(ONE.centre, stiffness=9.0), st.Dashpot(ONE.centre, coefficient=0.1)]
    alone = st.System(st.PointContact(ONE.centre, st.RigidTrack()), (), own)
    arrays = assemble(alone)
    assert arrays.coupled == 0
    np.testing.assert_allclose(np.sort(arrays.angular_frequency), [0.0, np.sqrt(9.0 / 0.4)])
    joined = assemble(st.System(contact, (), [st.Spring(ROD.root, TWO.centre, stiffness=100.0)]))
    assert joined.coupled == ROD.modes().count + 2
    assert joined.mode_count == joined.coupled + BAR.modes().count
    rod, two = ROD.trace(ROD.length)[0], TWO.trace("centre")[0]
    row = np.concatenate([rod, -two])
    own = np.diag(np.concatenate([ROD.modes().angular_frequency, np.zeros(2)]) ** 2)
    np.testing.assert_allclose(joined.stiffness, own + 100.0 * np.outer(row, row), atol=1e-9)


def test_cards_name_contacts_and_connections():
    walls = [
        st.PointContact(ONE.centre, st.RigidTrack(), inclination=0.5, name="wall", friction=st.Coulomb(0.3)),
        st.PointContact(ONE.centre, TWO.centre, name="point"),
    ]
    joints = [st.Spring(ONE.centre, TWO.centre, stiffness=12.0), st.Dashpot(TWO.centre, coefficient=3.0, direction="y")]
    card = str(st.System(walls, [st.InitialState(ONE, (1e-3, 0.0))], joints))
    for words in (
        "wall",
        "on a rigid track",
        "inclined 28.65 deg",
        "against a point",
        "spring 12 N/m along x from one to two",
        "dashpot 3 N s/m along y from two to the ground",
        "initial state",
    ):
        assert words in card


def test_records_of_several_contacts_name_them():
    masses = [
        st.PointContact(m.centre, st.RigidTrack(), friction=law, name=name)
        for m, law, name in ((ONE, st.Coulomb(0.3), "left"), (TWO, st.LuGre(0.5, 0.4, 0.1, 1e4), "right"))
    ]
    run = st.simulate(st.System(masses, [st.Gravity()]), 1e-3, step=1e-5, sample_rate=1e5)
    assert list(run.contact.values) == ["left", "right"]
    assert run.normal_force.dims == ("time", "contact")
    assert np.all(np.isnan(run.friction_state.sel(contact="left")))
    assert run.friction_state.attrs["units"] == "m"
    np.testing.assert_allclose(run.normal_force.values[-1], [0.4 * 9.80665, 0.7 * 9.80665], rtol=1e-9)
    assert "contact" not in st.simulate(st.System(masses[0], [st.Gravity()]), 1e-3, step=1e-5).dims


def test_a_frozen_contact_holds_two_masses_apart():
    """Two masses pressed together on the floor's line move as one: the force between them is m2 of F / (m1 + m2)."""
    contact = st.PointContact(ONE.centre, TWO.centre, friction=st.Coulomb(0.5))
    run = st.simulate(st.System(contact, [st.Force(ONE.centre, y=-2.2)]), 0.01, step=1e-5, sample_rate=1e5, probes=[])
    np.testing.assert_allclose(run.normal_force.values[1:], 2.2 * 0.7 / 1.1, rtol=1e-9)
    assert np.all(run.status == 1)
