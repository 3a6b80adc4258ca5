"""Parts of mesh files, with their materials."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from ...checks import ArgumentError, instance, listed, positive
from ...disk import named
from ..decks.deck import Elastic, Lump
from ..reading.finite import check_finite_in
from ..sections import Material
from . import mesh_files
from .kinds import words_of
from .solid_mesh import SolidMesh


@dataclass(frozen=True)
class MeshSpring:
    """A spring of a mesh file.

    Attributes
    ----------
    first : str
        Name of its point of the part that has it.
    second : str
        Name of its other point; empty for the ground.
    part : str
        Name of the part of the other point; empty for the ground.
    direction : tuple of float
        World direction along which it acts, a unit vector.
    stiffness : float
        Stiffness [N/m].
    """

    first: str
    second: str
    part: str
    direction: tuple[float, ...]
    stiffness: float


@dataclass(frozen=True)
class MeshPart:
    """A part of a mesh file: its elements share no node with others.

    Attributes
    ----------
    name : str
        Name of its instance, property or group of elements, "component 1" and so on without one, that of the file if
        it is alone in it and has none.
    mesh : SolidMesh
        Its mesh, where the file places it, with its groups.
    given : mapping
        Materials that the file gives completely, by the name of their group of elements.
    missing : str
        The properties that the file does not give, in words; empty if `materials` are known.
    cells : mapping
        Number of elements of each kind in the file, such as ``"wedges of 6 nodes"``; the mesh may have other elements.
    masses : mapping
        Point masses of a deck [kg] by the name of their point, such as ``"node 12"``; they are not in the mesh.
    springs : tuple of MeshSpring
        Springs of a deck from a point of this part to the ground, or to a point of this or another part.
    points : mapping
        Places [m] of the points of masses and springs by name, as `SolidBody` takes them.
    """

    name: str
    mesh: SolidMesh
    given: Mapping[str, Material] = field(default_factory=dict)
    missing: str = ""
    cells: Mapping[str, int] = field(default_factory=dict)
    masses: Mapping[str, float] = field(default_factory=dict)
    springs: tuple[MeshSpring, ...] = ()
    points: Mapping[str, tuple[float, ...]] = field(default_factory=dict)

    @property
    def mass(self) -> float:
        """Mass of its elements [kg].

        Raises
        ------
        ValueError
            As for `materials`.
        """
        given, volume = self.materials, self.mesh.volume
        if not isinstance(given, Mapping):
            return float(given.density * volume.sum())
        return float(sum(one.density * volume[self.mesh.volumes[of]].sum() for of, one in given.items()))

    @property
    def materials(self) -> Material | Mapping[str, Material]:
        """One material, or materials by the name of their group of elements, as `SolidBody` takes them.

        Raises
        ------
        ValueError
            If the file does not give them for every element, in the words of `missing`.
        """
        if self.missing:
            raise ArgumentError("materials", f"be given for the part {self.name!r}", got=self.missing)
        return next(iter(self.given.values())) if len(self.given) == 1 else self.given

    def __repr__(self) -> str:
        sides = " x ".join(f"{side:.4g}" for side in self.mesh.size)
        words = self.missing or listed(
            f"{one.young / 1e9:.4g} GPa, {one.density:.4g} kg/m3" for one in self.given.values()
        )
        return f"MeshPart({self.name!r}, {sides} m, {len(self.mesh.elements)} elements, {words})"


def read_parts(path: str | os.PathLike[str], scale: float = 1.0) -> dict[str, MeshPart]:
    """Read the parts of a mesh file that share no node: the bodies of an assembly.

    A deck of Abaqus, CalculiX or Nastran gives their isotropic materials, too. Its units are newton, second and the
    unit of length: densities in t/mm³ and moduli in MPa with a `scale` of 0.001.

    Parameters
    ----------
    path : str or Path
        The file, as for `SolidMesh.read`.
    scale : float, optional
        Length of its unit [m], 0.001 for millimetres.

    Returns
    -------
    dict of MeshPart
        Parts by name, in the order of their elements.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        As for `SolidMesh.read`.

    Examples
    --------
    Each part of a deck as a body::

        bodies = {
            name: st.SolidBody(part.mesh, part.materials, cutoff=8e3, name=name)
            for name, part in st.read_parts("brake.inp", scale=1e-3).items()
        }

    Springs of a part to the ground, as connections of its body::

        pad = st.SolidBody(part.mesh, part.materials, points=part.points, cutoff=8e3)
        springs = [
            st.Spring(pad.at(one.first), stiffness=one.stiffness, direction=one.direction)
            for one in part.springs if not one.part
        ]
    """
    instance("path", path, (str, os.PathLike))
    length = positive("scale", scale)
    return {name: _part(path, name, one, length) for name, one in mesh_files.read_each(path).items()}


def _part(path: str | os.PathLike[str], name: str, read: mesh_files.ReadPart, length: float) -> MeshPart:
    arguments: dict[str, Any] = dict(read.mesh)
    nodes = arguments.pop("nodes")
    check_finite_in(path, "nodes", nodes)
    mesh = SolidMesh(nodes * length, **arguments)
    lacking = {of: _lacking(one) for of, one in read.materials.items()}
    unknown = [f"{read.names[of]} has no {listed(words)}" for of, words in lacking.items() if words]
    given = {of: _material(one, length) for of, one in read.materials.items() if not lacking[of]}
    covered = sum(len(mesh.volumes[of]) for of in read.materials)
    if covered != len(mesh.elements):
        unknown.append(f"{named(path)} gives a material to {covered} of {len(mesh.elements)} elements")
    cells = {words_of(kind): number for kind, number in read.cells.items()}
    # Mass and stiffness per unit of length in units of newton, second and the length.
    masses = {of: float(f"{value / length:.12g}") for of, value in read.masses.items()}
    return MeshPart(
        name,
        mesh,
        MappingProxyType(given),
        listed(unknown) if unknown else "",
        MappingProxyType(cells),
        MappingProxyType(masses),
        tuple(_spring(one, parts, length) for one, parts in read.springs),
        MappingProxyType({of: tuple((place * length).tolist()) for of, place in read.points.items()}),
    )


def _spring(one: Lump, parts: list[str], length: float) -> MeshSpring:
    """Return a spring in SI units."""
    second, part = (one.labels[1], parts[1]) if len(parts) > 1 else ("", "")
    return MeshSpring(one.labels[0], second, part, one.direction, float(f"{one.value / length:.12g}"))


def _lacking(one: Elastic) -> list[str]:
    """Return the properties that a file does not give."""
    words = {"Young's modulus": one.young, "density": one.density, "Poisson's ratio": one.poisson}
    return [word for word, value in words.items() if math.isnan(value)]


def _material(one: Elastic, length: float) -> Material:
    """Return a material in SI units from units of newton, second and a length [m], without the rounding of both."""
    young, density = (float(f"{value:.12g}") for value in (one.young / length**2, one.density / length**4))
    return Material(young, density, one.poisson)
