"""The sound of bodies in space: surfaces, motion driven again, fits, and the whole computation.

Spheres, a disc, a bar and the balance of power are cases of `stridula verify`; negative controls are here.
"""

from __future__ import annotations

from dataclasses import fields, replace
from math import pi

import numpy as np
import pytest
from scipy.special import roots_legendre

import stridula as st
from stridula.acoustics import equivalent_sources, surface_pressures
from stridula.acoustics.delays import Sampling
from stridula.acoustics.distances import distances_to
from stridula.acoustics.fits import fits_of
from stridula.acoustics.flat_patches import patch_integrals
from stridula.acoustics.free_responses import free_responses
from stridula.acoustics.redriven import redriven
from stridula.acoustics.ring_sources import RingSources
from stridula.acoustics.surface_pressures import SurfacePressures
from stridula.bodies.body_surfaces import RingSurface, surface_of
from stridula.bodies.revolution import ring_surfaces
from stridula.bodies.solids import surfaces
from stridula.bodies.solids.cut_elements import cut_into_tetrahedra
from stridula.bodies.solids.surfaces import cut_faces
from stridula.verification import open_air
from stridula.verification.systems.discs import HERE, disc, struck

from .test_turning import rubbed

STEEL = st.Material(2.1e11, 7850.0, 0.3)
AWAY = (0.1, 2.0, 0.01)
EARS = [(0.1, 0.2, 0.5), (0.3, -0.2, 0.4)]


def closed(surface):
    """Volume that points of a surface enclose, and the sum of its areas with their normals."""
    flow = surface.areas[:, None] * surface.normals
    return (flow * surface.points).sum() / 3.0, flow.sum(axis=0)


@pytest.mark.parametrize(
    ("body", "area", "volume"),
    [
        (disc(0.0), 2.0 * pi * (0.15**2 - 0.03**2) + 2.0 * pi * 0.18 * 0.01, pi * (0.15**2 - 0.03**2) * 0.01),
        (st.SolidBody.block((0.02, 0.03, 0.05), (2, 2, 3), STEEL, cutoff=3e4), 0.0062, 3e-5),
    ],
)
def test_a_surface_is_closed_and_moves_as_the_body(body, area, volume):
    surface = body.surface().as_points
    found, flow = closed(surface)
    assert surface.areas.sum() == pytest.approx(area, rel=1e-9)
    assert found == pytest.approx(volume, rel=1e-3)
    assert np.abs(flow).max() < 1e-9 * area
    # A rigid translation along z, in modal coordinates, moves the surface by the z of its normals.
    free = body if body.kind == "solid" else replace(body, held=())
    modes, surface = free.modes(), free.surface().as_points
    moved = surface.shapes @ modes.translation[2][~modes.massless]
    np.testing.assert_allclose(moved, surface.normals[:, 2], atol=1e-6)


def test_a_tetrahedron_has_the_surface_of_its_faces():
    nodes = np.array([[0.0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]])
    body = st.SolidBody(st.SolidMesh(nodes, [[0, 1, 2, 3]], "tetra"), STEEL)
    surface = body.surface()
    volume, flow = closed(surface)
    assert surface.areas.sum() == pytest.approx(0.015 + 0.005 * 3**0.5, rel=1e-9)
    assert volume == pytest.approx(1e-3 / 6.0, rel=1e-9)
    assert np.abs(flow).max() < 1e-12


def seen(system, body, place, direction, duration=0.04):
    """Acceleration of a point in the march, and from its modes driven again."""
    probe = st.Acceleration(body.at(place), direction)
    run = st.simulate(system, duration, step=2e-6, sample_rate=1e5, probes=[probe])
    moved = redriven(run, system).of(system.body_name(body))
    row = body.trace(place)["xyz".index(direction)]
    row = np.where(body.modes().massless, 0.0, row)
    again = row @ moved.accelerations(np.arange(row.size))
    times = moved.first + moved.interval * np.arange(again.size)
    # The probe is low-passed and stands at the ends of the intervals.
    return run.acceleration.values.ravel(), np.interp(run.time.values, times, again)


