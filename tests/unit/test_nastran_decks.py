"""Decks of Nastran: each feature with its value, random meshes in random formats, bad decks refused in one line."""

from __future__ import annotations

import os
from math import atan2, degrees, hypot

import numpy as np
import pytest

from stridula.bodies.decks.nastran import read_nastran
from stridula.bodies.reading.deck_error import DeckError

BLANK_CONTINUATION = """\
$ the continuation of CHEXA has a blank first field, which Nastran accepts
BEGIN BULK
GRID           1           0.000   0.000   0.000
GRID           2           0.040   0.000   0.000
GRID           3           0.040   0.030   0.000
GRID           4           0.000   0.030   0.000
GRID           5           0.000   0.000   0.020
GRID           6           0.040   0.000   0.020
GRID           7           0.040   0.030   0.020
GRID           8           0.000   0.030   0.020
CHEXA          1       1       1       2       3       4       5       6
               7       8
ENDDATA
"""
CUBE = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], dtype=float)
GRIDS = "".join(f"GRID,{n},,{x},{y},{z}\n" for n, (x, y, z) in enumerate(CUBE, 1))
TETRA = "CTETRA,1,1,1,2,4,5\n"

# Corners and edges in the order of the cards of Nastran, and edges in the order of VTK.
PRISM, PYRAMID = CUBE[[0, 1, 3, 4, 5, 7]], np.vstack([CUBE[:4], [0.5, 0.5, 1.0]])
TETRA_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
PYRAMID_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)]
BELOW, ABOVE, UPRIGHT = (
    [(0, 1), (1, 2), (2, 3), (3, 0)],
    [(4, 5), (5, 6), (6, 7), (7, 4)],
    [(n, n + 4) for n in range(4)],
)
BELOW_3, ABOVE_3, UPRIGHT_3 = [(0, 1), (1, 2), (2, 0)], [(3, 4), (4, 5), (5, 3)], [(n, n + 3) for n in range(3)]
ELEMENTS = {
    "CTETRA": (CUBE[[0, 1, 3, 4]], TETRA_EDGES, TETRA_EDGES, ("tetra", "tetra10")),
    "CHEXA": (CUBE, BELOW + UPRIGHT + ABOVE, BELOW + ABOVE + UPRIGHT, ("hexahedron", "hexahedron20")),
    "CPENTA": (PRISM, BELOW_3 + UPRIGHT_3 + ABOVE_3, BELOW_3 + ABOVE_3 + UPRIGHT_3, ("wedge", "wedge15")),
    "CPYRAM": (PYRAMID, PYRAMID_EDGES, PYRAMID_EDGES, ("pyramid", "pyramid13")),
}


def read(folder, text, name="deck.bdf"):
    path = folder / name
    path.write_text(text)
    return read_nastran(path)


def with_middles(corners, edges):
    return np.vstack([corners, [corners[list(edge)].mean(axis=0) for edge in edges]])


def test_a_blank_first_field_continues_a_card(tmp_path):
    deck = read(tmp_path, BLANK_CONTINUATION)
    assert [block.kind for block in deck.blocks] == ["hexahedron"]
    np.testing.assert_array_equal(deck.blocks[0].nodes, [range(8)])
    np.testing.assert_array_equal(np.ptp(deck.points, axis=0), [0.04, 0.03, 0.02])


