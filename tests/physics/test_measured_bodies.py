"""Bodies from tests: modes of a known body written with noise, read back, and compared with that body."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st

ALUMINIUM = st.Material(7e10, 2700.0, 0.33)


def block(seed):
    """Return a free block of random size and damping, some places on it and its elastic modes."""
    rng = np.random.default_rng(seed)
    size = rng.uniform((0.2, 0.04, 0.008), (0.3, 0.06, 0.012))
    body = st.SolidBody.block(size, (6, 2, 1), ALUMINIUM, cutoff=5e3, damping=float(rng.uniform(0.001, 0.005)))
    modes = body.modes()
    elastic = np.flatnonzero((modes.frequency > 0.0) & ~modes.massless)
    nodes = rng.choice(len(body.mesh.nodes), 20, replace=False)
    return body, body.mesh.nodes[nodes], elastic, rng


def modal_test(body, places, elastic, rng, noise, *, mass=1.0):
    """Return the modes of a test with noise: relative to the largest value of a shape, to frequency and damping."""
    modes = body.modes()
    shapes = np.array([body.trace(tuple(place))[:, elastic] for place in places])
    shapes = shapes + noise * np.abs(shapes).max(axis=(0, 1)) * rng.standard_normal(shapes.shape)
    frequency = modes.frequency[elastic] * (1.0 + 0.01 * noise * rng.standard_normal(elastic.size))
    damping = modes.damping[elastic] * (1.0 + noise * rng.standard_normal(elastic.size))
    names = [str(number + 1) for number in range(len(places))]
    return st.MeasuredModes(frequency, damping, shapes * np.sqrt(mass), names, mass, places)


@pytest.mark.parametrize("noise", [0.0, 0.01, 0.05])
@pytest.mark.parametrize("seed", range(3))
def test_the_loop_is_closed(tmp_path, seed, noise):
    """Written, read, compared: each mode is its own by MAC, and peaks of the mobility are those of the body."""
    body, places, elastic, rng = block(seed)
    modal_test(body, places, elastic, rng, noise, mass=rng.uniform(0.1, 3.0, elastic.size)).write(tmp_path / "a.unv")
    modes = st.MeasuredModes.read(tmp_path / "a.unv")
    known = body.modes()
    np.testing.assert_allclose(modes.frequency, known.frequency[elastic], rtol=0.04 * noise + 1e-5)
    np.testing.assert_allclose(modes.damping, known.damping[elastic], rtol=4.0 * noise + 1e-5)
    table = st.mac(modes, body)
    assert table.attrs["distance"] < 1e-9
    assert table.shape == (elastic.size, (~known.massless).sum())
    np.testing.assert_array_equal(table.values.argmax(axis=1), elastic)
    # In the mean noise takes its share of the square of a shape, here over sixty rows.
    shapes = np.array([body.trace(tuple(place))[:, elastic] for place in places])
    share = noise**2 * (3 * len(places)) * np.abs(shapes).max(axis=(0, 1)) ** 2 / np.sum(shapes**2, axis=(0, 1))
    found = table.values[np.arange(elastic.size), elastic]
    np.testing.assert_allclose(1.0 - found, share / (1.0 + share), rtol=0.6, atol=1e-9)
    measured = modes.body()
    for mode in range(elastic.size):
        at, way = np.unravel_index(np.abs(shapes[:, :, mode]).argmax(), shapes.shape[:2])
        words = {"direction": tuple(np.eye(3)[way].tolist())}
        here = st.mobility(measured.at(str(at + 1)), **words, frequency=modes.frequency[[mode]])
        there = st.mobility(body.at(tuple(places[at])), **words, frequency=known.frequency[elastic[[mode]]])
        # The peak is the square of the shape over damping and frequency. In phase, other modes add the square of a
        # damping ratio over that of their distance: a thousandth.
        ratios = (
            modes.normalised[at, way, mode].real / shapes[at, way, mode],
            modes.damping[mode] * modes.frequency[mode],
        )
        peak = ratios[0] ** 2 * known.damping[elastic[mode]] * known.frequency[elastic[mode]] / ratios[1]
        assert here.values.real / there.values.real == pytest.approx(peak, rel=0.01)


def test_without_noise_the_mobility_is_that_of_the_same_modes(tmp_path):
    body, places, elastic, rng = block(7)
    modal_test(body, places, elastic, rng, 0.0).write(tmp_path / "a.unv")
    measured = st.ModalBody.read(tmp_path / "a.unv")
    modes, frequency = body.modes(), np.linspace(100.0, 5000.0, 200)
    one, other = (body.trace(tuple(place))[:, elastic] for place in places[:2])
    w, natural = 2.0 * np.pi * frequency[:, None], modes.angular_frequency[elastic]
    terms = one[1] * other[2] / (natural**2 - w**2 + 1j * w * modes.damping_rate[elastic])
    expected = (1j * w * terms).sum(axis=1)
    found = st.mobility(
        measured.at("1"), measured.at("2"), direction="y", excitation_direction="z", frequency=frequency
    )
    np.testing.assert_allclose(found.values, expected, rtol=0.0, atol=1e-2 * np.abs(expected).max())
    assert found.attrs["units"] == "m/(N s)"


def test_other_directions_and_points_are_told_apart():
    """Negative control: shapes of one direction at the places of another body, or shuffled, do not agree."""
    body, places, elastic, rng = block(1)
    given = modal_test(body, places, elastic, rng, 0.0)
    turned = np.asarray(given.shapes)[:, [2, 0, 1]]
    shuffled = np.asarray(given.shapes)[rng.permutation(len(places))]
    for shapes in (turned, shuffled):
        wrong = st.MeasuredModes(given.frequency, given.damping, shapes, given.points, 1.0, places)
        assert st.mac(wrong, body).values[np.arange(elastic.size), elastic].max() < 0.9


def test_mac_against_the_definition_with_some_directions_measured():
    body, places, elastic, rng = block(2)
    given = modal_test(body, places, elastic, rng, 0.3)
    seen = rng.random((len(places), 3)) < 0.4
    shapes = np.where(seen[:, :, None], given.shapes, 0.0) * np.exp(1j * rng.uniform(0.0, 6.0, elastic.size))
    modes = st.MeasuredModes(given.frequency, given.damping, shapes, given.points, None, places + 1e-4)
    table = st.mac(modes, body)
    assert table.attrs["rows"] == seen.sum()
    assert table.attrs["distance"] == pytest.approx(np.sqrt(3.0) * 1e-4, rel=1e-9)
    for row in range(elastic.size):
        for column in range(table.sizes["computed"]):
            psi = np.array([shapes[p, d, row] for p, d in zip(*np.nonzero(seen), strict=True)])
            phi = np.array([body.trace(tuple(places[p]))[d, column] for p, d in zip(*np.nonzero(seen), strict=True)])
            expected = abs(np.vdot(psi, phi)) ** 2 / (np.vdot(psi, psi).real * (phi @ phi))
            assert table.values[row, column] == pytest.approx(expected, rel=1e-9, abs=1e-12)
    own = st.mac(modes, modes)
    np.testing.assert_allclose(np.diag(own.values), 1.0)
    np.testing.assert_allclose(own.values, own.values.T, atol=1e-12)


def test_mac_of_a_beam_needs_its_points():
    steel = st.Material(2.1e11, 7800.0)
    beam = st.ModalBeam(steel, st.Rectangle(0.02, 0.01), 0.8, damping=0.01, cutoff=1e3)
    count = beam.modes().count
    abscissas = {"a": 0.1, "b": 0.25, "c": 0.55}
    rows = np.zeros((3, 3, count))
    rows[:, :2] = [beam.trace(x) for x in abscissas.values()]
    modes = st.MeasuredModes(beam.modes().frequency, 0.01, rows, list(abscissas))
    np.testing.assert_allclose(np.diag(st.mac(modes, beam, points=abscissas).values), 1.0)
    with pytest.raises(ValueError, match=r"^points must be given for measured points without places, got none$"):
        st.mac(modes, beam)


def test_points_off_the_body_are_refused():
    body, places, elastic, rng = block(3)
    given = modal_test(body, places, elastic, rng, 0.0)
    moved = st.MeasuredModes(
        given.frequency, given.damping, given.shapes, given.points, None, places + np.array([0.0, 0.5, 0.0])
    )
    with pytest.raises(
        ValueError, match=r"^measured must have its points within \S+ m of nodes, got 0\.\d+ m for '1' at"
    ):
        st.mac(moved, body)
    st.mac(moved, body, tolerance=1.0)
    with pytest.raises(ValueError, match=r"^points must be one of 1, 2, .* got 'x'"):
        st.mac(given, body, points={"x": tuple(places[0])})


def test_the_figure_shows_every_mode():
    body, places, elastic, rng = block(4)
    table = st.mac(modal_test(body, places, elastic, rng, 0.01), body)
    axes = st.plot.mac(table, title="block").axes[0]
    assert len(axes.get_yticks()) == elastic.size
    assert [text.get_text() for text in axes.get_yticklabels()] == [
        f"{one:.4g}" for one in table.measured_frequency.values
    ]
    assert {text.get_text() for text in axes.texts} >= {f"{table.values.max():.2f}"}
    with pytest.raises(ValueError, match=r"^found must be the result of mac"):
        st.plot.mac(table.rename(measured="row"))
