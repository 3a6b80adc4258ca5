"""Sound of plates and beams in space: as in their own axes, against theory, and together with other bodies."""

from __future__ import annotations

import re
from dataclasses import replace
from math import pi

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import stridula as st
from stridula.acoustics import responses, sheets
from stridula.acoustics.dipoles import moved_area
from stridula.acoustics.panels import line_of, panel_of
from stridula.acoustics.recorded_motion import VARIABLE
from stridula.acoustics.sheets import SheetDipoles, sheet_of
from stridula.acoustics.sounding import sounding_of
from stridula.acoustics.surface_pressures import SurfacePressures
from stridula.bodies.solids import surfaces
from stridula.places import origins_in_space
from stridula.verification.open_air import air_carried

from .test_radiation import AIR, baffled_spectrum, dipole_spectrum, error

TURN = Rotation.from_rotvec([0.3, -0.7, 1.1]).as_matrix()
PLANE = (TURN[:, 0], TURN[:, 1])
STEEL, ALUMINIUM = st.Material(2.1e11, 7850.0, 0.3), st.Material(7e10, 2700.0)
PLATE = st.ModalPlate(
    ALUMINIUM, 3e-3, 0.3, 0.25, (2, 2), damping=0.03, line=st.Line((0.05, 0.08), 0.4), plane=PLANE, name="plate"
)
BEAM = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.01), 0.3, 2, 1, damping=0.03, plane=PLANE, name="beam")
# Place of the block in the world, and listeners in the axes of the track.
THERE = np.array([0.3, -0.2, 0.1])
EARS = np.array([[0.1, 0.05, 0.5], [0.4, 0.3, 0.7]])


def along(vector) -> dict[str, float]:
    """World components of a vector in the axes of the track, as arguments of a force."""
    return dict(zip("xyz", (TURN @ np.asarray(vector)).tolist(), strict=True))


def pressed(track) -> st.System:
    """A block with a place in the world, pressed on a track that is turned and shifted."""
    mesh = st.SolidMesh.block((0.006, 0.006, 0.009), (1, 1, 1))
    block = st.SolidBody(replace(mesh, nodes=mesh.nodes @ TURN.T + THERE), STEEL, points={"tip": 0}, cutoff=2e4)
    with pytest.MonkeyPatch.context() as patch:
        # A coarse surface is faster.
        patch.setattr(surfaces, "MOST", 60)
        assert len(block.surface().points) < 200
    contact = st.PointContact(block.at("tip"), track, at=0.06, friction=st.Coulomb(0.3))
    history = st.Sampled((0.0, 1e-3, 2e-3, 5e-3, 6e-3), (0.0, 1.0, 0.6, 1.0, 0.0))
    return st.System(contact, [st.Force(block.at("tip"), history=history, **along([4.0, -30.0, 0.0]))])


def played(track):
    system = pressed(track)
    probes = [st.ModalMotion(track)]
    run = st.simulate(system, 0.02, step=5e-6, sample_rate=2e4, probes=probes)
    assert float(run.normal_force.max()) > 20.0
    # The corner of the block is at its place; the track begins 6 cm before.
    corner = THERE - 0.06 * TURN[:, 0]
    if hasattr(track, "track_line"):
        corner = corner - np.array(track.track_line.origin) @ track.frame[:2]
    return system, run, corner + EARS @ track.frame


@pytest.fixture(scope="module")
def plate():
    return played(PLATE)


@pytest.fixture(scope="module")
def beam():
    return played(BEAM)


@pytest.mark.parametrize("baffled", [True, False], ids=["in a baffle", "in open air"])
@pytest.mark.parametrize("kind", ["plate", "beam"])
def test_turned_and_shifted_it_sounds_as_in_its_own_axes(kind, baffled, request):
    """A track alone is driven by the normal forces along its line, a track in its system by all forces."""
    system, run, ears = request.getfixturevalue(kind)
    run, track = run.drop_vars(VARIABLE), system.track
    known = st.radiate(run, track, EARS, baffled=baffled)
    found = st.radiate(run, system, ears, bodies=[track], baffled=baffled)
    assert np.abs(known).max() > 0.01
    assert error(found.values, known.values) < 1e-6
    assert found.attrs["baffled"] == int(baffled)
    assert found.attrs["motion"] == "driven again"
    np.testing.assert_allclose(found.attrs["distance"], known.attrs["distance"], rtol=1e-9)
    # Negative control: as far away in another direction.
    other = st.radiate(run, system, ears + 0.2 * track.frame[0], bodies=[track], baffled=baffled)
    assert error(other.values, known.values) > 0.05


