"""Files of matrices: written files are read back, every format gives the same body, bad files give one line."""

from __future__ import annotations

import os
import tracemalloc
import zipfile

import numpy as np
import pytest
import scipy.io
import scipy.sparse

from stridula.bodies import FiniteElementBeam, Material, Rayleigh, Rectangle, ReducedBody, limits
from stridula.bodies.beams_and_plates.finite_elements import assemble, element_mass, element_stiffness

STEEL, STRIP = Material(2.1e11, 7800.0), Rectangle(0.020, 0.004)
ELEMENTS = 5
SIZE = 3 * (ELEMENTS + 1)
NODES = [101, 7, 30, 44, 50, 9]
LABELS = [(node, dof) for node in NODES for dof in (1, 2, 6)]
TIP = {"tip": (0, 1)}


def beam_matrices():
    le = 0.5 / ELEMENTS
    stiffness = element_stiffness(STEEL.young * STRIP.area, STEEL.young * STRIP.second_moment, le)
    mass = assemble(element_mass(STEEL.density * STRIP.area, le, "consistent"), 0.4, ELEMENTS)
    return tuple((part + part.T) / 2 for part in (mass, assemble(stiffness, 0.4, ELEMENTS)))


MASS, STIFFNESS = beam_matrices()
DAMPING = 3.0 * MASS + 1e-7 * STIFFNESS
TRANSLATION = np.tile(np.eye(3)[:2], ELEMENTS + 1)
PENALISED = STIFFNESS.copy()
# The root clamped as in Abaqus.
PENALISED[range(SIZE - 3, SIZE), range(SIZE - 3, SIZE)] = 1e36


def same_dynamics(body, other, point="tip", rtol=1e-9):
    """Bodies whose degrees of freedom may be in another order."""
    np.testing.assert_allclose(body.modes().frequency, other.modes().frequency, rtol=1e-7)
    receptances = (b.trace(point) / (b.modes().angular_frequency ** 2 + 1e6) @ b.trace(point).T for b in (body, other))
    np.testing.assert_allclose(*receptances, rtol=rtol)


def abaqus_input(path, matrix, labels=LABELS, keep=np.tril):
    """Write a matrix as FORMAT=MATRIX INPUT does, with comments and keywords around it."""
    lines = ["** ASSEMBLED MATRIX", "*MATRIX INPUT, NAME=M"]
    for i, j in zip(*np.nonzero(keep(matrix)), strict=True):
        (row, dof), (column, other) = labels[i], labels[j]
        lines.append(f"{row},{dof}, {column},{other}, {matrix[i, j]:.16e}")
    path.write_text("\n".join([*lines, ""]))
    return path


def abaqus_coordinate(path, matrix, keep=lambda m: m):
    entries = zip(*np.nonzero(keep(matrix)), strict=True)
    path.write_text("".join(f"  {i + 1:8d} {j + 1:8d}  {matrix[i, j]: .16e}\n" for i, j in entries))
    return path


def matrix_market(path, matrix, **words):
    scipy.io.mmwrite(path, matrix, precision=17, **words)
    return path


# The body's own format.

VARIANTS = [
    {},
    {"damping": 0.02},
    {"damping": [0.01] * SIZE},
    {"damping": Rayleigh(3.0, 1e-7)},
    {"damping": DAMPING},
    {"translation": TRANSLATION, "cutoff": 2000.0, "name": "strip, left"},
    {"points": {"tip": (0, 1), "a/b ü": (None, 4), "file": (2, None)}},
]


@pytest.mark.parametrize("change", VARIANTS)
def test_what_is_saved_is_read_back_exactly(change, tmp_path):
    body = ReducedBody(**({"mass": MASS, "stiffness": STIFFNESS, "points": TIP} | change))
    body.save(tmp_path / "body.npz")
    assert ReducedBody.read(tmp_path / "body.npz") == body
    assert [path.name for path in tmp_path.iterdir()] == ["body.npz"]