HEXA = {
    "comma": "CHEXA,1,1,1,2,3,4,5,6\n,7,8",
    "plus": "CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8",
    "plus, without a marker": "CHEXA,1,1,1,2,3,4,5,6\n+,7,8",
    "labels": "CHEXA,1,1,1,2,3,4,5,6,+A\n+A,7,8",
    "one line": "CHEXA,1,1,1,2,3,4,5,6,7,8",
    "ends with a comma": "CHEXA,1,1,1,2,3,4,5,6,\n,7,8,",
    "large": "CHEXA*,1,1,1,2,*A\n*A,3,4,5,6\n*,7,8",
    "lower case": "chexa,1,1,1,2,3,4,5,6,+a\n+A,7,8",
    "blanks": " CHEXA , 1, 1, 1,2,3,4,5,6\n , 7, 8 $ the end",
    "a remark between": "CHEXA,1,1,1,2,3,4,5,6\n$ a remark, with a comma\n\n,7,8",
    "small": "CHEXA          1       1       1       2       3       4       5       6+X\n+X             7       8",
    "old labels": "CHEXA   1       1       1       2       3       4       5       6       ABC\n+BC     7       8",
    "left": "CHEXA   1       1       1       2       3       4       5       6\n+       7       8",
    "tabs": "CHEXA\t1\t1\t1\t2\t3\t4\t5\t6\n\t7\t8",
    "large fields": "CHEXA*  "
    + "".join(f"{n:16}" for n in (1, 1, 1, 2))
    + "*\n*       "
    + "".join(f"{n:16}" for n in (3, 4, 5, 6))
    + "\n*       "
    + "".join(f"{n:16}" for n in (7, 8)),
    "large, then small": "CHEXA*,1,1,1,2\n*,3,4,5,6\n,7,8",
}


@pytest.mark.parametrize("card", HEXA.values(), ids=HEXA)
def test_all_forms_of_lines_and_continuations(tmp_path, card):
    deck = read(tmp_path, f"SOL 101\nCEND\nBEGIN BULK\n{GRIDS}{card}\nENDDATA\nnot read, 1\n")
    np.testing.assert_array_equal(deck.points[deck.blocks[0].nodes], [CUBE])


NUMBERS = {
    "1.5-3": 1.5e-3,
    "1.+3": 1e3,
    ".5D2": 50.0,
    "-1.5d-2": -0.015,
    "2.1E+1": 21.0,
    "+7": 7.0,
    "-.25": -0.25,
    "": 0,
}


@pytest.mark.parametrize(("text", "value"), NUMBERS.items())
def test_numbers(tmp_path, text, value):
    deck = read(tmp_path, f"GRID,1,,1.0,{text},3.0\nGRID*   {2:16}{'':16}{text:>16}{1.0:16}*\n*       {3.0:16}\n")
    np.testing.assert_array_equal(deck.points, [[1.0, value, 3.0], [value, 1.0, 3.0]])


def test_a_deck_may_begin_with_bulk_data_and_a_byte_order_mark(tmp_path):
    path = tmp_path / "deck.nas"
    path.write_bytes(b"\xef\xbb\xbfGRID,9,,1.,2.,3.\r\nPARAM,POST,-1\r\n")
    np.testing.assert_array_equal(read_nastran(path).points, [[1.0, 2.0, 3.0]])


@pytest.mark.parametrize("has_middles", [False, True])
@pytest.mark.parametrize("card", ELEMENTS)
def test_middle_nodes_are_in_the_order_of_vtk(tmp_path, card, has_middles):
    corners, edges, edges_of_vtk, kinds = ELEMENTS[card]
    places = with_middles(corners, edges) if has_middles else corners
    grids = "".join(f"GRID,{10 + n},,{x},{y},{z}\n" for n, (x, y, z) in enumerate(places))
    deck = read(tmp_path, f"{grids}{card}*,7,3,{','.join(str(10 + n) for n in range(len(places)))}\n")
    expected = with_middles(corners, edges_of_vtk) if has_middles else corners
    assert deck.blocks[0].kind == kinds[has_middles]
    np.testing.assert_array_equal(deck.points[deck.blocks[0].nodes], [expected])