@pytest.mark.parametrize("kind", ["plate", "beam"])
def test_recorded_motion_is_heard(kind, request):
    system, run, ears = request.getfixturevalue(kind)
    known = st.radiate(run.drop_vars(VARIABLE), system, ears, bodies=[system.track])
    found = st.radiate(run, system, ears, bodies=[system.track])
    assert found.attrs["motion"] == "recorded"
    # Samples of 50 us; the two differ by one sample.
    late = slice(60, 380)
    level = np.log10(np.mean(found.values[late] ** 2, axis=0) / np.mean(known.values[late] ** 2, axis=0))
    assert np.abs(10.0 * level).max() < 0.1
    still = run.assign({VARIABLE: 0.0 * run[VARIABLE]})
    assert not st.radiate(still, system, ears, bodies=[system.track]).values.any()


def test_the_whole_is_the_sum_of_its_bodies(plate):
    system, run, ears = plate
    block = system.slider
    # Each sound is cut off before it can arrive.
    late = slice(60, None)
    for baffled in (None, True):
        whole = st.radiate(run, system, ears, baffled=baffled)
        assert whole.attrs["bodies"] == ["slider", "plate"]
        assert np.isfinite(whole.attrs["fit_error"]).tolist() == [True, baffled is None]
        known = st.radiate(run, system, ears, bodies=[system.track], baffled=baffled).values
        if baffled is None:
            rest = st.radiate(run, system, ears, bodies=[block]).values
        else:
            # The reflected sound is that at the image of the listener.
            normal = system.track.frame[2]
            heights = (ears - THERE) @ normal
            images = ears - 2.0 * np.outer(heights, normal)
            both = st.radiate(run, system, np.concatenate([ears, images]), bodies=[block]).values
            rest = both[:, :2] + both[:, 2:]
        assert np.abs(rest).max() > 0.0
        np.testing.assert_allclose((whole.values - known)[late], rest[late], atol=1e-6 * np.abs(rest).max())


def test_ears_are_above_it_on_the_side_of_the_tip_by_default(plate):
    system, run, _ = plate
    found = st.radiate(run, system, bodies=[system.track])
    ears = np.column_stack([found[axis].values for axis in "xyz"])
    corner = THERE - 0.06 * TURN[:, 0] - np.array(PLATE.track_line.origin) @ PLATE.frame[:2]
    middle = corner + 0.5 * (0.3 * PLATE.frame[0] + 0.25 * PLATE.frame[1])
    np.testing.assert_allclose(ears.mean(axis=0), middle + PLATE.frame[2], atol=0.06)
    np.testing.assert_allclose((ears - middle) @ PLATE.frame[2], 1.0, rtol=1e-9)


# Thin plates against theory


def test_even_patches_carry_too_much_air(monkeypatch):
    """Negative control of the added masses of `stridula verify`: such strengths do not fall to zero at the edges."""
    assert air_carried(0.1, 0.1) == pytest.approx(0.579, abs=1e-3)
    monkeypatch.setattr(sheets, "_cuts", lambda count, side: np.linspace(0.0, side, count))
    monkeypatch.setattr(sheets, "_points", lambda count, side: (np.arange(count - 1) + 0.5) * side / (count - 1))
    assert air_carried(0.1, 0.1) > 0.61


def test_the_power_of_a_bent_plate_arrives_far_away():
    """The power on its faces and that through a sphere far away, mode by mode."""
    radiator = SheetDipoles(sheet_of(panel_of(PLATE), 2500.0))
    wave = 2.0 * pi * 2000.0 / AIR.speed
    fit = radiator.fit(wave)
    # Half the work for unit accelerations is that on both faces; the points are those of a quarter.
    shapes, areas = radiator.surface.shapes, radiator._areas
    near = -4.0 * 0.5 * np.imag(areas @ (fit.strengths[0] * shapes))
    cosines, weights = np.polynomial.legendre.leggauss(24)
    angles = (np.arange(48) + 0.5) * pi / 24.0
    sines, far = np.sqrt(1.0 - cosines**2), 200.0
    ways = np.stack(
        [np.outer(sines, np.cos(angles)), np.outer(sines, np.sin(angles)), np.outer(cosines, np.ones(48))], axis=-1
    )
    heard = radiator.heard(fit, wave, (far * ways + [0.15, 0.125, 0.0]).reshape(-1, 3))
    flow = 0.5 * np.abs(heard) ** 2 * wave
    through = far**2 * pi / 24.0 * (np.repeat(weights, 48) @ flow)
    np.testing.assert_allclose(through, near, rtol=5e-3)