@pytest.mark.parametrize("turning", [0.0, 100.0])
def test_a_disc_that_turns_is_driven_again_as_it_moved(turning):
    system, plate = struck(turning)
    known, found = seen(system, plate, AWAY, "z")
    assert np.abs(found - known).max() < 0.05 * np.abs(known).max()


def test_without_turning_the_same_blow_moves_it_in_another_way():
    """Negative control."""
    known, _ = seen(*struck(100.0), AWAY, "z")
    _, found = seen(*struck(0.0), AWAY, "z")
    assert np.abs(found - known).max() > 0.5 * np.abs(known).max()


@pytest.mark.parametrize("side", ["disc", "pad"])
def test_bodies_in_contact_and_on_springs_are_driven_again_as_they_moved(side):
    system = rubbed(5.0)
    body, place, way = (system.track, AWAY, "z") if side == "disc" else (system.slider, "tip", "x")
    known, found = seen(system, body, place, way)
    late = slice(400, -200)
    assert np.abs(found - known)[late].max() < 0.05 * np.abs(known[late]).max()


def test_another_systems_record_is_refused():
    run = st.simulate(rubbed(0.0), 1e-3)
    both = st.System([*rubbed(0.0).contacts, replace(rubbed(0.0).contacts[0], name="other")])
    with pytest.raises(ValueError, match="run must be a record of this system, of 2 contacts"):
        st.radiate(run, both)


def test_a_blow_on_a_disc_is_heard_as_its_response_says():
    """The spectrum of the sound over that of the force, against mobilities and fits at the frequencies."""
    system, plate = struck(0.0, damping=0.06)
    run = st.simulate(system, 0.04, step=5e-6, sample_rate=2e4)
    air = st.Air()
    heard = st.radiate(run, system, EARS, air=air)
    radiator, modes = RingSources(plate.surface()), plate.modes()
    moving = ~modes.massless
    own, rate = modes.angular_frequency[moving], modes.damping_rate[moving]
    row = plate.trace(HERE)[2][moving]
    time = np.linspace(0.0, 4e-4, 2001)
    force = np.interp(time, (0.0, 2e-4, 4e-4), (0.0, 1.0, 0.0))
    for frequency in (600.0, 1300.0, 2500.0):
        w = 2.0 * pi * frequency
        blow = np.trapezoid(force * np.exp(-1j * w * time), time)
        moved = -(w**2) * row * blow / (own**2 - w**2 + 1j * w * rate)
        wave = w / air.speed
        known = air.density * radiator.heard(radiator.fit(wave), wave, np.array(EARS)) @ moved
        found = np.exp(-1j * w * heard.time.values) @ heard.values * 5e-5
        assert np.abs(found - known).max() < 0.02 * np.abs(known).max()
    assert heard.attrs["bodies"] == ["track"]
    assert "not included, without a surface: slider" in heard.attrs["notes"]
    assert 0.0 < heard.attrs["fit_error"][0] < 0.1


def test_no_sound_arrives_before_its_time():
    system, _ = struck(0.0, damping=0.06)
    run = st.simulate(system, 0.01, step=5e-6, sample_rate=2e4)
    heard = st.radiate(run, system, (0.0, 0.0, 1.01))
    way = heard.attrs["distance"][0]
    assert way == pytest.approx(np.hypot(1.0, 0.03), rel=1e-3)
    early = heard.values[heard.time.values < way / heard.attrs["air_speed"]]
    assert early.size > 50
    assert not early.any()
    assert np.abs(heard.values).max() > 0.0