@pytest.mark.parametrize("has_middles", [False, True])
@pytest.mark.parametrize("card", ELEMENTS)
def test_elements_with_corners_in_the_other_sense_are_mirrored(tmp_path, card, has_middles):
    """The mirrored deck has the faces and edges of the mirrored element, with a positive volume."""
    corners, edges, edges_of_vtk, _ = ELEMENTS[card]
    places = (with_middles(corners, edges) if has_middles else corners) * [-1.0, 1.0, 1.0]
    grids = "".join(f"GRID,{10 + n},,{x},{y},{z}\n" for n, (x, y, z) in enumerate(places))
    deck = read(tmp_path, f"{grids}{card}*,7,3,{','.join(str(10 + n) for n in range(len(places)))}\n")
    found = deck.points[deck.blocks[0].nodes[0]]
    ring = 3 if card in ("CTETRA", "CPENTA") else 4
    first, second, up = found[1] - found[0], found[ring - 1] - found[0], found[ring] - found[0]
    assert np.dot(np.cross(first, second), up) > 0.0
    assert sorted(deck.blocks[0].nodes[0]) == list(range(len(places)))
    np.testing.assert_array_equal(found[: len(corners), 2], corners[:, 2])
    if has_middles:
        np.testing.assert_array_equal(found, with_middles(found[: len(corners)], edges_of_vtk))


def test_middle_nodes_of_zero_are_none(tmp_path):
    deck = read(tmp_path, f"{GRIDS}CTETRA,1,1,1,2,4,5,0,0\n,0,,,\n")
    assert deck.blocks[0].kind == "tetra"


def test_pyramids_of_optistruct(tmp_path):
    assert read(tmp_path, f"{GRIDS}CPYRA,1,1,1,2,3,4,5\n").blocks[0].kind == "pyramid"


def test_properties_are_parts_with_materials(tmp_path):
    deck = read(
        tmp_path,
        f"{GRIDS}CTETRA,1,12,1,2,4,5\nCHEXA,2,3,1,2,3,4,5,6\n,7,8\nCTETRA,4,3,2,3,4,7\nCTETRA,5,,1,2,3,6\n"
        "PSOLID,3,1\nPSOLID,12,2\nPSOLID,99,2\n"
        "MAT1,1,2.1+11,,.3,7800.\nMAT1,2,2.6+11,1.+11\nMAT1,3,,1.+10,.25\nMAT1,4\n",
    )
    assert [block.kind for block in deck.blocks] == ["tetra", "hexahedron"]
    assert {name: part.tolist() for name, part in deck.parts.items()} == {"3": [1, 3], "5": [2], "12": [0]}
    assert list(deck.element_sets) == list(deck.parts)
    assert deck.material_of == {"3": "1", "12": "2"}
    values = [(one.young, one.poisson, one.density) for one in deck.materials.values()]
    expected = [(2.1e11, 0.3, 7800.0), (2.6e11, 0.3, np.nan), (2.5e10, 0.25, np.nan), (np.nan,) * 3]
    np.testing.assert_allclose(values, expected, rtol=1e-12)


def test_the_parameter_wtmass_multiplies_densities(tmp_path):
    for deck in ("PARAM,WTMASS,.5\nCEND\nBEGIN BULK\nMAT1,1,1.,,.3,8.\n", "MAT1,1,1.,,.3,8.\nPARAM   WTMASS  .5\n"):
        assert read(tmp_path, deck).materials["1"].density == 4.0


def test_constraints_are_node_sets(tmp_path):
    deck = read(
        tmp_path,
        f"{GRIDS}SPC,5,1,123,0.,3,3\nSPC1,5,123456,8\nSPC1,6,123,2,THRU,99\nSPC1,7,3,1,2,3,4,5,6\n,7,8\nSPC1,7,1,900\n",
    )
    found = {name: nodes.tolist() for name, nodes in deck.node_sets.items()}
    assert found == {"SPC 5": [0, 2, 7], "SPC 6": list(range(1, 8)), "SPC 7": list(range(8))}
    assert dict(deck.left_out) == {"SPC1": 1}