def test_it_shorts_out_below_and_sounds_as_in_a_baffle_far_above():
    """At 4 kHz the air in front of it moves as with a wall, to 0.7 dB; at 50 Hz it flows round the edges."""
    radiator, place, shares = SheetDipoles(sheet_of(panel_of(PLATE), 5e3)), np.array([0.1, 0.2, 0.5]), []
    for frequency in (50.0, 4000.0):
        wave = 2.0 * pi * frequency / AIR.speed
        found = AIR.density * radiator.heard(radiator.fit(wave), wave, place[None])[0]
        known = baffled_spectrum(panel_of(PLATE), place, np.array([frequency, frequency + 1.0]))[:, 0]
        shares.append(np.abs(found / known))
    assert shares[0].max() < 0.5
    np.testing.assert_allclose(shares[1], 1.0, atol=0.08)


def test_more_points_change_little():
    """By 0.3 dB at the highest frequency for which the points of a sheet are enough, by 0.1 dB an octave below."""
    places = np.array([0.15, 0.125, 0.0]) + 0.6 * Rotation.random(20, random_state=2).as_matrix()[:, 2]
    coarse, fine = (SheetDipoles(sheet_of(panel_of(PLATE), frequency)) for frequency in (2e3, 5e3))
    for frequency, most in ((1.0, 0.04), (0.5, 0.01)):
        wave = 2.0 * pi * frequency * coarse.surface.frequency / AIR.speed
        found, known = (one.heard(one.fit(wave), wave, places) for one in (coarse, fine))
        assert (np.linalg.norm(found - known, axis=0) < most * np.linalg.norm(known, axis=0)).all()


def test_the_error_of_a_sheet_is_its_difference_from_many_points():
    """In the force of the air on each mode, to a factor of two."""
    fine = SheetDipoles(sheet_of(panel_of(PLATE), 9e3))
    for frequency in (800.0, 1500.0):
        sheet = SheetDipoles(sheet_of(panel_of(PLATE), frequency))
        for wave in 2.0 * pi * np.array([200.0, 800.0]) / AIR.speed:
            fits = [one.fit(wave) for one in (sheet, fine)]
            found, known = (one.carried(fit.strengths[0]) for one, fit in zip((sheet, fine), fits, strict=True))
            true = np.abs(found - known) / np.abs(known)
            assert (np.abs(np.log2(fits[0].errors / true)) < 1.0).all()
            assert (fits[1].errors < fits[0].errors).all()
    bare = replace(fine.surface, coarser=None)
    assert np.isnan(SheetDipoles(bare).fit(1.0).errors).all()


def test_a_sheet_with_few_points_is_doubted(monkeypatch):
    plate = replace(PLATE, cutoff=801.0)
    system = pressed(plate)
    run = st.simulate(system, 1e-3, step=1e-5, sample_rate=2e4, probes=[])
    words = "plate: error of .* % in the force of the air on it at 787.4 Hz"
    for most, doubted in ((2400, False), (36, True)):
        monkeypatch.setattr(sheets, "MOST", most)
        responses._sheet.cache_clear()
        heard = st.radiate(run, system, [[0.3, 0.25, 0.5]], bodies=[plate])
        assert (heard.attrs["fit_error"][0] > 0.05) == doubted
        assert bool(re.search(words, heard.attrs["notes"])) == doubted
    responses._sheet.cache_clear()