def test_arguments_replace_what_the_file_holds(tmp_path):
    path = tmp_path / "body.npz"
    ReducedBody(MASS, STIFFNESS, TIP, damping=Rayleigh(1.0, 0.0), cutoff=3e3, name="old").save(path)
    words = {"damping": 0.01, "cutoff": 2e3, "name": "new", "translation": TRANSLATION}
    body = ReducedBody.read(path, points={"root": (15, 16)}, **words)
    assert body == ReducedBody(MASS, STIFFNESS, {"tip": (0, 1), "root": (15, 16)}, **words)


def test_a_body_that_cannot_be_written_is_named_and_leaves_nothing(tmp_path):
    body = ReducedBody(np.eye(2), np.eye(2), TIP)
    with pytest.raises(OSError, match=r"^cannot write '.*nowhere/body.npz': no such file or directory$"):
        body.save(tmp_path / "nowhere" / "body.npz")
    (tmp_path / "folder.npz").mkdir()
    with pytest.raises(OSError, match=r"^cannot write '.*folder.npz': is a directory$"):
        body.save(tmp_path / "folder.npz")
    assert [path.name for path in tmp_path.iterdir()] == ["folder.npz"]


# MATLAB.


@pytest.mark.parametrize("sparse", [False, True])
@pytest.mark.parametrize("names", [("mass", "stiffness", "damping"), ("M", "K", "C")])
@pytest.mark.parametrize("version", ["4", "5", "5 compressed"])
def test_matlab_files(sparse, names, version, tmp_path):
    convert = scipy.sparse.csc_array if sparse else np.array
    held = {name: convert(part) for name, part in zip(names, (MASS, STIFFNESS, DAMPING), strict=True)}
    held |= {"point_tip": np.eye(SIZE)[:2], "translation": TRANSLATION, "notes": "made by a test"}
    path = tmp_path / "body.mat"
    scipy.io.savemat(path, held, format=version[0], do_compression="compressed" in version)
    assert ReducedBody.read(path) == ReducedBody(MASS, STIFFNESS, TIP, damping=DAMPING, translation=TRANSLATION)


@pytest.mark.parametrize("damping", [0.02, [0.02] * SIZE, np.full((SIZE, 1), 0.02)])
def test_matlab_numbers_and_lists_are_ratios(damping, tmp_path):
    path = tmp_path / "body.mat"
    scipy.io.savemat(path, {"M": MASS, "K": STIFFNESS, "damping": damping, "point_tip": np.eye(SIZE)[:2]})
    ratios = 0.02 if np.ndim(damping) == 0 else [0.02] * SIZE
    assert ReducedBody.read(path) == ReducedBody(MASS, STIFFNESS, TIP, damping=ratios)


def test_matlab_damping_of_one_degree_of_freedom_is_a_matrix(tmp_path):
    path = tmp_path / "body.mat"
    scipy.io.savemat(path, {"M": 2.0, "K": 800.0, "C": 4.0, "point_tip": [[1.0], [0.0]]})
    assert ReducedBody.read(path).modes().damping.tolist() == pytest.approx([4.0 / 2.0 / (2 * 20.0)])


def test_a_matlab_file_of_version_7_3_says_how_to_save_it(tmp_path):
    path = tmp_path / "body.mat"
    path.write_bytes(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512) + b"\x89HDF\r\n\x1a\n")
    with pytest.raises(
        ValueError, match=r"^cannot read '.*body.mat': a MATLAB file of version 7.3; save it with '-v7'$"
    ):
        ReducedBody.read(path)


# One file for each matrix.


@pytest.mark.parametrize("symmetry", ["general", "symmetric"])
@pytest.mark.parametrize("sparse", [False, True])
def test_matrix_market_files(sparse, symmetry, tmp_path):
    convert = scipy.sparse.coo_array if sparse else np.array
    parts = {"mass": MASS, "stiffness": STIFFNESS, "damping": DAMPING}
    paths = {n: matrix_market(tmp_path / f"{n}.mtx", convert(p), symmetry=symmetry) for n, p in parts.items()}
    body = ReducedBody.read(**paths, points=TIP, translation=TRANSLATION)
    assert body == ReducedBody(**parts, points=TIP, translation=TRANSLATION)


