"""Decks written from meshes."""

from __future__ import annotations

import math

import numpy as np

import stridula as st

# Faces of hexahedra of Abaqus by their corners, from 0.
SIDES = {
    frozenset(corners): f"S{k + 1}"
    for k, corners in enumerate([(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 4, 5), (1, 2, 5, 6), (2, 3, 6, 7), (3, 0, 7, 4)])
}
MILLIMETRE = 1e-3
# Young's modulus [MPa], Poisson's ratio, density [t/mm3].
MATERIALS = {"IRON": (1.1e5, 0.28, 7.1e-9), "LINING": (8e3, 0.25, 2.5e-9), "STEEL": (2.1e5, 0.3, 7.8e-9)}


def brake_deck() -> str:
    """Return a deck of Abaqus with a disc between two equal pads of two materials, in mm, t and s."""
    ring = st.SolidMesh.sector((0.07, 0.13), (0.0, 2.0 * math.pi), 0.012, (2, 24, 1))
    pad = st.SolidMesh.sector((0.085, 0.125), (-0.4, 0.4), {"LINING": 0.01, "PLATE": 0.005}, (2, 4, 1))
    return "\n".join(
        [
            "*HEADING",
            "A disc between two pads [mm, t, N, s, MPa]",
            *part("DISC", ring, {"all": "IRON"}, {"HUB": "inner"}, {"UPPER": "top", "LOWER": "bottom"}),
            *part("PAD", pad, {"LINING": "LINING", "PLATE": "STEEL"}, {}, {"RUB": "bottom", "BACK": "top"}),
            *instances(),
            *materials(),
            "",
        ]
    )


def instances() -> list[str]:
    """Return the lines of the assembly: the lower pad is turned by half a turn about the z axis."""
    return [
        "*ASSEMBLY, NAME=BRAKE",
        "*INSTANCE, NAME=DISC-1, PART=DISC",
        "*END INSTANCE",
        "*INSTANCE, NAME=PAD-UPPER, PART=PAD",
        "0., 12., 0.",
        "*END INSTANCE",
        "*INSTANCE, NAME=PAD-LOWER, PART=PAD",
        "0., 0., 0.",
        "0., 0., 0., 0., 0., 1., 180.",
        "*END INSTANCE",
        "*END ASSEMBLY",
    ]


def materials() -> list[str]:
    """Return the lines of the materials."""
    found = []
    for name, (young, poisson, density) in MATERIALS.items():
        found += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young:g}, {poisson:g}", "*DENSITY", f"{density:g},"]
    return found


def part(
    name: str, mesh: st.SolidMesh, of: dict[str, str], sets: dict[str, str], surfaces: dict[str, str]
) -> list[str]:
    """Return the lines of a part with the materials of its volumes, node sets and surfaces of its faces."""
    lines = [f"*PART, NAME={name}", "*NODE"]
    lines += [f"{k + 1}, {x:.6g}, {y:.6g}, {z:.6g}" for k, (x, y, z) in enumerate((mesh.nodes / MILLIMETRE).round(9))]
    volumes = mesh.volumes if mesh.volumes else {"all": np.arange(len(mesh.elements))}
    for volume, material in of.items():
        lines.append(f"*ELEMENT, TYPE=C3D20, ELSET={volume}")
        for number in volumes[volume]:
            row = [number + 1, *(mesh.elements[number] + 1)]
            lines += [", ".join(map(str, row[:16])) + ",", ", ".join(map(str, row[16:]))]
        lines += [f"*SOLID SECTION, ELSET={volume}, MATERIAL={material}", ""]
    for group, face in sets.items():
        lines += [f"*NSET, NSET={group}", *rows_of(mesh.nodes_of(face) + 1)]
    for surface, face in surfaces.items():
        lines.append(f"*SURFACE, NAME={surface}")
        for element, side in mesh.faces[face]:
            lines.append(f"{element + 1}, {SIDES[frozenset(mesh.element_kind.faces[side])]}")
    return [*lines, "*END PART"]


def rows_of(numbers: np.ndarray) -> list[str]:
    """Return numbers as lines of at most 16."""
    return [", ".join(map(str, numbers[k : k + 16])) for k in range(0, len(numbers), 16)]