def test_a_record_is_heard_without_the_mesh(stridula, tmp_path):
    system, _ = struck(20.0, damping=0.06, cutoff=800.0)
    run = st.simulate(system, 2e-3, step=1e-5, sample_rate=1e4)
    st.save(run, tmp_path / "run.nc")
    again = st.load_scenario(tmp_path / "run.nc").system
    assert [body.kind for body in again.bodies] == ["rigid body", "modal body"]
    place = (0.3, 0.3, 0.5)
    known, found = (st.radiate(run, one, place).values for one in (system, again))
    assert np.abs(known).max() > 0.0
    np.testing.assert_array_equal(found, known)
    # By its form, from lists as in a scenario.
    code, out, err = stridula("sound", "run.nc", "--listener", "0.3,0.3,0.5", "--wav", "a.wav")
    assert (code, err) == (0, "")
    assert "a.wav: 1 channel, 48 kHz" in out
    assert "not included, without a surface: slider" in out
    body = again.track
    bare = replace(body, outer_surface=None)
    assert not bare.has_surface
    assert bare != body
    with pytest.raises(
        ValueError, match="system must have a body with a surface, which radiates sound, got none of slider, track"
    ):
        st.radiate(run, st.System(replace(system.contacts[0], track=bare.at(bare.point_names[0]))), place)


def test_a_surface_that_does_not_fit_the_modes_is_refused():
    surface = disc(0.0, cutoff=800.0).surface().as_points
    points, modes = {"tip": np.ones((3, 2))}, [1.0, 2.0]
    with pytest.raises(ValueError, match=r"outer_surface.shapes must be finite numbers of the shape \(\d+, 2\)"):
        st.ModalBody(modes, points, outer_surface=surface)


def test_sums_and_choices_of_bodies():
    plate = disc(0.0, cutoff=1500.0)
    block = st.SolidBody.block((0.02, 0.02, 0.03), (1, 1, 2), STEEL, points={"tip": 0}, cutoff=2e4)
    contact = st.PointContact(block.at("tip"), plate.at(HERE), gap=1.0, normal=(0.0, 0.0, 1.0))
    blow = (0.0, 2e-4, 4e-4), (0.0, 1.0, 0.0)
    pushes = [st.Force(one, z=1.0, history=st.Sampled(*blow)) for one in (plate.at(HERE), block.at("tip"))]
    system = st.System(contact, pushes)
    run = st.simulate(system, 5e-3, step=1e-5, sample_rate=2e4)
    place = (0.3, 0.3, 0.5)
    # Before the sound arrives from both, each alone is silent.
    late = slice(60, None)
    parts = [st.radiate(run, system, place, bodies=[one]).values[late] for one in (plate, block)]
    both = st.radiate(run, system, place).values[late]
    assert min(np.abs(part).max() for part in parts) > 0.0
    np.testing.assert_allclose(both, parts[0] + parts[1], atol=1e-9 * np.abs(both).max())
    with pytest.raises(ValueError, match=r"bodies\[0\] must be a body of the system with a surface"):
        st.radiate(run, system, place, bodies=[disc(1.0)])
    with pytest.raises(ValueError, match="listener must be outside of the bodies"):
        st.radiate(run, system, (0.1, 0.0, 0.005))
    with pytest.raises(ValueError, match="baffled must be False, or left out, for bodies in space"):
        st.radiate(run, system, place, baffled=True)


def test_a_mesh_without_points_within_falls_short_at_a_resonance(monkeypatch):
    """Negative control: at ka = pi a standing wave fits into the sphere, and the integral alone is not sufficient."""
    place, wave = open_air.PLACES[:1], pi / open_air.RADIUS
    known = open_air.of_sphere(wave, place)[:, :1]
    sphere = open_air.meshed_sphere(4)
    sphere.surface.shapes[:, 1:] = 0.0
    found = open_air.heard(sphere, wave, place)[:, :1]
    assert np.abs(found - known) < 0.05 * np.abs(known)
    monkeypatch.setattr(SurfacePressures, "within", np.zeros((0, 3)))
    alone = open_air.heard(SurfacePressures(sphere.surface), wave, place)[:, :1]
    assert np.abs(alone - known) > 3.0 * np.abs(found - known)


