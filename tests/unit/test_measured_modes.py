"""Modes of tests: files of another writer, scales, units, complex shapes, and lines that are refused."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg

import stridula as st
from stridula.doubtful import DoubtfulValue

pytestmark = [
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]
FREQUENCY, DAMPING = np.array([412.0, 433.0, 1250.0]), np.array([0.004, 0.01, 0.002])
NODES = [3, 7, 12, 40]
# Relative error of numbers in format E13.5.
SIX_DIGITS = 5e-6


def shapes(seed=0, *, imaginary=0.0):
    rng = np.random.default_rng(seed)
    real, other = rng.standard_normal((2, len(NODES), 3, FREQUENCY.size))
    return real + 1j * imaginary * other


def places(seed=1):
    return np.random.default_rng(seed).uniform(-0.2, 0.2, (len(NODES), 3))


def by_pyuff(path, moved, *, mass=(0.0,) * 3, modal_a=None, nodes=None, units=(1.0, 1.0), **words):
    """Write modes by another program: normal ones, or complex ones with modal A."""
    pyuff = pytest.importorskip("pyuff")
    sets = []
    if units is not None:
        factors = {"length": units[0], "force": units[1], "temp": 1.0, "temp_offset": 273.15}
        sets.append({"type": 164, "units_code": 9, "units_description": "own", "temp_mode": 1} | factors)
    if nodes is not None:
        sets.append(nodes)
    for number, (frequency, damping) in enumerate(zip(FREQUENCY, DAMPING, strict=True)):
        rows = {f"r{k + 1}": moved[:, k, number] for k in range(3)}
        one = {"type": 55, "data_ch": 2, "spec_data_type": 8, "load_case": 1, "mode_n": number + 1, "node_nums": NODES}
        if modal_a is None:
            kind = {"analysis_type": 2, "freq": frequency, "modal_m": mass[number], "modal_damp_vis": damping}
        else:
            angular = 2.0 * np.pi * frequency
            pole = angular * (-damping + 1j * np.sqrt(1.0 - damping**2))
            kind = {"analysis_type": 3, "eig": pole, "modal_a": modal_a[number], "modal_b": 0j}
        sets.append(one | rows | kind | words)
    pyuff.UFF(str(path)).write_sets(sets, "overwrite")
    return path


def nodes_of(given, kind=2411, displacement=None):
    x, y, z = np.transpose(given)
    ones = [1] * len(NODES)
    words = {"type": kind, "node_nums": NODES, "def_cs": ones, "disp_cs": displacement or ones, "color": ones}
    return words | {"x": x, "y": y, "z": z}


# Files of another writer.


@pytest.mark.parametrize("kind", [15, 2411])
def test_normal_modes_of_pyuff_are_read(tmp_path, kind):
    masses = np.array([0.5, 2.0, 7.0])
    path = by_pyuff(tmp_path / "a.unv", shapes().real, mass=masses, nodes=nodes_of(places(), kind))
    modes = st.MeasuredModes.read(path)
    np.testing.assert_allclose(modes.frequency, FREQUENCY, rtol=SIX_DIGITS)
    np.testing.assert_allclose(modes.damping, DAMPING, rtol=SIX_DIGITS)
    np.testing.assert_allclose(modes.normalised, shapes() / np.sqrt(masses), rtol=2.0 * SIX_DIGITS)
    np.testing.assert_allclose(modes.places, places(), rtol=SIX_DIGITS)
    body = st.ModalBody.read(path, points={"tip": "12"}, name="beam")
    assert (body.point_names, body.name) == (("tip",), "beam")
    np.testing.assert_allclose(body.at("tip").place, places()[2], rtol=SIX_DIGITS)
    np.testing.assert_allclose(np.abs(body.trace("tip")), np.abs(shapes()[2] / np.sqrt(masses)), rtol=1e-4)


def test_complex_modes_of_pyuff_keep_their_modal_a(tmp_path):
    """With real shapes turned by any phase, modal A turned by twice that has the same residues."""
    angular = 2.0 * np.pi * FREQUENCY * np.sqrt(1.0 - DAMPING**2)
    turned, masses = np.exp(1j * np.array([0.3, 2.0, -1.1])), np.array([0.5, 2.0, 7.0])
    modal_a = 2j * angular * masses * turned**2
    modes = st.MeasuredModes.read(by_pyuff(tmp_path / "a.unv", shapes() * turned, modal_a=modal_a))
    assert modes.scaling == "unit modal A"
    expected = shapes().real / np.sqrt(masses)
    signs = np.sign(modes.normalised[0, 0].real / expected[0, 0])
    np.testing.assert_allclose(modes.normalised * signs, expected, rtol=0.0, atol=1e-4 * np.abs(expected).max())
    np.testing.assert_allclose(modes.frequency, FREQUENCY, rtol=SIX_DIGITS)
    np.testing.assert_allclose(modes.damping, DAMPING, rtol=1e-4)
    np.testing.assert_allclose(modes.collinearity, 1.0, atol=1e-8)


def test_units_of_the_file_become_si(tmp_path):
    """In mm, N and s masses are in tonnes."""
    words = {"nodes": nodes_of(1e3 * places()), "units": (1e3, 1.0)}
    path = by_pyuff(tmp_path / "a.unv", shapes().real, mass=(1e-3, 2e-3, 5e-3), **words)
    modes = st.MeasuredModes.read(path)
    np.testing.assert_allclose(modes.scaling, [1.0, 2.0, 5.0], rtol=SIX_DIGITS)
    np.testing.assert_allclose(modes.places, places(), rtol=1e-5)
    path = by_pyuff(tmp_path / "b.unv", shapes().real, **words)
    modes = st.MeasuredModes.read(path, "unit modal mass")
    np.testing.assert_allclose(modes.normalised, shapes() / np.sqrt(1e3), rtol=1e-5)
    with pytest.warns(DoubtfulValue, match=r"has no units, dataset 164: taken as SI$"):
        st.MeasuredModes.read(by_pyuff(tmp_path / "c.unv", shapes().real, units=None))


def test_pyuff_reads_what_is_written(tmp_path):
    pyuff = pytest.importorskip("pyuff")
    masses = np.array([0.5, 2.0, 7.0])
    given = st.MeasuredModes(FREQUENCY, DAMPING, shapes(), list(map(str, NODES)), masses, places())
    given.write(tmp_path / "a.unv")
    units, nodes, *modes = pyuff.UFF(str(tmp_path / "a.unv")).read_sets()
    assert (units["length"], units["force"]) == (1.0, 1.0)
    np.testing.assert_allclose(np.stack([nodes[axis] for axis in "xyz"], axis=1), places(), rtol=1e-15)
    for number, mode in enumerate(modes):
        found = np.stack([mode[f"r{k}"] for k in (1, 2, 3)], axis=1)
        np.testing.assert_allclose(found, shapes()[:, :, number].real, rtol=SIX_DIGITS)
        stated = [mode["freq"], mode["modal_damp_vis"], mode["modal_m"]]
        np.testing.assert_allclose(stated, [FREQUENCY[number], DAMPING[number], masses[number]], rtol=SIX_DIGITS)


@pytest.mark.parametrize("scaling", [None, "unit modal mass", "unit modal A", 3.0])
@pytest.mark.parametrize("imaginary", [0.0, 0.1])
def test_modes_are_read_back(tmp_path, scaling, imaginary):
    given = st.MeasuredModes(FREQUENCY, DAMPING, shapes(2, imaginary=imaginary), ["3", "7", "12", "40"], scaling)
    given.write(tmp_path / "a.unv")
    back = st.MeasuredModes.read(tmp_path / "a.unv")
    np.testing.assert_allclose(back.shapes, given.shapes, rtol=0.0, atol=1e-5 * np.abs(given.shapes).max())
    if scaling is None:
        assert back.scaling is None
    else:
        scale = np.abs(given.normalised).max()
        np.testing.assert_allclose(back.normalised, given.normalised, rtol=0.0, atol=1e-5 * scale)


def test_an_end_without_a_dataset_hides_no_other(tmp_path):
    lines = lines_of(tmp_path)
    (tmp_path / "b.unv").write_text("\n".join(["    -1", *lines]) + "\n")
    assert st.MeasuredModes.read(tmp_path / "b.unv").frequency.size == 3


# Coordinate systems.


@pytest.mark.parametrize("kind", [0, 1])
def test_local_directions_are_those_of_their_systems(tmp_path, kind):
    """Against SciPy's rotations: local axes turned about a random vector, then by the angle of a place round z."""
    rotation = scipy.spatial.transform.Rotation.random(random_state=3)
    origin, local = np.array([0.1, -0.3, 0.2]), places(4)
    angles = np.arctan2(local[:, 1], local[:, 0])
    system = {"CS_sys_labels": [9], "CS_types": [kind], "CS_colors": [8], "CS_names": ["own"]}
    system |= {"type": 2420, "CS_matrices": [np.vstack([rotation.as_matrix().T, origin])]}
    world = rotation.apply(local) + origin
    path = by_pyuff(tmp_path / "a.unv", shapes().real, nodes=nodes_of(world, displacement=[9] * 4))
    pyuff = pytest.importorskip("pyuff")
    pyuff.UFF(str(path)).write_sets(system, "add")
    expected = shapes().real.copy()
    for row, angle in enumerate(angles):
        about = scipy.spatial.transform.Rotation.from_euler("z", angle if kind else 0.0)
        expected[row] = (rotation * about).as_matrix() @ expected[row]
    with pytest.raises(ValueError, match=r"line \d+: node 3 .* of its own: pass directions=\"local\" for shapes in it"):
        st.MeasuredModes.read(path)
    found = st.MeasuredModes.read(path, directions="local")
    np.testing.assert_allclose(found.shapes, expected, atol=1e-4)
    np.testing.assert_allclose(st.MeasuredModes.read(path, directions="global").shapes, shapes().real, atol=1e-4)


