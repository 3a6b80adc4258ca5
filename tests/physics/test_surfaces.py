"""Faces in contact: the patch test, pads on turning discs, planes, and refusals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from stridula.analysis import surface
from stridula.linear.equilibrium import find_equilibrium
from stridula.linear.structure import Structure
from stridula.verification.surfaces import patches

from .test_equilibrium_starts import growth, starting

IRON, LINING = st.Material(1.1e11, 7100.0, 0.28), st.Material(5e9, 2500.0, 0.3)
SLIDING = 2


def moved(mesh: st.SolidMesh, *by: float) -> st.SolidMesh:
    return replace(mesh, nodes=mesh.nodes + np.array(by))


# Two unlike meshes.


def test_points_of_one_of_two_unlike_meshes_are_not_enough():
    """With the points of both it is the patch test of `stridula verify`."""
    system = patches(overlay=False)
    (face,) = system.faces
    rough = find_equilibrium(Structure(system), np.full(len(system.contacts), 0.1)).normal_force / face.areas
    assert np.abs(rough / 1e6 - 1.0).max() > 1e-3


def test_a_point_anywhere_in_a_mesh_moves_with_it():
    """Displacements that are linear in the coordinates are met exactly between the nodes, on curved elements too."""
    sector = st.SolidMesh.sector((0.08, 0.12), (-0.35, 0.35), 0.015, (2, 3, 2), axis="y")
    body = st.SolidBody(sector, LINING)
    rng = np.random.default_rng(0)
    nodes, shares = body.mesh.nodes, rng.uniform(size=(20, 3))
    radius, angle = 0.08 + 0.04 * shares[:, 0], -0.35 + 0.7 * shares[:, 1]
    places = np.array([radius * np.sin(angle), 0.015 * shares[:, 2], radius * np.cos(angle)]).T
    slope = rng.normal(size=(3, 3))
    modal = body.modal_coordinates(nodes @ slope.T)
    for place in places:
        np.testing.assert_allclose(body.trace(tuple(place.tolist())) @ modal, slope @ place, atol=1e-9)
    np.testing.assert_allclose(body.trace(tuple(nodes[7].tolist())), body.shapes[21:24], atol=1e-12 * body.shapes.max())


# A pad on a disc that turns.


def brake(friction: float, axis=(0.0, 1.0, 0.0), stiffness=3e12, turning: float = 30.0, law=st.Coulomb, **words):
    disc = st.AxisymmetricBody(
        st.RectangleProfile({"ring": ((0.04, 0.13), (-0.006, 0.006))}),
        IRON,
        cutoff=6e3,
        held=["inner"],
        damping=0.001,
        residual_at=[(0.1, 0.006)],
        axis=axis,
        turning=turning,
        name="disc",
    )
    mesh = moved(st.SolidMesh.sector((0.08, 0.12), (-0.35, 0.35), 0.015, (2, 3, 1), axis="y"), 0.0, 0.006, 0.0)
    pad = st.SolidBody(mesh, LINING, cutoff=12e3, damping=0.004, contact_faces=["bottom"], name="pad")
    face = st.SurfaceContact(pad, "bottom", disc, friction=law(friction), stiffness=stiffness, name="lining", **words)
    back = pad.face_points("top")
    loads = [
        st.Force(pad.at(place), y=-1200.0 * area / back.area.sum())
        for place, area in zip(back.place.tolist(), back.area.tolist(), strict=True)
    ]
    rates = {"x": 2e7, "y": 2e5, "z": 2e7}
    springs = [
        st.Spring(pad.at(place), stiffness=rate, direction=way)
        for place in back.place[::6].tolist()
        for way, rate in rates.items()
    ]
    return st.System(face, loads, springs), face


def test_a_face_finds_the_disc_before_it():
    system, face = brake(0.3)
    assert len(face.contacts) == 24
    for contact, place, normal in zip(face.contacts, face.points.place, face.points.normal, strict=True):
        assert contact.gap == pytest.approx(0.0, abs=1e-12)
        np.testing.assert_allclose(contact.frame[0], -normal, atol=1e-9)
        turning = contact.touched_point.turning_velocity
        np.testing.assert_allclose(turning, 30.0 * np.cross([0.0, 1.0, 0.0], place), atol=1e-9)
        np.testing.assert_allclose(contact.frame[1], turning / np.linalg.norm(turning), atol=1e-9)
        np.testing.assert_allclose(system.track.place(contact.touched_point.position), place, atol=1e-12)
    sector = 0.5 * 0.7 * (0.12**2 - 0.08**2)
    assert face.areas.sum() == pytest.approx(sector, rel=1e-4)


def test_a_pad_stays_in_equilibrium_and_has_its_resultants():
    system, face = brake(0.05)
    theory = st.sliding_stability(system)
    assert theory.attrs["equilibrium"] == "sliding"
    assert not theory.unstable.any()
    run = st.simulate(starting(system), 2e-3, step=1e-6, probes=[], surface_rate="all")
    np.testing.assert_allclose(
        run.normal_force.values, np.broadcast_to(theory.normal_force.values, run.normal_force.shape), rtol=2e-3
    )
    found = surface(run, face)
    loads = sum(drive.push[2][1] for drive in system.drives)
    force = found.force.values[-1]
    assert 0.9 * -loads < force[1] < -loads
    # Friction acts round the axis along the face.
    assert np.hypot(force[0], force[2]) == pytest.approx(0.05 * force[1] * np.sin(0.35) / 0.35, rel=0.01)
    np.testing.assert_allclose(found.pressure.values @ face.areas, run.normal_force.sum("contact"), rtol=1e-12)
    middle = face.areas @ face.points.place / face.areas.sum()
    centre = found.centre_of_pressure.values[-1]
    # Friction presses the leading edge more.
    assert 0.0 < np.linalg.norm(centre - middle) < 0.01
    moment = np.cross(centre - middle, [0.0, force[1], 0.0])
    np.testing.assert_allclose(found.moment.values[-1][[0, 2]], moment[[0, 2]], atol=0.02 * np.abs(moment).max())
    assert found.closed_area.values[-1] == pytest.approx(face.areas.sum())
    power = 0.05 * run.normal_force.values[-1] @ np.hypot(*run.slip_velocity.values[-1].T)
    assert found.friction_power.values[-1] == pytest.approx(power, rel=1e-3)


def test_growth_in_time_is_that_of_linear_theory():
    """A mode of the pad on its lining at 19.7 kHz."""
    system, _ = brake(0.3)
    probe = st.Displacement(system.track.at((0.13, 0.0, 0.006)), "y")
    known, seen, _ = growth(system, probe, 2.5e-7, 3e-4, 8, amplitude=1e-12)
    assert known.real > 1000.0
    assert seen.real == pytest.approx(known.real, rel=0.02)
    assert seen.imag == pytest.approx(known.imag, rel=1e-3)


def test_a_part_of_a_face_may_lift_off_and_the_run_runs_again(tmp_path):
    """Under strong friction the trailing edge is open in equilibrium, which still is one of sliding."""
    system, face = brake(0.6, stiffness=1e13)
    theory = st.sliding_stability(system)
    assert theory.attrs["equilibrium"] == "sliding"
    assert 0 < int((theory.status == "separated").sum()) < len(face.contacts)
    run = st.simulate(starting(system), 3e-4, probes=[])
    assert int(run.unsolved_steps.sum()) == 0
    again = st.load_scenario(run).simulate()
    np.testing.assert_array_equal(again.normal_force, run.normal_force)


@pytest.mark.parametrize("friction", [0.2, 0.4, 0.6])
def test_a_rigid_face_that_bounces_finds_its_forces(friction):
    """The condition of its compliance is 2e6, and the open points change at every step."""
    system, _ = brake(friction, stiffness=None)
    run = st.simulate(system, 1e-3, probes=[])
    assert int(run.unsolved_steps.sum()) == 0
    assert 0.1 < float(run.status_share.sel(contact_status="separated").mean()) < 0.9
    assert float(np.median(run.contact_sweeps)) < 20
    assert np.abs(run.ledger_residual).max() < 1e-10 * run.drive_work.max()


def test_a_rigid_face_that_is_not_solved_reports_its_rank():
    system, _ = brake(3.0, stiffness=None)
    with pytest.raises(st.Diverged, match=r"rank \d+ of \d+ .* or too few sweeps"):
        st.simulate(system, 1e-3, probes=[], contact_solve=st.GaussSeidel(sweeps=2))


@pytest.mark.parametrize("law", [st.Stribeck(0.5, 0.3, 0.5), st.StaticKinetic(0.5, 0.4)], ids=["Stribeck", "static"])
def test_a_rigid_face_under_another_law_finds_its_forces_in_few_steps(law):
    system, _ = brake(0.4, stiffness=None, law=lambda _: law)
    run = st.simulate(system, 1e-3, probes=[], contact_solve=st.GaussSeidel(sweeps=2))
    assert int(run.unsolved_steps.sum()) == 0
    assert np.abs(run.ledger_residual).max() < 1e-10 * run.drive_work.max()


def test_a_curved_face_has_gaps_over_a_plane():
    """The outside of a sector on a plane: gaps are the heights over its lowest points."""
    sector = st.SolidMesh.sector((0.08, 0.12), (-0.2, 0.2), 0.02, (1, 4, 1), axis="y")
    body = st.SolidBody(sector, LINING, cutoff=3e4)
    face = st.SurfaceContact(body, "outer", st.RigidTrack(), gap=1e-5)
    heights = -face.points.place[:, 2]
    gaps = np.array([contact.gap for contact in face.contacts])
    np.testing.assert_allclose(gaps - 1e-5, heights - heights.min(), atol=1e-9)
    assert gaps.max() > 1e-4


def flipped():
    block = st.SolidBody(st.SolidMesh.block((0.02, 0.02, 0.02), (1, 1, 1)), LINING, name="block")
    return block, st.SolidBody(moved(block.mesh, 0.0, 0.03, 0.0), LINING, name="other")


BAD = {
    "face": (lambda: st.SurfaceContact(flipped()[0], "roof", st.RigidTrack()), "face must be one of"),
    "track": (lambda: st.SurfaceContact(flipped()[0], "top", 3.0), "track must be"),
    "beside": (
        lambda: st.SurfaceContact(flipped()[0], "top", flipped()[1], "left"),
        "track_face must lie opposite the whole face",
    ),
    "overlap": (
        lambda: st.SurfaceContact(flipped()[0], "top", flipped()[1], "bottom", gap=-0.02),
        "gap must leave the faces apart",
    ),
    "off the disc": (
        lambda: st.SurfaceContact(
            st.SolidBody(moved(flipped()[0].mesh, 0.13, 0.006, 0.0), LINING), "bottom", brake(0.1)[0].track
        ),
        "track must lie opposite the whole face",
    ),
    "overlay": (
        lambda: st.SurfaceContact(flipped()[0], "top", st.RigidTrack(), overlay=True),
        "overlay must be left out except on a SolidBody",
    ),
    "outside": (lambda: flipped()[0].at((1.0, 0.0, 0.0)), "within the mesh"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_arguments_are_refused(name):
    make, words = BAD[name]
    with pytest.raises(ValueError, match=words):
        make()
