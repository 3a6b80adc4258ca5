"""Matrices of CalculiX, Nastran and Ansys: a chain with known frequencies, and refused files."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest
import scipy.io
import scipy.sparse
from fuzz import formats

from stridula import ReducedBody
from stridula.bodies.matrix_files import read_matrices

# Masses of 0.5 kg one behind the other, springs of 20 kN/m before each, the first to a wall.
SIZE, MASS, SPRING = 6, 0.5, 2e4
NODES = [30, 7, 101, 12, 44, 9]
LABELS = [(node, 1) for node in NODES]
END = {"end": 9}
STIFFNESS_OF_CHAIN = SPRING * (2.0 * np.eye(SIZE) - np.eye(SIZE, k=1) - np.eye(SIZE, k=-1))
STIFFNESS_OF_CHAIN[-1, -1] = SPRING
MATRICES = {"mass": MASS * np.eye(SIZE), "stiffness": STIFFNESS_OF_CHAIN, "damping": 1e-4 * STIFFNESS_OF_CHAIN}
NAMES = {"mass": "MAAX", "stiffness": "KAAX", "damping": "BAAX"}
NAMED = {NAMES[role]: matrix for role, matrix in MATRICES.items()}
# Entries on and beside the diagonal and far from it, of both signs.
BLOCKS = np.kron(np.array([[2.5, 0.0, -1.25], [0.0, 3.0, 0.5], [-1.25, 0.5, 4.0]]), np.array([[2.0, 1.0], [1.0, 3.0]]))


def check_chain(body, rtol=1e-6):
    """The frequencies of a chain held at one end, and the static displacement of its free end under a force."""
    order = np.arange(1, SIZE + 1)
    wanted = np.sqrt(SPRING / MASS) / np.pi * np.sin((2 * order - 1) * np.pi / (2 * (2 * SIZE + 1)))
    modes, trace = body.modes(), body.trace("end")
    np.testing.assert_allclose(modes.frequency, wanted, rtol=rtol)
    soft = trace / modes.angular_frequency**2 @ trace.T
    np.testing.assert_allclose(soft, [[SIZE / SPRING, 0.0], [0.0, 0.0]], rtol=rtol, atol=1e-9)


def check_damping(body, rtol=1e-6):
    np.testing.assert_allclose(body.modes().damping, 0.5 * 1e-4 * body.modes().angular_frequency, rtol=rtol)


def written(folder, contents):
    for name, content in contents.items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder


def calculix(folder, **others):
    contents = {"job.sti": formats.calculix(MATRICES["stiffness"]), "job.mas": formats.calculix(MATRICES["mass"])}
    return written(folder, contents | {"job.dof": formats.dof(LABELS)} | others)


@pytest.mark.parametrize("given", ["job.sti", "job.mas", None])
def test_calculix(given, tmp_path):
    calculix(tmp_path)
    files = {"mass": tmp_path / "job.mas", "stiffness": tmp_path / "job.sti"}
    body = ReducedBody.read(tmp_path / given, points=END) if given else ReducedBody.read(**files, points=END)
    check_chain(body)


def test_calculix_without_names_of_rows_has_numbers(tmp_path):
    (calculix(tmp_path) / "job.dof").unlink()
    check_chain(ReducedBody.read(tmp_path / "job.sti", points={"end": (SIZE - 1, None)}))


def test_names_of_rows_may_lie_elsewhere(tmp_path):
    calculix(tmp_path)
    (tmp_path / "job.dof").rename(tmp_path / "rows.txt")
    body = ReducedBody.read(tmp_path / "job.sti", points=END, labels=tmp_path / "rows.txt")
    check_chain(body)
    market = {name: tmp_path / f"{name}.mtx" for name in ("mass", "stiffness")}
    for name, path in market.items():
        scipy.io.mmwrite(path, scipy.sparse.coo_array(MATRICES[name]), precision=15)
    assert ReducedBody.read(**market, points=END, labels=tmp_path / "rows.txt") == body


@pytest.mark.parametrize("fields", ["small", "large", "free"])
@pytest.mark.parametrize("form", [1, 6])
@pytest.mark.parametrize("kind", [1, 2])
def test_nastran_cards(fields, form, kind, tmp_path):
    """Fields of eight characters keep four digits of a number."""
    rtol = 1e-3 if fields == "small" else 1e-6
    others = {"K4AAX": 9.0 * np.eye(SIZE), "VAX": np.ones((SIZE, SIZE))}
    written(tmp_path, {"b.pch": formats.dmig(NAMED | others, LABELS, fields, form, kind)})
    for given in ({"path": tmp_path / "b.pch"}, dict.fromkeys(MATRICES, tmp_path / "b.pch")):
        body = ReducedBody.read(**given, points=END)
        check_chain(body, rtol)
        check_damping(body, rtol)
    check_chain(ReducedBody.read(tmp_path / "b.pch", points=END, damping=0.01), rtol)


def test_a_continued_card_is_one_column(tmp_path):
    """From the lines of a deck: numbers without the letter of their exponent, remarks, another card behind."""
    text = """SOL 103