def test_shells_are_surfaces(tmp_path):
    shells = "CTRIA3,21,7,1,2,3\nCQUAD4,22,7,1,2,3,4\nCTRIA6,23,8,5,6,7,1,2,3\nCQUAD8,24,9,5,6,7,8,1,2\n,3,4\n"
    deck = read(tmp_path, GRIDS + TETRA + shells)
    found = {name: [(block.kind, block.nodes.tolist()) for block in blocks] for name, blocks in deck.surfaces.items()}
    assert found == {
        "7": [("triangle", [[0, 1, 2]]), ("quad", [[0, 1, 2, 3]])],
        "8": [("triangle", [[4, 5, 6]])],
        "9": [("quad", [[4, 5, 6, 7]])],
    }
    assert not deck.left_out


def test_other_elements_are_counted(tmp_path):
    deck = read(
        tmp_path,
        f"SET 1 = 1 THRU 10,\n 15\nSET 2 = ALL\nCEND\nBEGIN BULK\n{GRIDS}{TETRA}CBAR,2,1,1,2\nCELAS2,3,1.,1,1,2,1\n"
        "CONM2*,4,1,,.5\nRBE2,5,1,123,2,3,4,5,6\n,7\nRBE3,6,,1,123,1.,123,2\nCBAR,7,1,1,3\nMAT9,3,1.\nMPC,1,1,1,1.\n"
        "FORCE,1,1,,1.,1.,0.,0.\nPLOAD4,1,1,1.\nCORD2R,3,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n",
    )
    assert deck.left_out == {"SET": 2, "CBAR": 2, "RBE2": 1, "RBE3": 1, "MAT9": 1, "MPC": 1}
    assert [(one.word, one.labels, one.value) for one in deck.lumps] == [
        ("CONM2", ("node 1",), 0.5),
        ("CELAS2", ("node 1", "node 2"), 1.0),
    ]
    assert deck.count == 1


def test_a_deck_without_solid_elements_is_read(tmp_path):
    deck = read(tmp_path, "nothing")
    assert (deck.count, len(deck.points), deck.parts) == (0, 0, {})


def test_equal_grids_may_be_repeated(tmp_path):
    assert len(read(tmp_path, GRIDS + GRIDS + TETRA).points) == 8


def test_huge_numbers_give_no_warnings(tmp_path):
    deck = read(
        tmp_path, f"{GRIDS.replace('1.0', '1.+300')}{TETRA}GRID,20,3,1.+300,1.+300,1.+300\n{SYSTEMS['spherical'][0]}\n"
    )
    assert deck.count == 1


SYSTEMS = {
    "rectangular": ("CORD2R,3,,1.,2.,3.,2.,2.,3.\n,1.,3.,3.", "10.,20.,30.", [31.0, 12.0, 23.0]),
    "cylindrical": ("CORD2C,3,0,0.,0.,1.,0.,0.,2.\n,0.,1.,1.", "2.,90.,5.", [-2.0, 0.0, 6.0]),
    "spherical": ("CORD2S,3,0,0.,0.,1.,0.,0.,2.\n,1.,0.,1.", "2.,90.,90.", [0.0, 2.0, 1.0]),
    "spherical, up": ("CORD2S,3,0,0.,0.,1.,0.,0.,2.\n,1.,0.,1.", "2.,0.,90.", [0.0, 0.0, 3.0]),
    "by grids": ("CORD1R,3,1,5,4", "1.,2.,3.", [-2.0, 1.0, 3.0]),
    "two of a card": ("CORD1C,9,1,2,3,3,1,5,4", "2.,0.,1.", [0.0, 2.0, 1.0]),
    "spherical by grids": ("CORD1S,3,1,5,2", "2.,90.,90.", [0.0, 2.0, 0.0]),
    "one after the other": (
        "CORD2R,3,4,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2C,4,,5.,0.,0.,5.,0.,1.\n,5.,1.,0.",
        "1.,0.,0.",
        [5.0, 1.0, 0.0],
    ),
    "in one line": ("CORD2R,3,,1.,0.,0.,1.,0.,1.,2.,0.,0.", "1.,1.,1.", [2.0, 1.0, 1.0]),
}