def test_places_of_dataset_15_are_in_their_systems(tmp_path):
    rotation, origin = scipy.spatial.transform.Rotation.random(random_state=5), np.array([0.1, 0.2, 0.3])
    given = places()
    given[:, 1] = np.degrees(given[:, 1])
    radius, angle = np.abs(given[:, 0]), np.radians(given[:, 1])
    given[:, 0] = radius
    local = np.stack([radius * np.cos(angle), radius * np.sin(angle), given[:, 2]], axis=1)
    system = {"CS_sys_labels": [9], "CS_types": [1], "CS_colors": [8], "CS_names": ["own"], "type": 2420}
    system |= {"CS_matrices": [np.vstack([rotation.as_matrix().T, origin])]}
    for kind in (15, 2411):
        nodes = nodes_of(given, kind) | {"def_cs": [9] * 4}
        path = by_pyuff(tmp_path / f"{kind}.unv", shapes().real, nodes=nodes)
        pytest.importorskip("pyuff").UFF(str(path)).write_sets(system, "add")
    modes = st.MeasuredModes.read(tmp_path / "15.unv")
    np.testing.assert_allclose(modes.places, rotation.apply(local) + origin, atol=1e-5)
    with pytest.raises(ValueError, match=r"node 3 has the coordinate system 9, .* export the nodes in the global"):
        st.MeasuredModes.read(tmp_path / "2411.unv")


