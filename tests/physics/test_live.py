"""Live marches: the run of `simulate` in parts, and continuity at changes."""

import numpy as np
import pytest

import stridula as st
from stridula._kernels.layout import columns as at
from stridula.integration.live import LiveMarch

RATE = 48e3


def system(case: str, **changes) -> st.System:
    return st.load_scenario(case, {key.replace("__", "."): value for key, value in changes.items()}).system


def probes(of: st.System) -> tuple:
    return (st.Acceleration(of.track.centre, "y"),)


def played(case: str, chunks: int = 20, samples: int = 480, **changes) -> tuple[LiveMarch, dict[str, np.ndarray]]:
    what = system(case, **changes)
    live = LiveMarch(what, probes(what))
    return live, marched(live, chunks, samples)


def changed(live: LiveMarch, case: str, scheme=None, **changes) -> bool:
    what = system(case, **changes)
    return live.change(what, probes(what), scheme)


def marched(live: LiveMarch, chunks: int, samples: int = 480) -> dict[str, np.ndarray]:
    parts = [live.advance(samples)[0] for _ in range(chunks)]
    found = {name: np.concatenate([part.contact[name] for part in parts]) for name in parts[0].contact}
    return found | {"separated": np.concatenate([part.status_share[:, 0] for part in parts])}


@pytest.mark.parametrize("case", ["squeal", "weak-pressure", "squeal-on-plate"])
def test_parts_are_the_run_bit_for_bit(case):
    what = system(case)
    live = LiveMarch(what, probes(what))
    parts = [live.advance(samples)[0] for samples in (480, 1, 479, 7, 953)]
    run = st.simulate(what, 1920 / RATE, sample_rate=RATE)
    for name in ("normal_force", "contact_position", "gap", "slip_velocity"):
        assert np.array_equal(run[name].values, np.concatenate([part.contact[name] for part in parts]))
    assert np.array_equal(run.status_share.values, np.concatenate([part.status_share for part in parts]))
    assert np.allclose(run.time.values, np.concatenate([part.time for part in parts]), rtol=1e-12)
    late = np.concatenate([part.probes for part in parts])[live.delay :, 0]
    assert np.array_equal(run.acceleration.values[: len(late), 0], late)


@pytest.mark.parametrize("case", ["squeal", "weak-pressure"])
def test_a_change_to_the_same_system_changes_nothing(case):
    live, _ = played(case)
    still, _ = played(case)
    assert changed(live, case)
    now, then = marched(live, 4)["normal_force"], marched(still, 4)["normal_force"]
    assert np.abs(now - then)[:200].max() < 1e-6 * then.max()


def test_a_root_continues_in_place_at_another_velocity():
    """Its displacement at a probe does not jump: 1 cm/s for 0.31 s, then 2 and 0.5 cm/s for 0.1 s each."""

    def dragged(velocity):
        what = system("weak-pressure", drives__0__velocity=velocity)
        return what, (st.Displacement(what.slider.root, "x"),)

    live = LiveMarch(*dragged(0.01))
    for chunks, velocity, expected in ((31, 0.01, 3.1e-3), (10, 0.02, 5.1e-3), (10, 0.005, 5.6e-3)):
        assert live.change(*dragged(velocity))
        found = [live.advance(480)[0] for _ in range(chunks)][-1].probes[-1, 0]
        assert found == pytest.approx(expected, abs=velocity * (live.delay + 1) / RATE)


@pytest.mark.parametrize(
    "change",
    [
        {"slider__angle": "-44.5 deg"},
        {"slider__length": 0.533},
        {"track__length": 1.35},
        {"section__height": "14.6 mm"},
        {"damping": 0.02},
        {"drives__0__velocity": 0.012},
        {"drives__0__normal_load": 2.2},
        {"coefficient": 0.9},
        {"cutoff": "14 kHz"},
    ],
)
def test_motion_continues_after_a_small_change(change):
    live, before = played("weak-pressure", chunks=30)
    still, _ = played("weak-pressure", chunks=30)
    assert changed(live, "weak-pressure", **change)
    first, kept = marched(live, 1, 4), marched(still, 1, 4)
    assert abs(first["contact_position"][0] - before["contact_position"][-1]) < 1e-6
    for name in ("gap", "contact_height"):
        assert np.abs(first[name] - kept[name]).max() < 0.05 * np.abs(before[name]).max()
    after = marched(live, 30)
    assert after["normal_force"].max() < 3.0 * before["normal_force"].max()
    assert after["separated"].mean() == pytest.approx(before["separated"].mean(), abs=0.2)


