"""`stridula mesh`: the content of a mesh file."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ..arrays import Array
from ..bodies import Material, MeshPart, SolidMesh, read_parts
from ..bodies.sections import doubts_of_material
from ..bodies.solids.mesh_parts import MeshSpring
from ..bodies.solids.mesh_quality import SLIVER
from ..checks import ArgumentError, choice, counted, listed, positive
from ..doubtful import LARGEST_SIZE, DoubtfulValue, LeftOut
from ..scenarios.quantities import quantity
from .outputs import check_outputs

# Units of mesh files [m], and sizes of bodies without materials that are not doubted [m].
UNITS = {"metres": 1.0, "millimetres": 1e-3}
LIKELY_SIZES = (1e-3, 5.0)
# Groups of a kind that are shown.
MOST_GROUPS = 40


def print_mesh(path: str, scale: str, part: str | None, plot: str | None) -> None:
    """Print the parts of a mesh file, and draw them.

    Raises
    ------
    ValueError
        If the file, an option or the format of the figure is not usable.
    OSError
        If the file cannot be read, or the figure not be written.
    """
    check_outputs(None, plot)
    length = positive("--scale", quantity(scale, "m", "--scale"))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", DoubtfulValue)
        try:
            parts = read_parts(path, length)
        except ArgumentError as error:
            raise error.renamed({"path": "FILE"}.get(error.argument, error.argument)) from None
    found = parts if part is None else {name: parts[name] for name in (_part(parts, part),)}
    console = Console()
    print(f"{Path(path).name}: {counted(len(parts), 'part')}")
    for name, one in found.items():
        table = Table(title=escape(name), show_header=False, title_justify="left")
        for title, words in facts_of(one).items():
            table.add_row(title, escape(words))
        console.print(table)
    said = {str(one.message): one.category for one in caught}
    left_out = [words for words, kind in said.items() if issubclass(kind, LeftOut)]
    unit = likely_unit(parts.values(), length)
    doubts = [] if unit else [words for words, kind in said.items() if not issubclass(kind, LeftOut)]
    for words in [*left_out, *(f"doubtful: {words}" for words in doubts), *([unit] if unit else [])]:
        print(words)
    if plot is not None:
        from ..plot import meshes, save

        save(meshes(found, title=Path(path).name), plot)
        print(plot)


def _part(parts: Mapping[str, MeshPart], name: str) -> str:
    """Return the name of a part as it is spelled."""
    key = next((one for one in parts if one.upper() == name.upper()), name)
    return choice("--part", key, tuple(parts))


def facts_of(part: MeshPart) -> dict[str, str]:
    """Return what is known of a part, in words by title."""
    mesh, kind = part.mesh, part.mesh.element_kind
    low, high = mesh.nodes.min(axis=0), mesh.nodes.max(axis=0)
    elements = listed(f"{number} {words}" for words, number in part.cells.items())
    if [*part.cells] != [kind.words]:
        elements += f", cut into {len(mesh.elements)} {kind.words}"
    quadratic = 3 * (len(mesh.nodes) + (0 if kind.middles else _edges(mesh)))
    facts = {
        "size": f"{_numbers(high - low, ' x ')} m",
        "place": f"{_numbers(low)} to {_numbers(high)} m",
        "elements": elements,
        "nodes": f"{len(mesh.nodes)}, {quadratic} degrees of freedom"
        + ("" if kind.middles else " with nodes in the middle of edges"),
        "quality": _quality(mesh),
        "volumes": _groups(f"{name} ({counted(len(those), 'element')})" for name, those in mesh.volumes.items()),
        "faces": _groups(f"{name} ({mesh.face(name).area.sum():.4g} m²)" for name in mesh.faces),
        "node sets": _groups(f"{name} ({counted(len(those), 'node')})" for name, those in mesh.node_sets.items()),
        "materials": "\n".join([*map(_material, part.given, part.given.values()), part.missing]).strip(),
        "point masses": _groups(f"{name}: {value:.4g} kg" for name, value in part.masses.items()),
        "springs": _groups(map(_spring, part.springs)),
        "volume": f"{mesh.volume.sum():.4g} m³",
        "mass": "" if part.missing else f"{part.mass:.4g} kg",
    }
    return {title: words for title, words in facts.items() if words}


def _quality(mesh: SolidMesh) -> str:
    """Return the least scaled Jacobian, where it is, and the number of slivers."""
    values = mesh.scaled_jacobian
    worst = int(values.argmin())
    place = _numbers(mesh.nodes[mesh.elements[worst]].mean(axis=0))
    words = f"scaled Jacobian of {values[worst]:.2g} at least (element at {place} m), {values.mean():.2g} in the mean"
    slivers = int((values < SLIVER).sum())
    return f"{words}; {counted(slivers, 'sliver')} below {SLIVER:g}" if slivers else words


def _groups(words: Iterable[str]) -> str:
    """Return groups, a line for each."""
    lines = [*words]
    more = [f"and {len(lines) - MOST_GROUPS} more"] if len(lines) > MOST_GROUPS else []
    return "\n".join([*lines[:MOST_GROUPS], *more])


def _material(name: str, one: Material) -> str:
    return f"{name}: {one.young / 1e9:.4g} GPa, {one.density:.4g} kg/m³, Poisson's ratio {one.poisson:.4g}"


def _spring(one: MeshSpring) -> str:
    other = f"{one.second} of {one.part}" if one.part else "the ground"
    return f"{one.first} to {other}, along ({_numbers(np.array(one.direction))}): {one.stiffness:.4g} N/m"


def _numbers(values: Array, joint: str = ", ") -> str:
    return joint.join(f"{value:.4g}" for value in np.round(values, 12) + 0.0)


def _edges(mesh: SolidMesh) -> int:
    """Return the number of edges of a mesh."""
    ends = np.sort(mesh.elements[:, np.array(mesh.element_kind.edges)].reshape(-1, 2), axis=1)
    return len(np.unique(ends, axis=0))


def likely_unit(parts: Iterable[MeshPart], scale: float) -> str:
    """Return the unit that sizes and materials have if it is another than the given one, with the option; else none."""
    ours = [*parts]
    if not _doubted(ours, 1.0):
        return ""
    for unit, length in UNITS.items():
        if doubted := _doubted(ours, 1.0) if not _doubted(ours, length / scale) else "":
            return f"{doubted} look like {unit}: try --scale {length:g}"
    return ""


def _doubted(parts: Iterable[MeshPart], factor: float) -> str:
    """Return what would be doubtful if lengths were larger by a factor: sizes, materials or both; else nothing."""
    found = []
    materials = [(one.young / factor**2, one.density / factor**4) for part in parts for one in part.given.values()]
    largest = factor * max(float(part.mesh.size.max()) for part in parts)
    low, high = (0.0, LARGEST_SIZE) if materials else LIKELY_SIZES
    if not low <= largest <= high:
        found.append("sizes")
    if any(doubts_of_material(*one) for one in materials):
        found.append("materials")
    return " and ".join(found)
