"""Point masses and springs of decks, as attributes of parts in SI units."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from test_decks import box_part, cube

import stridula as st
from stridula.bodies.solids.mesh_parts import MeshSpring
from stridula.doubtful import DoubtfulValue

NODES = f"*NODE\n{cube()}*NODE\n9, 5, 5, 5\n"
SOLID = "*ELEMENT, TYPE=C3D8, ELSET=ALL\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
MASS = "*ELEMENT, TYPE=MASS, ELSET=M\n2, 7\n*MASS, ELSET=M\n0.25\n"
SPRING = "*ELEMENT, TYPE=SPRING1, ELSET=S\n3, 8\n*SPRING, ELSET=S\n2\n40.\n"
GRIDS = "".join(f"GRID,{line.replace(' ', '').replace(',', ',,', 1)}\n" for line in cube().splitlines())
HEXA = "CHEXA,1,1,1,2,3,4,5,6\n,7,8\n"


def parts_of(tmp_path, text, ending="inp", scale=1e-3):
    """Return the parts of a deck, and the words of the warning of what is not read."""
    path = tmp_path / f"deck.{ending}"
    path.write_text(text, encoding="latin-1")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", DoubtfulValue)
        parts = st.read_parts(path, scale=scale)
    return parts, [str(one.message).partition("not read: ")[2] for one in caught]


def test_masses_and_springs_become_bodies_and_connections(tmp_path):
    """Tonnes and N/mm; as in the example of the docstring."""
    parts, said = parts_of(tmp_path, NODES + SOLID + MASS + SPRING)
    (part,) = parts.values()
    assert said == []
    assert part.masses == {"node 7": 250.0}
    assert part.springs == (MeshSpring("node 8", "", "", (0.0, 1.0, 0.0), 40e3),)
    assert part.points == {"node 7": (1e-3, 1e-3, 1e-3), "node 8": (0.0, 1e-3, 1e-3)}
    pad = st.SolidBody(part.mesh, st.Material(2.1e11, 7800.0), points=part.points, cutoff=1e6)
    (one,) = part.springs
    spring = st.Spring(pad.at(one.first), stiffness=one.stiffness, direction=one.direction)
    np.testing.assert_allclose(spring.first.place, part.points[one.first], atol=1e-12)
    assert st.RigidBody(part.masses["node 7"]).total_mass == 250.0


def test_meshes_without_parts_say_that_masses_and_springs_are_not_read(tmp_path):
    path = tmp_path / "deck.inp"
    path.write_text(NODES + SOLID + MASS + SPRING, encoding="latin-1")
    with pytest.warns(DoubtfulValue, match="not read: 1 MASS, 1 SPRING1"):
        st.SolidMesh.read(path, scale=1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_springs_between_instances(seed, tmp_path):
    """Random springs of an assembly, along an axis or the line between their ends, some in a set of their own."""
    rng = np.random.default_rng(seed)
    shift = rng.uniform(2.0, 5.0, 3).tolist()
    text = box_part("BASE", (1.0, 1.0, 1.0)) + box_part("PAD", (0.5, 0.5, 0.5))
    text += "*ASSEMBLY, NAME=RIG\n*INSTANCE, NAME=B, PART=BASE\n*END INSTANCE\n*INSTANCE, NAME=P, PART=PAD\n"
    text += ", ".join(map(repr, shift)) + "\n*END INSTANCE\n"
    wanted = []
    for number in range(5):
        first, second, way = *rng.integers(1, 9, 2).tolist(), int(rng.integers(1, 4))
        stiffness, is_axial = float(np.round(rng.uniform(1.0, 9.0), 3)), bool(rng.integers(2))
        form, head = ("SPRINGA", "") if is_axial else ("SPRING2", f"{way}, {way}\n")
        text += f"*ELEMENT, TYPE={form}, ELSET=S{number}\n{number + 1}, B.{first}, P.{second}\n"
        text += f"*SPRING, ELSET=s{number}\n{head}{stiffness}\n"
        place, other = (np.array(place_of(text, one, number)) for one, number in (("BASE", first), ("PAD", second)))
        along = other + shift - place
        direction = along / np.linalg.norm(along) if is_axial else np.eye(3)[way - 1]
        wanted.append((f"node {first}", f"node {second}", "P", stiffness, *direction))
    parts, said = parts_of(tmp_path, text + "*END ASSEMBLY\n", scale=1.0)
    assert said == []
    assert parts["P"].springs == ()
    found = [(one.first, one.second, one.part, one.stiffness, *one.direction) for one in parts["B"].springs]
    assert [one[:4] for one in found] == [one[:4] for one in wanted]
    np.testing.assert_allclose([one[4:] for one in found], [one[4:] for one in wanted], rtol=1e-12, atol=1e-15)
    for one in parts["B"].springs:
        number = int(one.second.removeprefix("node "))
        place = np.array(place_of(text, "PAD", number)) + shift
        np.testing.assert_allclose(parts["P"].points[one.second], place, rtol=1e-12)


def place_of(text: str, part: str, number: int) -> list[float]:
    """Return the coordinates of a node, as the text of its part has them."""
    lines = text.partition(f"*PART, NAME={part}\n")[2].splitlines()
    return [float(word) for word in next(line for line in lines if line.startswith(f"{number}, ")).split(",")[1:]]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (SPRING.replace("*SPRING,", "*SPRING, NONLINEAR,"), "1 SPRING1"),
        (SPRING.replace("\n2\n", "\n5\n"), "1 SPRING1"),
        (SPRING.replace("40.", "-40."), "1 SPRING1"),
        (SPRING.replace("40.\n", "40., 0., 20.\n50., 0., 90.\n"), "1 SPRING1"),
        (SPRING.replace("3, 8", "3, 9"), "1 SPRING1"),
        (SPRING + "*TRANSFORM, NSET=ALL\n1, 1, 0, -1, 1, 0\n", "1 SPRING1"),
        ("*ELEMENT, TYPE=SPRING2, ELSET=S\n3, 7, 8\n*SPRING, ELSET=S\n1, 2\n40.\n", "1 SPRING2"),
        (MASS.partition("*MASS")[0], "1 MASS"),
        (MASS.replace("*MASS,", "*MASS, TYPE=ANISOTROPIC,"), "1 MASS"),
        (MASS.replace("2, 7", "2, 77"), "1 MASS"),
        ("*ELEMENT, TYPE=ROTARYI, ELSET=R\n2, 7\n", "1 ROTARYI"),
    ],
)
def test_others_of_abaqus_are_counted(text, words, tmp_path):
    parts, said = parts_of(tmp_path, NODES + SOLID + text)
    assert said == [words]
    (part,) = parts.values()
    assert (dict(part.masses), part.springs, dict(part.points)) == ({}, (), {})


def test_springs_of_a_turned_instance_are_counted(tmp_path):
    own = "*ELEMENT, TYPE=SPRING1, ELSET=S\n3, 8\n*SPRING, ELSET=S\n2\n40.\n"
    text = box_part("PAD", (1.0, 1.0, 1.0)).replace("*END PART", f"{own}*END PART")
    turned = "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P, PART=PAD\n0, 0, 0\n{}*END INSTANCE\n*END ASSEMBLY\n"
    assert len(parts_of(tmp_path, text + turned.format(""))[0]["P"].springs) == 1
    parts, said = parts_of(tmp_path, text + turned.format("0, 0, 0, 0, 0, 1, 90\n"))
    assert (parts["P"].springs, said) == ((), ["1 SPRING1"])


def test_elements_of_sets_of_sets(tmp_path):
    text = MASS.replace(", ELSET=M\n2, 7", "\n2, 7\n3, 8").replace(
        "*MASS, ELSET=M", "*ELSET, ELSET=IN\n2, 3\n*MASS, ELSET=M"
    )
    parts, said = parts_of(tmp_path, NODES + SOLID + text + "*ELSET, ELSET=M\nIN\n")
    assert said == []
    assert parts["ALL"].masses == {"node 7": 250.0, "node 8": 250.0}


def test_masses_and_springs_of_nastran(tmp_path):
    text = GRIDS + HEXA + "PARAM,WTMASS,2.\nCONM2,9,7,,.25\nCONM2,10,7,,.05\nCELAS2,11,40.,8,2\nCELAS1,12,5,,,1,3\n"
    (part,), said = _nastran(tmp_path, text + "PELAS,5,70.\n")
    assert said == []
    assert part.masses == {"node 7": 600.0}
    assert part.springs == (
        MeshSpring("node 8", "", "", (0.0, 1.0, 0.0), 40e3),
        MeshSpring("node 1", "", "", (0.0, 0.0, 1.0), 70e3),
    )


def _nastran(tmp_path, text):
    parts, said = parts_of(tmp_path, f"BEGIN BULK\n{text}ENDDATA\n", "bdf")
    return tuple(parts.values()), said


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("CONM2,9,7,,.25,.1\n", "1 CONM2"),
        ("CONM2,9,7,-1,.25\n", "1 CONM2"),
        ("CONM2,9,99,,.25\n", "1 CONM2"),
        ("CELAS2,11,40.,8,4\n", "1 CELAS2"),
        ("CELAS2,11,40.,8,2,7,1\n", "1 CELAS2"),
        ("CELAS1,11,6,8,2\n", "1 CELAS1"),
        ("GRDSET,,,,,,3\nCELAS2,11,40.,8,2\n", "1 CELAS2"),
    ],
)
def test_others_of_nastran_are_counted(text, words, tmp_path):
    (part,), said = _nastran(tmp_path, GRIDS + HEXA + text)
    assert said == [words]
    assert (dict(part.masses), part.springs, dict(part.points)) == ({}, (), {})


def test_rotary_inertia_is_counted_beside_its_mass(tmp_path):
    (part,), said = _nastran(tmp_path, GRIDS + HEXA + "CONM2,9,7,,.25\n,.1\n")
    assert (dict(part.masses), said) == ({"node 7": 250.0}, ["1 rotary inertia of a CONM2"])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("CELAS2,11,40.,8,2,,,.02\n", "1 structural damping of a CELAS2"),
        ("PELAS,5,40.,.02\nCELAS1,11,5,8,2\n", "1 structural damping of a PELAS"),
    ],
)
def test_structural_damping_is_counted_beside_its_spring(text, words, tmp_path):
    (part,), said = _nastran(tmp_path, GRIDS + HEXA + text)
    assert ([one.stiffness for one in part.springs], said) == ([40e3], [words])


def test_the_command_prints_them(stridula, tmp_path):
    (tmp_path / "deck.inp").write_text(NODES + SOLID + MASS + SPRING, encoding="latin-1")
    out = " ".join(stridula("mesh", "deck.inp", "--scale", "1 mm")[1].replace("│", " ").split())
    assert "node 7: 250 kg" in out
    assert "node 8 to the ground, along (0, 1, 0): 4e+04 N/m" in out