# Complex shapes.


def test_imaginary_share_and_collinearity_against_all_phases():
    """The share that is lost is the least over all phases; the collinearity is that of the covariance of both parts."""
    moved = shapes(6, imaginary=0.6)
    modes = st.MeasuredModes(FREQUENCY, DAMPING, moved, ["a", "b", "c", "d"])
    flat = moved.reshape(-1, 3)
    phases = np.exp(1j * np.linspace(0.0, np.pi, 20001))
    for number, column in enumerate(flat.T):
        shares = np.sum(np.imag(phases[:, None] * column) ** 2, axis=1) / np.sum(np.abs(column) ** 2)
        assert modes.imaginary_share[number] == pytest.approx(shares.min(), abs=1e-7)
        xx, yy, xy = column.real @ column.real, column.imag @ column.imag, column.real @ column.imag
        expected = ((xx - yy) ** 2 + 4.0 * xy**2) / (xx + yy) ** 2
        assert modes.collinearity[number] == pytest.approx(expected, rel=1e-12)


def system_of(seed, size=6, spread=0.0):
    """Return mass, damping and stiffness of a random system whose damping is not proportional by a share."""
    rng = np.random.default_rng(seed)
    mass = np.diag(rng.uniform(0.5, 2.0, size))
    springs = rng.uniform(0.5e6, 2e6, size + 1)
    stiffness = np.diag(springs[:-1] + springs[1:]) - np.diag(springs[1:-1], 1) - np.diag(springs[1:-1], -1)
    own = rng.uniform(0.0, 2.0, size)
    return mass, 2.0 * mass + 1e-6 * stiffness + spread * np.diag(own), stiffness