@pytest.mark.parametrize(("cards", "coordinates", "place"), SYSTEMS.values(), ids=SYSTEMS)
def test_coordinate_systems(tmp_path, cards, coordinates, place):
    deck = read(tmp_path, f"GRID,50,3,{coordinates},7\n{GRIDS}{cards}\n")
    np.testing.assert_allclose(deck.points[0], place, atol=1e-12)


def test_the_default_system_of_grids(tmp_path):
    deck = read(
        tmp_path, "GRID,1,,1.,0.,0.\nGRID,2,0,1.,0.,0.\nGRDSET,,3\nCORD2R,3,,5.,0.,0.,5.,0.,1.\n,6.,0.,0.\nENDDATA\n"
    )
    np.testing.assert_array_equal(deck.points[:, 0], [6.0, 1.0])


@pytest.mark.parametrize("line", ["INCLUDE 'parts/grids.inc'", 'include "parts\\grids.inc"', "INCLUDE parts/grids.inc"])
def test_included_files(tmp_path, line):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "grids.inc").write_text("$ grids\nINCLUDE 'more.inc'\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n")
    (tmp_path / "parts" / "more.inc").write_text("GRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\n")
    deck = read(tmp_path, f"INCLUDE 'not/there'\nBEGIN BULK\n{line}\n{TETRA}")
    np.testing.assert_array_equal(deck.points[deck.blocks[0].nodes[0]], CUBE[[0, 1, 3, 4]])


def test_names_of_included_files_may_go_on_in_the_next_line(tmp_path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "grids.inc").write_text(GRIDS)
    assert len(read(tmp_path, "INCLUDE 'parts/\n   grids.inc'\n").points) == 8


def refusal(folder, text):
    with pytest.raises(DeckError) as caught:
        read(folder, text)
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < 400
    return message