@pytest.mark.parametrize("keep", [np.tril, np.triu, np.asarray])
def test_abaqus_matrix_input(keep, tmp_path):
    """One triangle, the other or both; nodes are sorted by their number, so the order of rows changes."""
    mass = abaqus_input(tmp_path / "b_MASS1.mtx", MASS, keep=keep)
    stiffness = abaqus_input(tmp_path / "b_STIF1.mtx", STIFFNESS, keep=keep)
    damping = abaqus_input(tmp_path / "b_DMPV1.mtx", DAMPING, keep=keep)
    points = {"tip": ((101, 1), (101, 2)), "end": (None, [9, 2])}
    body = ReducedBody.read(mass=mass, stiffness=stiffness, damping=str(damping), points=points, translation=(1, 2))
    wanted = ReducedBody(MASS, STIFFNESS, {"tip": (0, 1), "end": (None, 16)}, DAMPING, TRANSLATION)
    order = np.argsort([1000 * node + dof for node, dof in LABELS])
    np.testing.assert_allclose(body.stiffness, STIFFNESS[np.ix_(order, order)], rtol=1e-15)
    np.testing.assert_allclose(body.damping, DAMPING[np.ix_(order, order)], rtol=1e-15)
    np.testing.assert_array_equal(body.points["tip"], np.eye(SIZE)[:2][:, order])
    assert body.total_mass == pytest.approx(wanted.total_mass)
    same_dynamics(body, wanted)
    same_dynamics(body, wanted, "end")


def test_a_triangle_in_the_order_of_the_program_is_filled_in(tmp_path):
    """Abaqus orders rows in its own way: each pair stands once, some above and some below the diagonal."""
    flip = np.random.default_rng(2).integers(0, 2, MASS.shape).astype(bool)

    def keep(matrix):
        upper = np.triu(flip, 1)
        return np.where(upper | np.tril(~upper.T), matrix, 0.0)

    assert np.count_nonzero(np.triu(keep(MASS), 1)) > 5 < np.count_nonzero(np.tril(keep(MASS), -1))
    paths = {
        "mass": abaqus_coordinate(tmp_path / "m.mtx", MASS, keep),
        "stiffness": abaqus_coordinate(tmp_path / "k.mtx", STIFFNESS, keep),
    }
    body = ReducedBody.read(**paths, points=TIP)
    np.testing.assert_allclose(body.mass, MASS, rtol=1e-15, atol=1e-20)
    np.testing.assert_allclose(body.stiffness, STIFFNESS, rtol=1e-15)


@pytest.mark.parametrize("keep", [np.tril, np.triu, np.asarray])
def test_abaqus_coordinate(keep, tmp_path):
    mass = abaqus_coordinate(tmp_path / "b_MASS1.mtx", MASS, keep)
    stiffness = abaqus_coordinate(tmp_path / "b_STIF1.mtx", STIFFNESS, keep)
    body = ReducedBody.read(mass=mass, stiffness=stiffness, points=TIP, damping=0.01, translation=TRANSLATION)
    assert body == ReducedBody(MASS, STIFFNESS, TIP, 0.01, TRANSLATION)


@pytest.mark.parametrize("labelled", [False, True])
def test_constrained_degrees_of_freedom_are_removed(labelled, tmp_path):
    """A beam clamped by Abaqus is the clamped beam, with the same load of gravity."""
    write = abaqus_input if labelled else abaqus_coordinate
    paths = {"mass": write(tmp_path / "m.mtx", MASS), "stiffness": write(tmp_path / "k.mtx", PENALISED)}
    body = ReducedBody.read(
        **paths,
        points={"tip": ((101, 1), (101, 2)), "root": ((9, 1), (9, 2))}
        if labelled
        else {"tip": (0, 1), "root": (15, 16)},
        translation=(1, 2) if labelled else TRANSLATION,
    )
    beam = FiniteElementBeam(STEEL, STRIP, 0.5, angle=0.4, elements=ELEMENTS, root_support="clamped")
    assert body.mass.shape == (SIZE - 3, SIZE - 3)
    np.testing.assert_allclose(body.modes().frequency, beam.modes().frequency, rtol=1e-8)
    np.testing.assert_array_equal(body.trace("root"), np.zeros((2, SIZE - 3)))
    load, wanted = (
        trace / modes.angular_frequency**2 @ modes.translation.T
        for trace, modes in ((body.trace("tip"), body.modes()), (beam.trace(0.0), beam.modes()))
    )
    np.testing.assert_allclose(load, wanted, rtol=1e-8)