def complex_modes(mass, damping, stiffness):
    """Return poles above the real axis, shapes and modal A of a viscous system, from its first-order form."""
    size = len(mass)
    inverse = np.linalg.inv(mass)
    first = np.block([[np.zeros((size, size)), np.eye(size)], [-inverse @ stiffness, -inverse @ damping]])
    values, vectors = np.linalg.eig(first)
    kept = values.imag > 0.0
    order = np.argsort(np.abs(values[kept]))
    poles, shapes = values[kept][order], vectors[:size, kept][:, order]
    modal_a = np.array([x @ (2.0 * p * mass + damping) @ x for p, x in zip(poles, shapes.T, strict=True)])
    return poles, shapes, modal_a


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("spread", [0.0, 30.0])
def test_residues_give_the_modes_and_their_receptance(seed, spread):
    """Against the inverse of the dynamic stiffness; only with proportional damping is the body's mobility the same."""
    mass, damping, stiffness = system_of(seed, spread=spread)
    poles, moved, modal_a = complex_modes(mass, damping, stiffness)
    residues = np.einsum("im,jm,m->ijm", moved, moved, 1.0 / modal_a)
    labels = [f"{point} {way}" for point in "ab" for way in ("+X", "-Y", "+Z")]
    senses = np.array([1.0, -1.0, 1.0] * 2)
    given = residues * np.multiply.outer(senses, senses)[:, :, None]
    modes = st.MeasuredModes.from_residues(poles, given[:, [4, 2]], labels, [labels[4], labels[2]])
    psi = (modes.shapes.reshape(6, -1)).T
    angular = np.linspace(100.0, 4000.0, 40)
    for w in angular:
        exact = np.linalg.inv(stiffness + 1j * w * damping - w**2 * mass)
        found = np.einsum("mi,mj,m->ij", psi, psi, 1.0 / (1j * w - poles))
        found = found + np.einsum("mi,mj,m->ij", psi.conj(), psi.conj(), 1.0 / (1j * w - poles.conj()))
        np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-9 * np.abs(exact).max())
    if spread:
        assert modes.imaginary_share.max() > 1e-5
        return
    body = modes.body()
    exact = [1j * w * np.linalg.inv(stiffness + 1j * w * damping - w**2 * mass)[0, 2] for w in angular]
    found = st.mobility(body.at("a"), direction="x", excitation_direction="z", frequency=angular / (2.0 * np.pi))
    np.testing.assert_allclose(found.values, exact, rtol=0.0, atol=1e-9 * np.abs(exact).max())


def test_complex_modes_are_mentioned_with_their_loss():
    moved = shapes(7) + shapes(7, imaginary=0.8) * [1.0, 0.0, 0.0]
    modes = st.MeasuredModes(FREQUENCY, DAMPING, moved, ["a", "b", "c", "d"], "unit modal mass")
    with pytest.warns(DoubtfulValue, match=r"^mode 1 at 412 Hz is complex: its real part leaves out 0\.\d+ of it"):
        modes.body()
    turned = st.MeasuredModes([412.0], 0.01, shapes(7)[:, :, :1], ["a", "b", "c", "d"], "unit modal A")
    with pytest.warns(DoubtfulValue, match=r"mode 1 at 412 Hz is 45 degrees out of phase with its modal A"):
        turned.body()


def test_a_scale_given_in_words_replaces_that_of_the_file_with_a_warning(tmp_path):
    path = by_pyuff(tmp_path / "a.unv", shapes().real, mass=(1.0, 2.0, 3.0))
    with pytest.warns(DoubtfulValue, match=r"^unit modal mass in place of that of '.*a\.unv', 3$"):
        modes = st.MeasuredModes.read(path, "unit modal mass")
    np.testing.assert_allclose(modes.normalised, shapes(), rtol=1e-5)
    np.testing.assert_allclose(st.MeasuredModes.read(path, 4.0).normalised, shapes() / 2.0, rtol=1e-5)


# What is refused.


def test_without_a_scale_there_is_no_body(tmp_path):
    path = by_pyuff(tmp_path / "a.unv", shapes().real)
    assert st.MeasuredModes.read(path).scaling is None
    words = r"^scaling must be 'unit modal mass', 'unit modal A' or modal masses \[kg\], got none$"
    with pytest.raises(ValueError, match=words):
        st.ModalBody.read(path)
    path = by_pyuff(tmp_path / "b.unv", shapes().real, mass=(1.0, 0.0, 1.0))
    with pytest.raises(ValueError, match=r"scaling must be given where the file lacks it .* that at 433 Hz, line \d+$"):
        st.MeasuredModes.read(path)


