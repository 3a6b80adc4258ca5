"""Where a model ends: notes of records, of linear theory and on cards, and the limits that they state."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
import scipy.linalg

import stridula as st
from stridula.bodies.sections import SHORTEST_WAVE
from stridula.lowering import assemble
from stridula.lowering.model_ends import contact_modes

STEEL = st.Material(2.1e11, 7800.0)
COULOMB = st.Coulomb(0.3)


def notes(system, duration=1e-4):
    """Return the notes of a record, which linear theory and the card repeat."""
    run = st.simulate(system, duration)
    found = run.attrs["notes"]
    assert st.card(run).facts.get("notes", "") == found
    return found


def pressed(track, friction=COULOMB, **words):
    """Return a mass pressed on a track."""
    mass = st.PointMass(1.0)
    return st.System(st.PointContact(mass.centre, track, friction=friction, **words), [st.Force(mass.centre, y=-10.0)])


# Beams beyond slender, plates beyond thin.


def timoshenko(waves, depth, shear=5.0 / 6.0, poisson=0.3, widens=0.0):
    """Return the frequency of thin theory over that with shear and rotatory inertia, for waves over the depth."""
    k, inertia = 2.0 * math.pi / (waves * depth), depth**3 / 12.0
    rigidity, shear = inertia / (1.0 - widens**2), shear * depth / (2.0 * (1.0 + poisson))
    stiffness = np.array([[shear * k * k, -shear * k], [-shear * k, rigidity * k * k + shear]])
    squared = scipy.linalg.eigh(stiffness, np.diag([depth, inertia]), eigvals_only=True)[0]
    return math.sqrt(rigidity / depth) * k * k / math.sqrt(squared)


def test_thin_theory_is_a_seventh_or_more_too_stiff_for_waves_of_six_depths():
    assert timoshenko(SHORTEST_WAVE, 0.02) == pytest.approx(1.165, abs=1e-3)
    assert timoshenko(SHORTEST_WAVE, 0.02, math.pi**2 / 12.0, widens=0.3) == pytest.approx(1.178, abs=1e-3)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("section", [st.Rectangle, st.Circle, st.Section])
def test_beams_are_noted_from_the_first_mode_with_waves_under_six_depths(seed, section):
    dice = np.random.default_rng(seed)
    depth, length = dice.uniform(5e-3, 3e-2), dice.uniform(0.2, 1.0)
    made = {
        st.Rectangle: st.Rectangle(0.03, depth),
        st.Circle: st.Circle(depth),
        st.Section: st.Section(0.03 * depth, 0.03 * depth**3 / 12.0),
    }[section]
    last = math.floor(2.0 * length / (6.0 * depth))
    slim, thick = (st.ModalBeam(STEEL, made, length, bending_modes=count, axial_modes=1) for count in (last, last + 1))
    assert slim.thick_from == math.inf
    below, above = thick.modes().frequency[last - 1 : last + 1]
    assert below <= thick.thick_from < above
    assert notes(pressed(slim, at=length / 3)) == ""
    theory = st.sliding_stability(pressed(thick, at=length / 3), status="sliding", velocity=1.0)
    assert f"bending above {thick.thick_from:.4g} Hz" in theory.attrs["notes"]
    assert notes(pressed(thick, at=length / 3)) == (
        f"track: bending above {thick.thick_from:.4g} Hz is too stiff without shear, with waves under six heights"
    )


def test_rods_in_elements_are_noted_by_element_and_cutoff():
    section = st.Rectangle(0.02, 0.01)
    coarse, fine = (st.FiniteElementBeam(STEEL, section, 0.3, elements=count) for count in (10, 11))
    assert coarse.thick_from == math.inf
    limit = fine.thick_from
    expected = st.ModalBeam(STEEL, section, 0.3, bending_modes=40).thick_from
    assert limit == pytest.approx(expected)
    cut = [st.FiniteElementBeam(STEEL, section, 0.3, elements=40, cutoff=share * limit) for share in (0.99, 1.01)]
    assert [one.thick_from for one in cut] == [math.inf, pytest.approx(limit)]
    rod = st.System(st.PointContact(fine.tip, st.RigidTrack(), friction=COULOMB), [st.Force(fine.root, y=-10.0)])
    assert notes(rod).startswith(f"slider: bending above {limit:.4g} Hz is too stiff")


def test_strings_are_not_noted():
    string = st.ModalBeam(STEEL, st.Circle(1e-3), 0.33, bending_modes=400, axial_modes=1, tension=5e6)
    assert string.thick_from == math.inf
    assert st.ModalBeam(STEEL, st.Circle(1e-3), 0.33, bending_modes=400, axial_modes=1).thick_from < math.inf


@pytest.mark.parametrize("seed", range(4))
def test_plates_are_noted_from_waves_under_six_thicknesses(seed):
    dice = np.random.default_rng(seed)
    thickness, sides = dice.uniform(2e-3, 8e-3), dice.uniform(0.05, 0.1, 2)
    plate = st.ModalPlate(STEEL, thickness, *sides, (40, 40), in_plane=True, in_plane_modes=(1, 1))
    wave = 2.0 * np.pi / np.linalg.norm(plate.wavenumbers, axis=1)
    frequency = plate.modes().frequency[: len(wave)]
    is_short = wave < 6.0 * thickness
    assert is_short.any()
    assert frequency[~is_short].max() <= plate.thick_from < frequency[is_short].min()
    thin = st.ModalPlate(STEEL, thickness, *sides, (1, 1), in_plane=True, in_plane_modes=(1, 1))
    assert thin.thick_from == math.inf
    assert notes(pressed(thin, at=sides[0] / 3)) == ""
    assert notes(pressed(plate, at=sides[0] / 3)).startswith(f"track: bending above {plate.thick_from:.4g} Hz")


# Discs near a critical speed.


def disc(turning, **words):
    return st.AxisymmetricBody(
        st.RectangleProfile({"disc": ((0.03, 0.15), (0.0, 0.004))}), STEEL, 2e3, "inner", turning=turning, **words
    )


def rubbed(turning, **words):
    mass, body = st.RigidBody(0.1), disc(turning, **words)
    contact = st.PointContact(mass.centre, body.at((0.12, 0.0, 0.004)), friction=COULOMB, normal=(0.0, 0.0, 1.0))
    return st.System(contact, [st.Force(mass.centre, z=-10.0)])


def test_a_disc_near_a_critical_speed_is_noted():
    body = disc(0.0)
    order, frequency = body.numbers[:, 0], body.modes().angular_frequency
    order, frequency = order[order > 0], frequency[order > 0]
    lowest = int((frequency / order).argmin())
    critical, number = float(frequency[lowest] / order[lowest]), int(order[lowest])
    found = notes(rubbed(0.77 * critical))
    words = (
        r"track: turns at 77 % of (\S+) rad/s, critical for waves of order (\d+); centrifugal stiffening is left out"
    )
    (speed, waves), *none = re.findall(words, found)
    assert not none
    # Coriolis forces shift it a little.
    assert (float(speed), int(waves)) == (pytest.approx(critical, rel=1e-3), number)
    assert notes(rubbed(-0.77 * critical)) == found
    assert notes(rubbed(0.25 * critical)) == ""
    # The speed counts that is reached, not the stated one.
    history = st.Harmonic(1.0, amplitude=1.0, mean=2.0)
    assert "turns at 75 %" in notes(rubbed(0.25 * critical, turning_history=history))


# Friction that is left out.


def test_contacts_without_friction_are_named():
    assert notes(pressed(st.RigidTrack(), st.Coulomb(0.0))) == "without friction: contact 1"
    assert notes(pressed(st.RigidTrack())) == ""
    body = st.SolidBody.block((0.1, 0.04, 0.1), (2, 1, 2), STEEL, cutoff=3e4)
    face = st.SurfaceContact(body, "bottom", st.RigidTrack(), stiffness=1e11, name="lining")
    assert notes(st.System(face, [st.Force(body.at("top"), y=-10.0)])).startswith("without friction: lining")


def test_tracks_that_friction_does_not_move_are_named():
    stiff = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.008), 0.8, bending_modes=9, axial_modes=0)
    words = "rigid along their contacts, so that friction does not move them: track"
    assert notes(pressed(stiff, at=0.3)) == words
    assert notes(pressed(stiff, st.Coulomb(0.0), at=0.3)) == "without friction: contact 1"
    plate = st.ModalPlate(STEEL, 0.002, 0.4, 0.3, (4, 4))
    assert notes(pressed(plate, at=0.1)) == words


# Contacts that vibrate near a cutoff.


def lined(stiffness, modes=30):
    """Return a small mass on a lining on a beam with a cutoff."""
    beam = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.02), 0.8, cutoff=5e3)
    mass = st.PointMass(0.01)
    contact = st.PointContact(mass.centre, beam, at=0.31, friction=COULOMB, stiffness=stiffness)
    return st.System(contact, [st.Force(mass.centre, y=-10.0)])


@pytest.mark.parametrize("share", [0.2, 0.6, 1.0, 1.6, 3.0])
def test_a_contact_that_vibrates_near_the_cutoff_is_noted(share):
    stiffness = 0.01 * (2.0 * math.pi * 5e3 * share) ** 2
    found = notes(lined(stiffness))
    is_near = 0.5 < share < 2.0
    assert ("contact 1: vibrates on its stiffness at " in found) == is_near
    if is_near:
        assert found.endswith("near the cutoff of track, 5000 Hz")
        frequency = float(found.split(" at ")[1].split(" Hz")[0])
        assert frequency == pytest.approx(5e3 * share, rel=0.15)


@pytest.mark.parametrize("seed", range(5))
def test_frequencies_with_closed_contacts_are_those_of_the_whole_matrix(seed):
    """Residual shapes without mass as the limit of shapes of little mass."""
    dice = np.random.default_rng(seed)
    body = st.SolidBody.block((0.1, 0.04, 0.1), (2, 1, 2), STEEL, cutoff=2e4, contact_faces=["bottom"])
    face = st.SurfaceContact(body, "bottom", st.RigidTrack(), stiffness=10.0 ** dice.uniform(10, 13), friction=COULOMB)
    arrays = assemble(st.System(face, [st.Force(body.at("top"), y=-10.0)]))
    soft = [one for one in arrays.contacts if one.yields is not None]
    rows = np.array([one.fixed[0] for one in soft])
    stiffness = np.array([one.yields.numbers[0] for one in soft])
    frequency, shares = contact_modes(arrays, rows, stiffness)
    assert arrays.massless.any()
    matrix = arrays.all_stiffness + (rows.T * stiffness) @ rows
    inertia = np.diag(np.where(arrays.massless, 1e-14, 1.0))
    squared = scipy.linalg.eigh(matrix, inertia, eigvals_only=True)
    expected = np.sqrt(np.maximum(squared, 0.0)) / (2.0 * np.pi)
    # A frequency of zero is the root of a rounding error of the largest.
    rounding = expected[-1] * np.sqrt(squared.size * np.finfo(float).eps)
    np.testing.assert_allclose(frequency, expected[: frequency.size], rtol=1e-4, atol=rounding)
    vibrates = frequency > rounding
    assert vibrates.any()
    assert (shares[:, vibrates].sum(axis=0) <= 1.0 + 1e-9).all()


def sprung(held: float, pressed: float = 1e7) -> st.System:
    """A chain with a cutoff of 2 kHz and a mass, both on a belt under falling friction, held along it by springs."""
    size = 40
    chain = 1e9 * (2.0 * np.eye(size) - np.eye(size, k=1) - np.eye(size, k=-1))
    body = st.ReducedBody(np.eye(size), chain, {"foot": (3, 30)}, cutoff=2e3, residual_flexibility=False, name="chain")
    mass, track = st.PointMass(1.0, name="mass"), st.RigidTrack(velocity=0.2, name="belt")
    law = st.ExponentialWeakening(0.5, 0.2, 0.5)
    contacts = [
        st.PointContact(body.at("foot"), track, friction=law, stiffness=st.LinearStiffness(1e7), name="foot"),
        st.PointContact(mass.centre, track, friction=law, stiffness=st.LinearStiffness(pressed), name="mass"),
    ]
    springs = [st.Spring(point, stiffness=held, direction="x") for point in (body.at("foot"), mass.centre)]
    loads = [st.Force(point, y=-100.0) for point in (body.at("foot"), mass.centre)]
    return st.System(contacts, loads, springs)


def test_modes_beyond_every_cutoff_are_flagged():
    """Of bodies with a cutoff alone: a mass vibrates on its springs at any frequency."""
    soft, fast, stiff = (st.sliding_stability(sprung(*one)) for one in ((1e7,), (1e7, 1e11), (1e12,)))
    assert not soft.beyond_cutoff.any()
    assert (float(soft.frequency.max()), float(fast.frequency.max())) == pytest.approx((2e3, 5e4), rel=0.1)
    assert not fast.beyond_cutoff.any()
    # Both on springs of 1e12 N/m: that of the mass is where the mass is, that of the chain lacks its other modes.
    beyond = stiff.frequency.values > 2e3
    assert int((beyond & stiff.unstable.values).sum()) == 2
    chain = stiff.energy_share.sel(body="chain").values > 0.5
    np.testing.assert_array_equal(stiff.beyond_cutoff, beyond & chain)
    assert int(stiff.beyond_cutoff.sum()) == 1
    words = "growing mode lies above the cutoff of every body, 2000 Hz"
    assert [words in one.attrs["notes"] for one in (soft, fast, stiff)] == [False, False, True]
    # Without a cutoff nothing lies beyond.
    assert not st.sliding_stability(pressed(st.RigidTrack(velocity=1.0))).beyond_cutoff.any()


def test_meshes_without_residual_shapes_of_a_face_in_contact_are_noted():
    """A pad on a block: each side without the residual shapes of its face is named."""
    steel = st.Material(210e9, 7800.0)
    mesh = st.SolidMesh.block((0.04, 0.01, 0.03), (2, 1, 2))

    def noted(**faces):
        lower = st.SolidBody(
            mesh, steel, fixed=["bottom"], cutoff=9e4, contact_faces=faces.get("lower", ()), name="base"
        )
        upper = st.SolidBody(
            mesh.moved((0.0, 0.01, 0.0)), steel, cutoff=9e4, contact_faces=faces.get("upper", ()), name="pad"
        )
        face = st.SurfaceContact(upper, "bottom", lower, "top", st.Coulomb(0.3), stiffness=1e11)
        return notes(st.System(face, [st.Force(upper.at("top"), y=-100.0)]))

    words = "too stiff in contact without residual shapes, which contact_faces gives: {}"
    assert words.format("'bottom' of pad, 'top' of base") in noted(upper=["top"])
    assert words.format("'top' of base") in noted(upper=["bottom"])
    assert "residual shapes" not in noted(upper=["bottom"], lower=["top"])