BAD = {
    "grid twice": (f"{GRIDS}GRID,3,,7.,1.,0.\n", "line 9: GRID 3 is also in line 3, at another place"),
    "no grid": (f"{GRIDS}CTETRA,1,1,1,2,4,77\n", "line 9: CTETRA 1 refers to the grid 77, which is missing"),
    "no grid of a shell": (f"{GRIDS}CTRIA3,1,1,1,2,77\n", "line 9: CTRIA3 1 refers to the grid 77, which is missing"),
    "no number": ("GRID,1,,0.,1.0x,0.\n", "line 1: X2 of GRID 1 must be a number, got '1.0x'"),
    "nan": ("GRID,1,,0.,nan,0.\n", "line 1: X2 of GRID 1 must be a number, got 'nan'"),
    "huge": ("GRID,1,,0.,1.+999,0.\n", "line 1: X2 of GRID 1 must be a number, got '1.+999'"),
    "underscore": ("GRID,1,,0.,1_0.,0.\n", "line 1: X2 of GRID 1 must be a number, got '1_0.'"),
    "no whole number": ("\nGRID,1.5,,0.,1.,0.\n", "line 2: ID of GRID 1.5 must be a whole number, got '1.5'"),
    "huge number": (f"GRID,{'9' * 30},,0.,1.,0.\n", "must be a whole number, got '9999"),
    "blank number": ("GRID,,,0.,1.,0.\n", "line 1: ID of GRID must be a whole number, got ''"),
    "too few corners": (f"{GRIDS}CHEXA,4,1,1,2,3,4,5\n", "line 9: CHEXA 4 must have 8 corners, got 5"),
    "some middles": (
        f"{GRIDS}CTETRA,4,1,1,2,4,5,6,7\n,8\n",
        "line 9: CTETRA 4 must have all 6 nodes in the middle of edges, or none, got 3: convert the mesh to",
    ),
    "too many grids": (f"{GRIDS}CTETRA,4,1,1,2,4,5,6,7,8,1,2,3,4\n", "line 9: CTETRA 4 must have at most 10 grids"),
    "element twice": (f"{GRIDS}{TETRA}CTETRA,1,1,2,3,4,5\n", "line 10: the element 1 is also in line 9"),
    "no system": ("GRID,1,,0.\nGRID,2,7,1.\n", "line 2: GRID 2 refers to the coordinate system 7, which is missing"),
    "no system of a system": (
        "CORD2C,1,4,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n",
        "line 1: CORD2C 1 refers to the coordinate system 4, which is missing",
    ),
    "systems in a circle": (
        "CORD2R,1,2,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,2,1,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n",
        "refers to itself, by ",
    ),
    "a system by its own grids": (
        "CORD1R,1,1,2,3\nGRID,1,1\nGRID,2,,0.,0.,1.\nGRID,3,,1.,0.,0.\n",
        "line 1: CORD1R 1 refers to itself, by 1 and 1",
    ),
    "a system by missing grids": ("CORD1R,1,1,2,3\n", "line 1: CORD1R 1 refers to the grid 1, which is missing"),
    "points on a line": (
        "CORD2S,1,,0.,0.,0.,0.,0.,1.\n,0.,0.,3.\n",
        "line 1: the three points of CORD2S 1 must not lie on a line",
    ),
    "system twice": ("CORD1R,1,1,2,3\nCORD1R,1,1,2,3\n", "line 2: the coordinate system 1 is also in line 1"),
    "material twice": ("MAT1,1,1.,,.3\nMAT1,1,2.,,.3\n", "line 2: MAT1 1 is given twice, with other values"),
    "property twice": ("PSOLID,1,1\nPSOLID,1,2\n", "line 2: PSOLID 1 is given twice, with other materials"),
    "continuation alone": ("BEGIN BULK\n+,1\n", "line 2: the line '+,1' has no card before it"),
    "another marker": (
        f"{GRIDS}CHEXA,1,1,1,2,3,4,5,6,+A\n+B,7,8\n",
        "line 10: the continuation '+B' must follow the line that ends with it, got one that ends with '+A'",
    ),
    "repeated cards": ("GRID,1,,0.,0.,0.\n=,*1,=,*1.,==\n", "line 2: a line after GRID must begin with the name of a"),
    "too many fields": ("GRID,1,,0.,0.,0.,,,,+A,5\n", "line 1: a line with more than 8 fields must have a marker or"),
    "superelements": ("BEGIN BULK\nGRID,1\nBEGIN SUPER=1\n", "line 3: 'BEGIN SUPER=1' begins another model"),
    "no end of a range": (
        "SPC1,1,123,1,THRU\n",
        "line 1: the number after THRU of SPC1 1 must be a whole number, got ''",
    ),
    "no file": ("INCLUDE 'there.inc'\n", "there.inc': no such file or directory"),
    "a file above": (
        "INCLUDE '../up.inc'\n",
        "line 1: INCLUDE must name a file below the folder of the deck, got '../up",
    ),
    "a file elsewhere": ("INCLUDE '/etc/passwd'\n", "line 1: INCLUDE must name a file below the folder of the deck"),
    "no name of a file": ("INCLUDE '\0'\n", "line 1: INCLUDE must name a file, got"),
    "a folder": ("INCLUDE '.'\n", "is a directory"),
    "itself": ("INCLUDE 'deck.bdf'\n", "line 1: 'deck.bdf' must be included only once"),
}


@pytest.mark.parametrize(("text", "words"), BAD.values(), ids=BAD)
def test_bad_decks_are_refused_in_one_line(tmp_path, text, words):
    assert words in refusal(tmp_path, text)


def test_errors_name_the_included_file(tmp_path):
    (tmp_path / "grids.inc").write_text("\nGRID,1,,a\n")
    message = refusal(tmp_path, "INCLUDE 'grids.inc'\n")
    assert message == "line 2: in the included file 'grids.inc', X1 of GRID 1 must be a number, got 'a'"