def test_an_open_contact_keeps_its_opening_and_a_closed_one_stays_closed():
    live, _ = played("judder", chunks=30)
    found = set()
    for number in range(40):
        last = {name: values[-1] for name, values in marched(live, 1, 37).items()}
        assert changed(live, "judder", slider__length=0.5354 - 1e-5 * (number % 2))
        gap = float(live.now.gaps[0])
        arrays, state = live.now.arrays, live.now.state
        rows = live.now.blocks.contacts.rows[0].copy()
        track = arrays.contacts[0].bending
        rows[slice(track[0], arrays.contacts[0].axial[1])] = -live.system.track.trace(last["contact_position"])[1]
        opening = arrays.contacts[0].contact.gap + rows @ state.modal[0]
        wanted = gap if last["gap"] > 0.0 and state.carried[0, at.STATUS] == 0.0 else 0.0
        assert opening == pytest.approx(wanted, abs=1e-12)
        found.add(wanted > 0.0)
    assert found == {True, False}


def test_energy_balances_after_a_change():
    live, _ = played("squeal", chunks=30)
    assert changed(live, "squeal", coefficient=0.8, drives__0__transverse=4.0)
    start = float(live.now.state.energies[at.STORED])
    energies = {name: float(values[-1]) for name, values in live.advance(4800)[0].energies.items()}
    balance = energies["kinetic_and_elastic"] - start + energies["damping_loss"]
    balance -= energies["drive_work"] + energies["contact_work"]
    assert abs(balance) < 1e-8 * max(map(abs, energies.values()))


def test_another_velocity_continues_from_the_place_of_the_tip():
    live, _ = played("weak-pressure", chunks=50)
    changed(live, "weak-pressure", drives__0__velocity=0.1)
    place = marched(live, 50)["contact_position"]
    travelled = 0.5 * 0.1
    assert place[-1] - place[0] == pytest.approx(travelled, rel=0.1)


def test_a_plate_keeps_the_amplitude_of_each_of_its_waves():
    def on_plate(thickness: float) -> st.System:
        plate = st.ModalPlate(st.Material(2.1e11, 7800.0), thickness, 0.5, 0.4, (4, 3), in_plane=True)
        rod = st.load_scenario("squeal").system.slider
        contact = st.PointContact(rod.tip, plate, 0.2, st.Coulomb(0.5))
        return st.System(contact, [st.Force(rod.root, transverse=3.0)])

    before, now = on_plate(0.004), on_plate(0.0041)
    live = LiveMarch(before, ())
    marched(live, 5)
    spans, old = live.spans["track"], live.position
    assert live.change(now, ())
    ratio = np.sqrt(0.0041 / 0.004)
    # The contact keeps its gap, by a displacement that is small against the waves.
    kept = np.abs(live.position[slice(*spans)] - ratio * old[slice(*spans)])
    assert kept.max() < 0.05 * np.abs(old[slice(*spans)]).max()
    frequencies = [one.track.modes().angular_frequency for one in (before, now)]
    assert not np.array_equal(*frequencies)


def test_a_root_that_is_made_to_move_faster_does_not_take_its_body_along_at_once():
    live, before = played("weak-pressure", chunks=50, drives__0__normal_load=0.001, contact__gap=1e-3)
    changed(live, "weak-pressure", drives__0__normal_load=0.001, contact__gap=1e-3, drives__0__velocity=0.5)
    place = marched(live, 1, 4)["contact_position"]
    assert abs(place[-1] - before["contact_position"][-1]) < 0.5 * 4 / RATE / 10


@pytest.mark.parametrize(
    "changes",
    [
        {"slider__elements": 12},
        {"slider__root_support": "free"},
        {"contact__gap": 1e-5},
        {"contact__at": 1.6},
    ],
)
def test_systems_that_cannot_continue_restart(changes):
    live, _ = played("stable-sliding", chunks=60)
    assert not changed(live, "stable-sliding", **changes)
    assert live.time == 0.0
    _, first = played("stable-sliding", chunks=2, **changes)
    again = marched(live, 2)
    assert all(np.array_equal(again[name], first[name]) for name in first)


def test_off_the_track_it_reports_it_and_restarts():
    what = system("stable-sliding", drives__0__transverse=40.0)
    live = LiveMarch(what, probes(what))
    for _ in range(200):
        chunk, ended = live.advance(480)
        if ended != "finished":
            break
    assert ended == "off the track"
    assert len(chunk.time) < 480
    live.restart()
    assert live.advance(480)[1] == "finished"


