"""Live marches in space: the run of `simulate` in parts, and continuity at changes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import stridula as st
from stridula._kernels.layout import columns as at
from stridula.integration.live import LiveMarch
from stridula.lowering import assemble

from .into_space import IntoSpace
from .test_paths_in_space import BEAM, rubbed

RATE = 48e3
TURNED = Rotation.from_rotvec([0.3, -0.7, 1.1]).as_matrix()
ALONG_BOTH = ("tangential_force", "contact_position", "slip_velocity")


def system(case: str, **changes) -> st.System:
    return st.load_scenario(case, {key.replace("__", "."): value for key, value in changes.items()}).system


def joined(parts, name: str) -> np.ndarray:
    values = [part.along_tangents.get(name, part.contacts[name]) for part in parts]
    return np.moveaxis(np.concatenate(values, axis=1), 0, 1)


@pytest.mark.parametrize(
    ("case", "samples"), [("pin-on-disc", 480), ("glass", 480), ("wheel", 480), ("pad-on-disc", 96), ("brake", 24)]
)
def test_parts_are_the_run_bit_for_bit(case, samples):
    scenario = st.load_scenario(case)
    what, probes = scenario.system, scenario.probes
    live = LiveMarch(what, probes)
    parts = [live.advance(count)[0] for count in (samples // 2, 1, samples // 2 - 1)]
    words = {"surface_rate": "all"} if what.faces else {}
    run = st.simulate(what, samples / RATE, sample_rate=RATE, probes=probes, **words)
    for name in ("normal_force", "gap", "status", *ALONG_BOTH):
        found = joined(parts, name)
        assert np.array_equal(run[name].values.reshape(found.shape), found), name
    shares = np.concatenate([part.status_shares for part in parts], axis=1).swapaxes(0, 1)
    assert np.array_equal(run.status_share.values.reshape(shares.shape), shares)
    late = np.concatenate([part.probes for part in parts])[live.delay :]
    assert np.array_equal(run.velocity.values[: len(late)], late)


def test_motion_of_bodies_is_given_with_springs_on_residual_shapes():
    """Displacement and velocity of a pad's back: by the modes of the body, and by the rows of probes."""
    what = system("brake")
    pad = next(body for body in what.bodies if body.name == "upper pad")
    live = LiveMarch(what, ())
    live.advance(8)
    span, (position, velocity) = slice(*live.spans["upper pad"]), live.motion
    assert np.array_equal(position, live.position)
    marched = live.now.state.modal
    moved = {"displacement": position[span], "velocity": velocity[span]}
    probes = (st.Displacement(pad.at("top"), "y"), st.Velocity(pad.at("top"), "y"))
    rows = assemble(what, probes).probes
    assert pad.trace("top")[1] @ moved["displacement"] == pytest.approx(rows[0].rows[0] @ marched[at.Q], rel=1e-9)
    assert pad.trace("top")[1] @ moved["velocity"] == pytest.approx(
        rows[1].rows[1] @ marched[at.D] / live.step, rel=1e-9
    )
    assert not np.allclose(position[span], marched[at.Q][span])


def changed_in_both(change, samples: int = 480):
    """March a rod along a beam in the plane and in space, with a change during the run; return their normal forces."""
    before, now = rubbed(BEAM), change(rubbed(BEAM))
    found = []
    for first, second in ((before, now), (IntoSpace(TURNED).system(before)[0], IntoSpace(TURNED).system(now)[0])):
        live = LiveMarch(first, ())
        live.advance(samples)
        assert live.change(second, ())
        found.append(np.concatenate([live.advance(samples)[0].contact[name] for name in ("normal_force", "gap")]))
    return found


def harder(what: st.System) -> st.System:
    return replace(
        what, drives=[replace(one, y=1.3 * one.y) if isinstance(one, st.Force) else one for one in what.drives]
    )


CHANGES = {
    "friction": lambda what: replace(what, contact=replace(what.contact, friction=st.Coulomb(0.1))),
    "a longer beam": lambda what: replace(what, contact=replace(what.contact, track=replace(BEAM, length=0.81))),
    "a damped beam": lambda what: replace(what, contact=replace(what.contact, track=replace(BEAM, damping=0.02))),
    "another place": lambda what: replace(what, contact=replace(what.contact, at=what.contact.at + 0.01)),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_change_in_space_is_that_of_the_plane(change):
    flat, in_space = changed_in_both(CHANGES[change])
    assert np.abs(flat).max() > 0.0
    np.testing.assert_allclose(in_space, flat, atol=1e-6 * np.abs(flat).max())


def test_a_glass_turned_faster_continues_to_sing():
    live = LiveMarch(system("glass"), ())
    before = live.advance(4800)[0]
    faster = system("glass", **{"bodies__glass__turning": "33 rpm"})
    assert live.change(faster, ())
    passed = live.passed[0]
    after = live.advance(4800)[0]
    assert live.time == pytest.approx(0.2)
    assert (live.passed[0] - passed) / 0.1 == pytest.approx(1.1 * 0.0325 * np.pi, rel=1e-9)
    force = np.concatenate([before.contact["normal_force"], after.contact["normal_force"]])
    assert abs(force[4800] - force[4799]) < 0.01 * force.max()


@pytest.mark.parametrize("change", ["friction", "scheme"])
def test_a_compliant_contact_stays_indented(change):
    live = LiveMarch(system("wheel"), ())
    before = live.advance(4800)[0].contact
    other = system("wheel", contacts__0__friction__kinetic=0.15) if change == "friction" else system("wheel")
    assert live.change(other, (), st.CentralDifference() if change == "scheme" else None)
    after = live.advance(480)[0].contact
    assert before["normal_force"][-1] > 1e4
    assert after["normal_force"][0] == pytest.approx(before["normal_force"][-1], rel=0.02)
    assert after["gap"][0] == pytest.approx(before["gap"][-1], rel=0.02)


def test_a_body_at_its_own_speed_restarts_with_other_modes():
    ramp = {"kind": "ramp", "duration": 0.5}
    case = {"bodies__glass__turning_history": ramp, "drives": [{"kind": "force", "body": "finger", "z": -1.0}]}
    live = LiveMarch(system("glass", **case), ())
    live.advance(480)
    assert not live.change(system("glass", **case), (), st.CentralDifference())
    assert live.time == 0.0