def test_files_that_include_each_other_are_refused(tmp_path):
    for n in range(30):
        (tmp_path / f"{n}.inc").write_text(f"INCLUDE '{n + 1}.inc'\n")
    assert "at most 20 files may include each other" in refusal(tmp_path, "INCLUDE '0.inc'\n")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="Windows has no pipes in folders")
def test_pipes_are_not_included(tmp_path):
    os.mkfifo(tmp_path / "pipe.inc")
    assert "must be a regular file, got a pipe" in refusal(tmp_path, "INCLUDE 'pipe.inc'\n")


@pytest.mark.skipif(os.name == "nt", reason="links need rights on Windows")
def test_links_out_of_the_folder_are_not_included(tmp_path):
    inside, outside = tmp_path / "inside", tmp_path / "secret.inc"
    inside.mkdir()
    outside.write_text(GRIDS)
    (inside / "link.inc").symlink_to(outside)
    assert "below the folder of the deck" in refusal(inside, "INCLUDE 'link.inc'\n")


def test_a_missing_deck_is_an_os_error(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_nastran(tmp_path / "none.bdf")


class Writer:
    """Cards in random formats."""

    def __init__(self, random):
        self.random = random
        self.labels = 0

    def of(self, *words):
        return words[self.random.integers(len(words))]

    def number(self, value):
        """A number of three decimals, in at most eight characters."""
        whole = f"{value * 1000:.0f}"
        return self.of(f"{value:.3f}", f"{whole}.-3", f"{whole}.E-3", f"{value:.3f}+0", f"{value:.3f}"[:8])

    def card(self, name, fields):
        """The lines of a card, of eight small or of four large fields."""
        fields, lines, end = [str(word) for word in fields], [], ""
        rows = [fields[at : at + 8] for at in range(0, len(fields), 8)]
        for at, row in enumerate(rows):
            is_last = at + 1 == len(rows)
            large = max(map(len, row)) > 8 or self.random.random() < 0.3
            parts = [row[:4], row[4:]] if large and len(row) > 4 else [row]
            for k, part in enumerate(parts):
                first = name + "*" * large if not lines else self.first(large, end)
                end = "" if is_last and k + 1 == len(parts) else self.end()
                lines.append(self.line(first, part, large, end))
                if self.random.random() < 0.1:
                    lines.append(self.of("", "$ GRID,1,,0.,0.,0.", "$"))
        text = "\n".join(lines)
        return text.lower() if self.random.random() < 0.2 else text

    def end(self):
        self.labels += 1
        return self.of("", "+", f"+{self.labels}A", f"*{self.labels}A")

    def first(self, large, end):
        label = self.of("", end[1:])
        if large:
            return "*" + label
        return "+" + label if label else self.of("", "+")

    def line(self, first, part, large, end):
        count, width = (4, 16) if large else (8, 8)
        form = self.of("fixed", "left", "free", "tabs")
        if form == "free":
            words = part + [""] * (count - len(part)) + [end] if end else part
            return ("," + self.of("", " ")).join([first, *words])
        whole = part + [""] * (count - len(part))
        if form == "tabs" and not large and all(len(word) < 8 for word in whole) and len(first) < 8:
            return "\t".join([first, *whole, end]).rstrip("\t") if end or any(whole) else first
        words = [f"{word:<{width}}" if form == "left" else f"{word:>{width}}" for word in whole]
        return (f"{first:8}" + "".join(words) + end).rstrip()


class Axes:
    """A system with known origin and axes, which gives coordinates of places."""

    def __init__(self, kind, origin, axes):
        self.kind, self.origin, self.axes = kind, origin, axes

    def coordinates(self, place):
        x, y, z = (sum(a * (p - o) for a, p, o in zip(axis, place, self.origin, strict=True)) for axis in self.axes)
        if self.kind == "C":
            return hypot(x, y), degrees(atan2(y, x)), z
        if self.kind == "S":
            return hypot(x, y, z), degrees(atan2(hypot(x, y), z)), degrees(atan2(y, x))
        return x, y, z


def random_axes(random, kind):
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
    return Axes(kind, random.uniform(-2, 2, 3), axes * np.sign(np.linalg.det(axes)))


def system_cards(writer, count):
    """Cards of systems in random other ones, in a random order, and their axes by number."""
    random, cards = writer.random, []
    systems = {0: Axes("R", np.zeros(3), np.eye(3))}
    for _ in range(count):
        reference = int(random.choice(list(systems)))
        axes = random_axes(random, writer.of("R", "C", "S"))
        x, _, z = axes.axes
        places = axes.origin, axes.origin + 1.5 * z, axes.origin + 2.0 * x - 0.5 * z
        number = int(random.integers(1, 10**6))
        given = [f"{value:.9e}" for place in places for value in systems[reference].coordinates(place)]
        cards.append(writer.card(f"CORD2{axes.kind}", [number, reference or "", *given]))
        systems[number] = axes
    return cards, systems


@pytest.mark.parametrize("seed", range(60))
def test_random_meshes_in_random_formats(tmp_path, seed):
    random = np.random.default_rng(seed)
    writer = Writer(random)
    cards, systems = system_cards(writer, int(random.integers(0, 5)))
    wanted, next_grid = {}, 1
    for element in range(1, int(random.integers(2, 12))):
        card = writer.of(*ELEMENTS)
        corners, edges, edges_of_vtk, kinds = ELEMENTS[card]
        has_middles = bool(random.integers(2))
        # Thousandths, of which the small fields keep all digits.
        moved = np.round(corners * random.uniform(0.5, 2, 3) + random.uniform(-2, 2, 3), 1) * 2
        places = with_middles(moved, edges) if has_middles else moved
        ids = next_grid + random.permutation(2 * len(places))[: len(places)]
        next_grid = int(ids.max()) + 1
        for grid, place in zip(ids.tolist(), places, strict=True):
            system = int(random.choice(list(systems)))
            texts = [writer.number(x) for x in place]
            if system:
                texts = [f"{x:.9e}" for x in systems[system].coordinates(place)]
            cards.append(writer.card("GRID", [grid, writer.of("", "0") if system == 0 else system, *texts]))
        part = int(random.integers(1, 4))
        cards.append(writer.card(card, [element, part, *ids.tolist()]))
        vtk = with_middles(moved, edges_of_vtk) if has_middles else moved
        wanted[tuple(np.round(vtk, 4).ravel() + 0.0)] = kinds[has_middles], str(part)
    random.shuffle(cards)
    deck = read(tmp_path, "\n".join([*writer.of(["CEND", "BEGIN BULK"], []), *cards, "ENDDATA", ""]))
    names = {int(n): name for name, part in deck.parts.items() for n in part}
    kinds = [block.kind for block in deck.blocks for _ in block.nodes]
    rows = [deck.points[row] for block in deck.blocks for row in block.nodes]
    found = {tuple(np.round(row, 4).ravel() + 0.0): (kinds[n], names[n]) for n, row in enumerate(rows)}
    assert found == wanted


def outcome(folder, text):
    try:
        return f"{read(folder, text).count} elements"
    except DeckError as error:
        return str(error)


@pytest.mark.parametrize("seed", range(30))
def test_damaged_decks_are_read_or_refused_in_one_line(tmp_path, seed):
    random = np.random.default_rng(seed)
    writer = Writer(random)
    cards, _ = system_cards(writer, 2)
    text = "\n".join(["BEGIN BULK", GRIDS, *cards, HEXA["small"], TETRA, "SPC1,1,123,1,THRU,4", "MAT1,1,2.+11,,.3"])
    for wrong in (1, 3, 20):
        letters = np.array(list(text))
        letters[random.integers(0, letters.size, wrong)] = random.choice(list("0123456789-.,e *+=$\n\t'"), wrong)
        assert "\n" not in outcome(tmp_path, "".join(letters))