def test_a_blow_on_a_free_plate_sounds_as_its_response_predicts():
    """The spectrum of the sound, against that of the force with mobilities and fits at the frequencies."""
    # Sound is cut off before it can arrive; that of a blow after the start is complete.
    plate, at = replace(PLATE, damping=0.1), (0.11, 0.07)
    (contact,) = pressed(plate).contacts
    times, heights = (0.0, 8e-3, 8.4e-3, 8.8e-3), (0.0, 0.0, 1.0, 0.0)
    blow = st.Sampled(times, heights)
    system = st.System(replace(contact, gap=1.0), [st.Force(plate.at(at), history=blow, **along([0.0, 1.0, 0.0]))])
    run = st.simulate(system, 0.08, step=1e-5, sample_rate=2e4, probes=[])
    ears = origins_in_space(system)[plate] + (EARS - [*plate.track_line.origin, 0.0]) @ plate.frame
    heard = st.radiate(run, system, ears, bodies=[plate], air=AIR)
    radiator, panel = SheetDipoles(sheet_of(panel_of(plate), 2500.0)), panel_of(plate)
    own, rate, row = panel.angular_frequency, panel.damping_rate, plate.shapes(*at)
    time = np.linspace(0.0, 9e-3, 9001)
    force = np.interp(time, times, heights)
    for frequency in (150.0, 400.0, 790.0):
        w = 2.0 * pi * frequency
        struck = np.trapezoid(force * np.exp(-1j * w * time), time)
        moved = -(w**2) * row * struck / (own**2 - w**2 + 1j * w * rate)
        wave = w / AIR.speed
        known = AIR.density * radiator.heard(radiator.fit(wave), wave, EARS) @ moved
        found = np.exp(-1j * w * heard.time.values) @ heard.values * 5e-5
        assert np.abs(found - known).max() < 3e-3 * np.abs(known).max()


# Beams: slim ones as lines of dipoles, others by their surface


def test_a_beam_is_a_line_of_dipoles_only_where_it_is_slim():
    """Up to all frequencies of its sound: one of 20 mm is slim below 2.9 kHz."""
    for modes, form in ((2, "SlimBeam"), (5, "OpenSurface")):
        body = replace(BEAM, bending_modes=modes, axial_modes=0)
        found = sounding_of("beam", body, False, np.zeros(3), False, AIR)
        assert type(found).__name__ == form, body.modes().frequency.max()


def test_the_surface_of_a_beam_sounds_as_the_line_of_dipoles_while_it_is_slim():
    """Where half of its width times the wavenumber is 0.02 to 0.13, and no longer where it is 1.5.

    The air also flows round its ends, which the line neglects; the effect grows with shorter half-waves, here from ten
    to three widths. With patches of half a height in width, the added mass is right to 2 %.
    """
    bar = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.01), 0.2, 3, 0)
    radiator, area = SurfacePressures(bar.surface()), moved_area(bar.section)
    place = np.array([0.07, 0.1, 0.4])
    apart = []
    for wave in (1.8, 13.0, 146.0):
        found = AIR.density * radiator.heard(radiator.fit(wave), wave, place[None, [0, 2, 1]])[0]
        frequency = wave * AIR.speed / (2.0 * pi)
        known = dipole_spectrum(line_of(bar), area, place, np.array([frequency, frequency + 1.0]))[:, 0]
        apart.append(20.0 * np.log10(np.abs(found / known)))
    for levels in apart[:2]:
        assert (np.abs(levels) < [0.2, 0.45, 0.65]).all(), levels
    assert (apart[2] < -3.0).all()


# Places of bodies, and refused arguments


def test_bodies_are_placed_beside_those_with_places_in_the_world():
    system = pressed(PLATE)
    found = origins_in_space(system)
    np.testing.assert_allclose(found[system.slider], 0.0)
    np.testing.assert_allclose(found[PLATE] + PLATE.offset(0.06), THERE, atol=1e-12)
    # Places on the plate count from its corner, for any line.
    corner = found[PLATE] - np.array(PLATE.track_line.origin) @ PLATE.frame[:2]
    np.testing.assert_allclose(found[PLATE] + PLATE.offset((0.2, 0.1)), corner + [0.2, 0.1] @ PLATE.frame[:2])
    # A rod on the far end of a beam that touches nothing else, and a gap.
    rod = st.RigidBody(0.1, points={"end": (0.0, -0.05, 0.0)})
    beam = replace(BEAM, plane=None)
    alone = origins_in_space(st.System(st.PointContact(rod.at("end"), beam, at=0.1, gap=0.02)))
    np.testing.assert_allclose(alone[beam], 0.0)
    np.testing.assert_allclose(alone[rod], [0.1, 0.07, 0.0], atol=1e-15)