def test_files_are_aligned_on_all_their_labels_and_internal_nodes_are_kept(tmp_path):
    """A damper at one node only, a mass without stiffness, an internal node with a negative number."""
    mass = abaqus_input(tmp_path / "m.mtx", np.diag([1.0, 2.0, 3.0]), [(-4, 1), (2, 1), (10, 2)])
    stiffness = abaqus_input(tmp_path / "k.mtx", np.array([[50.0, -50.0], [-50.0, 50.0]]), [(2, 1), (-4, 1)])
    damping = abaqus_input(tmp_path / "c.mtx", np.array([[7.0]]), [(10, 2)])
    points = {"p": ((2, 1), (10, 2))}
    body = ReducedBody.read(mass=mass, stiffness=stiffness, damping=damping, points=points, translation=(1, 2))
    np.testing.assert_array_equal(body.mass, np.diag([1.0, 2.0, 3.0]))
    np.testing.assert_array_equal(body.stiffness, [[50.0, -50.0, 0.0], [-50.0, 50.0, 0.0], [0.0, 0.0, 0.0]])
    np.testing.assert_array_equal(body.damping, np.diag([0.0, 0.0, 7.0]))
    np.testing.assert_array_equal(body.points["p"], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_array_equal(body.translation, [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])


def test_a_full_file_that_is_not_symmetric_is_refused(tmp_path):
    """A missing mirror image is a zero there, since other entries have theirs."""
    matrix = np.array([[5.0, 1.0, 2.0], [1.0, 5.0, 0.0], [0.0, 0.0, 5.0]])
    paths = {
        "mass": abaqus_coordinate(tmp_path / "m", np.eye(3)),
        "stiffness": abaqus_coordinate(tmp_path / "k", matrix),
    }
    with pytest.raises(ValueError, match=r"^stiffness must be symmetric, got 2.0 at row 0, column 2"):
        ReducedBody.read(**paths, points=TIP)


# Refused files.


def one_matrix(tmp_path, content):
    """Read a file as the mass of a body with a valid stiffness."""
    path = tmp_path / "mass.mtx"
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    stiffness = abaqus_coordinate(tmp_path / "stiffness.mtx", np.eye(3))
    return ReducedBody.read(mass=path, stiffness=stiffness, points=TIP)


MARKET = "%%MatrixMarket matrix coordinate real general\n"
ARRAY = "%%MatrixMarket matrix array real symmetric\n"
TEXTS = {
    "empty": ("", "the file is empty"),
    "comments only": ("** nothing\n*MATRIX\n", "it holds no number"),
    "prose": ("import numpy as np\n", "line 1 must be 'row column value', got 'import numpy as np'"),
    "binary": (bytes(range(128, 256)) * 20, "line 1 must be 'row column value', got "),
    "cut labels": ("**\n1,1,1,1,5.0\n2,1,2,", "line 3 must be 'node, dof, node, dof, value', got '2,1,2,'"),
    "cut coordinate": ("1 1 5.0\n2 2\n", "line 2 must be 'row column value', got '2 2'"),
    "cut number": ("1 1 5.0\n2 2 1.0e\n", "line 2 must be 'row column value', got '2 2 1.0e'"),
    "four columns": ("1,1,1,5.0\n", "line 1 must be 'node, dof, node, dof, value', got '1,1,1,5.0'"),
    "first line damaged": (
        "** a\n*MATRIX INPUT, NAME=M\n1,1,1\n2,1,2,1,5.0\n",
        "line 3 must be 'node, dof, node, dof, value', got '1,1,1'",
    ),
    "first line damaged, no keyword": (
        "1,1,1 5.0\n2,1,2,1,5.0\n3,1,3,1,5.0\n",
        "line 1 must be 'node, dof, node, dof, value', got '1,1,1 5.0'",
    ),
    "first line without commas": (
        "1 1 5.0\n2,1,2,1,5.0\n3,1,3,1,5.0\n",
        "line 1 must be 'node, dof, node, dof, value', got '1 1 5.0'",
    ),
    "broken number": ("1.5 1 5.0\n", "line 1 must be 'row column value', got '1.5 1 5.0'"),
    "huge number": ("1e300 1 5.0\n", "line 1 must be 'row column value', got '1e300 1 5.0'"),
    "nan number": ("nan 1 5.0\n", "line 1 must be 'row column value', got 'nan 1 5.0'"),
    "row zero": ("0 1 5.0\n", "rows and columns must be numbered from 1, got 0"),
    "bad dof": ("1,-2,1,-2,5.0\n", "degrees of freedom of a node must be numbered from 0 to 1048575"),
    "twice": ("1 1 5.0\n2 2 5.0\n1 1 5.0\n", r"each entry must occur once (assembled matrices), got two at 1, 1"),
    "twice labels": ("1,2,1,2,5.0\n1,2,1,2,6.0\n", r"each entry must occur once .*, got two at (1, 2), (1, 2)"),
    "market header": ("%%MatrixMarket tensor\n1 1 1\n", ""),
    "market cut": (MARKET + "3 3 3\n1 1 1.0\n", "it must hold 3 entries, as its header announces, but holds 1"),
    "market cut to its header": (MARKET + "3 3 3\n", "it must hold 3 entries, as its header announces, but holds none"),
    "market more": (
        MARKET + "3 3 1\n1 1 1.0\n2 2 1.0\n",
        "it must hold 1 entries, as its header announces, but holds more",
    ),
    "market text": (MARKET + "3 3 1\n1 one 1.0\n", "line 3 must be 'row column value', got '1 one 1.0'"),
    "market exponent": (MARKET + "%\n3 3 2\n1 1 1.0\n2 2 1.5E", "line 5 must be 'row column value', got '2 2 1.5E'"),
    "market exponent within": (MARKET + "3 3 2\n1 1 1.0E\n2 2 1.5\n", "line 3 must be .*, got '1 1 1.0E'"),
    "market sign": (MARKET + "3 3 2\n1 1 1.0\n2 2 1.5E+", "line 4 must be .*, got '2 2 1.5E.'"),
    "market beyond": (MARKET + "3 3 1\n1 4 1.0\n", "rows and columns must be numbered from 1 to 3, got 4"),
    "market row zero": (MARKET + "3 3 1\n0 1 1.0\n", "rows and columns must be numbered from 1 to 3, got 0"),
    "market skew": (
        MARKET.replace("general", "skew-symmetric") + "3 3 1\n2 1 1.0\n",
        ".* but announces skew-symmetric",
    ),
    "market array cut": (ARRAY + "3 3\n1\n0\n0\n1\n", "it must hold 6 entries, as its header announces, but holds 4"),
    "market array exponent": (ARRAY + "3 3\n1\n0\n0\n1\n0\n1.5E", "line 8 must be one number, got '1.5E'"),
    "market array on a line": (ARRAY + "3 3\n1 0 0 1 0 1E", "line 3 must be one number, got '1 0 0 1 0 1E'"),
    "market complex": (MARKET.replace("real", "complex") + "3 3 1\n1 1 1.0 0.0\n", ".* but announces 1 complex"),
    "market pattern": (MARKET.replace("real", "pattern") + "3 3 1\n1 1\n", ".* but announces 1 pattern"),
    "market entries": (
        MARKET + "3 3 999999999999\n1 1 1.0\n",
        ".* at most 9 real entries, but announces 999999999999 real",
    ),
    "market not square": (MARKET + "3 2 1\n1 1 1.0\n", "mass must be square, got 3 x 2"),
    "market large": (MARKET + "1000000 1000000 1\n1 1 1.0\n", "mass must have at most 300000 .*, got 1000000: reduce"),
}


@pytest.mark.parametrize(("content", "message"), TEXTS.values(), ids=TEXTS)
def test_bad_text_files_are_named_in_one_line(content, message, tmp_path):
    pattern = message.replace("(", r"\(").replace(")", r"\)")
    with pytest.raises(ValueError, match=rf"^cannot read '.*mass.mtx': {pattern}") as caught:
        one_matrix(tmp_path, content)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400


def test_market_files_are_refused_wherever_they_are_cut_within_a_word(tmp_path):
    path = matrix_market(tmp_path / "whole.mtx", np.diag([1.5e-3, 2.5e10, 3.0]))
    text = path.read_bytes().rstrip()
    for end in range(1, len(text)):
        if text[end - 1 : end] in b"eE+-" or text.count(b"\n", 0, end) < text.count(b"\n"):
            with pytest.raises(ValueError, match=r"^(cannot read|mass must|points)"):
                one_matrix(tmp_path, text[:end])


def test_unnamed_rows_are_refused_before_memory_is_allocated(tmp_path):
    path = tmp_path / "m.txt"
    path.write_text("1 1 1.0\n1000000000 1000000000 1.0\n")
    tracemalloc.start()
    with pytest.raises(
        ValueError, match=r"^stiffness must have at most 300000 degrees of freedom, got 1000000000: reduce"
    ):
        ReducedBody.read(mass=path, stiffness=path, points=TIP)
    assert tracemalloc.get_traced_memory()[1] < 1e8
    tracemalloc.stop()


def test_too_many_degrees_of_freedom_are_refused_before_anything_dense_is_made(tmp_path):
    with pytest.raises(
        ValueError, match=r"^stiffness must have at most 300000 degrees of freedom, got 1000000: reduce"
    ):
        one_matrix(tmp_path, "1000000 1000000 1.0\n")
    scipy.io.savemat(tmp_path / "b.mat", {"M": scipy.sparse.eye_array(10**6, format="csc"), "K": 1.0})
    with pytest.raises(ValueError, match=r"^cannot read '.*b.mat': M must have at most 4000 .* got 1000000: reduce"):
        ReducedBody.read(tmp_path / "b.mat")


def test_files_of_more_than_2_gib_are_refused_unread(tmp_path, monkeypatch):
    path = tmp_path / "mass.mtx"
    with open(path, "wb") as file:
        file.write(b"1 1 1.0\n")
        os.truncate(path, 3 * 1024**3)
    with pytest.raises(ValueError, match=r"^cannot read '.*mass.mtx': 3 GiB, but at most 2 GiB are read$"):
        ReducedBody.read(mass=path, stiffness=path)
    monkeypatch.setattr(limits, "LARGEST_FILE", 10**5)
    np.savez_compressed(tmp_path / "b.npz", mass=np.zeros((400, 400)))
    with pytest.raises(ValueError, match=r"^cannot read '.*b.npz': .* GiB when unpacked, but at most 2 GiB are read$"):
        ReducedBody.read(tmp_path / "b.npz")


@pytest.mark.parametrize("content", ["2 2 3\n1 1 3.0e4\n2 1 -1.0e4\n2 2 1.0e4\n", "% made by hand\n2 2 1\n1 1 3.0\n"])
def test_matrix_market_files_without_their_first_line_are_named(content, tmp_path):
    path = tmp_path / "k.mtx"
    path.write_text(content)
    words = "the first line must be '%%MatrixMarket matrix coordinate real symmetric' or a similar one"
    with pytest.raises(ValueError, match=rf"^cannot read '.*k.mtx': {words}"):
        ReducedBody.read(mass=path, stiffness=path, points={"tip": (0, 1)})


def test_missing_files_and_folders_are_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"^cannot read 'no.npz': no such file or directory$"):
        ReducedBody.read("no.npz")
    with pytest.raises(FileNotFoundError, match=r"^cannot read 'k.mtx': no such file or directory$"):
        ReducedBody.read(mass=abaqus_coordinate(tmp_path / "m", MASS), stiffness="k.mtx")
    with pytest.raises(IsADirectoryError, match=r"^cannot read '.*': is a directory$"):
        ReducedBody.read(tmp_path)