def meshed_disc(thickness, divisions, cut):
    """Return a ring of 30 and 100 mm that moves along its axis, as a mesh of hexahedra or tetrahedra."""
    mesh = st.SolidMesh.sector((0.03, 0.1), (0.0, 2.0 * pi), thickness, divisions, axis="z")
    if cut:
        parts = cut_into_tetrahedra(mesh.nodes, [("hexahedron20", mesh.elements)])
        mesh = st.SolidMesh(parts.nodes, parts.elements, "tetra10")
    along = np.tile([0.0, 0.0, 1.0], (len(mesh.nodes), 1))[:, :, None]
    return SurfacePressures(cut_faces(mesh, along, 0.0035))


@pytest.mark.parametrize(
    ("thickness", "divisions", "cut"),
    [(0.003, (4, 24, 1), False), (0.003, (10, 64, 2), False), (0.01, (4, 24, 1), True)],
)
def test_thin_meshed_bodies_sound_as_the_same_bodies_of_revolution(thickness, divisions, cut):
    """Patches of 9 mm on a disc of 3 mm, some of many small pieces, against rings."""
    profile = st.RectangleProfile({"disc": ((0.03, 0.1), (0.0, thickness))}).mesh(lambda size, name: 0.1)
    places, normals, widths = ring_surfaces.cut_outline(profile, 0.0125)
    orders = np.zeros(1, dtype=int)
    rings = RingSources(RingSurface(places, normals, widths, normals[:, 1:], orders, orders, np.eye(3), np.zeros(3)))
    mesh, ears = meshed_disc(thickness, divisions, cut), np.array([[0.3, 0.1, 0.5], [0.2, 0.05, 0.1]])
    for wavenumber in (10.0, 60.0):
        known, found = (open_air.heard(one, wavenumber, ears) for one in (rings, mesh))
        # 0.3 dB: both have errors of some 3 % at edges.
        np.testing.assert_allclose(np.abs(found), np.abs(known), rtol=0.035)


@pytest.mark.parametrize("wave", [10.0, 40.0])
def test_a_thin_surface_sounds_as_thicker_ones(wave, monkeypatch):
    """With a thickness of a thirtieth and of a tenth of the width of its patches, for modes of the same amplitude."""
    monkeypatch.setattr(surfaces, "MOST", 200)
    place, known = np.array([[0.1, 0.5, 0.1]]), None
    for thickness in (3e-3, 1e-3):
        plate = st.ModalPlate(STEEL, thickness, 0.3, 0.25, (1, 1))
        surface = SurfacePressures(plate.surface())
        found = np.abs(open_air.heard(surface, wave, place)[0, 0]) / plate.amplitude
        assert known is None or found == pytest.approx(known, rel=0.03)
        known = found


def test_equations_too_ill_for_single_precision_are_solved_in_double(monkeypatch):
    """Those of a foil with wide patches, whose normal equations have no Cholesky factors in single precision."""
    monkeypatch.setattr(surfaces, "MOST", 200)
    surface = SurfacePressures(st.ModalPlate(STEEL, 3e-5, 0.3, 0.25, (2, 2)).surface())
    asked: list[tuple] = []
    solved = surface_pressures.least_squares
    monkeypatch.setattr(surface_pressures, "least_squares", lambda *given: asked.append(given) or solved(*given))
    (pressures,) = surface.fit(0.0).strengths
    ((matrix, wanted),) = asked
    assert pressures.dtype == matrix.dtype == np.complex64
    with pytest.raises(np.linalg.LinAlgError):
        equivalent_sources._by_normal_equations(matrix, wanted, 0.0)
    known = np.linalg.solve(matrix.astype(complex), wanted)
    np.testing.assert_allclose(pressures, known, atol=1e-5 * np.abs(known).max())


def test_singular_equations_are_refused():
    with pytest.raises(np.linalg.LinAlgError):
        equivalent_sources.least_squares(np.zeros((3, 2), dtype=np.complex64), np.ones((3, 1)))


