"""Universal files that other programs wrote, against pyuff and the numbers in their lines."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest

import stridula as st

FILES = Path(__file__).parent / "universal"
pytestmark = [
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]


def sets_of(path, kind):
    """Return the datasets of a kind as pyuff reads them."""
    pyuff = pytest.importorskip("pyuff")
    found = pyuff.UFF(str(path)).read_sets()
    return [one for one in (found if isinstance(found, list) else [found]) if one["type"] == kind]


@pytest.mark.parametrize(
    ("name", "channel", "units", "rate"),
    [
        ("binary8byte.uff", "sine 5 Hz 1", "g", 100.0),
        ("time-history-not-all-columns-filled.uff", "1x : m/s²", "m/s2", 2e4),
    ],
)
def test_time_responses(name, channel, units, rate):
    signal = st.read_signal(FILES / name)
    (other,) = sets_of(FILES / name, 58)
    np.testing.assert_array_equal(signal, other["data"])
    assert (signal.name, signal.attrs["units"]) == (channel, units)
    np.testing.assert_allclose(np.diff(signal["time"]), 1.0 / rate)


def test_modes_with_rotations_are_read_without_them():
    modes = st.MeasuredModes.read(FILES / "uff55_translation_rotation.uff", scale=1.0)
    (other,) = sets_of(FILES / "uff55_translation_rotation.uff", 55)
    assert modes.points == tuple(str(int(node)) for node in sorted(other["node_nums"]))
    np.testing.assert_array_equal(modes.frequency, [97.013])
    np.testing.assert_array_equal(modes.shapes[:, :, 0].real, np.stack([other[f"r{k}"] for k in (1, 2, 3)], axis=1))


def test_numbers_may_touch():
    """A complex mode: its eigenvalue and modal A are in one line without a blank between."""
    modes = st.MeasuredModes.read(FILES / "uff55_sample_test_record10.uff", scale=1.0)
    eigenvalue, modal_a = -0.1111111 + 41.11111j, 4111.111 - 3111.111j
    np.testing.assert_allclose(modes.frequency, abs(eigenvalue) / (2.0 * np.pi))
    np.testing.assert_allclose(modes.damping, 0.1111111 / abs(eigenvalue))
    assert (modes.scaling, modes.points) == ("unit modal A", ("60101", "111111"))
    shape = modes.shapes[:, :, 0] * np.sqrt(modal_a)
    listed = [[0.0, 0.0, -4.111111e-2 - 1.111111e-2j], [0.0, 0.1111111 + 9.111111e-2j, 7.111111e-3 + 4.111111e-3j]]
    np.testing.assert_allclose(shape, listed, atol=1e-9)


def test_modes_of_dataset_2414(tmp_path):
    """In mm and without a modal mass, as Permas wrote them."""
    path = tmp_path / "a.uff"
    path.write_bytes(gzip.decompress((FILES / "2411_and_2414.uff.gz").read_bytes()))
    modes = st.MeasuredModes.read(path, scale=1e-3)
    others = sets_of(path, 2414)
    np.testing.assert_array_equal(modes.frequency, [one["record12_field2"] for one in others])
    assert modes.scaling is None
    for number, other in enumerate(others):
        order = np.argsort(other["node_nums"])
        np.testing.assert_array_equal(modes.shapes[:, :, number].real, np.array(other["data_at_node"])[order, :3])
    (nodes,) = sets_of(path, 2411)
    assert modes.points == tuple(str(int(node)) for node in np.sort(nodes["node_nums"]))
    order = np.argsort(nodes["node_nums"])
    np.testing.assert_allclose(modes.places, 1e-3 * np.stack([nodes[axis] for axis in "xyz"], axis=1)[order])


def dataset_2414(*, analysis=2, specific=8, location=1, reals="0.0 412.0 0.0 0.5 0.01 0.0", others="0.0 0.0 0.0 0.0"):
    head = [
        "    -1",
        "  2414",
        "1",
        "mode",
        str(location),
        *["NONE"] * 5,
        f"1 {analysis} 2 {specific} 2 3",
        *["0 0"] * 2,
    ]
    return "\n".join([*head, reals, f"{others} 0.0 0.0", "         7", " 1.0 2.0-3.0E+00", "    -1", ""])


def test_results_of_dataset_2414_other_than_modes_are_left_out(tmp_path):
    static, stress = dataset_2414(analysis=1), dataset_2414(specific=2)
    elements = dataset_2414(location=2)
    (tmp_path / "a.unv").write_text(static + stress + elements + dataset_2414().replace("2.0-3.0E", "2.0E+00-3.0E"))
    modes = st.MeasuredModes.read(tmp_path / "a.unv", scale=1.0)
    np.testing.assert_array_equal(modes.shapes[:, :, 0].real, [[1.0, 2.0, -3.0]])
    assert (modes.frequency[0], modes.scaling[0], modes.damping[0]) == (412.0, 0.5, 0.01)
    pole = "-10.0 200.0 0.0 8.0"
    given = dataset_2414(analysis=3, others=pole).replace("2.0-3.0E", "2.0E+00-3.0E")
    (tmp_path / "b.unv").write_text(given)
    modes = st.MeasuredModes.read(tmp_path / "b.unv", scale=1.0)
    np.testing.assert_allclose(modes.frequency, np.hypot(10.0, 200.0) / (2.0 * np.pi))
    np.testing.assert_allclose(modes.shapes[0, :, 0], np.array([1.0, 2.0, -3.0]) / np.sqrt(8j))
    # Numbers that touch need exponents: 2.0-3 is 0.002 in files of Fortran.
    (tmp_path / "c.unv").write_text(dataset_2414())
    with pytest.raises(ValueError, match=r"c.unv': line 17: dataset 2414 needs 3 numbers in a line"):
        st.MeasuredModes.read(tmp_path / "c.unv", scale=1.0)
    (tmp_path / "d.unv").write_text(static)
    with pytest.raises(ValueError, match=r"^path must have mode shapes, dataset 55 or 2414, got none in"):
        st.MeasuredModes.read(tmp_path / "d.unv", scale=1.0)


def test_modes_are_read_beside_binary_functions(tmp_path):
    """The bytes of a binary function hide no dataset after it, even if they look like the end of one."""
    binary = (FILES / "binary8byte.uff").read_bytes()
    start = binary.index(b"\n", binary.index(b"g   ")) + 1
    for _ in range(2):
        start = binary.index(b"\n", start) + 1
    spoiled = binary[:start] + b"\n    -1\n    55\n" + binary[start + 15 :]
    mode = (FILES / "uff55_translation_rotation.uff").read_bytes()
    for number, first in enumerate((binary, spoiled)):
        path = tmp_path / f"{number}.uff"
        path.write_bytes(first.rstrip(b"\n") + b"\n" + mode)
        np.testing.assert_array_equal(st.MeasuredModes.read(path, scale=1.0).frequency, [97.013])
        assert st.read_signal(path).size == 250
    (tmp_path / "c.uff").write_bytes(binary[: start + 100])
    with pytest.raises(
        ValueError, match=r"c.uff': line 2: a binary function of 2000 bytes begins here: the file is cut"
    ):
        st.MeasuredModes.read(tmp_path / "c.uff")


def test_headers_and_nodes_of_a_test_system_are_no_modes():
    with pytest.raises(ValueError, match=r"^path must have mode shapes, dataset 55 or 2414, got none in"):
        st.MeasuredModes.read(FILES / "TestLab_161_164_18_15_82.uff")
    modes = FILES / "uff55_translation_rotation.uff"
    with pytest.raises(ValueError, match=r"moves node \d+, which is not among the nodes"):
        st.MeasuredModes.read(modes, geometry=FILES / "TestLab_161_164_18_15_82.uff")
    with pytest.raises(ValueError, match=r"non_ascii_header.uff, line 14: the response must be displacement \(8\)"):
        st.read_mobilities(FILES / "non_ascii_header.uff")