@pytest.mark.parametrize("kind", ["npz", "mat"])
def test_damaged_containers_are_named_wherever_they_are_cut(kind, tmp_path):
    path = tmp_path / f"body.{kind}"
    if kind == "npz":
        ReducedBody(MASS, STIFFNESS, TIP).save(path)
    else:
        held = {"mass": MASS, "stiffness": STIFFNESS, "point_tip": np.eye(SIZE)[:2]}
        scipy.io.savemat(path, held, do_compression=True)
    content = path.read_bytes()
    for part in (1, 50, 150, len(content) // 3, len(content) // 2, len(content) - 40):
        path.write_bytes(content[:part])
        with pytest.raises(ValueError, match=rf"^(cannot read|path must be) .*'.*body.{kind}'") as caught:
            ReducedBody.read(path)
        assert "\n" not in str(caught.value)
    broken = bytearray(content)
    broken[len(content) // 2] ^= 0xFF
    path.write_bytes(broken)
    with pytest.raises(ValueError, match=rf"^cannot read '.*body.{kind}': "):
        ReducedBody.read(path)


def test_containers_must_hold_matrices_and_points(tmp_path):
    path = tmp_path / "body.npz"
    np.savez(path, mass=MASS, other=MASS, point_tip=np.eye(SIZE)[:2])
    with pytest.raises(ValueError, match=r"^cannot read '.*': it must hold stiffness, but holds mass, point_tip$"):
        ReducedBody.read(path)
    np.savez(path, mass=MASS, stiffness=STIFFNESS)
    with pytest.raises(ValueError, match=r"^points must have at least one point, got none$"):
        ReducedBody.read(path)
    np.savez(path, mass=MASS, stiffness=np.array([None]), allow_pickle=True)
    with pytest.raises(
        ValueError, match=r"^cannot read '.*body.npz': stiffness must be an array of numbers, got .* object"
    ):
        ReducedBody.read(path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mass", "no array")
        archive.writestr("stiffness", "no array")
    with pytest.raises(ValueError, match=r"mass must be an array of numbers, got other bytes"):
        ReducedBody.read(path)
    scipy.io.savemat(tmp_path / "b.mat", {"M": MASS, "K": "stiff", "point_tip": np.eye(SIZE)[:2]})
    with pytest.raises(ValueError, match=r"K must be a matrix of numbers"):
        ReducedBody.read(tmp_path / "b.mat")


def test_npz_files_may_name_matrices_as_matlab_does(tmp_path):
    points = {"point_tip": np.eye(SIZE)[:2]}
    np.savez(tmp_path / "b.npz", M=MASS, K=STIFFNESS, C=DAMPING, **points)
    wanted = ReducedBody(MASS, STIFFNESS, TIP, damping=DAMPING)
    assert ReducedBody.read(tmp_path / "b.npz") == wanted
    np.savez(tmp_path / "b.npz", M=MASS, mass=MASS, stiffness=STIFFNESS, C=DAMPING, **points)
    assert ReducedBody.read(tmp_path / "b.npz") == wanted


@pytest.mark.parametrize("other", [2.0 * MASS, MASS[:3, :3], scipy.sparse.csc_array(2.0 * MASS)])
@pytest.mark.parametrize("kind", ["npz", "mat"])
def test_a_container_with_two_different_mass_matrices_is_refused(kind, other, tmp_path):
    path = tmp_path / f"b.{kind}"
    full = other.toarray() if kind == "npz" and scipy.sparse.issparse(other) else other
    held = {"mass": MASS, "M": full, "K": STIFFNESS, "point_tip": np.eye(SIZE)[:2]}
    np.savez(path, **held) if kind == "npz" else scipy.io.savemat(path, held)
    with pytest.raises(ValueError, match=r"it must hold mass once, but holds mass and M, which differ$"):
        ReducedBody.read(path)


@pytest.mark.parametrize("name", ["body.mat", "body", "body.npz.gz", ".npz"])
def test_a_body_is_saved_as_npz_only(name, tmp_path):
    with pytest.raises(ValueError, match=r"^path must end in \.npz, got '"):
        ReducedBody(MASS, STIFFNESS, TIP).save(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_which_files_go_together(tmp_path):
    market = matrix_market(tmp_path / "m.mtx", MASS)
    labelled = abaqus_input(tmp_path / "k.mtx", STIFFNESS)
    container = tmp_path / "body.npz"
    ReducedBody(MASS, STIFFNESS, TIP).save(container)
    cases = [
        ({}, "path must be one file with all matrices, or mass and stiffness must be one file each, got none of them"),
        ({"mass": market}, "path must be one file .* got mass"),
        ({"path": container, "stiffness": market}, "path must be one file .* got path and stiffness"),
        ({"path": container, "mass": market, "stiffness": market}, "path must be one .* path and mass and stiffness"),
        (
            {"path": market},
            "path must be a file with all matrices: .npz, .mat, .*, got '.*m.mtx'; give files of single matrices",
        ),
        (
            {"mass": container, "stiffness": market},
            "mass must be a file of matrices alone, got '.*body.npz'; give a file with all",
        ),
        ({"path": 3}, "path must be a str or PathLike, got 3"),
        ({"mass": MASS, "stiffness": STIFFNESS}, "mass must be a str or PathLike, got a ndarray"),
        ({"mass": market, "stiffness": labelled}, "mass, stiffness .* got mass without, stiffness with$"),
        ({"path": container, "points": 3}, "points must be a Mapping, got 3"),
    ]
    for words, message in cases:
        with pytest.raises(ValueError, match=f"^{message}") as caught:
            ReducedBody.read(**{"points": TIP, **words})
        assert "\n" not in str(caught.value)


def test_matrices_of_different_size_are_refused(tmp_path):
    small, large = matrix_market(tmp_path / "m.mtx", np.eye(3)), matrix_market(tmp_path / "k.mtx", np.eye(4))
    with pytest.raises(ValueError, match=r"^mass must have as many degrees of freedom as stiffness, 4, got 3"):
        ReducedBody.read(mass=small, stiffness=large, points=TIP)
    coordinate = abaqus_coordinate(tmp_path / "c.mtx", np.diag([1.0, 1.0, 1.0, 0.0]))
    body = ReducedBody.read(mass=large, stiffness=large, damping=coordinate, points=TIP)
    np.testing.assert_array_equal(body.damping, np.diag([1.0, 1.0, 1.0, 0.0]))


LABELLED = {
    "no node": ({"points": {"a": ((55, 1), None)}}, r"points\['a'\] must name .* \(no node 55\), got \(55, 1\)"),
    "no dof": (
        {"points": {"a": (None, (101, 3))}},
        r"points\['a'\] must name .* \(node 101 has 1, 2, 6\), got \(101, 3",
    ),
    "numbers": (
        {"points": {"a": (0, 1)}},
        r"points\['a'\] must be a pair of labels \(node, .*\), three .*, or a node's number, got \(0, 1\)",
    ),
    "one label": ({"points": {"a": (101, 1)}}, r"points\['a'\] must be a pair of labels .*, got \(101, 1\)"),
    "text": ({"points": {"a": "tip"}}, r"points\['a'\] must be a pair of labels .*, got 'tip'"),
    "translation": ({"translation": (0, 1)}, r"translation must name degrees .* of the nodes \(1, 2, 6\), got 0"),
    "translation shape": (
        {"translation": np.ones((2, 3))},
        r"translation must have the shape \(2, 18\) or \(3, 18\), got \(2, 3\)",
    ),
}


@pytest.mark.parametrize(("change", "message"), LABELLED.values(), ids=LABELLED)
def test_unknown_labels_are_named_with_those_there_are(change, message, tmp_path):
    paths = {"mass": abaqus_input(tmp_path / "m", MASS), "stiffness": abaqus_input(tmp_path / "k", STIFFNESS)}
    with pytest.raises(ValueError, match=f"^{message}"):
        ReducedBody.read(**paths, **{"points": {"a": ((101, 1), None)}, **change})


def test_points_and_translations_of_labelled_files_may_be_rows(tmp_path):
    paths = {"mass": abaqus_input(tmp_path / "m", MASS), "stiffness": abaqus_input(tmp_path / "k", PENALISED)}
    rows = np.arange(2.0 * SIZE).reshape(2, SIZE)
    body = ReducedBody.read(**paths, points={"a": rows})
    order = sorted(LABELS)
    free = [k for k, label in enumerate(order) if label[0] != 9]
    np.testing.assert_array_equal(body.points["a"], rows[:, free])


def test_a_mass_without_degrees_of_freedom_of_the_stiffness_is_singular(tmp_path):
    mass, stiffness = abaqus_coordinate(tmp_path / "m", np.eye(2)), abaqus_coordinate(tmp_path / "k", np.eye(3))
    for words in ({}, {"translation": np.ones((2, 3))}):
        with pytest.raises(
            ValueError, match=r"^mass must be positive definite, got the smallest eigenvalue 0; condense"
        ):
            ReducedBody.read(mass=mass, stiffness=stiffness, points=TIP, **words)