def other_plate(away: float, plane=PLANE) -> st.System:
    """The block between two plates."""
    system = pressed(PLATE)
    second = replace(PLATE, name="second", plane=plane)
    contact = replace(system.contacts[0], track=second, gap=away, name="second")
    return st.System([replace(system.contacts[0], name="first"), contact])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"listener": THERE}, r"listener must be at least 0.000391 m from the plate, got \(0.3, -0.2, 0.1\) at"),
        ({"listener": THERE - TURN[:, 1], "baffled": True}, "listener must be in front of the baffle"),
        ({"bodies": "slider", "baffled": True}, "baffled must be False, or left out, for bodies in space without a"),
        ({"system": other_plate(0.01), "baffled": True}, "baffled must be False where flat bodies do not lie in one"),
        (
            {"system": other_plate(0.0, [PLANE[0], -PLANE[1]]), "baffled": True},
            "baffled must be False where flat bodies do not lie in one",
        ),
    ],
)
def test_arguments_that_are_refused(words, message, plate):
    system, run, ears = plate
    given = {"system": system, "listener": ears, "bodies": [system.track], **words}
    if given["bodies"] == "slider":
        given["bodies"] = [system.slider]
    if given["system"] is not system:
        given["bodies"] = None
    with pytest.raises(ValueError, match=f"^{message}"):
        st.radiate(run, given.pop("system"), given.pop("listener"), **given)


def test_bodies_behind_the_baffle_are_refused(plate):
    """A plate that the block presses from below."""
    system, run, ears = plate
    below = replace(PLATE, plane=(PLANE[0], -PLANE[1]))
    turned = st.System(replace(system.contacts[0], track=below), [])
    with pytest.raises(ValueError, match=r"^baffled must be False with bodies behind the baffle: slider, got True"):
        st.radiate(run, turned, ears, baffled=True)


def test_a_plate_in_the_plane_has_no_need_of_a_baffle(plate):
    """Its sound in open air is that of the plate in space."""
    _, run, _ = plate
    run = run.drop_vars(VARIABLE)
    flat = replace(PLATE, plane=None)
    mass = st.PointMass(0.1, name="mass")
    system = st.System(st.PointContact(mass.centre, flat, at=0.06))
    known = st.radiate(run, PLATE, EARS, baffled=False)
    plane = run.isel(tangent=0, drop=True)
    found = st.radiate(plane, system, EARS, baffled=False)
    assert error(found.values, known.values) < 1e-9
    assert found.attrs["baffled"] == 0


def test_a_rod_that_slides_on_a_plate_sounds_as_in_the_plane():
    """From the mean place of the rod, driven by all forces at its tip and its end."""
    rod = st.FiniteElementBeam(STEEL, st.Circle(0.004), 0.05, 0.2, elements=3, damping=0.02, cutoff=10e3, name="rod")
    flat = replace(PLATE, plane=None, line=None)
    heard = []
    for track, place in ((flat, (0.2, 0.025, 0.4)), (replace(flat, plane=np.eye(3)[:2]), (0.2, 0.4, 0.1))):
        contact = st.PointContact(rod.tip, track, at=0.1, friction=st.Coulomb(0.3))
        system = st.System(contact, [st.Force(rod.root, x=2.0, y=-5.0)])
        run = st.simulate(system, 0.02, step=4e-6, sample_rate=2.5e4, probes=[])
        heard.append(st.radiate(run, system, place, bodies=[rod], baffled=False))
    assert error(heard[1].values, heard[0].values) < 1e-6
    for one in heard:
        assert "rod: it slides over 0.0" in one.attrs["notes"]
        assert "rod: a line of dipoles, slim below" in one.attrs["notes"]


def test_a_held_beam_moves_with_the_modes_of_its_drive():
    """Slim or not, its modes are those with the root held along x."""
    for height, form in ((0.02, "OpenSurface"), (0.002, "SlimBeam")):
        beam = st.FiniteElementBeam(STEEL, st.Rectangle(height, height), 0.05, 0.2, elements=3, cutoff=18e3)
        found = sounding_of("beam", beam, True, np.zeros(3), False, AIR)
        assert type(found).__name__ == form
        assert len(found.numbers) <= beam.modes(True).count < beam.modes(False).count
