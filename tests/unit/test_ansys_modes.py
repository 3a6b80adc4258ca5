"""Modes of Ansys: a file of its own against another reader and a body of the same mesh; records of another writer."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import stridula as st
from stridula.doubtful import DoubtfulValue, LeftOut

FILE = Path(__file__).parent / "modes" / "hex_201.rst.gz"
SIZE = (1.0, 1.0, 5.0)
RNG = np.random.default_rng(2)
NODES = np.array([7, 3, 40, 12])
PLACES, ANGLES = RNG.uniform(-1.0, 1.0, (4, 3)), RNG.uniform(-170.0, 170.0, (4, 3))
SHAPES = RNG.standard_normal((4, 3, 2))
FREQUENCY = np.array([32.0, 181.5])


@pytest.fixture
def beam(tmp_path):
    path = tmp_path / "hex_201.rst"
    path.write_bytes(gzip.decompress(FILE.read_bytes()))
    return path


def test_modes_are_those_of_another_reader(beam):
    modes = st.MeasuredModes.read(beam, scale=1.0)
    found = [32.13951614479067, 32.13951614483834, 145.47838954313121, 173.45579430419966, 173.45579430420608]
    np.testing.assert_array_equal(modes.frequency, [*found, 254.85112372052464])
    at = [modes.points.index(name) for name in ("7", "160", "300")]
    np.testing.assert_array_equal(modes.places[at], [[1.0, 0.25, 0.0], [1.0, 0.5, 3.75], [0.5, 0.5, 4.0]])
    third = [[0.0] * 3, [6.859860470794038e-16, 0.008110712530714926, -1.0984676212237955e-15]]
    sixth = [-0.00013192259035224075, 4.868151901194065e-16, 0.006619315668597436]
    np.testing.assert_array_equal(modes.shapes[at[:2], :, 2], third)
    np.testing.assert_array_equal(modes.shapes[at[1], :, 5], sixth)


def test_modes_are_those_of_a_body_of_the_same_mesh(beam):
    """Ansys integrates its stiffness at fewer points, which makes it softer; pairs of bending are in any direction."""
    modes = st.MeasuredModes.read(beam, "unit modal mass", scale=1.0)
    mesh = st.SolidMesh.block(SIZE, (2, 2, 10))
    mesh = mesh.moved(modes.places.min(axis=0) - mesh.nodes.min(axis=0))
    solid = st.SolidBody(mesh, st.Material(2e11, 7800.0, 0.3), fixed=["back"], cutoff=300.0)
    agreement = st.mac(modes, solid)
    np.testing.assert_allclose(modes.frequency, agreement["computed_frequency"], rtol=5e-3)
    for pair in (slice(0, 2), slice(3, 5)):
        np.testing.assert_allclose(agreement.values[pair, pair].sum(axis=1), 1.0, atol=1e-4)
    for single in (2, 5):
        np.testing.assert_allclose(agreement.values[single, single], 1.0, atol=1e-4)
        own = np.array([solid.trace(tuple(place))[:, single] for place in modes.places])
        np.testing.assert_allclose(np.linalg.norm(modes.normalised[:, :, single]), np.linalg.norm(own), rtol=1e-4)


def test_the_scale_of_shapes_is_asked_for(beam):
    with pytest.raises(ValueError, match=r"^scaling must be 'unit modal mass', .* got none$"):
        st.ModalBody.read(beam, scale=1.0)
    with pytest.warns(DoubtfulValue, match=r"hex_201.rst' has no units: taken as SI; pass scale"):
        body = st.ModalBody.read(beam, [2.0] * 6, points={"tip": (0.5, 0.5, 5.0)})
    unit = st.ModalBody.read(beam, "unit modal mass", scale=1.0, points={"tip": (0.5, 0.5, 5.0)})
    np.testing.assert_allclose(body.trace("tip"), unit.trace("tip") / np.sqrt(2.0))


# Records of another writer.

SPARSE, WINDOWS, SHORT, WHOLE = 1 << 27, 1 << 28, 1 << 30, 1 << 31


def record(values, form="plain"):
    """Return a record of whole numbers or reals, in full, without zeros, or as windows."""
    values = np.asarray(values)
    flags = WHOLE if values.dtype.kind == "i" else SHORT if values.dtype.itemsize == 4 else 0
    values = values.astype("<i4") if values.dtype.kind == "i" else values
    data = values.tobytes()
    if form == "sparse":
        there = values != 0.0
        bits = int((there << np.arange(values.size)).sum())
        data, flags = np.array([values.size, bits], "<u4").tobytes() + values[there].tobytes(), flags | SPARSE
    elif form == "windows":
        data, flags = windows(values), flags | WINDOWS
    assert len(data) % 4 == 0
    return np.array([len(data) // 4, flags], "<u4").tobytes() + data + np.array([len(data) // 4], "<u4").tobytes()


def windows(values):
    """Return a lone value, a run of values, and a run of one value, in this order of their places."""
    out, count, at = b"", 0, 0
    nonzero = np.flatnonzero(values)
    while nonzero[nonzero >= at].size:
        start = int(nonzero[nonzero >= at][0])
        end = start + 1
        while end < values.size and values[end] != 0.0:
            end += 1
        run = values[start:end]
        if end - start == 1 and start > 0:
            out += np.array([start], "<i4").tobytes() + run.tobytes()
        elif (run == run[0]).all():
            out += np.array([-start, start - end], "<i4").tobytes() + run[:1].tobytes()
        else:
            out += np.array([-start, end - start], "<i4").tobytes() + run.tobytes()
        count, at = count + 1, end
    return np.array([values.size, count], "<i4").tobytes() + out


def written(path, *, form="plain", kind="<f8", units=-1, freedoms=(1, 2, 3), shapes=SHAPES, own=None, **words):
    """Write results: headers, nodes and a data set for each mode; `own` are the rows of nodes with displacements."""
    standard = np.zeros(100, int)
    standard[[0, 1, 4]] = 12, -1, units
    parts, place = [record(standard)], {}

    def put(name, data):
        place[name] = sum(map(len, parts)) // 4
        parts.append(data)

    parts.append(b"")
    assert len(parts[0]) // 4 == 103
    header = np.zeros(80, int)
    parts.append(record(header))
    put("nodes", record(NODES))
    put("frequency", record(FREQUENCY))
    rows = np.column_stack([NODES.astype(float), PLACES, ANGLES])
    put("places", b"".join(record(row, "sparse" if form == "sparse" else "plain") for row in rows))
    geometry = np.zeros(80, int)
    geometry[[3, 26]] = NODES.size, place["places"]
    put("geometry", record(geometry))
    starts = []
    for mode in range(2):
        starts.append(sum(map(len, parts)) // 4)
        own_rows = np.arange(NODES.size) if own is None else np.array(own)
        across = np.zeros((own_rows.size, len(freedoms)))
        for column, freedom in enumerate(freedoms):
            across[:, column] = shapes[own_rows, freedom - 1, mode] if freedom <= 3 else 9.0
        data = np.zeros(200, int)
        data[19], data[20 : 20 + len(freedoms)] = len(freedoms), freedoms
        solution = record(data)
        data[104] = len(solution) // 4
        parts += [record(data), record(across.astype(kind).ravel(), form)]
        if own is not None:
            parts.append(record(own_rows + 1))
    table = np.zeros(20, int)
    table[:2] = starts
    put("sets", record(table))
    given = {2: NODES.size, 3: 10, 4: len(freedoms), 7: 2, 8: 2, 10: place["sets"], 11: place["frequency"]}
    given |= {14: place["nodes"], 15: place["geometry"], 20: 1, 48: NODES.size}
    for at, value in (given | {int(key[1:]): value for key, value in words.items()}).items():
        header[at] = value
    parts[2] = record(header)
    path.write_bytes(b"".join(parts))
    return path


@pytest.mark.parametrize("form", ["plain", "windows"])
@pytest.mark.parametrize("kind", ["<f8", "<f4"])
def test_shapes_are_turned_to_the_world(tmp_path, form, kind):
    """Angles about z, the new x and the new y, NROTAT; a run of zeros and one of equal values make windows."""
    local = np.array(SHAPES)
    local[1], local[2] = 0.0, 0.25
    local[3, :2] = 0.0
    expected = np.zeros_like(local)
    for row, (first, second, third) in enumerate(ANGLES):
        z, x, y = (
            Rotation.from_euler(axis, angle, degrees=True)
            for axis, angle in zip("zxy", (first, second, third), strict=True)
        )
        expected[row] = (z * x * y).as_matrix() @ local[row]
    path = written(tmp_path / "a.rst", form=form, kind=kind, shapes=local)
    modes = st.MeasuredModes.read(path, scale=1e-3)
    order = np.argsort(NODES)
    np.testing.assert_allclose(modes.shapes, expected[order], rtol=1e-6, atol=1e-6 if kind == "<f4" else 1e-14)
    np.testing.assert_array_equal(modes.places, PLACES[order] / 1e3)
    np.testing.assert_allclose(modes.frequency, FREQUENCY, rtol=1e-15)
    assert modes.points == ("3", "7", "12", "40")


def test_nodes_without_displacements_are_left_out_with_a_word(tmp_path):
    path = written(tmp_path / "a.rst", form="plain", own=[3, 0], freedoms=(1, 2, 3, 4))
    with pytest.warns(LeftOut, match=r"a.rst': 2 nodes without displacements are left out"):
        modes = st.MeasuredModes.read(path, scale=1.0)
    assert modes.points == ("7", "12")
    turned = [Rotation.from_euler("ZXY", ANGLES[row], degrees=True).as_matrix() @ SHAPES[row] for row in (0, 3)]
    np.testing.assert_allclose(modes.shapes, turned, rtol=1e-12)


@pytest.mark.parametrize(("units", "length", "mass"), [(1, 1.0, 1.0), (5, 1.0, 1.0), (6, 1e-3, 1e3), (2, 1e-2, 1e-3)])
def test_units_of_the_file_become_si(tmp_path, units, length, mass):
    """Of m and kg, twice, of mm and t, of cm and g."""
    path = written(tmp_path / "a.rst", units=units)
    modes = st.MeasuredModes.read(path, "unit modal mass")
    order = np.argsort(NODES)
    np.testing.assert_allclose(modes.places, length * PLACES[order])
    np.testing.assert_allclose(
        np.linalg.norm(modes.normalised, axis=1), np.linalg.norm(SHAPES[order], axis=1) / mass**0.5
    )
    with pytest.raises(
        ValueError, match=rf"a.rst': scale must be {length:g}, as the file states, or left out, got 0.5$"
    ):
        st.MeasuredModes.read(path, scale=0.5)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"w7": 0}, r"must have modes, ANTYPE,MODAL, got results of the kind static$"),
        ({"w20": 12}, r"has modes of a sector \(cyclic symmetry\): expand them"),
        ({"w48": 9}, r"has 4 of 9 nodes, as of a distributed run: combine its files first$"),
        ({"w32": 1}, r"has complex modes, of a damped solver: real modes are read$"),
        ({"w8": 11}, r"must have room for 11 modes, got 10: it is damaged$"),
        ({"w14": 10**6}, r"the record at byte 4000000 must have the numbers of the nodes, .* cut off$"),
        ({"units": 4}, r"is in inches: export it in metres or millimetres$"),
        ({"freedoms": (20,)}, r"mode 1 has no displacements: write them with OUTRES,NSOL,ALL$"),
    ],
)
def test_wrong_files_are_refused_in_one_line(tmp_path, words, message):
    path = written(tmp_path / "a.rst", **words)
    with pytest.raises(ValueError, match=rf"^cannot read .*a.rst': {message}"):
        st.MeasuredModes.read(path, scale=1.0)


def test_a_file_that_is_cut_off_is_refused(tmp_path):
    whole = written(tmp_path / "a.rst").read_bytes()
    for length in range(0, len(whole) - 4, 211):
        (tmp_path / "a.rst").write_bytes(whole[:length])
        with pytest.raises(ValueError, match=r"^cannot read .*a.rst': (.*cut off|must begin with 100)"):
            st.MeasuredModes.read(tmp_path / "a.rst", scale=1.0)