def test_patches_in_closed_form_are_the_integral_over_points():
    """Over a square and a triangle, from the side, from below and from within the plane."""
    square = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.9, 0.8, 0.0], [0.0, 0.7, 0.0]])
    triangle = square[[0, 1, 2, 2]]
    nodes, weights = np.polynomial.legendre.leggauss(120)
    u, v = np.meshgrid(0.5 * (nodes + 1.0), 0.5 * (nodes + 1.0))
    share = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=-1)
    for corners in (square, triangle):
        points = share @ corners
        along = (1 - v)[..., None] * (corners[1] - corners[0]) + v[..., None] * (corners[2] - corners[3])
        across = (1 - u)[..., None] * (corners[3] - corners[0]) + u[..., None] * (corners[2] - corners[1])
        area = np.cross(along, across)[..., 2] * 0.25 * np.multiply.outer(weights, weights)
        for place in ([0.6, 0.3, 0.2], [2.0, 1.0, 0.0], [0.6, 0.3, -0.3], [-0.4, 0.2, 0.4]):
            apart = points - np.array(place)
            away = np.linalg.norm(apart, axis=-1)
            inverse, angle = patch_integrals(np.array([place]), corners[None])
            assert inverse[0] == pytest.approx((area / away).sum(), rel=1e-9)
            assert angle[0] == pytest.approx((area * apart[..., 2] / away**3).sum(), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("beside", [0.0, 1e-11, 1e-9, 1e-6])
def test_a_place_near_an_edge_has_a_finite_integral(beside):
    """At the middle of a side, a square has half the integral of a rectangle of twice its length at its centre."""
    square = np.array([[[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]])
    whole = np.array([[[0.0, -1, 0], [1, -1, 0], [1, 1, 0], [0, 1, 0]]])
    (half,), _ = patch_integrals(np.array([[0.4, beside, 0.0]]), square)
    (both,), _ = patch_integrals(np.array([[0.4, 0.0, 0.0]]), whole)
    assert half == pytest.approx(0.5 * both, rel=1e-4)


def test_a_listener_within_a_thin_body_is_refused():
    thin = st.SolidBody.block((0.1, 0.1, 0.001), (4, 4, 1), STEEL, points={"tip": 0}, cutoff=2e4)
    surface, random = thin.surface(), np.random.default_rng(3)
    places = np.column_stack([random.uniform(0.002, 0.098, (40, 2)), np.full(40, 5e-4)])
    low = surface.corners.reshape(-1, 3).min(axis=0)
    for place in places + low:
        with pytest.raises(ValueError, match="listener must be outside of the bodies"):
            distances_to(surface, place[None])
    assert distances_to(surface, np.add(low, (0.05, 0.05, 0.02))[None])[0] == pytest.approx(0.019, rel=0.05)


def test_pieces_of_no_point_are_refused():
    surface = st.SolidBody.block((0.1, 0.1, 0.05), (1, 1, 1), STEEL, points={"tip": 0}, cutoff=2e4).surface()
    wrong = {one.name: getattr(surface, one.name) for one in fields(surface)}
    wrong["owners"] = np.where(surface.owners == 1, len(surface.points), surface.owners)
    with pytest.raises(ValueError, match=r"outer_surface.owners must have the number of each point, from 0"):
        surface_of(wrong)


def test_a_surface_without_its_pieces_is_read_as_squares():
    """As in files written before pieces existed."""
    whole = open_air.meshed_sphere(4).surface
    names = ("points", "normals", "areas", "shapes")
    bare = surface_of({name: getattr(whole, name).tolist() for name in names})
    corners = bare.corners.reshape(-1, 4, 3)
    np.testing.assert_allclose(corners.mean(axis=1), whole.points, atol=1e-12)
    vectors = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    np.testing.assert_allclose(vectors, whole.areas[:, None] * whole.normals, atol=1e-12)
    places, wave = open_air.PLACES, 1.0 / open_air.RADIUS
    known, found = (open_air.heard(SurfacePressures(one), wave, places) for one in (whole, bare))
    np.testing.assert_allclose(found, known, atol=0.01 * np.abs(known).max())


def test_a_response_is_delayed_by_the_way_to_the_surface():
    surface, place = open_air.ring_sphere(12), np.array([[0.0, 0.0, 1.1]])
    for distance, interval in ((1.0, 1e-5), (1.0, 2.3e-5)):
        sent = free_responses(surface, place, np.array([distance]), st.Air(), Sampling(interval, 15e3, 0.5))
        taps = sent.responses[0]
        whole = taps.taps[:, 0].sum()
        # A pulsating sphere at frequency zero: rho a² / R.
        assert whole == pytest.approx(st.Air().density * 0.01 / 1.1, rel=2e-3)
        peak = taps.first + int(taps.taps[:, 0].argmax())
        assert peak == pytest.approx(distance / st.Air().speed / interval + 0.5, abs=4.0)


def test_beyond_the_highest_mode_fits_end_and_below_it_responses_stay():
    surface, place = open_air.ring_sphere(12), open_air.PLACES[:1]
    whole, short = (
        free_responses(surface, place, np.array([0.6]), st.Air(), Sampling(1e-5, 15e3), highest)
        for highest in (np.inf, 4e3)
    )
    assert whole.frequencies[-1] > 17e3
    assert 6e3 < short.frequencies[-1] < 6.4e3
    assert len(short.frequencies) < len(whole.frequencies)
    assert max(whole.left, short.left) < 5e-3
    spectra = []
    for sent in (whole, short):
        (one,) = sent.responses
        spectra.append(
            np.fft.rfft(one.taps, 4096, axis=0) * np.exp(-2j * pi * np.arange(2049) / 4096 * one.first)[:, None]
        )
    frequency = np.arange(2049) / 4096 / 1e-5
    known, found = (one[(frequency > 50.0) & (frequency < 4.6e3)] for one in spectra)
    assert np.abs(found - known).max() < 5e-3 * np.abs(known).max()
    assert np.abs(spectra[1][frequency > 6.6e3]).max() < 5e-3 * np.abs(spectra[1]).max()


def fits_made(monkeypatch, surface):
    """Return impulse responses of a body as in a new process, and the number of fits computed for them."""
    counted = []
    fit = RingSources.fit
    monkeypatch.setattr(RingSources, "fit", lambda self, wavenumber: counted.append(1) or fit(self, wavenumber))
    fits_of.cache_clear()
    sent = free_responses(surface, open_air.PLACES[:1], np.array([0.6]), st.Air(), Sampling(1e-5, 15e3))
    monkeypatch.setattr(RingSources, "fit", fit)
    return sent, len(counted)


def test_fits_are_kept_for_the_next_process(monkeypatch, tmp_path):
    monkeypatch.setenv("STRIDULA_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr("stridula.acoustics.fits.WORTH", 0.0)
    first, many = fits_made(monkeypatch, open_air.ring_sphere(12))
    again, none = fits_made(monkeypatch, open_air.ring_sphere(12))
    assert many == len(first.frequencies)
    assert none == 0
    np.testing.assert_array_equal(again.responses[0].taps, first.responses[0].taps)
    np.testing.assert_array_equal(again.errors, first.errors)
    # A body with other mode shapes is a different one.
    other = open_air.ring_sphere(12)
    other.shapes[3, 1] *= 1.5
    moved, made = fits_made(monkeypatch, other)
    assert made == many
    assert np.abs(moved.responses[0].taps - first.responses[0].taps).max() > 0.0


def test_slopes_of_rings_in_single_precision_are_the_plain_integral():
    """Over the angles in double precision; the sharp part of the nearest pairs is integrated to 5e-5."""
    sources = RingSources(open_air.disc(0.02))
    surface, wave = sources.surface, 150.0
    nodes, weights = roots_legendre(4000)
    angles, weights = 0.5 * pi * (nodes + 1.0), 0.5 * weights
    found = sources._slopes(wave)
    for ring, source in ((0, 5), (11, 5), (40, 20), (len(surface.places) - 1, 0)):
        (r, z), (across, along), (radius, height) = (
            surface.places[ring],
            surface.normals[ring],
            sources.sources[source],
        )
        away = np.sqrt(r**2 + radius**2 - 2.0 * r * radius * np.cos(angles) + (z - height) ** 2)
        slope = (across * (r - radius * np.cos(angles)) + along * (z - height)) / away
        change = -(1.0 + 1j * wave * away) * np.exp(-1j * wave * away) / away**2 * slope
        known = [(weights * change * np.cos(order * angles)).sum() / (4.0 * pi) for order in sources.orders]
        np.testing.assert_allclose(found[:, ring, source], known, atol=1e-4 * np.abs(found[:, ring]).max())


def hat() -> RingSources:
    """A disc with a hat, with two reentrant corners, that moves outwards on its inside and along its axis."""
    parts = {
        "disc": ((0.07, 0.13), (-0.01, 0.01)),
        "wall": ((0.06, 0.07), (-0.01, 0.05)),
        "top": ((0.03, 0.06), (0.044, 0.05)),
    }
    mesh = st.RectangleProfile(parts).mesh(lambda size, name: size)
    places, normals, widths = ring_surfaces.cut_outline(mesh, 3.5e-3)
    shapes = np.stack([normals[:, 1], -normals[:, 0] * (places[:, 0] < 0.061)], axis=1)
    return RingSources(
        RingSurface(places, normals, widths, shapes, *np.zeros((2, 2), dtype=int), np.eye(3), np.zeros(3))
    )


def test_reentrant_corners_are_accurate(monkeypatch):
    place, wave = np.array([[0.2, 0.3, 0.5], [0.0, 0.0, 1.0]]), 30.0

    def found():
        sources = hat()
        fit = sources.fit(wave)
        return sources.heard(fit, wave, place), fit.errors

    pressure, errors = found()
    assert errors.max() < 0.06
    monkeypatch.setattr(ring_surfaces, "PART_OF_WAY", 1e9)
    # Negative control: elements as long there as elsewhere.
    coarse, missed = found()
    assert missed.max() > 0.1
    monkeypatch.setattr(ring_surfaces, "PART_OF_WAY", 0.3)
    monkeypatch.setattr(ring_surfaces, "PART_OF_BALL", 0.25)
    fine, _ = found()
    size = np.abs(fine).max(axis=0)
    assert (np.abs(pressure - fine) < 0.01 * size).all()
    assert (np.abs(coarse - fine) > 0.05 * size).any()


def test_a_wall_of_a_hundredth_of_the_radius_carries_the_air_of_a_thin_disc():
    """The air carried by a disc, against an extrapolation from thicker ones; the limit of a thin one is 8 / 3."""

    def carried(share):
        thickness, far = share * open_air.RADIUS, 5.0
        places = np.array([[0.0, 0.0, 0.5 * thickness + far], [0.0, 0.0, 0.5 * thickness - far]])
        front, back = open_air.heard(RingSources(open_air.disc(thickness)), 1e-6, places)[:, 0].real
        whole = 2.0 * pi * far**2 * (front - back) / open_air.AIR.density
        return (whole - pi * open_air.RADIUS**2 * thickness) / open_air.RADIUS**3

    known = np.array([0.2, 0.1, 0.05])
    terms = np.stack([np.ones(3), known, known * np.log(known)], axis=1)
    told = np.linalg.solve(terms, [carried(share) for share in known]) @ [1.0, 0.01, 0.01 * np.log(0.01)]
    assert carried(0.01) == pytest.approx(told, rel=5e-3)
    assert told == pytest.approx(8.0 / 3.0, rel=0.03)
