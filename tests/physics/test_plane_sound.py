"""The sound of a system in the plane: the sum of its parts, a rigid rod as a dipole, the image of a wall."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula.acoustics.redriven import redriven

from .cases import STEEL

AIR = st.Air()
RATE, SAMPLES, FREQUENCY = 100e3, 2000, 500.0
# So stiff that it moves as a rigid body.
RIGID = st.Material(1e16, 7800.0)
ROD = st.FiniteElementBeam(RIGID, st.Circle(0.004), 0.02, elements=2, name="rod")
TRACK = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.02), 0.25, damping=0.03, cutoff=15e3)
PLACE = (0.3, 0.1, 0.4)


def record(normal, tangential, at=0.0, contacts=0) -> xr.Dataset:
    """A record of given forces, whose means are those of its samples."""
    time = np.arange(1, SAMPLES + 1) / RATE
    values = {"normal_force": normal, "tangential_force": tangential, "contact_position": at}
    data = {name: ("time", np.broadcast_to(value, SAMPLES).astype(float)) for name, value in values.items()}
    run = xr.Dataset(data, {"time": time})
    return run.expand_dims(contact=[f"contact {k + 1}" for k in range(contacts)]) if contacts else run


def swinging() -> np.ndarray:
    """Means of 2 N at `FREQUENCY` over each interval."""
    edges = np.arange(SAMPLES + 1) / RATE
    return 2.0 * np.diff(-np.cos(2.0 * pi * FREQUENCY * edges)) / (2.0 * pi * FREQUENCY) * RATE


def on_the_ground(rod) -> st.System:
    return st.System(st.PointContact(rod.tip, st.RigidTrack()))


def dipole(place, along, force, area=2.0 * ROD.section.area):
    """The pressure of a small dipole at the origin whose strength is that of a rod under a force in steady motion.

    ``p = rho V z / (4 pi R²) (a' / c + a / R)`` at the time of sending, V the air moved.
    """
    distance = np.linalg.norm(place)
    time = np.arange(SAMPLES) / RATE - distance / AIR.speed
    angular = 2.0 * pi * FREQUENCY
    peak = force / ROD.total_mass
    strength = AIR.density * area * ROD.length / (4.0 * pi) * (np.dot(place, along) / distance) / distance
    change, still = angular / AIR.speed * np.cos(angular * time), np.sin(angular * time) / distance
    return strength * peak * (change + still)


@pytest.mark.parametrize("angle", [0.0, 40.0])
def test_a_short_rigid_rod_is_a_dipole(angle):
    """Rubbed at its tip, with guided root: it moves rigidly along the force on the tip, against that on the track."""
    lean = np.radians(angle)
    rod = st.FiniteElementBeam(RIGID, st.Circle(0.004), 0.02, lean, elements=2)
    middle = 0.01 * np.array([np.sin(lean), 0.0, np.cos(lean)])
    across = np.array([np.cos(lean), 0.0, -np.sin(lean)])
    places = [(2.0, 0.3, 1.0), (0.6, -0.2, -0.9)]
    found = st.radiate(record(0.0, swinging()), on_the_ground(rod), places, air=AIR)
    late = slice(1000, -100)
    for k, place in enumerate(places):
        # The part of the force along x across the rod; axial motion does not radiate.
        known = dipole(np.subtract(place, middle), across, -2.0 * np.cos(lean))[late]
        assert np.abs(found.values[late, k] - known).max() < 2e-3 * np.abs(known).max()
    assert found.attrs["baffled"] == 0
    assert "slider: a line of dipoles, slim below" in found.attrs["notes"]


def test_normal_forces_and_drives_move_a_leaning_rod_too():
    """Upward and sideways forces are heard by their part across the rod, from drives as from contacts."""
    rod = st.FiniteElementBeam(RIGID, st.Circle(0.004), 0.02, np.radians(45.0), elements=2)
    place = (1.0, 0.2, -0.5)
    rubbed = st.radiate(record(0.0, -swinging()), on_the_ground(rod), place, air=AIR).values
    pressed = st.radiate(record(swinging(), 0.0), on_the_ground(rod), place, air=AIR).values
    np.testing.assert_allclose(pressed, -rubbed, atol=1e-9 * np.abs(rubbed).max())
    push = st.Force(rod.root, x=2.0, history=st.Harmonic(FREQUENCY))
    driven = st.System(st.PointContact(rod.tip, st.RigidTrack()), [push])
    run = record(0.0, 0.0).assign_attrs(steps_per_sample=50)
    sound = st.radiate(run, driven, place, air=AIR).values
    late = slice(1000, -100)
    assert np.abs(sound - rubbed)[late].max() < 2e-3 * np.abs(rubbed[late]).max()


def carried(rod, in_space, history):
    """A system in which the root of a rod follows a velocity, and its record without forces."""
    changing, still = st.ImposedVelocity(rod.root, 0.1, history=history), np.zeros(SAMPLES)
    if not in_space:
        return st.System(st.PointContact(rod.tip, st.RigidTrack()), [changing]), record(still, still)
    other = st.RigidBody(1.0, points={"top": (0.0, 0.0, 0.0)})
    held = [st.Spring(other.at("top"), stiffness=1e6, direction=way) for way in "xyz"]
    system = st.System(st.PointContact(rod.tip, other.at("top"), normal=(0.0, 1.0, 0.0)), [changing], held)
    along = {name: (("time", "tangent"), np.zeros((SAMPLES, 2))) for name in ("tangential_force", "contact_position")}
    return system, record(still, still).drop_vars(list(along)).assign(along)


SWINGING = st.Harmonic(FREQUENCY, mean=3.0, phase=-0.5 * pi)


@pytest.mark.parametrize("in_space", [False, True])
def test_changes_of_an_imposed_velocity_are_heard(in_space):
    """A rigid rod moves as a whole with its root: a dipole."""
    lean = np.radians(40.0)
    rod = st.FiniteElementBeam(RIGID, st.Circle(0.002), 0.02, lean, elements=2)
    middle = 0.01 * np.array([np.sin(lean), 0.0, np.cos(lean)])
    across = np.array([np.cos(lean), 0.0, -np.sin(lean)])
    places = [(2.0, 0.3, 1.0), (0.6, -0.2, -0.9)]
    seen = [(x, z, -y) for x, y, z in places] if in_space else places
    system, run = carried(rod, in_space, SWINGING)
    found = st.radiate(run, system, seen, bodies=[rod], air=AIR)
    push = ROD.total_mass * 0.1 * 2.0 * pi * FREQUENCY * np.cos(lean)
    late = slice(1000, -100)
    for k, place in enumerate(places):
        known = dipole(np.subtract(place, middle), across, push, 2.0 * rod.section.area)[late]
        assert np.abs(found.values[late, k] - known).max() < 2e-3 * np.abs(known).max()
    assert "imposed" not in found.attrs["notes"]
    steady, run = carried(rod, in_space, st.Constant())
    assert not st.radiate(run, steady, seen, bodies=[rod], air=AIR).values.any()


def test_beams_that_are_not_slim_state_what_is_left_out_of_an_imposed_velocity():
    beam = st.FiniteElementBeam(STEEL, st.Rectangle(0.02, 0.008), 0.3, np.radians(30.0), elements=6, damping=0.02)
    system, run = carried(beam, True, SWINGING)
    notes = st.radiate(run, system, (0.1, 0.3, 0.4), bodies=[beam], air=AIR).attrs["notes"]
    words = "slider: changes of its imposed velocity are heard by its vibration alone, not as a whole: about "
    assert words in notes
    assert "dB relative to what is heard" in notes


SLIDER = st.FiniteElementBeam(STEEL, st.Rectangle(0.02, 0.008), 0.3, np.radians(30.0), elements=6, damping=0.02)
BENCH = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.008), 0.5, bending_modes=12, axial_modes=3, damping=0.01)


@pytest.mark.parametrize(
    ("joined", "most"),
    [
        (lambda: [], 0.01),
        (lambda: [st.Spring(SLIDER.root, stiffness=2e5, direction="y")], 0.01),
        # Without the forces on the track it is 13 %, without the damping that couples modes 3 %.
        (lambda: [st.Spring(SLIDER.at(0.1), BENCH.at(0.35), stiffness=2e6, direction="y")], 0.01),
        (lambda: [st.Dashpot(SLIDER.at(0.1), BENCH.at(0.35), coefficient=300.0, direction="y")], 0.01),
    ],
    ids=["alone", "held by a spring", "joined to its track", "damped by its track"],
)
def test_the_slider_moves_again_as_it_did_in_the_march(joined, most):
    """At one sample a step, below 10 kHz; the probe is a second difference."""
    contact = st.PointContact(SLIDER.tip, BENCH, at=0.2, friction=st.Coulomb(0.4))
    system = st.System(contact, [st.Force(SLIDER.root, x=6.0, y=-20.0)], joined())
    point, step = SLIDER.at(0.17), 5e-6
    run = st.simulate(system, 0.02, step=step, sample_rate=1.0 / step, probes=[st.Acceleration(point, "x")])
    assert (run.normal_force > 0.0).any()
    probe = run.acceleration.values[:, 0]

    def error(record):
        slider = redriven(record, system, [SLIDER]).of("slider")
        own = slider.accelerations(np.arange(SLIDER.modes(system.is_held(SLIDER)).count))
        times = slider.first + slider.interval * np.arange(own.shape[1])
        found = np.interp(run.time.values, times, SLIDER.trace(0.17)[0] @ own)
        spectra = [np.fft.rfft(values * np.hanning(values.size)) for values in (found, probe)]
        one, other = (part[np.fft.rfftfreq(probe.size, step) < 10e3] for part in spectra)
        return np.linalg.norm(one - other) / np.linalg.norm(other)

    assert error(run) < most
    # Negative control: the other sense of friction.
    assert error(run.assign(tangential_force=-run.tangential_force)) > 0.1


SHAKER = st.PointMass(0.2, name="shaker")
PLATE = st.ModalPlate(STEEL, 0.004, 0.4, 0.3, bending_modes=(4, 3), damping=0.01)
BAR = st.ModalBeam(STEEL, st.Rectangle(0.03, 0.006), 0.5, bending_modes=8, axial_modes=2, damping=0.01)


def shaking(point) -> st.Force:
    return st.Force(point, y=3.0, history=st.Harmonic(430.0))


@pytest.mark.parametrize("track", [PLATE, BAR], ids=["plate", "bar"])
@pytest.mark.parametrize(
    "acting",
    [
        lambda track: ([shaking(track.at(0.13))], []),
        lambda track: (
            [shaking(SHAKER.centre)],
            [st.Spring(SHAKER.centre, track.at(0.3), stiffness=1e6, direction="y")],
        ),
        lambda track: (
            [shaking(SHAKER.centre)],
            [st.Dashpot(SHAKER.centre, track.at(0.3), coefficient=200.0, direction="y")],
        ),
        lambda track: (
            [],
            [st.Spring(track.at(0.3), stiffness=1e6, direction="y", offset=1e-5, history=st.Harmonic(300.0))],
        ),
        lambda track: ([st.Gravity()], []),
    ],
    ids=["force", "spring", "dashpot", "moving support", "gravity"],
)
def test_drives_and_connections_of_a_track_are_heard(track, acting):
    """As from its recorded motion: the march itself is the reference."""
    drives, connections = acting(track)
    mass = st.PointMass(0.05)
    contact = st.PointContact(mass.centre, track, at=0.21, stiffness=1e5)
    system = st.System(contact, [*drives, st.Force(mass.centre, y=-0.5)], connections)
    run = st.simulate(system, 0.03, motion_rate=50e3)
    known = st.radiate(run, system, PLACE, bodies=[track], sample_rate=16e3)
    found = st.radiate(run.drop_vars("modal_motion"), system, PLACE, bodies=[track], sample_rate=16e3)
    assert (known.attrs["motion"], found.attrs["motion"]) == ("recorded", "driven again")
    known, found = (one.interp(time=np.linspace(1e-3, 0.029, 400)).values for one in (known, found))
    assert np.linalg.norm(found - known) < 0.01 * np.linalg.norm(known)


def test_a_track_touched_at_a_point_is_heard():
    """A contact at a fixed point drives it as one along it does."""
    mass = st.PointMass(0.05)
    runs = []
    for words in ({"at": 0.21}, {}):
        contact = st.PointContact(mass.centre, BAR if words else BAR.at(0.21), stiffness=1e5, **words)
        beside = st.PointContact(st.PointMass(0.1, name="other").centre, BAR, at=0.4, gap=1.0)
        system = st.System([contact, beside], [st.Force(mass.centre, y=-5.0)])
        runs.append(st.radiate(st.simulate(system, 0.01), system, PLACE, bodies=[BAR]).values)
    np.testing.assert_allclose(runs[1], runs[0], atol=1e-6 * np.abs(runs[0]).max())


def on_the_beam(contacts=1) -> st.System:
    rods = [
        st.FiniteElementBeam(STEEL, st.Rectangle(0.01, 0.004), 0.05, np.radians(20.0), 4, 0.02, name=f"rod {k}")
        for k in range(contacts)
    ]
    return st.System([st.PointContact(rod.tip, TRACK, at=0.05 + 0.1 * k) for k, rod in enumerate(rods)])


def pulse(middle=5e-3, width=2e-4):
    return np.exp(-(((np.arange(SAMPLES) / RATE - middle) / width) ** 2))


@pytest.mark.parametrize("baffled", [True, False])
def test_the_sound_is_the_sum_of_track_and_slider(baffled):
    system, run = on_the_beam(), record(pulse(), 0.3 * pulse(), 0.05)
    alone = st.radiate(run, TRACK, PLACE, baffled=baffled)
    whole = st.radiate(run, system, PLACE, baffled=baffled)
    track, slider = (st.radiate(run, system, PLACE, bodies=[one], baffled=baffled) for one in (TRACK, system.slider))
    np.testing.assert_array_equal(track.values, alone.values)
    np.testing.assert_allclose(whole.values, track.values + slider.values, atol=1e-12 * np.abs(whole.values).max())
    assert np.abs(slider.values).max() > 1e-3 * np.abs(track.values).max() > 0.0
    assert whole.attrs["bodies"] == ["rod 0", "track"] or whole.attrs["bodies"] == ["track", "rod 0"]
    assert whole.attrs["baffled"] == int(baffled)


def test_a_wall_adds_the_image_of_the_slider():
    system, run = on_the_beam(), record(pulse(), 0.3 * pulse(), 0.05)
    slider = [system.slider]
    image = PLACE[0], PLACE[1], -PLACE[2]
    before = st.radiate(run, system, [PLACE, image], bodies=slider, baffled=False).values.sum(axis=1)
    walled = st.radiate(run, system, PLACE, bodies=slider).values[:, 0]
    # The image arrives later than the rod itself: both alone are cut at their own first arrival.
    np.testing.assert_allclose(walled, before, atol=1e-6 * np.abs(before).max())


def test_the_place_of_the_slider_counts():
    """Moved along the track with its listener it sounds the same, elsewhere not; tracks use their own contacts."""
    system = on_the_beam(2)
    first, second = system.bodies[0], system.bodies[2]
    assert {first.name, second.name} == {"rod 0", "rod 1"}
    runs = [record(force, 0.0, at) for force, at in ((pulse(), 0.05), (pulse(), 0.15))]
    run = xr.concat(runs, "contact").assign_coords(contact=list(system.contact_names))
    words = {"baffled": False}
    one = st.radiate(run, system, (0.4, 0.1, 0.4), bodies=[first], **words).values
    other = st.radiate(run, system, (0.5, 0.1, 0.4), bodies=[second], **words).values
    np.testing.assert_allclose(one, other, atol=1e-9 * np.abs(one).max())
    elsewhere = st.radiate(run, system, (0.4, 0.1, 0.4), bodies=[second], **words).values
    assert np.abs(elsewhere - one).max() > 0.1 * np.abs(one).max()
    np.testing.assert_array_equal(
        st.radiate(run, system, PLACE, bodies=[TRACK]).values, st.radiate(run, TRACK, PLACE).values
    )


def test_a_moving_slider_is_heard_from_the_middle_of_its_way():
    system = on_the_beam()
    way = np.linspace(0.05, 0.15, SAMPLES)
    found = st.radiate(record(pulse(), 0.0, way), system, PLACE, bodies=[system.slider])
    middle = np.array([PLACE[0] - 0.05, *PLACE[1:]])
    at_rest = st.radiate(record(pulse(), 0.0, 0.05), system, tuple(middle.tolist()), bodies=[system.slider])
    np.testing.assert_allclose(found.values, at_rest.values, atol=1e-9 * np.abs(found.values).max())
    assert "it slides over 0.1 m; its sound is computed at the middle of its path" in found.attrs["notes"]


def test_two_ears_above_the_track_by_default_and_above_the_rod_without_one():
    system, run = on_the_beam(), record(pulse(), 0.0, 0.05)
    assert st.radiate(run, system).z.values.tolist() == [1.0, 1.0]
    rod = st.radiate(record(0.0, pulse()), on_the_ground(ROD))
    assert rod.z.values == pytest.approx([1.02, 1.02])
    assert rod.x.values == pytest.approx([-0.09, 0.09])


def test_beams_that_nothing_pushes_are_silent():
    quiet = st.radiate(record(0.0, 0.0), on_the_ground(ROD), PLACE)
    assert not quiet.values.any()
    assert "rod is silent: nothing pushes" in quiet.attrs["notes"]


def test_bodies_without_a_surface_are_reported():
    mass = st.PointMass(0.1, name="bob")
    system = st.System([st.PointContact(mass.centre, TRACK, at=0.1)])
    found = st.radiate(record(pulse(), 0.0, 0.1), system, PLACE)
    assert found.attrs["bodies"] == ["track"]
    assert "not included, without a surface: bob" in found.attrs["notes"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"listener": (0.1, 0.0, -0.1)}, "behind the baffle"),
        ({"listener": (0.055, 0.0, 0.01), "baffled": False, "bodies": "slider"}, "from the beam's axis"),
        ({"bodies": [ROD]}, r"bodies\[0\] must be a body of the system"),
        ({"bodies": []}, "bodies must be one or more"),
        ({"sample_rate": 192e3}, "at most the record's 100000 Hz"),
        ({"run": record(pulse(), 0.0, 0.05).drop_vars("tangential_force")}, "run must be a record with tangential"),
    ],
)
def test_bad_arguments_are_refused(words, message):
    system = on_the_beam()
    given = {"run": record(pulse(), 0.0, 0.05), "listener": PLACE} | words
    if given.get("bodies") == "slider":
        given["bodies"] = [system.slider]
    with pytest.raises(ValueError, match=message):
        st.radiate(given.pop("run"), system, given.pop("listener"), **given)


def test_a_wall_needs_a_track_and_sound_needs_a_surface():
    with pytest.raises(ValueError, match="baffled must be False, or left out, without a track"):
        st.radiate(record(0.0, pulse()), on_the_ground(ROD), PLACE, baffled=True)
    mass = st.PointMass(0.1)
    with pytest.raises(
        ValueError, match="system must have a body with a surface, which radiates sound, got none of slider"
    ):
        st.radiate(record(0.0, pulse()), st.System(st.PointContact(mass.centre, st.RigidTrack())), PLACE)


@pytest.mark.parametrize("joined", [False, True])
def test_vibration_at_the_start_is_heard(joined):
    """A struck track, alone and joined to a mass that starts in motion, as from its recorded motion."""
    start = [st.InitialVelocity(BAR, y=0.1), st.InitialState(SHAKER, displacement=(0.0, 1e-4), velocity=(0.0, 0.2))]
    between = [st.Spring(SHAKER.centre, BAR.at(0.3), stiffness=1e6, direction="y")]
    apart = st.PointContact(st.PointMass(0.05).centre, BAR, at=0.21, gap=1.0)
    system = st.System(apart, start if joined else start[:1], between if joined else [])
    run = st.simulate(system, 0.03, motion_rate=50e3)
    known = st.radiate(run, system, PLACE, bodies=[BAR], sample_rate=16e3)
    found = st.radiate(run.drop_vars("modal_motion"), system, PLACE, bodies=[BAR], sample_rate=16e3)
    assert "vibration at the start" not in found.attrs["notes"]
    known, found = (one.interp(time=np.linspace(3e-3, 0.029, 400)).values for one in (known, found))
    assert np.linalg.norm(found - known) < 0.01 * np.linalg.norm(known)


def test_a_continued_record_has_no_blow_at_its_start():
    """A track at rest under constant forces is silent in the second record, too."""
    mass = st.PointMass(0.05)
    contact = st.PointContact(mass.centre, BAR, at=0.21)
    drives = [st.Force(mass.centre, y=-5.0), st.Force(BAR.at(0.3), y=2.0), st.InitialEquilibrium()]
    first = st.simulate(st.System(contact, drives), 2e-3)
    later = st.simulate(st.System(contact, drives), 2e-3, start=first)
    sudden = st.System(contact, drives[:-1])
    blow = np.abs(st.radiate(first, sudden, PLACE, bodies=[BAR]).values).max()
    for source in (st.System(contact, drives), BAR):
        kind = {"bodies": [BAR]} if source is not BAR else {}
        assert np.abs(st.radiate(later, source, PLACE, **kind).values).max() < 1e-6 * blow


def test_a_start_in_equilibrium_is_silent():
    mass = st.PointMass(0.05)
    contact = st.PointContact(mass.centre, BAR, at=0.21)
    drives = [st.Force(mass.centre, y=-5.0), st.Force(BAR.at(0.3), y=2.0)]
    loud = st.System(contact, drives)
    known = np.abs(st.radiate(st.simulate(loud, 2e-3), loud, PLACE).values).max()
    still = st.System(contact, [*drives, st.InitialEquilibrium()])
    assert np.abs(st.radiate(st.simulate(still, 2e-3), still, PLACE).values).max() < 1e-6 * known


def test_a_mode_on_top_of_the_equilibrium_is_reported_as_left_out():
    mass = st.PointMass(0.05)
    contact = st.PointContact(mass.centre, BAR, at=0.21)
    for start in (st.InitialEquilibrium(mode=0, amplitude=1e-7), st.InitialEquilibrium()):
        system = st.System(contact, [st.Force(mass.centre, y=-5.0), start])
        notes = st.radiate(st.simulate(system, 1e-3), system, PLACE).attrs["notes"]
        assert (f"vibration at the start is not included: {start}" in notes) == start.starts_motion