def lines_of(tmp_path):
    """Return the lines of a file of real modes."""
    given = st.MeasuredModes(FREQUENCY, DAMPING, shapes(), ["3", "7", "12", "40"], 1.0, places())
    given.write(tmp_path / "a.unv")
    return (tmp_path / "a.unv").read_text().splitlines()


# Line 25 has the kinds of the first mode, 27 its frequency, 28 and 29 its first node.
BAD = [
    ({27: "  4.12000E+02  nan  4.00000E-03  0.00000E+00"}, "line 27: dataset 55 needs 4 numbers in a line"),
    ({27: " -4.12000E+02  1.00000E+00  4.00000E-03  0.0"}, "line 27: dataset 55 must have frequency and modal mass"),
    ({27: "  4.12000E+02  1.00000E+00  4.00000E-03  0.1"}, "line 27: dataset 55 has a viscous damping ratio of 0.004"),
    ({27: "  4.12000E+02  1.00000E+00  4.00000E+00  0.0"}, "must have a damping ratio from 0 to below 1, got 4"),
    ({28: "         x"}, "line 28: dataset 55 needs whole numbers, got 'x'"),
    ({28: "         7"}, "line 30: dataset 55 has node 7 twice"),
    ({28: "       999"}, "the mode that begins here moves node 999, which is not among the nodes"),
    ({28: "        -3"}, "line 28: dataset 55 needs the number of a node in a line"),
    ({29: "  1.0  2.0"}, "line 29: dataset 55 needs 3 numbers in a line, got '1.0  2.0'"),
    ({29: "  1.0  2.0 3.0 4.0"}, "line 29: dataset 55 needs 3 numbers in a line, got '1.0  2.0 3.0 4.0'"),
    ({29: "  1.0  inf  3.0"}, "line 29: dataset 55 needs 3 numbers in a line, got '1.0  inf  3.0'"),
    ({25: "1 5 2 8 2 3"}, "line 25: dataset 55 must be of modes (2, 3 or 7), got a frequency response (5)"),
    ({25: "1 2 2 12 2 3"}, "line 25: dataset 55 has accelerations (type 12), which leaves the scale of the shape open"),
    ({25: "1 2 4 8 2 6"}, "line 25: dataset 55 must have 3 or 6 real (2) or complex (5) values"),
    (
        {25: "1 3 2 8 2 3", 26: "2 6 1 1", 27: "3.0 40.0 0 0 0 0"},
        "must have an eigenvalue of a vibration",
    ),
    ({4: "1D3 1D0 1D0", 6: "    -1\n    -1\n   164\n1\n1D0 1D0 1D0\n    -1"}, "units must not be mixed"),
    ({4: "0D3 1D0 1D0"}, "line 4: dataset 164 needs factors of units above 0, got 0 and 1"),
]


@pytest.mark.parametrize(("changes", "words"), BAD)
def test_bad_lines_are_refused_with_their_number(tmp_path, changes, words):
    lines = lines_of(tmp_path)
    for number, text in changes.items():
        lines[number - 1] = text
    (tmp_path / "b.unv").write_text("\n".join(lines) + "\n")
    with pytest.raises(ValueError) as raised:
        st.ModalBody.read(tmp_path / "b.unv")
    message = str(raised.value)
    assert words in message
    assert "b.unv" in message
    assert "\n" not in message


def read_or_refused(path):
    """Return the modes of a file, or None and the message of the error or warning."""
    try:
        return st.MeasuredModes.read(path), ""
    except (ValueError, DoubtfulValue) as error:
        return None, str(error)


def test_a_mode_that_is_there_twice_is_refused(tmp_path):
    """Two modes of one frequency with other shapes, as of a disc, are two."""
    moved = shapes().real[:, :, [0, 0, 1]]
    given = st.MeasuredModes([412.0, 412.0, 800.0], 0.01, moved * [1.0, -0.99, 1.0], ["3", "7", "12", "40"], 1.0)
    given.write(tmp_path / "a.unv")
    with pytest.raises(ValueError, match=r"a\.unv': line \d+: the mode at 412 Hz is there twice, also in line \d+$"):
        st.MeasuredModes.read(tmp_path / "a.unv")
    moved[:, :, 1] = shapes(9).real[:, :, 0]
    st.MeasuredModes([412.0, 412.0, 800.0], 0.01, moved, ["3", "7", "12", "40"], 1.0).write(tmp_path / "a.unv")
    assert st.MeasuredModes.read(tmp_path / "a.unv").frequency.size == 3


