"""Decks of Abaqus and CalculiX: parts, sets, systems and surfaces, against plain readings of the same text."""

from __future__ import annotations

import gzip
import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import stridula as st
from stridula.bodies.decks import abaqus
from stridula.doubtful import DoubtfulValue

CUBE = ["0, 0, 0", "1, 0, 0", "1, 1, 0", "0, 1, 0", "0, 0, 1", "1, 0, 1", "1, 1, 1", "0, 1, 1"]
BAR = """*NODE
1, 0., 0., 0.
2, 0.1, 0., 0.
3, 0.2, 0., 0.
4, 0., 0.1, 0.
5, 0.1, 0.1, 0.
6, 0.2, 0.1, 0.
7, 0., 0., 0.1
8, 0.1, 0., 0.1
9, 0.2, 0., 0.1
10, 0., 0.1, 0.1
11, 0.1, 0.1, 0.1
12, 0.2, 0.1, 0.1
*ELEMENT, TYPE=C3D8, ELSET=BAR
1, 1, 2, 5, 4, 7, 8, 11, 10
2, 2, 3, 6, 5, 8, 9, 12, 11
"""


def cube(first: int = 1, size: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> str:
    """Return the nodes of a block."""
    places = [np.array([float(word) for word in one.split(",")]) * size for one in CUBE]
    return "".join(f"{first + k}, {x:g}, {y:g}, {z:g}\n" for k, (x, y, z) in enumerate(places))


def box_part(name: str, size: tuple[float, float, float]) -> str:
    """Return a part of one element with all nodes in the set TOP."""
    return (
        f"*PART, NAME={name}\n*NODE\n{cube(1, size)}*ELEMENT, TYPE=C3D8R, ELSET={name}-ALL\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
        "*NSET, NSET=TOP\n5, 6, 7, 8\n*END PART\n"
    )


TWO_PARTS = (
    box_part("BASE", (0.08, 0.05, 0.012))
    + box_part("Pad", (0.03, 0.02, 0.007))
    + """*ASSEMBLY, NAME=RIG
*INSTANCE, NAME=BASE-1, PART=BASE
*END INSTANCE
*INSTANCE, NAME=PAD-1, PART=PAD
0.02, 0.015, 0.012
*END INSTANCE
*INSTANCE, NAME=PAD-2, PART=PAD
0.2, 0., 0.
0.2, 0., 0., 0.2, 0., 1., 90.
*END INSTANCE
*ELSET, ELSET=_UNDER_S1, INTERNAL, INSTANCE=PAD-1
1
*SURFACE, TYPE=ELEMENT, NAME=UNDER
_UNDER_S1, S1
*NSET, NSET=BOTH
PAD-1.1, PAD-2.TOP
*NSET, NSET=OTHER, INSTANCE=PAD-2
1, 2
*END ASSEMBLY
"""
)


def read(tmp_path: Path, text: str, **words) -> st.SolidMesh:
    path = tmp_path / "deck.inp"
    path.write_text(text, encoding="latin-1")
    return st.SolidMesh.read(path, **words)


def refused(tmp_path: Path, text: str, **words) -> str:
    with pytest.raises(ValueError, match=r"\S") as error:
        read(tmp_path, text, **words)
    assert "\n" not in str(error.value)
    return str(error.value)


def places(mesh: st.SolidMesh, name: str) -> list[list[float]]:
    return sorted(np.round(mesh.nodes[mesh.node_sets[name]], 9).tolist())


def test_parts_are_placed_by_their_instances(tmp_path):
    base, first, second = (read(tmp_path, TWO_PARTS, part=name) for name in ("BASE-1", "pad-1", "PAD-2"))
    np.testing.assert_allclose([base.nodes.min(0), base.nodes.max(0)], [[0, 0, 0], [0.08, 0.05, 0.012]], atol=1e-15)
    np.testing.assert_allclose([first.nodes.min(0), first.nodes.max(0)], [[0.02, 0.015, 0.012], [0.05, 0.035, 0.019]])
    # Shifted, then turned about a line along z.
    np.testing.assert_allclose(
        [second.nodes.min(0), second.nodes.max(0)], [[0.18, 0, 0], [0.2, 0.03, 0.007]], atol=1e-15
    )


def test_sets_of_instances_keep_apart(tmp_path):
    """Sets of two instances of a part, sets of the assembly and a surface of it."""
    first, second = (read(tmp_path, TWO_PARTS, part=name) for name in ("PAD-1", "PAD-2"))
    assert places(first, "TOP") == sorted(
        [[0.02, 0.015, 0.019], [0.05, 0.015, 0.019], [0.05, 0.035, 0.019], [0.02, 0.035, 0.019]]
    )
    assert len(places(second, "TOP")) == 4
    assert places(first, "BOTH") == [[0.02, 0.015, 0.012]]
    assert places(second, "BOTH") == places(second, "TOP")
    assert places(second, "OTHER") == [[0.2, 0.0, 0.0], [0.2, 0.03, 0.0]]
    ((element, face),) = first.faces["UNDER"].tolist()
    corners = first.nodes[first.elements[element]][list(first.element_kind.faces[face])]
    assert (corners[:, 2] == 0.012).all()
    assert "UNDER" not in second.faces


def test_several_parts_are_named_with_the_way_out(tmp_path):
    said = refused(tmp_path, TWO_PARTS)
    assert "got 3 that share no node: choose one by part='BASE-1' or 'PAD-1' or 'PAD-2'" in said
    assert "part must be" in (said := refused(tmp_path, TWO_PARTS, part="PIN"))
    assert "'BASE-1' or 'PAD-1'" in said
    flat = f"*NODE\n{cube()}{cube(101)}*ELEMENT, TYPE=C3D8, ELSET=A\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*ELEMENT, TYPE=C3D8\n"
    flat += "2, 101, 102, 103, 104, 105, 106, 107, 108\n"
    assert "choose one by part='A' or 'component 2'" in refused(tmp_path, flat)
    assert len(read(tmp_path, flat, part="component 2").elements) == 1


def test_parts_are_read_by_their_material(tmp_path):
    text = f"*NODE\n{cube()}{cube(101)}*ELEMENT, TYPE=C3D8, ELSET=A\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
    text += "*ELEMENT, TYPE=C3D8, ELSET=B\n2, 101, 102, 103, 104, 105, 106, 107, 108\n*MATERIAL, NAME=Steel\n"
    text += "*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SOLID SECTION, ELSET=B, MATERIAL=STEEL\n"
    mesh = read(tmp_path, text, part="Steel")
    assert list(mesh.volumes) == ["B"]


@pytest.mark.parametrize(
    ("lines", "name", "numbers"),
    [
        ("*NSET, NSET=LEFT\n1, 4\n*NSET, NSET=LEFT\n7, 10\n", "LEFT", [1, 4, 7, 10]),
        ("*NSET, NSET=A\n1, 4\n*NSET, NSET=B\n7, 10\n*NSET, NSET=LEFT\nA, B\n", "LEFT", [1, 4, 7, 10]),
        ("*nset, nset=front, generate\n1, 6\n", "front", [1, 2, 3, 4, 5, 6]),
        ("*NSET, NSET=ENDS, GENERATE\n1, 7, 3\n9, 12, 3\n", "ENDS", [1, 4, 7, 9, 12]),
        ("*ELSET, ELSET=RIGHT\n2\n*NSET, NSET=R, ELSET=RIGHT\n", "R", [2, 3, 5, 6, 8, 9, 11, 12]),
        ("*NSET, NSET=R, ELSET=BAR\n", "R", list(range(1, 13))),
        ('*NSET,\nNSET="two words",\n UNSORTED\n1, 2,\n3\n', "two words", [1, 2, 3]),
        ("*NSET, NSET=S\n1, S\n** a comment\n2\n", "S", [1, 2]),
        ("*NSET, NSET=ALL, GENERATE\n1, 2000000000\n", "ALL", list(range(1, 13))),
        ("*NSET, NSET=N\n1, 2\n*SURFACE, TYPE=NODE, NAME=W\nN, 0.5\n4, 0.2\n", "W", [1, 2, 4]),
    ],
)
def test_sets_are_read_whole(lines, name, numbers, tmp_path):
    mesh = read(tmp_path, BAR + lines)
    given = np.array([[0.1 * (k % 3), 0.1 * (k // 3 % 2), 0.1 * (k // 6)] for k in range(12)])
    expected = sorted(np.round(given[np.array(numbers) - 1], 9).tolist())
    assert places(mesh, name) == expected


def test_a_bar_held_by_a_set_in_two_blocks(tmp_path):
    """Frequencies of one in which all four nodes are held."""
    steel = st.Material(2e11, 7800.0, 0.3)
    mesh = read(tmp_path, BAR + "*NSET, NSET=LEFT\n1, 4\n*NSET, NSET=LEFT\n7, 10\n")
    body = st.SolidBody(mesh, steel, fixed=["LEFT"], cutoff=7e3)
    np.testing.assert_allclose(
        body.modes().angular_frequency[:4] / (2 * np.pi), [1867.6, 1867.6, 3926.5, 6474.5], atol=0.05
    )


def test_all_sets_of_one_deck(tmp_path):
    """Named at *NODE, from a set of elements, and from other sets."""
    text = BAR.replace("*NODE", "*NODE, NSET=ALL") + "*ELSET, ELSET=RIGHT\n2\n*NSET, NSET=RIGHT-NODES, ELSET=RIGHT\n"
    mesh = read(tmp_path, text)
    assert {name: len(nodes) for name, nodes in mesh.node_sets.items()} == {"ALL": 12, "RIGHT-NODES": 8}
    assert {name: those.tolist() for name, those in mesh.volumes.items()} == {"BAR": [0, 1], "RIGHT": [1]}


@pytest.mark.parametrize("form", ["*NODE, SYSTEM=C\n", "*Node, system = c\n"])
def test_cylindrical_coordinates(form, tmp_path):
    places = ((0.1, 0, 0), (0.15, 0, 0), (0.15, 90, 0), (0.1, 90, 0), (0.1, 0, 0.02), (0.15, 0, 0.02), (0.15, 90, 0.02))
    rows = "".join(f"{k}, {r}, {t}, {z}\n" for k, (r, t, z) in enumerate((*places, (0.1, 90, 0.02)), 1))
    mesh = read(tmp_path, f"{form}{rows}*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n")
    np.testing.assert_allclose(mesh.nodes[[2, 3, 6, 7], 1], [0.15, 0.1, 0.15, 0.1])
    np.testing.assert_allclose(mesh.nodes[[2, 3, 6, 7], 0], 0.0, atol=1e-15)


def test_a_local_system_moves_the_nodes_that_follow(tmp_path):
    text = f"*SYSTEM\n1, 0, 0, 1, 1, 0\n0, 1, 0\n*NODE\n{cube()}*SYSTEM\n*NODE\n9, 5, 5, 5\n"
    mesh = read(tmp_path, text + "*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n")
    # Origin at (1, 0, 0), the axis x along y, the plane towards -x.
    local = np.array([[float(word) for word in one.split(",")] for one in CUBE])
    np.testing.assert_allclose(mesh.nodes, np.stack([1 - local[:, 1], local[:, 0], local[:, 2]], axis=1), atol=1e-15)


def test_nodes_between_two(tmp_path):
    text = "*NODE\n1, 0, 0, 0\n3, 2, 0, 0\n4, 0, 1, 0\n6, 2, 1, 0\n7, 0, 0, 1\n9, 2, 0, 1\n10, 0, 1, 1\n12, 2, 1, 1\n"
    text += "*NGEN, NSET=LOWER\n1, 3\n4, 6, 1\n*NGEN\n7, 9\n10, 12\n*ELEMENT, TYPE=C3D8\n"
    mesh = read(tmp_path, text + "1, 1, 2, 5, 4, 7, 8, 11, 10\n2, 2, 3, 6, 5, 8, 9, 12, 11\n")
    assert len(mesh.nodes) == 12
    assert len(mesh.node_sets["LOWER"]) == 6
    assert mesh.nodes[:, 0].tolist().count(1.0) == 4


def test_spherical_coordinates(tmp_path):
    """A part of a shell between two spheres: longitudes from 0 to 90 degrees, latitudes from 30 to 60."""
    angles = [(0, 30), (90, 30), (90, 60), (0, 60)]
    rows = "".join(
        f"{4 * layer + k + 1}, {radius}, {longitude}, {latitude}\n"
        for layer, radius in enumerate((0.1, 0.12))
        for k, (longitude, latitude) in enumerate(angles)
    )
    mesh = read(tmp_path, f"*NODE, SYSTEM=S\n{rows}*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n")
    np.testing.assert_allclose(np.linalg.norm(mesh.nodes, axis=1), [0.1] * 4 + [0.12] * 4, rtol=1e-12)
    c, s = np.sqrt(0.75), 0.5
    lower = 0.1 * np.array([[c, 0, s], [0, c, s], [0, s, c], [s, 0, c]])
    np.testing.assert_allclose(mesh.nodes[:4], lower, atol=1e-15)


@pytest.mark.parametrize("seed", range(12))
def test_nodes_on_arcs(seed, tmp_path):
    """Equal steps along random arcs in space, of more than half a turn too, about a node or a place as the centre."""
    rng = np.random.default_rng(seed)
    centre, radius, steps = rng.normal(size=3), rng.uniform(0.5, 3.0), int(rng.integers(2, 7))
    first, second, normal = np.linalg.qr(rng.normal(size=(3, 3)))[0].T
    normal = np.cross(first, second)
    angle = rng.uniform(0.1, 1.9) * np.pi
    along = np.linspace(0.0, angle, steps + 1)
    arc = centre + radius * (np.cos(along)[:, None] * first + np.sin(along)[:, None] * second)
    node, short = seed % 2 == 0, angle < 3.0 and seed % 3 > 0
    words = [
        "101",
        str(101 + 3 * steps),
        "3",
        "99" if node else "",
        *(["", "", ""] if node else map(repr, centre.tolist())),
    ]
    words += [] if short else map(repr, (rng.uniform(0.5, 2.0) * normal).tolist())
    rows = [(99, centre), (101, arc[0]), (101 + 3 * steps, arc[-1])]
    text = "*NODE\n" + "".join(
        f"{number}, {x!r}, {y!r}, {z!r}\n" for number, (x, y, z) in ((n, p.tolist()) for n, p in rows)
    )
    text += f"*NGEN, LINE=C, NSET=ARC\n{', '.join(words)}\n"
    found = abaqus_nodes(tmp_path, text)
    np.testing.assert_allclose([found[101 + 3 * k] for k in range(steps + 1)], arc, atol=1e-12)


def abaqus_nodes(tmp_path, text) -> dict[int, np.ndarray]:
    """Return the nodes of a deck by their number, read as points of the set of all in the order of numbers."""
    path = tmp_path / "nodes.inp"
    path.write_text(text, encoding="latin-1")
    reader = abaqus._Reader()
    reader.read(path)
    return {number: np.array(place) for number, place in reader.deck_scope.nodes.items()}


def test_centres_of_arcs_in_other_coordinates(tmp_path):
    text = "*NODE\n1, 2, 1, 0\n3, 1, 2, 0\n*NGEN, LINE=C, SYSTEM={}\n1, 3, 1, , {}\n"
    place = np.array([1.0, 1.0, 0.0]) + np.sqrt([0.5, 0.5, 0.0])
    for form, centre in (("RC", "1, 1, 0"), ("C", "1.4142135623730951, 45, 0"), ("S", "1.4142135623730951, 45, 0")):
        np.testing.assert_allclose(abaqus_nodes(tmp_path, text.format(form, centre))[2], place, rtol=1e-12)


@pytest.mark.parametrize(("normal", "sign"), [("0, 0, 1", 1.0), ("0, 0.5, -3", -1.0)])
def test_half_a_circle(normal, sign, tmp_path):
    """The side is that of the normal, of which the part along the radius does not count."""
    found = abaqus_nodes(tmp_path, f"*NODE\n1, 0, 1, 0\n3, 0, -1, 0\n*NGEN, LINE=C\n1, 3, 1, , 0, 0, 0, {normal}\n")
    np.testing.assert_allclose(found[2], [-sign, 0.0, 0.0], atol=1e-15)


def test_a_whole_circle(tmp_path):
    """Both ends at the same place, with the normal of the circle."""
    found = abaqus_nodes(tmp_path, "*NODE\n1, 1, 0, 0\n5, 1, 0, 0\n*NGEN, LINE=C\n1, 5, 1, , 0, 0, 0, 0, 0, -2\n")
    np.testing.assert_allclose([found[k] for k in (2, 3, 4)], [[0, -1, 0], [-1, 0, 0], [0, 1, 0]], atol=1e-15)


def test_other_things_are_counted_in_a_line(tmp_path):
    text = f"*NODE\n{cube()}*ELEMENT, TYPE=c3d8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
    text += "*ELEMENT, TYPE=MASS, ELSET=L\n2, 7\n*MASS, ELSET=L\n0.25\n"
    with pytest.warns(DoubtfulValue, match="not read: 1 MASS"):
        assert len(read(tmp_path, text).elements) == 1


NODES = f"*NODE\n{cube()}"
ELEMENT = "*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            NODES + "*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 99\n",
            "line 11: element 1 has node 99, which was not given",
        ),
        (NODES + "*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4\n5, 6, 7\n", "line 11: an element needs 8 nodes, got 7"),
        (NODES + "*ELEMENT\n1, 1, 2\n", "line 10: *ELEMENT needs TYPE="),
        ("*NODE\n1, 0, x, 0\n", "line 2: *NODE needs a number as entry 3, got 'x'"),
        ("*NODE\n1, nan, 0, 0\n", "line 2: coordinates must be finite"),
        ("*NODE\na, 0, 0, 0\n", "line 2: *NODE needs a whole number as entry 1, got 'a'"),
        ("*NODE, SYSTEM=T\n1, 0, 0, 0\n", "line 1: *NODE, SYSTEM=T is not read: give rectangular (R)"),
        (NODES + "1, 3, 0, 0\n", "line 10: node 1 is given twice, at different places"),
        (NODES + "*NFILL\n1, 2, 3\n", "line 10: *NFILL is not read"),
        (NODES + "*NGEN, LINE=P\n1, 2, 1, 3\n", "line 10: *NGEN, LINE=P is not read: write the nodes on the curve"),
        (NODES + "*NGEN, LINE=C\n1, 2\n", "line 11: *NGEN needs a number as entry 5, got ''"),
        (NODES + "*NGEN, LINE=C\n1, 2, 1, 99\n", "line 11: *NGEN has the centre 99, a node which was not given"),
        (NODES + "*NGEN, LINE=C\n1, 2, 1, 3\n", "line 11: *NGEN, LINE=C needs ends that are equally far"),
        (NODES + "*NGEN, LINE=C\n1, 2, 1, , 0.5, 0, 0\n", "line 11: *NGEN, LINE=C needs the normal of an arc of 180"),
        (
            "*SYSTEM\n1, 0, 0\n" + NODES + "*NGEN, LINE=C\n1, 3, 1, , 1, 0, 0\n",
            "line 13: *NGEN below *SYSTEM needs the number of a node",
        ),
        ("*INCLUDE, INPUT=/dev/zero\n", "line 1: *INCLUDE must name a file below the folder of the deck"),
        ("*INCLUDE, INPUT=../other.inp\n", "line 1: *INCLUDE must name a file below the folder of the deck"),
        ("*INCLUDE, INPUT=deck.inp\n", "line 1: *INCLUDE of 'deck.inp', which includes itself"),
        (
            "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n",
            "line 2: instance 'I' is of part 'P', which the deck has not",
        ),
        (box_part("P", (1, 1, 1)) * 2, "two parts have the name 'P'"),
        ("*END PART\n", "line 1: *END PART ends nothing that began"),
        (NODES + ELEMENT + "*NSET, NSET=A, GENERATE\n5, 1\n", "line 13: GENERATE needs a range that rises, got 5, 1"),
        (NODES + "*ELEMENT, TYPE=S4\n1, 1, 2, 3, 4\n", "hold solid elements"),
    ],
)
def test_faults_name_line_and_remedy(text, words, tmp_path, recwarn):
    assert words in refused(tmp_path, text)


def test_an_included_file_is_named(tmp_path):
    (tmp_path / "below").mkdir()
    (tmp_path / "below" / "nodes.inc").write_text("*NODE\n1, 0, 0\n2, x, 0, 0\n")
    assert "below/nodes.inc, line 3: *NODE needs" in refused(tmp_path, "** first\n*INCLUDE, INPUT=below/nodes.inc\n")
    (tmp_path / "below" / "nodes.inc").write_text(NODES)
    assert len(read(tmp_path, "*INCLUDE, INPUT=below/nodes.inc\n" + ELEMENT).nodes) == 8


@pytest.mark.parametrize("seed", range(30))
def test_the_same_mesh_in_any_form(seed, tmp_path):
    """A block of elements with numbers, cases, blocks, sets and comments at random."""
    rng = np.random.default_rng(seed)
    shape = rng.integers(1, 4, 3)
    grid = np.stack(np.meshgrid(*(np.arange(n + 1) for n in shape), indexing="ij"), axis=-1).reshape(-1, 3)
    points = grid + 0.1 * rng.uniform(-1, 1, grid.shape)
    number = {tuple(place): k for k, place in enumerate(grid.tolist())}
    corners = np.array([[float(word) for word in one.split(",")] for one in CUBE], dtype=int)
    cells = [[number[tuple((np.array(c) + d).tolist())] for d in corners] for c in np.ndindex(*shape)]
    ids = rng.choice(10_000, len(points), replace=False) + 1
    of_cells = rng.choice(10_000, len(cells), replace=False) + 1
    chosen = {"nodes one": rng.choice(len(points), rng.integers(1, len(points) + 1), replace=False)}
    some = rng.choice(len(cells), rng.integers(1, len(cells) + 1), replace=False)

    def any_case(word: str) -> str:
        return "".join(sign.upper() if rng.random() < 0.5 else sign.lower() for sign in word)

    def wrapped(numbers: list[int], row: str) -> str:
        at = int(rng.integers(1, len(numbers) + 1))
        first, second = numbers[:at], numbers[at:]
        sep = str(rng.choice([",", ", ", " ,  "]))
        return (
            f"{row}{sep.join(map(str, first))}{sep.strip()}\n{sep.join(map(str, second))}\n"
            if second
            else f"{row}{sep.join(map(str, first))}\n"
        )

    lines = []
    order, cut = rng.permutation(len(points)), int(rng.integers(0, len(points) + 1))
    for part in (order[:cut], order[cut:]):
        lines.append(f"*{any_case('node')}\n")
        for k in part:
            lines.append(f"{ids[k]}, " + ", ".join(repr(float(x)) for x in points[k]) + "\n")
            lines += ["** a comment, 1, 2\n"] * int(rng.random() < 0.2)
    for k in rng.permutation(len(cells)):
        if rng.random() < 0.3 or lines[-1].startswith("*") or "element" not in "".join(lines).lower():
            lines.append(f"*{any_case('element')}, {any_case('type')}={any_case('c3d8')}\n")
        lines.append(wrapped([int(of_cells[k]), *(int(ids[n]) for n in cells[k])], ""))
    half = len(some) // 2
    for part in (some[:half], some[half:]):
        lines.append(f'*{any_case("elset")}, {any_case("elset")}="{any_case("some cells")}"\n')
        lines += [f"{of_cells[k]},\n" for k in part]
    for name, those in chosen.items():
        for k in those:
            lines.append(f'*{any_case("nset")}, {any_case("nset")}="{any_case(name)}"\n{ids[k]}\n')
    mesh = read(tmp_path, "".join(lines))

    def told(nodes) -> set:
        return {tuple(np.round(place, 12)) for place in np.asarray(nodes).tolist()}

    assert told(mesh.nodes) == told(points)
    assert {frozenset(told(mesh.nodes[one])) for one in mesh.elements} == {
        frozenset(told(points[one])) for one in cells
    }
    ((_, found),) = [(name, those) for name, those in mesh.volumes.items() if name.lower() == "some cells"]
    assert {frozenset(told(mesh.nodes[one])) for one in mesh.elements[found]} == {
        frozenset(told(points[cells[k]])) for k in some
    }
    ((_, nodes),) = [(name, those) for name, those in mesh.node_sets.items() if name.lower() == "nodes one"]
    assert told(mesh.nodes[nodes]) == told(points[chosen["nodes one"]])


# Decks of CalculiX' own tests, as Debian's calculix-ccx-test installs them.
DECKS = Path("/usr/share/doc/calculix-ccx-test/examples/test")
SOLIDS = {"4": 4, "6": 6, "8": 8, "10": 10, "15": 15, "20": 20}
# The only ones refused: elements of 8 nodes given with 10.
REFUSED = {"beampsensfreq.inp", "dloadlinI.inp", "dloadlinIf.inp"}


def plainly(text: str) -> tuple[int, int, list[float]]:
    """Return the number of elements, of their nodes, and the box of a deck, by a reading that knows nothing else."""
    nodes, elements, keyword, waiting = {}, {}, "", []
    for line in text.splitlines():
        line = line.strip().upper().replace(" ", "").replace("\t", "")
        if line.startswith("**") or not line:
            continue
        if line.startswith("*"):
            keyword, waiting = line, []
            continue
        words = [word for word in line.split(",") if word]
        if re.match(r"\*NODE(,|$)", keyword):
            nodes[int(words[0])] = [float(word) for word in (*words[1:4], *["0"] * (4 - len(words)))]
        elif solid := re.search(r"^\*ELEMENT,.*TYPE=D?C3D(\d+)", keyword):
            waiting += map(int, words)
            if len(waiting) > SOLIDS[solid[1]]:
                elements[waiting[0]] = waiting[1:]
                waiting = []
    used = {node for one in elements.values() for node in one}
    places = np.array([nodes[one] for one in used]).reshape(-1, 3)
    box = [*places.min(axis=0), *places.max(axis=0)] if used else []
    return len({frozenset(one) for one in elements.values()}), len(used), box


def test_decks_of_calculix_agree_with_a_plain_count(tmp_path):
    if not DECKS.is_dir():
        pytest.skip("the decks of Debian's calculix-ccx-test are not installed: its decks were not read")
    whole, by_part, refusals = 0, 0, {}
    for path in sorted([*DECKS.glob("*.inp"), *DECKS.glob("*.inp.gz")]):
        text = (gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()).decode("latin-1")
        if not re.search(r"(?im)^\*ELEMENT\s*,.*TYPE\s*=\s*D?C3D", text) or "*INCLUDE" in text.upper():
            continue
        copy = tmp_path / path.name.removesuffix(".gz")
        copy.write_text(text, encoding="latin-1")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DoubtfulValue)
            try:
                meshes = [st.SolidMesh.read(copy)]
                whole += 1
            except ValueError as error:
                names = re.findall(r"part='([^']+)'| or '([^']+)'", str(error))
                if not names:
                    refusals[copy.name] = str(error)
                    continue
                meshes = [st.SolidMesh.read(copy, part=first or second) for first, second in names]
                by_part += 1
        if sum(len(one.elements) for one in meshes) and all(one.kind != "tetra" or "C3D4" in text for one in meshes):
            elements, nodes, box = plainly(text)
            if re.search(r"(?i)C3D(6|15)", text):
                continue
            assert sum(len(one.elements) for one in meshes) == elements, copy.name
            assert sum(len(one.nodes) for one in meshes) == nodes, copy.name
            seen = [
                *np.min([m.nodes.min(0) for m in meshes], axis=0),
                *np.max([m.nodes.max(0) for m in meshes], axis=0),
            ]
            np.testing.assert_allclose(seen, box, rtol=1e-12, atol=1e-12, err_msg=copy.name)
    assert whole >= 150
    assert by_part >= 50
    assert refusals.keys() <= REFUSED, refusals
