"""Mobilities of universal files and their modes: files of another writer, noise, close and complex modes, refusals."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula.doubtful import DoubtfulValue

pytestmark = [
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]
LABELS = [f"{point} {way}" for point in (1, 2, 5) for way in ("+X", "-Z")]
SENSES = np.array([1.0, -1.0] * 3)
LINES = np.arange(40.0, 1001.0, 1.0)


def random_modes(seed, *, close=True):
    """Return frequencies [Hz], damping and mass-normalised rows of modes, the first two close to each other."""
    rng = np.random.default_rng(seed)
    frequency = np.sort(rng.uniform(100.0, 900.0, 4))
    damping = rng.uniform(0.003, 0.02, 4)
    if close:
        frequency[1] = frequency[0] * (1.0 + 2.0 * damping[0])
    shapes = rng.choice([-1.0, 1.0], (len(LABELS), 4)) * rng.uniform(0.4, 1.5, (len(LABELS), 4))
    return frequency, damping, shapes


def mobilities(frequency, damping, shapes, driven=(0,), lines=LINES):
    """Return mobilities of modes in closed form, shape (responses, excitations, lines)."""
    w, natural = 2.0 * np.pi * lines, 2.0 * np.pi * frequency[:, None]
    terms = 1j * w / (natural**2 - w**2 + 2j * damping[:, None] * natural * w)
    return np.einsum("rm,em,ml->rel", shapes, shapes[list(driven)], terms)


def measured(values, driven=(0,), labels=LABELS, lines=LINES):
    names = {"response": labels, "excitation": [labels[k] for k in driven], "frequency": lines}
    return xr.DataArray(values, names, ("response", "excitation", "frequency"), attrs={"units": "m/(N s)"})


def noisy(values, noise, seed):
    rng = np.random.default_rng(seed)
    size = noise * np.sqrt(np.mean(np.abs(values) ** 2))
    return values + size * (rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)) / np.sqrt(2.0)


# Identification.


@pytest.mark.parametrize("seed", range(8))
def test_without_noise_modes_are_exact(seed):
    frequency, damping, shapes = random_modes(seed)
    modes = st.identify_modes(measured(mobilities(frequency, damping, shapes)))
    order = np.argsort(frequency)
    np.testing.assert_allclose(modes.frequency, frequency[order], rtol=1e-9)
    np.testing.assert_allclose(modes.damping, damping[order], rtol=1e-7)
    found = modes.normalised[:, [0, 2]].reshape(6, 4)
    expected = shapes[:, order] * SENSES[:, None]
    expected = expected * np.sign((found.real * expected).sum(axis=0))
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-6 * np.abs(expected).max())
    assert modes.points == ("1", "2", "5")


def deviations(frequency, damping, shapes, noise):
    """Return the least standard deviations of frequencies [Hz] and damping by the bound of Cramer and Rao.

    The derivatives are differences of the closed form; residues are those of each function, complex.
    """
    exact = mobilities(frequency, damping, shapes)[:, 0]
    size = noise * np.sqrt(np.mean(np.abs(exact) ** 2)) / np.sqrt(2.0)
    w, count = 2.0 * np.pi * LINES, frequency.size
    slopes = []
    for mode in range(count):
        for way, step in ((0, 1e-4), (1, 1e-7)):
            given = [frequency.copy(), damping.copy()]
            sums = []
            for sign in (1.0, -1.0):
                given[way][mode] = (frequency, damping)[way][mode] + sign * step
                sums.append(mobilities(*given, shapes)[:, 0])
            slopes.append((sums[0] - sums[1]).ravel() / (2.0 * step))
    angular = 2.0 * np.pi * frequency
    poles = angular * (-damping + 1j * np.sqrt(1.0 - damping**2))
    parts = (
        [1j * w / (1j * w - poles[m]) for m in range(count)],
        [1j * w / (1j * w - poles[m].conj()) for m in range(count)],
    )
    own = [a + b for a, b in zip(*parts, strict=True)] + [1j * (a - b) for a, b in zip(*parts, strict=True)]
    own += [1j * w / w[-1], w[0] / (1j * w)]
    for function in range(len(shapes)):
        for column in own:
            row = np.zeros((len(shapes), w.size), dtype=complex)
            row[function] = column
            slopes.append(row.ravel())
    rows = np.array(slopes)
    stacked = np.concatenate([rows.real, rows.imag], axis=1)
    stacked = stacked / (sizes := np.linalg.norm(stacked, axis=1))[:, None]
    spread = size * np.sqrt(np.diag(np.linalg.inv(stacked @ stacked.T))) / sizes
    return spread[: 2 * count : 2], spread[1 : 2 * count : 2]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("noise", [1e-3, 0.02, 0.05])
def test_errors_are_those_that_noise_makes_unavoidable(seed, noise):
    """Within five standard deviations of the bound of Cramer and Rao, from all modes that are there and no other."""
    frequency, damping, shapes = random_modes(seed)
    # Weak modes are buried in more noise, and their search needs a frequency to begin with.
    begun = None if noise < 0.05 else np.sort(frequency)
    modes = st.identify_modes(measured(noisy(mobilities(frequency, damping, shapes), noise, seed)), begun)
    assert modes.frequency.size == 4
    order = np.argsort(frequency)
    spread = deviations(frequency[order], damping[order], shapes[:, order], noise)
    np.testing.assert_array_less(np.abs(modes.frequency - frequency[order]), 5.0 * spread[0])
    np.testing.assert_array_less(np.abs(modes.damping - damping[order]), 5.0 * spread[1])


def test_noise_alone_has_no_modes():
    """Negative control."""
    noise = noisy(np.ones((6, 1, LINES.size)), 1.0, 0) - 1.0
    with pytest.raises(ValueError, match=r"^modes must be given where no pole stays while the order of the fit rises"):
        st.identify_modes(measured(noise))


def test_two_excitations_and_a_roving_hammer_give_the_same_modes():
    frequency, damping, shapes = random_modes(3)
    driven = (1, 4)
    values = mobilities(frequency, damping, shapes, driven)
    several = st.identify_modes(measured(values, driven))
    hammer = measured(values, driven).transpose("excitation", "response", "frequency")
    hammer = hammer.rename(response="excitation", excitation="response")
    roving = st.identify_modes(hammer)
    one = st.identify_modes(measured(values[:, :1], driven[:1]))
    for other in (several, roving):
        np.testing.assert_allclose(other.frequency, one.frequency, rtol=1e-8)
        np.testing.assert_allclose(np.abs(other.normalised), np.abs(one.normalised), rtol=1e-4, atol=1e-6)


def test_modes_outside_of_the_band_are_left_to_the_terms_for_them():
    frequency, damping, shapes = np.array([60.0, 300.0, 420.0, 2000.0]), np.full(4, 0.01), random_modes(5)[2]
    modes = st.identify_modes(measured(mobilities(frequency, damping, shapes)), band=(200.0, 600.0))
    assert {300, 420} <= {*np.round(modes.frequency).astype(int)}
    for mode in (300.0, 420.0):
        at = int(np.argmin(np.abs(modes.frequency - mode)))
        assert modes.frequency[at] == pytest.approx(mode, rel=1e-4)
        assert modes.damping[at] == pytest.approx(0.01, rel=1e-2)


def test_given_frequencies_begin_the_search():
    frequency, damping, shapes = random_modes(6, close=False)
    found = measured(mobilities(frequency, damping, shapes))
    modes = st.identify_modes(found, modes=frequency * 1.004)
    np.testing.assert_allclose(modes.frequency, frequency, rtol=1e-8)
    np.testing.assert_allclose(modes.damping, damping, rtol=1e-6)
    with pytest.warns(DoubtfulValue, match=r"^the modes leave out 0\.\d+ of the square of the mobilities$"):
        st.identify_modes(found, modes=frequency[:1])
    with pytest.raises(ValueError, match=r"^modes must be different frequencies from 40 to 1000 Hz"):
        st.identify_modes(found, modes=[20.0])
    with pytest.raises(ValueError, match=r"^modes must be an array of numbers"):
        st.identify_modes(found, modes="x")
    with pytest.raises(ValueError, match=r"^band must be the lowest and the highest frequency \[Hz\], got 3"):
        st.identify_modes(found, band=3)
    with pytest.raises(ValueError, match=r"^places must have a place of each point, got none of '1'$"):
        st.identify_modes(found, places={})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda one: one.isel(excitation=0), r"^measured must have the dimensions response, excitation, frequency"),
        (lambda one: one.assign_attrs(units="m/N"), r"^measured must be mobilities in m/\(N s\), got 'm/N'$"),
        (lambda one: one * np.nan, r"^measured must be finite, over rising frequencies"),
        (lambda one: one.isel(frequency=slice(3)), r"^measured must have at least 16 frequencies .*, got 3$"),
        (lambda one: one.assign_coords(excitation=["9 +Z"]), r"^responses must have one of the excitations, 9 \+Z"),
    ],
)
def test_wrong_mobilities_are_refused(change, words):
    with pytest.raises(ValueError, match=words):
        st.identify_modes(change(measured(mobilities(*random_modes(0)))))


# Files.

KINDS = {"receptance": (8, -1, "m"), "mobility": (11, 0, "m/s"), "accelerance": (12, 1, "m/s^2")}


def by_pyuff(path, values, quantity="accelerance", *, units=True, factors=None, scale=1.0, **words):
    """Write functions between the points of LABELS, and from the first of them."""
    pyuff = pytest.importorskip("pyuff")
    kind, power, label = KINDS[quantity]
    sets = (
        []
        if factors is None
        else [
            {"type": 164, "units_code": 9, "temp": 1.0, "temp_offset": 0.0, "length": factors[0], "force": factors[1]}
        ]
    )
    for row, one in enumerate(LABELS):
        node, way = one.split(" ")
        one = {"type": 58, "func_type": 4, "rsp_node": int(node), "rsp_dir": {"+X": 1, "-Z": -3}[way]}
        one |= {"ref_node": 1, "ref_dir": 1, "x": LINES, "abscissa_spacing": 1, "binary": 0}
        one |= {"abscissa_spec_data_type": 18, "ordinate_spec_data_type": kind, "orddenom_spec_data_type": 13}
        if units:
            one |= {"ordinate_axis_units_lab": label, "orddenom_axis_units_lab": "N"}
        one["data"] = scale * values[row, 0] * (2j * np.pi * LINES) ** power
        sets.append(one | {key: value[row] if isinstance(value, list) else value for key, value in words.items()})
    path.unlink(missing_ok=True)
    for one in sets:
        pyuff.UFF(str(path)).write_sets(one, "add")
    return path


@pytest.mark.parametrize("quantity", list(KINDS))
@pytest.mark.parametrize("binary", [0, 1])
@pytest.mark.parametrize("spacing", [0, 1])
def test_functions_of_pyuff_are_read_as_mobilities(tmp_path, quantity, binary, spacing):
    values = mobilities(*random_modes(1))
    words = {"binary": binary, "abscissa_spacing": spacing}
    if binary and not spacing:
        pytest.skip("pyuff does not write these")
    found = st.read_mobilities(by_pyuff(tmp_path / "a.uff", values, quantity, **words))
    assert (found.dims, found.attrs["units"]) == (("response", "excitation", "frequency"), "m/(N s)")
    assert (list(found.response.values), list(found.excitation.values)) == (LABELS, ["1 +X"])
    np.testing.assert_allclose(found.frequency, LINES, rtol=1e-6)
    np.testing.assert_allclose(found.values, values, rtol=1e-5)


def test_an_end_without_a_dataset_hides_no_other(tmp_path):
    values = mobilities(*random_modes(1))
    path = by_pyuff(tmp_path / "a.uff", values, binary=1)
    path.write_bytes(b"    -1\n" + path.read_bytes())
    assert list(st.read_mobilities(path).response.values) == LABELS


def test_units_are_those_of_labels_or_of_dataset_164(tmp_path):
    values = mobilities(*random_modes(1))
    path = by_pyuff(tmp_path / "a.uff", values, ordinate_axis_units_lab="g", scale=1.0 / 9.80665)
    np.testing.assert_allclose(st.read_mobilities(path).values, values, rtol=1e-9)
    path = by_pyuff(tmp_path / "b.uff", values, units=False, factors=(1e3, 1.0), scale=1e3)
    np.testing.assert_allclose(st.read_mobilities(path).values, values, rtol=1e-9)
    with pytest.raises(ValueError, match=r"line \d+: the unit of the response must be in its label or in dataset 164"):
        st.read_mobilities(by_pyuff(tmp_path / "c.uff", values, units=False))
    with pytest.raises(ValueError, match=r"the unit of the response must be one of m/s2, .*, got 'furlong'$"):
        st.read_mobilities(by_pyuff(tmp_path / "d.uff", values, ordinate_axis_units_lab="furlong"))


def test_functions_that_do_not_fit_are_refused(tmp_path):
    values = mobilities(*random_modes(1))
    other = [LINES] * 5 + [LINES[:-1]]
    shorter = [LINES.size] * 5 + [LINES.size - 1]
    path = by_pyuff(tmp_path / "a.uff", values, x=other, num_pts=shorter, data=[*values[:5, 0], values[5, 0, :-1]])
    with pytest.raises(ValueError, match=r"line \d+: a function must have the 961 frequencies .* got 960, 40 to 999"):
        st.read_mobilities(path)
    twice = by_pyuff(tmp_path / "b.uff", values, rsp_node=[1, 1, 2, 2, 2, 5])
    with pytest.raises(ValueError, match=r"line \d+: the function from '1 \+X' to '2 \+X' is there twice$"):
        st.read_mobilities(twice)
    lost = by_pyuff(tmp_path / "c.uff", values, ref_node=[1, 1, 1, 1, 1, 2])
    with pytest.raises(ValueError, match=r"path must have each response for each excitation, 6 times 2, got none from"):
        st.read_mobilities(lost)
    unknown = by_pyuff(tmp_path / "d.uff", values, ordinate_spec_data_type=0)
    with pytest.raises(ValueError, match=r"line \d+: the response must be displacement \(8\), velocity \(11\) or"):
        st.read_mobilities(unknown)
    np.testing.assert_allclose(st.read_mobilities(unknown, quantity="accelerance").values, values, rtol=1e-9)
    force = by_pyuff(tmp_path / "e.uff", values, orddenom_spec_data_type=12)
    with pytest.raises(ValueError, match=r"line \d+: the excitation must be a force \(13\), got type 12$"):
        st.read_mobilities(force)
    times = by_pyuff(tmp_path / "f.uff", values, func_type=6, data=list(values[:, 0].real))
    with pytest.raises(ValueError, match=r"path must have frequency response functions, type 4 of dataset 58, got"):
        st.read_mobilities(times)


def test_files_that_are_cut_are_refused(tmp_path):
    path = by_pyuff(tmp_path / "a.uff", mobilities(*random_modes(1))[:, :, :])
    text, rng = path.read_bytes(), np.random.default_rng(0)
    refused = 0
    for cut in rng.integers(1, len(text) - 20, 40):
        path.write_bytes(text[:cut])
        found, message = read_or_refused(path)
        refused += found is None
        assert "\n" not in message
        # A file that ends between functions has fewer of them.
        assert found is None or found.sizes["response"] < len(LABELS)
    assert refused > 30


def read_or_refused(path):
    """Return the mobilities of a file, or None and the message of the error."""
    try:
        return st.read_mobilities(path), ""
    except ValueError as error:
        return None, str(error)


def test_from_a_file_to_a_body(tmp_path):
    """The mobility of the body of the identified modes is the one that was written."""
    values = mobilities(*random_modes(2))
    modes = st.identify_modes(st.read_mobilities(by_pyuff(tmp_path / "a.uff", values)))
    body = modes.body()
    words = {"direction": (0.0, 0.0, -1.0), "excitation_direction": "x", "frequency": LINES}
    found = st.mobility(body.at("5"), body.at("1"), **words)
    np.testing.assert_allclose(found.values, values[5, 0], rtol=0.0, atol=1e-6 * np.abs(values).max())
