"""Modes of Nastran: its files against its own listings, files of another writer, and places that are refused."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import stridula as st
from stridula.doubtful import DoubtfulValue, LeftOut

FILES = Path(__file__).parent / "modes"
# Modal masses and eigenvalues in the listings, .f06, have seven digits.
SEVEN = 5e-7
RNG = np.random.default_rng(5)
NODES = [3, 7, 12, 40]
PLACES = RNG.uniform(-0.5, 0.5, (4, 3))
SHAPES = RNG.standard_normal((4, 3, 2))
EIGENVALUES, MASSES = (2.0 * np.pi * np.array([100.0, 250.0])) ** 2, np.array([0.5, 2.0])


def unpacked(folder, name):
    path = folder / name
    path.write_bytes(gzip.decompress((FILES / f"{name}.gz").read_bytes()))
    return path


# Files that Nastran wrote.


def test_modes_that_are_not_of_unit_mass_have_their_masses(tmp_path):
    """A beam, PARAM,POST,-2, each mode of largest component 1; pairs of equal frequency are those of another run."""
    modes = st.MeasuredModes.read(unpacked(tmp_path, "beam_modes_m1.op2"), scale=1.0)
    listed = [456.6603, 456.6603, 2674.588, 2674.588, 3554.923, 4507.487, 6626.104, 6626.104, 11111.59, 11111.59]
    np.testing.assert_allclose(modes.frequency, listed, rtol=SEVEN)
    np.testing.assert_allclose(modes.scaling[[4, 5]], [3.668128e-3, 1.334596e-2], rtol=SEVEN)
    assert (len(modes.points), modes.places[10].tolist()) == (12, [10.0, 0.0, 0.0])
    np.testing.assert_allclose(np.abs(modes.shapes[:, :, 5]).max(), 1.0)


def test_shapes_are_those_of_the_listing(tmp_path):
    modes = st.MeasuredModes.read(unpacked(tmp_path, "mode_solid_shell_bar.op2"), scale=1.0)
    np.testing.assert_allclose((2.0 * np.pi * modes.frequency) ** 2, [2.005177e5, 2.277722e5, 6.246444e5], rtol=SEVEN)
    listed = [[-2.931720e-01, -5.107800e-01, -1.129750e-01], [-2.862867e-01, -7.436559e-01, -6.192411e-02]]
    np.testing.assert_allclose(modes.shapes[:2, :, 0], listed, rtol=SEVEN)
    # This file lacks the table of eigenvalues with the modal masses.
    assert modes.scaling is None
    with pytest.raises(ValueError, match=r"^scaling must be 'unit modal mass', .* got none$"):
        modes.body()
    body = st.ModalBody.read(tmp_path / "mode_solid_shell_bar.op2", "unit modal mass", scale=1.0, points={"one": "1"})
    np.testing.assert_allclose(np.abs(body.trace("one")), np.abs(modes.shapes[0]))


def test_real_modes_are_read_beside_complex_ones(tmp_path):
    """A wing in flutter, with displacements in the basic system, table BOPHIG."""
    modes = st.MeasuredModes.read(unpacked(tmp_path, "0012_flutter.op2"), scale=1.0)
    np.testing.assert_allclose(modes.frequency, [2.667090, 10.62820], rtol=SEVEN)
    np.testing.assert_allclose(modes.scaling, 1.0, rtol=SEVEN)
    assert modes.shapes.shape == (243, 3, 2)


# Files of another writer.


class Writer:
    """Writes binary tables of words of four or eight bytes, in either order."""

    def __init__(self, size=4, order="<"):
        self.size, self.order, self.out = size, order, bytearray()

    def words(self, *values):
        kinds = {int: f"{self.order}i{self.size}", float: f"{self.order}f{self.size}"}
        return b"".join(np.array(one, kinds[type(one)]).tobytes() for one in values)

    def block(self, data):
        length = np.array(len(data), f"{self.order}i4").tobytes()
        self.out += length + data + length

    def keys(self, *values):
        for one in values:
            self.block(self.words(one))

    def text(self, text):
        wide = b"".join(text[at : at + 4].ljust(self.size).encode() for at in range(0, len(text), 4))
        self.keys(len(wide) // self.size)
        self.block(wide)

    def table(self, name, records):
        self.text(name.ljust(8))
        self.keys(-1, 7)
        self.block(self.words(*[0] * 7))
        self.keys(-2, 1, 0)
        self.text(name.ljust(8))
        self.keys(-3)
        for number, record in enumerate(records, 4):
            self.keys(1, 0)
            # Long records are in pieces.
            for piece in (record[: self.size * 5], record[self.size * 5 :]):
                if piece:
                    self.keys(len(piece) // self.size)
                    self.block(piece)
            self.keys(-number)
        self.keys(1, 0, 0)

    def header(self, mode, eigenvalue, subcase=1, approach=2, code=7, wide=8):
        given = {0: 10 * approach + 1, 1: code, 3: subcase, 4: mode, 5: float(eigenvalue), 8: 1, 9: wide}
        return self.words(*[given.get(at, 0) for at in range(146)])

    def rows(self, shape, nodes=NODES, kind=1):
        rows = zip(nodes, shape.tolist(), strict=True)
        return b"".join(self.words(10 * node + 1, kind, *map(float, row), 0.1, 0.2, 0.3) for node, row in rows)


def grids(writer, places, system=0, turned=0, double=False):
    key = (4501, 45, 1120001) if double else (4501, 45, 1)
    out = writer.words(*key)
    for node, place in zip(NODES, places.tolist(), strict=True):
        given = np.array(place, f"{writer.order}f8").tobytes() if double else writer.words(*map(float, place))
        out += writer.words(node, system) + given + writer.words(turned, 0, 0)
    return out


def cord2(writer, number, kind, points, double=False):
    """Return a record of a system by three points; 1 is rectangular, 2 cylindrical, 3 spherical."""
    given = np.ravel(points).tolist()
    reals = np.array(given, f"{writer.order}f8").tobytes() if double else writer.words(*map(float, given))
    key = {1: (2101, 21, 8), 2: (2001, 20, 9), 3: (2201, 22, 10)}[kind]
    return writer.words(*key, number, kind, 2, 0) + reals


def written(path, writer, *, geometry=None, table="OUGV1", shapes=SHAPES, masses=MASSES, subcases=(1, 1), label=True):
    if label:
        writer.keys(3)
        writer.block(writer.words(11, 30, 26))
        writer.text("NASTRAN FORT TAPE ID CODE - ")
        writer.text("NX2020  ")
        writer.keys(-1, 0)
    writer.table("GEOM1", [grids(writer, PLACES)] if geometry is None else geometry)
    if masses is not None:
        rows = zip(EIGENVALUES.tolist(), masses.tolist(), strict=True)
        out = [writer.words(k + 1, k + 1, e, e**0.5, e**0.5 / 6.3, m, m * e) for k, (e, m) in enumerate(rows)]
        writer.table("LAMA", [writer.header(0, 0.0, 0), b"".join(out)])
    records = []
    for mode, eigenvalue in enumerate(EIGENVALUES):
        records += [writer.header(mode + 1, eigenvalue, subcases[mode]), writer.rows(shapes[:, :, mode])]
    writer.table(table, records)
    writer.keys(0)
    path.write_bytes(bytes(writer.out))
    return path


@pytest.mark.parametrize(("size", "order"), [(4, "<"), (4, ">"), (8, "<"), (8, ">")])
@pytest.mark.parametrize("label", [True, False])
def test_every_kind_of_words_is_read(tmp_path, size, order, label):
    modes = st.MeasuredModes.read(written(tmp_path / "a.op2", Writer(size, order), label=label), scale=1e-3)
    rounding = 1e-6 if size == 4 else 1e-14
    np.testing.assert_allclose(modes.frequency, [100.0, 250.0], rtol=rounding)
    np.testing.assert_allclose(modes.scaling, 1e3 * MASSES, rtol=rounding)
    np.testing.assert_allclose(modes.shapes, SHAPES, rtol=rounding)
    np.testing.assert_allclose(modes.places, 1e-3 * PLACES, rtol=rounding)
    assert modes.points == tuple(map(str, NODES))


def local(kind, rotation, origin):
    """Return points of a system, and the directions of its coordinates at every place, as columns, by SciPy."""
    axes = rotation.as_matrix()
    points = origin, origin + 0.3 * axes[:, 2], origin + 0.2 * axes[:, 0] + 0.1 * axes[:, 2]
    found = []
    for place in PLACES:
        x, y, z = axes.T @ (place - origin)
        around = Rotation.from_rotvec([0.0, 0.0, np.arctan2(y, x)])
        down = Rotation.from_rotvec([0.0, np.arctan2(np.hypot(x, y), z), 0.0])
        if kind == 3:
            # r, theta, phi of a sphere are z, x, y of axes that are turned by theta about y, then by phi about z.
            found.append((rotation * around * down).as_matrix()[:, [2, 0, 1]])
        else:
            found.append((rotation * around if kind == 2 else rotation).as_matrix())
    return points, np.array(found)


@pytest.mark.parametrize("kind", [1, 2, 3])
@pytest.mark.parametrize("double", [False, True])
def test_displacements_are_turned_to_the_world(tmp_path, kind, double):
    writer = Writer()
    points, axes = local(kind, Rotation.random(random_state=kind), np.array([0.1, -0.2, 0.3]))
    geometry = [grids(writer, PLACES, 0, 4, double), cord2(writer, 4, kind, points, double)]
    given = np.einsum("nka,nkm->nam", axes, SHAPES)
    path = written(tmp_path / "a.op2", writer, geometry=geometry, shapes=given)
    np.testing.assert_allclose(st.MeasuredModes.read(path, scale=1.0).shapes, SHAPES, atol=1e-5)
    np.testing.assert_allclose(st.MeasuredModes.read(path, scale=1.0, directions="global").shapes, given, atol=1e-6)


def test_tables_in_the_basic_system_are_not_turned(tmp_path):
    writer = Writer()
    points, _ = local(2, Rotation.random(random_state=1), np.zeros(3))
    geometry = [grids(writer, PLACES, 0, 4), cord2(writer, 4, 2, points)]
    path = written(tmp_path / "a.op2", writer, geometry=geometry, table="BOPHIG")
    np.testing.assert_allclose(st.MeasuredModes.read(path, scale=1.0).shapes, SHAPES, rtol=1e-6)
    writer = Writer()
    path = written(tmp_path / "b.op2", writer, geometry=geometry, table="OUGV1PAT")
    with pytest.raises(ValueError, match=r"table OUGV1PAT: .* pass directions=\"local\" for shapes in them"):
        st.MeasuredModes.read(path, scale=1.0)
    np.testing.assert_allclose(st.MeasuredModes.read(path, scale=1.0, directions="global").shapes, SHAPES, rtol=1e-6)


def test_nodes_may_be_in_the_deck(tmp_path):
    points, axes = local(2, Rotation.random(random_state=3), np.array([0.1, 0.2, -0.1]))
    cards = [f"GRID,{node},,{','.join(f'{v:.7f}' for v in place)},9" for node, place in zip(NODES, PLACES, strict=True)]
    rows = [f"{value:.6f}" for point in points for value in point]
    cards += [f"CORD2C,9,0,{','.join(rows[:6])}", f",{','.join(rows[6:])}"]
    (tmp_path / "a.bdf").write_text("\n".join(["BEGIN BULK", *cards, "ENDDATA", ""]))
    given = np.einsum("nka,nkm->nam", axes, SHAPES)
    path = written(tmp_path / "a.op2", Writer(), geometry=[], shapes=given)
    with pytest.raises(ValueError, match=r"has no nodes, table GEOM1, .* pass the deck of the model, geometry="):
        st.MeasuredModes.read(path, scale=1.0)
    modes = st.MeasuredModes.read(path, scale=1.0, geometry=tmp_path / "a.bdf")
    np.testing.assert_allclose(modes.shapes, SHAPES, atol=1e-4)
    np.testing.assert_allclose(modes.places, PLACES, atol=1e-6)
    (tmp_path / "b.bdf").write_text("BEGIN BULK\nGRID,3,,0.0,x1,0.0\n")
    with pytest.raises(ValueError, match=r"^cannot read .*b.bdf': line 2: X2 of GRID 3 must be a number, got 'x1'$"):
        st.MeasuredModes.read(path, scale=1.0, geometry=tmp_path / "b.bdf")


def test_points_without_a_place_and_modes_that_turn_are_left_out_with_a_word(tmp_path):
    writer = Writer()
    records = []
    for mode, eigenvalue in enumerate(EIGENVALUES):
        shape = SHAPES[:, :, mode] * (mode == 1)
        scalar = writer.rows(np.ones((1, 3)), [50], 2)
        records += [writer.header(mode + 1, eigenvalue), writer.rows(shape) + scalar]
    writer.table("GEOM1", [grids(writer, PLACES)])
    writer.table("OUGV1", records)
    writer.keys(0)
    (tmp_path / "a.op2").write_bytes(bytes(writer.out))
    with pytest.warns(LeftOut) as caught:
        modes = st.MeasuredModes.read(tmp_path / "a.op2", "unit modal mass", scale=1.0)
    words = " ".join(str(one.message) for one in caught)
    assert "1 scalar or other points without a place are left out" in words
    assert "mode 1 of table OUGV1 at 100 Hz only turns nodes and is left out" in words
    np.testing.assert_allclose(modes.frequency, [250.0], rtol=1e-6)


def test_a_scale_in_place_of_that_of_the_file_is_mentioned(tmp_path):
    path = written(tmp_path / "a.op2", Writer())
    with pytest.warns(DoubtfulValue, match=r"unit modal mass in place of that of .*a.op2', 2$"):
        st.MeasuredModes.read(path, "unit modal mass", scale=1.0)


def test_wrong_files_are_refused_in_one_line(tmp_path):
    def refused(words, **options):
        with pytest.raises(ValueError, match=rf"^cannot read .*a.op2': {words}"):
            st.MeasuredModes.read(written(tmp_path / "a.op2", Writer(), **options), scale=1.0)

    refused(r"must have the modes of one subcase, got 1, 2: export one of them$", subcases=(1, 2))
    refused(r"mode 2 of table OUGV1: has the modal mass 0, but it must be above 0$", masses=np.array([1.0, 0.0]))
    writer = Writer()
    geometry = [grids(writer, PLACES, 0, 4)]
    refused(r"GRID 3 refers to the coordinate system 4, which is missing$", geometry=geometry)
    refused(r"table OUGV1 at byte \d+: mode 1 has displacements that are not finite$", shapes=SHAPES * np.nan)
    whole = written(tmp_path / "a.op2", Writer()).read_bytes()
    for length in range(40, len(whole) - 20, 401):
        (tmp_path / "a.op2").write_bytes(whole[:length])
        with pytest.raises(ValueError, match=r"^cannot read .*a.op2': (byte|table|must have real modes)"):
            st.MeasuredModes.read(tmp_path / "a.op2", scale=1.0)
    (tmp_path / "a.op2").write_text("X 01 a formatted file")
    with pytest.raises(ValueError, match=r"must begin with a record of one word, .* got b'X 01': not a binary .op2"):
        st.MeasuredModes.read(tmp_path / "a.op2", scale=1.0)


def test_static_and_complex_results_are_named(tmp_path):
    writer = Writer()
    writer.table("GEOM1", [grids(writer, PLACES)])
    record = [writer.header(1, -4.0, approach=9, code=1007, wide=14), writer.rows(SHAPES[:, :, 0])]
    writer.table("OUGV1", [*record, writer.header(1, 0.0, approach=1, code=1), writer.rows(SHAPES[:, :, 0])])
    writer.keys(0)
    (tmp_path / "a.op2").write_bytes(bytes(writer.out))
    with pytest.raises(ValueError, match=r"must have real modes, .* other kinds \(complex eigenvalues, static\)$"):
        st.MeasuredModes.read(tmp_path / "a.op2", scale=1.0)