DMIG    KAAX           0       6       1       0                       2
$ a remark
DMIG    KAAX           7       0               7       0    2.+4$ behind
DMIG*   KAAX                           9               1
*                      7               0        -1.0D+04
*                      9               1        1.00E+04
DMIG,MAAX,0,6,2,0
DMIG,MAAX,7,,,7,,5.0-1
DMIG,MAAX,9,1,,9,1,.5
GRID,7,,0.,0.,0.
ENDDATA
"""
    written(tmp_path, {"deck.bdf": text})
    body = ReducedBody.read(tmp_path / "deck.bdf", points={"end": ((9, 1), (7, 0))})
    np.testing.assert_array_equal(body.stiffness, [[2e4, -1e4], [-1e4, 1e4]])
    np.testing.assert_array_equal(body.mass, 0.5 * np.eye(2))


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("strings", ["", "short", "long"])
@pytest.mark.parametrize("kind", [1, 2])
def test_nastran_output4(order, strings, kind, tmp_path):
    rtol = 1e-6 if kind == 2 or not order else 1e-5
    empty = {"BXX": np.zeros((1, 1))}
    content = formats.output4(NAMED | empty, order, strings, kind, digits=9)
    body = ReducedBody.read(written(tmp_path, {"b.op4": content}) / "b.op4", points={"end": (SIZE - 1, None)})
    check_chain(body, rtol)
    check_damping(body, rtol)


@pytest.mark.parametrize("form", [1, 6])
@pytest.mark.parametrize("strings", ["", "short", "long"])
def test_nastran_output4_keeps_every_entry(form, strings, tmp_path):
    for order in ("", "<", ">"):
        content = formats.output4({"KGG": 1e5 * BLOCKS, "MGG": BLOCKS}, order, strings, form=form)
        body = ReducedBody.read(written(tmp_path, {"b.op4": content}) / "b.op4", points={"end": (0, 1)})
        np.testing.assert_array_equal(body.stiffness, 1e5 * BLOCKS)
        np.testing.assert_array_equal(body.mass, BLOCKS)


def test_a_triangle_of_a_symmetric_output4_is_filled_in(tmp_path):
    content = formats.output4({"KGG": np.tril(BLOCKS), "MGG": np.triu(BLOCKS)}, strings="short")
    body = ReducedBody.read(written(tmp_path, {"b.op4": content}) / "b.op4", points={"end": (0, 1)})
    np.testing.assert_array_equal(body.stiffness, BLOCKS)
    np.testing.assert_array_equal(body.mass, BLOCKS)


def test_the_only_matrix_of_a_file_may_have_any_name(tmp_path):
    for role, name in (("mass", "ANY"), ("stiffness", "A")):
        written(tmp_path, {f"{role}.op4": formats.output4({name: MATRICES[role]})})
    files = {role: tmp_path / f"{role}.op4" for role in ("mass", "stiffness")}
    check_chain(ReducedBody.read(**files, points={"end": (SIZE - 1, None)}))


@pytest.mark.parametrize("kind", ["RSA", "RUA"])
@pytest.mark.parametrize("across", [1, 3])
@pytest.mark.parametrize("right_hand_side", [True, False])
def test_ansys_harwell_boeing(kind, across, right_hand_side, tmp_path):
    files = {role: tmp_path / f"{role}.matrix" for role in MATRICES}
    for role, matrix in MATRICES.items():
        text = formats.harwell_boeing(matrix, kind, across, right_hand_side)
        written(tmp_path, {f"{role}.matrix": text, f"{role}.mapping": formats.mapping(LABELS)})
    body = ReducedBody.read(**files, points=END)
    check_chain(body)
    check_damping(body)


@pytest.mark.parametrize("ending", [".mapping", ".mmf.mapping"])
def test_ansys_matrix_market_with_one_mapping(ending, tmp_path):
    """The rows of one matrix from HBMAT are those of all matrices."""
    files = {role: tmp_path / f"{role}.mmf" for role in MATRICES}
    for role, path in files.items():
        with open(path, "wb") as file:
            scipy.io.mmwrite(file, scipy.sparse.coo_array(MATRICES[role]), precision=15, symmetry="symmetric")
    written(tmp_path, {f"stiffness{ending}": formats.mapping(LABELS)})
    check_chain(ReducedBody.read(**files, points=END))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_harwell_boeing_files_of_scipy(sign, tmp_path):
    """Their columns are narrower than their header announces."""
    matrix = np.diag(np.linspace(1.0, 3.0, 7)) + sign * 0.1 * (np.eye(7, k=1) + np.eye(7, k=-1))
    scipy.io.hb_write(tmp_path / "k.matrix", scipy.sparse.csc_matrix(matrix))
    body = ReducedBody.read(mass=tmp_path / "k.matrix", stiffness=tmp_path / "k.matrix", points={"tip": (0, 1)})
    np.testing.assert_array_equal(body.stiffness, matrix)


@pytest.mark.parametrize("line", ["-1.0E+00 2.0E+00 x", "1.0E+00 -2.0E+00", "1.0 2.0 3.0 4.0"])
def test_damaged_lines_of_such_files_are_named(line, tmp_path):
    scipy.io.hb_write(tmp_path / "k.matrix", scipy.sparse.csc_matrix(np.diag([1.0, 2.0, 3.0]) - 0.1))
    lines = (tmp_path / "k.matrix").read_text().splitlines()
    written(tmp_path, {"k.matrix": "\n".join([*lines[:-2], line, lines[-1]])})
    with pytest.raises(ValueError, match=r"line \d+ must be 3 numbers of 25 characters, got"):
        ReducedBody.read(mass=tmp_path / "k.matrix", stiffness=tmp_path / "k.matrix", points={"tip": (0, 1)})


def test_scipy_reads_the_harwell_boeing_files_of_these_tests(tmp_path):
    """Those that SciPy supports: without a right-hand side."""
    written(
        tmp_path, {"k.rsa": formats.harwell_boeing(BLOCKS, "RUA", 3, False).replace("D+", "E+").replace("D-", "E-")}
    )
    np.testing.assert_allclose(scipy.io.hb_read(tmp_path / "k.rsa").toarray(), BLOCKS, rtol=1e-12)


# Points of decks.

PLACES = {node: (0.1 * k, 0.02, 0.0) for k, node in enumerate(NODES)}
ABAQUS = "*HEADING\n chain\n*NODE, NSET=ALL\n** a remark\n{}\n*ELEMENT, TYPE=T3D2\n1, 30, 7\n"
DECKS = {
    "deck.inp": ABAQUS.format("\n".join(f"{node}, {x}, {y}, {z}" for node, (x, y, z) in PLACES.items())),
    "small.bdf": "$\n" + "".join(f"GRID    {n:8d}{'':8}{x:8.3f}{y:8.3f}{z:8.3f}\n" for n, (x, y, z) in PLACES.items()),
    "large.nas": "".join(
        f"GRID*   {n:16d}{'':16}{x:16.9f}{y:16.9f}\n*       {z:16.9f}\n" for n, (x, y, z) in PLACES.items()
    ),
    "free.dat": "".join(f"GRID,{n},,{x},2.0-2\n" for n, (x, _, _) in PLACES.items()),
}


@pytest.mark.parametrize("deck", list(DECKS))
def test_points_by_place(deck, tmp_path):
    written(calculix(tmp_path), {deck: DECKS[deck]})
    for place in (PLACES[9], np.array(PLACES[9]), [0.50001, 0.02, 0]):
        check_chain(ReducedBody.read(tmp_path / "job.sti", mesh=tmp_path / deck, points={"end": place}))


BAD_DECKS = {
    "no.inp": ("*HEADING\n", "it holds no nodes"),
    "word.inp": ("*NODE\n1, 0, x, 0\n", "line 2 must be the number of a node and its coordinates, got '1, 0, x, 0'"),
    "many.inp": ("*NODE\n1, 0, 0, 0, 0\n", "line 2 must be 'node, x, y, z', got '1, 0, 0, 0, 0'"),
    "twice.inp": ("*NODE\n1, 0\n1, 1\n", "nodes must have different numbers"),
    "made.inp": ("*NODE\n1, 0\n9, 1\n*NGEN\n1, 9\n", "line 4 must be of nodes that are all written out here, got"),
    "other.bdf": ("GRID,1,3,0.,0.,0.\n", "line 1 must be a GRID in the basic coordinate system, got 'GRID,1,3,0"),
    "cut.bdf": ("GRID*                  1\n", "line 2 must be the rest of the card, but the file ends before it"),
    "far.inp": ("*NODE\n1, 0\n2, 1e999\n", "line 3: nodes must be finite, got inf"),
}


@pytest.mark.parametrize("deck", list(BAD_DECKS))
def test_bad_decks_are_reported_in_one_line(deck, tmp_path):
    content, message = BAD_DECKS[deck]
    written(calculix(tmp_path), {deck: content})
    with pytest.raises(ValueError) as caught:
        ReducedBody.read(tmp_path / "job.sti", mesh=tmp_path / deck, points={"end": (0.0, 0.0, 0.0)})
    assert str(caught.value).startswith(f"cannot read '{tmp_path / deck}': {message}")
    assert "\n" not in str(caught.value)


# Refused files.


def refused(files, points=END, **words):
    with pytest.raises(ValueError) as caught:
        ReducedBody.read(**files, points=points, **words)
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < 400
    return message


STI = formats.calculix(STIFFNESS_OF_CHAIN)
OF_CALCULIX = {
    "word": ({"job.sti": STI + "7 7 x\n"}, "job.sti': line 12 must be 'row column value', got '7 7 x'"),
    "prose": ({"job.sti": "nothing\n"}, "job.sti': line 1 must be 'row column value', got 'nothing'"),
    "no number": ({"job.sti": "\n\n"}, "job.sti': it holds no number"),
    "row zero": ({"job.sti": "0 1 1.0\n"}, "job.sti': rows and columns must be numbered from 1, got 0"),
    "both triangles": (
        {"job.sti": STI + "2 1 1.0\n"},
        "job.sti': it must hold one triangle, as CalculiX writes it, but",
    ),
    "large": ({"job.sti": "300001 300001 1.0\n"}, "stiffness must have at most 300000 degrees of freedom, got 300001"),
    "fewer rows": (
        {"job.dof": formats.dof(LABELS[:-1])},
        "job.dof': it must name 6 rows, as many as mass has, but names 5",
    ),
    "cyclic": ({"job.dof": formats.dof(LABELS[:3])}, "but names 3: a model of cyclic symmetry is not read"),
    "no label": ({"job.dof": "30.1\n7\n"}, "job.dof': line 2 must be 'node.direction' or, first, 'Matrix Eqn"),
    "twice": (
        {"job.dof": formats.dof(LABELS[:5] + LABELS[:1])},
        "a different degree of freedom, but node 30 has 1 twice",
    ),
    "empty labels": ({"job.dof": ""}, "job.dof': the file is empty"),
    "no label at all": ({"job.dof": "\n"}, "job.dof': it names no row"),
}


@pytest.mark.parametrize(("change", "message"), OF_CALCULIX.values(), ids=OF_CALCULIX)
def test_bad_calculix_files_are_reported_in_one_line(change, message, tmp_path):
    calculix(tmp_path, **change)
    assert message in refused({"path": tmp_path / "job.sti"})


def test_calculix_without_its_other_file_names_it(tmp_path):
    (calculix(tmp_path) / "job.mas").unlink()
    with pytest.raises(FileNotFoundError, match=r"^cannot read '.*job.mas': no such file or directory$"):
        ReducedBody.read(tmp_path / "job.sti", points=END)


CARDS = formats.dmig(NAMED, LABELS, "free")
CHAIN = {name: NAMED[name] for name in ("KAAX", "MAAX")}
OF_CARDS = {
    "complex": (formats.dmig(NAMED, LABELS, kind=4), "mass must be real, got complex numbers in MAAX"),
    "rectangular": (
        formats.dmig(NAMED, LABELS, form=9),
        "it must hold a matrix whose name begins with M for mass, but",
    ),
    "no stiffness": (
        formats.dmig({"MAAX": MASS * np.eye(2)}, LABELS[:2]),
        "begins with K for stiffness, but holds MAAX",
    ),
    "two": (
        formats.dmig(CHAIN | {"MGG": np.eye(6)}, LABELS),
        "must hold one matrix whose name begins with M for mass, but",
    ),
    "one triangle": (
        formats.dmig({name: np.triu(part) for name, part in CHAIN.items()}, LABELS, form=1),
        "it must hold both triangles, as the form of KAAX is square, but holds one of each pair of entries only",
    ),
    "imaginary": (
        CARDS.replace("12,1,4.0000000000000000D+04,", "12,1,4.0D+04,1.0"),
        "the card at line 16 must hold real numbers, got '4.0D+04 and 1.0'",
    ),
    "word": (CARDS.replace("12,1,4.0000000000000000D+04", "12,1,none"), "must have a number, got 'none'"),
    "component": (CARDS.replace("12,1,", "12,7,"), "degree of freedom from 0 to 6, got '12, 7'"),
    "node": (CARDS.replace("12,1,", "-12,1,"), "must name a node from 1 on and a degree of freedom from 0 to 6"),
    "cut": (CARDS + "DMIG,KAAX\n", "must be 'DMIG, name, node, dof, , node, dof, value', got 'DMIG,KAAX'"),
    "twice": (
        CARDS + "DMIG,MAAX,9,1,,9,1,1.0\n",
        "each entry must occur once (assembled matrices), got two at (9, 1), (9, 1)",
    ),
}


@pytest.mark.parametrize(("content", "message"), OF_CARDS.values(), ids=OF_CARDS)
def test_bad_cards_are_reported_in_one_line(content, message, tmp_path):
    written(tmp_path, {"b.pch": content})
    assert message in refused({"path": tmp_path / "b.pch"})


def text4(text="", **words):
    return formats.output4(CHAIN, **words) + text.encode()


OF_OUTPUT4 = {
    "heading": (
        text4("      no heading\n"),
        "line 31 must be columns, rows, form, type and name of a matrix, got 'no head",
    ),
    "type": (
        text4("       6       6       6       9KGG\n"),
        "the heading of KGG must have numbers of columns and rows and a",
    ),
    "word": (
        text4().replace(b"-2.0000000000000000E+04", b"-2.00000000x0000000E+04", 1),
        "line 3 must be 3 numbers of 23 ch",
    ),
    "row": (
        text4().replace(b"       3       2       3", b"       3       5       3", 1),
        "KAAX has 6 rows, but a column has 3",
    ),
    "cut": (text4()[:300], "the file ends before"),
    "cut record": (text4(order="<")[:200], "it ends within a record"),
    "word in column": (
        text4().replace(b"       3       2       3", b"       3       2       x", 1),
        "whole numbers, got 'x'",
    ),
    "64 bits": (
        formats._record("<", bytes(48)),
        "it has 64-bit integers; write it with 32-bit integers or as text",
    ),
    "string": (
        text4(strings="short").replace(b"  327681", b"  327686", 1),
        "KAAX has 6 rows, but a column has 2 numbers from row 6",
    ),
    "complex": (text4().replace(b"6       2MAAX", b"6       4MAAX"), "mass must be real, got complex numbers in MAAX"),
    "one triangle": (
        formats.output4({name: np.tril(part) for name, part in CHAIN.items()}, form=1),
        "it must hold both triangles, as the form of KAAX is square, but holds the lower triangle only",
    ),
}


@pytest.mark.parametrize(("content", "message"), OF_OUTPUT4.values(), ids=OF_OUTPUT4)
def test_bad_output4_files_are_reported_in_one_line(content, message, tmp_path):
    written(tmp_path, {"b.op4": content})
    assert message in refused({"path": tmp_path / "b.op4"}, {"end": (5, None)})


RSA = formats.harwell_boeing(STIFFNESS_OF_CHAIN)
RUA = formats.harwell_boeing(STIFFNESS_OF_CHAIN, "RUA")
OF_ANSYS = {
    "complex": ({"stiffness.matrix": RSA.replace("RSA", "CSA")}, "stiffness must be real, got CSA: complex numbers"),
    "pattern": ({"stiffness.matrix": RSA.replace("RSA", "PSA")}, "stiffness must be real, got PSA: a pattern"),
    "elements": ({"stiffness.matrix": RSA.replace("RSA", "RSE")}, "stiffness must be assembled and symmetric or unsym"),
    "word": (
        {"stiffness.matrix": RSA.replace("4.000", "x.000")},
        "line 24 must be a number of 25 characters, got 'x.000",
    ),
    "cut": ({"stiffness.matrix": RSA[:700]}, "the file ends before"),
    "formats": ({"stiffness.matrix": RSA.replace("(I14)", "(A14)")}, "line 4 must be three formats such as (8I10)"),
    "pointers": (
        {"stiffness.matrix": RSA.replace(" 3\n", " 9\n", 1)},
        "its columns must begin from 1 on to 12, rising",
    ),
    "triangle": (
        {"stiffness.matrix": formats.harwell_boeing(np.tril(STIFFNESS_OF_CHAIN), "RUA")},
        "it must hold both triangles, as its header declares it unsymmetric, but holds the lower triangle only",
    ),
    "both": (
        {"stiffness.matrix": RUA.replace("RUA", "RSA")},
        "it must hold one triangle, as its header declares it symmetric, but holds entries of both",
    ),
    "unknown": (
        {"stiffness.mapping": formats.mapping(LABELS).replace("UX", "TEMP")},
        "line 2 must name one of UX, UY,",
    ),
    "rows": (
        {"stiffness.mapping": formats.mapping(LABELS[:4])},
        "it must name 6 rows, as many as stiffness has, but names 4",
    ),
    "order": (
        {"stiffness.mapping": formats.mapping(LABELS).replace(" 2   ", " 3   ", 1)},
        "line 3 must be '2 node dof'",
    ),
}


@pytest.mark.parametrize(("change", "message"), OF_ANSYS.values(), ids=OF_ANSYS)
def test_bad_ansys_files_are_reported_in_one_line(change, message, tmp_path):
    contents = {"stiffness.matrix": RSA, "mass.matrix": formats.harwell_boeing(MATRICES["mass"])}
    contents |= {f"{role}.mapping": formats.mapping(LABELS) for role in ("mass", "stiffness")}
    written(tmp_path, contents | change)
    assert message in refused({role: tmp_path / f"{role}.matrix" for role in ("mass", "stiffness")})


def test_matrices_of_two_sizes_are_refused(tmp_path):
    written(tmp_path, {"m.matrix": formats.harwell_boeing(np.eye(3)), "k.matrix": RSA})
    message = refused({"mass": tmp_path / "m.matrix", "stiffness": tmp_path / "k.matrix"}, {"end": (5, None)})
    assert message.startswith("mass must have as many degrees of freedom as stiffness, 6, got 3")


@pytest.mark.parametrize(
    ("ending", "words"), [("full", "write its matrices with HBMAT"), ("op2", "as OUTPUT4 or DMIG")]
)
def test_unsupported_binary_files_name_supported_ones(ending, words, tmp_path):
    written(tmp_path, {f"b.{ending}": bytes(100)})
    assert words in refused({"path": tmp_path / f"b.{ending}"})


def test_mismatched_companion_files_are_refused(tmp_path):
    calculix(tmp_path)
    held = {"path": tmp_path / "body.npz"}
    ReducedBody(MATRICES["mass"], MATRICES["stiffness"], {"end": (5, None)}).save(held["path"])
    assert refused(held, {}, labels=tmp_path / "job.dof").startswith("labels must be left out where a file holds")
    assert refused(held, {}, mesh=tmp_path / "job.dof").startswith("mesh must be left out where a file holds")
    written(tmp_path, {"b.pch": CARDS, "deck.inp": DECKS["deck.inp"]})
    assert refused({"path": tmp_path / "b.pch"}, labels=tmp_path / "job.dof").startswith(
        "labels must be left out where m"
    )
    (tmp_path / "job.dof").unlink()
    message = refused({"path": tmp_path / "job.sti"}, {"end": (5, None)}, mesh=tmp_path / "deck.inp")
    assert message.startswith("mesh must be left out where files do not name the nodes of their rows")


POINTS = {
    "no node": (55, "points['a'] must name a node in the files that moves (no node 55, or all of it is held), got 55"),
    "far": (
        (0.1, 0.02, 0.3),
        "points['a'] must be within 0.0005 m of a node, got (0.1, 0.02, 0.3), 0.3 m from the nearest, 7",
    ),
    "word": (
        "tip",
        "points['a'] must be a pair of labels (node, degree of freedom), three of them in space, or a node's nu",
    ),
    "truth": (True, "points['a'] must be a pair of labels"),
    "not finite": ((0.1, np.nan, 0.3), "points['a'] must be finite"),
}


@pytest.mark.parametrize(("point", "message"), POINTS.values(), ids=POINTS)
def test_missing_points_are_refused(point, message, tmp_path):
    written(calculix(tmp_path), {"deck.inp": DECKS["deck.inp"]})
    assert refused({"path": tmp_path / "job.sti"}, {"a": point}, mesh=tmp_path / "deck.inp").startswith(message)


def test_a_node_moves_along_what_it_has(tmp_path):
    """A second node with rotations only does not move; a third direction anywhere makes the body one in space."""
    labels = [(1, 1), (1, 2), (1, 3), (2, 4), (2, 5), (2, 6)]
    calculix(tmp_path, **{"job.dof": formats.dof(labels)})
    body = ReducedBody.read(tmp_path / "job.sti", points={"a": 1})
    np.testing.assert_array_equal(body.points["a"], np.eye(SIZE)[:3])
    assert "node 2 has 4, 5, 6" in refused({"path": tmp_path / "job.sti"}, {"a": 2})


def test_large_files_take_memory_of_their_entries(tmp_path):
    """A chain of 200 000 masses: a dense matrix would take 320 GB."""
    size = 200_000
    lines = "".join(f"{k} {k} 2e4\n{k} {k + 1} -1e4\n" for k in range(1, size))
    written(tmp_path, {"job.sti": f"{lines}{size} {size} 2e4\n"})
    written(tmp_path, {"job.mas": "".join(f"{k} {k} 0.5\n" for k in range(1, size + 1))})
    written(tmp_path, {"job.dof": "".join(f"{k}.1\n" for k in range(1, size + 1))})
    tracemalloc.start()
    held = read_matrices({"mass": tmp_path / "job.mas", "stiffness": tmp_path / "job.sti"})
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert held.matrices["stiffness"].nnz == 3 * size - 2
    assert most < 150e6