@pytest.mark.parametrize("case", ["squeal", "judder", "weak-pressure"])
def test_a_contact_that_is_moved_far_keeps_its_opening(case):
    for chunks in (7, 20, 31):
        live, before = played(case, chunks=chunks)
        place, was_open = before["contact_position"][-1], live.now.state.carried[0, at.STATUS] == 0.0
        for moved in (-0.15, 0.3):
            assert changed(live, case, contact__at=live.system.contacts[0].at + moved)
            chunk, ended = live.advance(480)
            assert ended == "finished"
            place += moved
            assert chunk.contact["contact_position"][0] == pytest.approx(place, abs=1e-4)
            if not was_open:
                assert abs(chunk.contact["gap"][0]) < 1e-4
            place = chunk.contact["contact_position"][-1]
            was_open = live.now.state.carried[0, at.STATUS] == 0.0


def test_it_restarts_as_another_system_from_any_state(monkeypatch):
    live, _ = played("squeal", chunks=5)
    monkeypatch.setattr(live.now.belief, "initial_energy", live.now.belief.initial_energy + 1.0)
    assert live.advance(480)[1] == "energy created"
    what = system("judder")
    live.begin(what, probes(what))
    _, first = played("judder", chunks=2)
    again = marched(live, 2)
    assert all(np.array_equal(again[name], first[name]) for name in first)
    with pytest.raises(ValueError, match="probe must be on a body of this system"):
        live.begin(system("squeal"), probes(system("squeal-on-plate")))
    assert live.system is what


def test_schemes_change_during_a_run():
    live, before = played("weak-pressure", chunks=30)
    assert changed(live, "weak-pressure", st.CentralDifference())
    after = marched(live, 30)
    assert after["normal_force"].max() < 3.0 * before["normal_force"].max()


def test_steps_are_as_long_as_asked_for_and_the_run_bit_for_bit():
    """A sample has a whole number of steps, none longer than requested."""
    what = system("weak-pressure")
    live = LiveMarch(what, probes(what), step=9e-6)
    assert live.ratio == 3
    run = st.simulate(what, 960 / RATE, step=1.0 / RATE / 3, sample_rate=RATE)
    found = marched(live, 2)["normal_force"]
    assert np.array_equal(run.normal_force.values, found)
    usual = LiveMarch(what, probes(what))
    assert usual.ratio > 3
    assert live.change(what, probes(what))
    assert (live.ratio, live.step) == (usual.ratio, usual.step)
    with pytest.raises(ValueError, match="step must be below the exact modal scheme's limit"):
        LiveMarch(what, probes(what), sample_rate=100.0, step=1e-2)


@pytest.mark.parametrize("case", ["violin", "belt", "lugre"])
def test_several_contacts_and_rigid_tracks_are_the_run_bit_for_bit(case):
    what = system(case)
    live = LiveMarch(what, ())
    parts = [live.advance(480)[0] for _ in range(10)]
    run = st.simulate(what, duration=0.1, sample_rate=RATE, probes=())
    for name in ("normal_force", "tangential_force", "gap", "slip_velocity", "status"):
        found = np.concatenate([part.contacts[name] for part in parts], axis=1)
        assert np.array_equal(np.atleast_2d(run[name].values.T), found), name
    assert np.abs(run.tangential_force.values).max() > 0.01


@pytest.mark.parametrize(
    ("case", "key", "value"), [("belt", "track__velocity", 0.2), ("violin", "friction__static", 0.9)]
)
def test_contacts_continue_in_place_when_values_change(case, key, value):
    live, _ = LiveMarch(system(case), ()), None
    before = live.advance(4800)[0]
    assert live.change(system(case, **{key: value}), ())
    after = live.advance(4800)[0]
    for name in ("contact_position", "gap"):
        steps = np.abs(np.diff(np.concatenate([before.contacts[name], after.contacts[name]], axis=1), axis=1))
        assert steps[:, 4799].max() <= 2.0 * steps.max(axis=1).max() + 1e-12
    passed = live.passed[0]
    live.advance(4800)
    speed = (live.passed[0] - passed) / 0.1
    assert speed == pytest.approx(value if case == "belt" else -0.2)


def refuse(*_):
    raise ValueError("no start")


def test_a_refused_change_has_no_effect(monkeypatch):
    live, _ = played("squeal", chunks=5)
    still, _ = played("squeal", chunks=5)
    with pytest.raises(ValueError, match="probe must be on a body of this system"):
        live.change(system("squeal", track__length=1.3), probes(live.system))
    with monkeypatch.context() as patch:
        patch.setattr("stridula.integration.under_way.state_at_start", refuse)
        with pytest.raises(ValueError, match="no start"):
            changed(live, "squeal", track__length=1.3)
    now, then = marched(live, 4), marched(still, 4)
    assert all(np.array_equal(now[name], then[name]) for name in now)


def test_created_energy_ends_it(monkeypatch):
    live, _ = played("squeal", chunks=5)
    monkeypatch.setattr(live.now.belief, "initial_energy", live.now.belief.initial_energy + 1.0)
    chunk, ended = live.advance(480)
    assert ended == "energy created"
    assert len(chunk.time) == 0