def test_files_that_are_cut_or_shuffled_are_refused_or_equal(tmp_path):
    """A file without its end is refused, unless only whole modes are missing."""
    lines, rng = lines_of(tmp_path), np.random.default_rng(0)
    whole = st.MeasuredModes.read(tmp_path / "a.unv")
    text, path = "\n".join(lines) + "\n", tmp_path / "b.unv"
    outcomes = {"read": 0, "refused": 0}
    for number in range(300):
        cut = list(lines)
        if number % 2:
            first, second = rng.integers(0, len(lines), 2)
            cut[first], cut[second] = cut[second], cut[first]
            path.write_text("\n".join(cut) + "\n")
        else:
            path.write_text(text[: rng.integers(0, len(text))])
        found, message = read_or_refused(path)
        outcomes["refused" if found is None else "read"] += 1
        assert "\n" not in message
        if found is not None and not number % 2:
            assert {*found.frequency} <= {*whole.frequency}
    assert min(outcomes.values()) > 10


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"frequency": [-1.0, 2.0, 3.0]}, r"^frequency\[0\] must be 0 or above, got -1\.0$"),
        ({"damping": [0.1, 1.0, 0.1]}, r"^damping\[1\] must be from 0 to below 1, got 1\.0$"),
        ({"damping": [0.1, 0.1]}, r"^damping must have the shape \(3\), got \(2,\)$"),
        ({"points": "abcd"}, r"^points must be different names of points"),
        ({"points": ["a", "a", "b", "c"]}, r"^points must be different names of points"),
        ({"scaling": "unit mass"}, r"^scaling must be one of unit modal mass, unit modal A, got 'unit mass'"),
        ({"scaling": [1.0, -1.0, 2.0]}, r"^scaling must be modal masses above 0 kg, got -1\.0 for mode 2$"),
        ({"scaling": [1.0, 2.0]}, r"^scaling must have the shape \(3\), got \(2,\)$"),
        ({"shapes": np.zeros((4, 3, 3))}, r"^shapes must move a point in every mode, got none in mode 0"),
        ({"shapes": np.ones((4, 2, 3))}, r"^shapes must have the shape \(4, 3, 3\), got \(4, 2, 3\)$"),
        ({"shapes": np.full((4, 3, 3), np.nan)}, r"^shapes must be finite, got \(?nan.* at point 0, direction 0"),
        ({"places": [[0.0, 1.0]]}, r"^places must have the shape \(4, 3\), got \(1, 2\)$"),
    ],
)
def test_bad_arguments_are_refused(changes, words):
    given = {"frequency": FREQUENCY, "damping": DAMPING, "shapes": shapes(), "points": ["a", "b", "c", "d"]} | changes
    with pytest.raises(ValueError, match=words):
        st.MeasuredModes(**given)


def test_two_modes_of_the_same_frequency_are_mentioned():
    shapes_of_two = np.eye(6)[:, :2] * [1.0, 0.7] + 0.1
    residue = (shapes_of_two @ shapes_of_two.T)[:, :2, None]
    labels = [f"{point} {way}" for point in "ab" for way in ("+X", "+Y", "+Z")]
    with pytest.warns(
        DoubtfulValue, match=r"^the residue at 15\.9\d+ Hz is not one product .* a second mode of the same"
    ):
        st.MeasuredModes.from_residues([-1.0 + 100j], residue, labels, labels[:2])


def test_residues_without_a_driving_point_have_no_scale():
    with pytest.raises(ValueError, match=r"^responses must have one of the excitations, 9 \+Z: without it the scale"):
        st.MeasuredModes.from_residues([-1.0 + 9j], np.ones((1, 1, 1)), ["1 +Z"], ["9 +Z"])
    with pytest.raises(ValueError, match=r"^responses must be points with directions, such as \"7 \+Z\", got '1'$"):
        st.MeasuredModes.from_residues([-1.0 + 9j], np.ones((1, 1, 1)), ["1"], ["9 +Z"])
