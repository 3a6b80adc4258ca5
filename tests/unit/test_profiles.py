"""Profiles of bodies of revolution: content, mesh files, and refusals in one line."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace

import meshio
import numpy as np
import pytest

import stridula as st
from stridula.analysis.doubts import _of as doubts_of

STEEL, IRON = st.Material(2.1e11, 7800.0), st.Material(1.1e11, 7100.0, 0.26)
BOXES = {"disc": ((0.03, 0.12), (0.0, 0.01)), "hat": ((0.03, 0.06), (0.01, 0.03))}
PROFILE = st.RectangleProfile(BOXES)
BODY = st.AxisymmetricBody(PROFILE, {"disc": IRON, "hat": STEEL}, 6000.0, "hat.top", name="disc")


def test_rectangles_fill_their_area_whatever_the_cells():
    for size in (None, 0.004, 0.0013):
        mesh = replace(BODY, profile=st.RectangleProfile(BOXES, size)).mesh
        volumes = {name: math.pi * (b**2 - a**2) * (d - c) for name, ((a, b), (c, d)) in BOXES.items()}
        for name, cells in mesh.regions.items():
            assert mesh.volumes[cells].sum() == pytest.approx(volumes[name], rel=1e-12)
        if size:
            ends = mesh.nodes[mesh.sides]
            assert np.abs(ends[:, 1] - ends[:, 0]).max() <= size * (1.0 + 1e-9)
    assert BODY.total_mass == pytest.approx(7100.0 * volumes["disc"] + 7800.0 * volumes["hat"], rel=1e-12)


def test_small_cells_grow_step_by_step():
    mesh = st.RectangleProfile({"hub": ((0.0, 0.05), (0.0, 0.05)), "flange": ((0.05, 0.1), (0.0, 0.001))}).mesh(
        lambda thickness, region: thickness
    )
    heights = np.diff(np.unique(mesh.nodes[:, 1]))
    assert heights.min() == pytest.approx(0.0005)
    assert len(heights) < 12
    # Sides that grow by half of the distance grow by exp(1 / 2) from cell to cell.
    assert (heights[1:] / heights[:-1]).max() < 1.02 * math.exp(0.5)


@pytest.mark.parametrize(
    ("profile", "thinnest"),
    [
        (PROFILE, 0.01),
        (st.RectangleProfile({"lining": ((0.0, 1.0), (0.0, 0.1)), "disc": ((0.0, 1.0), (0.1, 0.4))}), 0.4),
        (st.RectangleProfile({"rod": ((0.0, 0.1), (0.0, 5.0))}), 0.1),
        (st.LineProfile([(0.1, 0.0), (0.1, 0.2), (0.2, 0.4)], [0.01, 0.004, 0.008]), 0.004),
    ],
)
def test_the_thinnest_part_is_measured(profile, thinnest):
    """Measured normal to a slightly inclined side it is somewhat larger; cells here are coarse."""
    found = profile.mesh(lambda thickness, region: 0.01).thinnest
    assert found == pytest.approx(thinnest, rel=0.03)


def test_named_places_have_their_coordinates():
    mesh = BODY.mesh
    assert mesh.place_names[:4] == ("inner", "outer", "bottom", "top")
    for place, r, z in (
        ("inner", (0.03, 0.03), (0.0, 0.03)),
        ("outer", (0.12, 0.12), (0.0, 0.01)),
        ("hat.top", (0.03, 0.06), (0.03, 0.03)),
        ("disc.top", (0.03, 0.12), (0.01, 0.01)),
        ("hat", (0.03, 0.06), (0.01, 0.03)),
    ):
        at = mesh.nodes[mesh.sides_of(place)].reshape(-1, 2)
        np.testing.assert_allclose([at.min(axis=0), at.max(axis=0)], np.transpose([r, z]), atol=1e-15)
        np.testing.assert_array_equal(mesh.sides_of(place), mesh.sides_within(r, z))


def test_bodies_are_compared_by_content_and_travel():
    again = st.AxisymmetricBody(
        st.RectangleProfile(BOXES), {"hat": STEEL, "disc": IRON}, 6000.0, "hat.top", name="disc"
    )
    assert again == BODY
    assert hash(again) == hash(BODY)
    assert pickle.loads(pickle.dumps(BODY)) == BODY
    assert replace(BODY, axis=(0.0, 0.0, 2.0)) == BODY
    assert replace(BODY, axis=(0.0, -0.0, -1.0)) == replace(BODY, axis=(-0.0, 0.0, -1.0))
    assert replace(BODY, cutoff=7000.0) != BODY
    mesh = BODY.mesh
    profile = st.MeshProfile(mesh.nodes, mesh.cells, mesh.regions)
    same = st.MeshProfile(mesh.nodes.tolist(), mesh.cells[:, ::-1].tolist(), mesh.regions)
    assert pickle.loads(pickle.dumps(profile)) == profile
    assert len({profile, st.MeshProfile(mesh.nodes, mesh.cells, mesh.regions)}) == 1
    assert same.mesh(lambda thickness, region: 1.0).volumes.min() > 0.0
    with pytest.raises(ValueError, match="read-only"):
        profile.nodes[0] = 1.0


def test_points_have_a_place_and_a_name_of_numbers():
    point = BODY.at((0.1, 0.5, 0.004))
    assert point.position == (0.1, 0.5, 0.004)
    assert point.point_name is None
    np.testing.assert_allclose(BODY.place(point.position), [0.1 * math.cos(0.5), 0.1 * math.sin(0.5), 0.004])
    assert BODY.dimensions == "0.24 m across, 0.03 m high"
    assert BODY.posture == "axis along (0, 0, 1)"


def test_damping_takes_the_forms_of_other_bodies():
    frequencies = BODY.modes().angular_frequency
    np.testing.assert_allclose(replace(BODY, damping=0.01).modes().damping_rate, 0.02 * frequencies)
    rates = replace(BODY, damping=st.Rayleigh(3.0, 1e-7)).modes().damping_rate
    np.testing.assert_allclose(rates, 3.0 + 1e-7 * frequencies**2)
    each = np.linspace(0.01, 0.02, frequencies.size)
    np.testing.assert_allclose(replace(BODY, damping=each).modes().damping_rate, 2.0 * each * frequencies)
    with pytest.raises(st.ArgumentError, match="damping must have one ratio or"):
        replace(BODY, damping=[0.01]).modes()


def parts(mesh):
    """Return nodes in millimetres, and the cells of each group of a mesh."""
    points = np.hstack([1e3 * mesh.nodes, np.zeros((len(mesh.nodes), 1))])
    disc, hat = (mesh.cells[mesh.regions[name]] for name in ("disc", "hat"))
    return points, {"disc": ("quad", disc), "hat": ("quad", hat), "clamp": ("line", mesh.sides_of("hat.top"))}


def write_gmsh(path, mesh):
    """Groups as a number of each cell."""
    points, groups = parts(mesh)
    tags = [np.full(len(block), k + 1) for k, (_, block) in enumerate(groups.values())]
    names = {name: np.array([k + 1, 1 if kind == "line" else 2]) for k, (name, (kind, _)) in enumerate(groups.items())}
    data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    written = meshio.Mesh(points, list(groups.values()), cell_data=data, field_data=names)
    written.write(path.with_suffix(".msh"), file_format="gmsh22")
    return path.with_suffix(".msh")


def write_abaqus(path, mesh):
    """Groups as sets of cells."""
    points, groups = parts(mesh)
    sets = {
        name: [
            np.arange(len(block)) if other == name else np.zeros(0, dtype=int) for other, (_, block) in groups.items()
        ]
        for name in groups
    }
    meshio.Mesh(points, list(groups.values()), cell_sets=sets).write(path.with_suffix(".inp"))
    return path.with_suffix(".inp")


@pytest.mark.parametrize("write", [write_gmsh, write_abaqus])
def test_a_profile_from_a_file_has_the_same_modes(tmp_path, write):
    profile = st.MeshProfile.read(write(tmp_path / "disc", BODY.mesh), scale=1e-3)
    assert profile.region_names == ("disc", "hat")
    body = replace(BODY, profile=profile, held="clamp")
    np.testing.assert_allclose(body.modes().frequency, BODY.modes().frequency, rtol=1e-8)


def test_cells_of_higher_degree_and_mixed_ones_are_read(tmp_path):
    nodes = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1], [0.5, 0], [1, 0.5], [0.5, 1], [0, 0.5], [9, 9]])
    cells = [("quad8", np.array([[0, 1, 2, 3, 6, 7, 8, 9]])), ("triangle", np.array([[1, 4, 5], [1, 5, 2]]))]
    path = tmp_path / "mixed.vtk"
    # In the plane of x and z.
    meshio.Mesh(np.insert(nodes.astype(float), 1, 0.0, axis=1), cells).write(path)
    profile = st.MeshProfile.read(path, plane="xz")
    assert profile.cells.shape == (4, 3)
    assert len(profile.nodes) == 6
    assert profile.region_names == ("body",)
    assert profile.mesh(lambda thickness, region: 1.0).volumes.sum() == pytest.approx(math.pi * 4.0)
    with pytest.raises(st.ArgumentError, match="plane must be the plane in which the mesh"):
        st.MeshProfile.read(path)


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.msh", "nonsense", "path must be a file of a mesh"),
        ("a.unknown", "nonsense", "path must be a file of a mesh"),
        ("a.inp", "*NODE\n1, 0, 0\n", "path must be a file with triangles"),
    ],
)
def test_files_that_hold_no_profile_are_refused(tmp_path, capsys, name, text, words):
    (tmp_path / name).write_text(text)
    with pytest.raises(st.ArgumentError, match=words) as refused:
        st.MeshProfile.read(tmp_path / name)
    assert "\n" not in str(refused.value)
    assert capsys.readouterr() == ("", "")


def test_a_missing_file_is_reported():
    with pytest.raises(FileNotFoundError, match=r"cannot read 'nowhere\.msh'"):
        st.MeshProfile.read("nowhere.msh")


def rectangles(*boxes):
    return lambda: st.RectangleProfile([("a", box) for box in boxes])


def line(*points, thickness=0.01):
    return lambda: st.LineProfile(points, thickness)


SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


def mesh(nodes, cells, **named):
    return lambda: st.MeshProfile(nodes, cells, **named)


def body(**changes):
    return lambda: replace(BODY, **changes)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (rectangles(((-0.1, 0.1), (0, 1))), r"r of 'a' must be 0 or above, got -0.1"),
        (rectangles(((0.1, 0.1), (0, 1))), "r of 'a' must increase"),
        (rectangles(((0, 1), (0, 1)), ((0.5, 2), (0.5, 2))), "rectangles must not overlap, got 'a' and 'a'"),
        (rectangles(((0, 1), (0, 1)), ((2, 3), (0, 1))), "rectangles must be in one piece"),
        (rectangles(((0, 1), (0, 1)), ((1, 2), (1, 2))), "rectangles must be in one piece"),
        (rectangles(), "rectangles must be one or more"),
        (lambda: st.RectangleProfile({"a.b": ((0, 1), (0, 1))}), "names without a dot"),
        (lambda: st.RectangleProfile({"a": (0, 1)}), "r of 'a' must be two numbers"),
        (lambda: st.RectangleProfile({"a": ((0, 1), (0, 1))}, size=0.0), "size must be above 0"),
        (lambda: replace(BODY, profile=st.RectangleProfile(BOXES, size=1e-6)), "size must leave at most 10000 cells"),
        (line((0.1, 0.0)), "points must be two or more, got 1"),
        (line((0.1, 0.0), (0.1, 0.0)), r"points\[1\] must differ"),
        (line((0.1, 0.0), (0.2, 0.0), (0.1, 0.0)), "points must not double back"),
        (line((0.001, 0.0), (0.001, 1.0)), "not cross the axis: r >= 0, got r = -0.004 m"),
        (line((0.0, 0.0), (0.3, 0.3), (0.3, 0.0), (0.0, 0.3)), "must not cross or touch itself"),
        (line((0.1, 0.0), (0.104, 0.0), (0.104, 0.004), thickness=0.02), "must not fold back on itself"),
        (line((0.1, 0.0), (0.2, 0.0), thickness=[0.01]), "thickness must be one or 2"),
        (line((0.1, 0.0), (0.2, 0.0), thickness=-1.0), "thickness must be above 0"),
        (mesh([(-1.0, 0.0), (1.0, 0.0), (1.0, 1.0)], [(0, 1, 2)]), "cells must not cross the axis"),
        (mesh(SQUARE, [(0, 1, 3, 2)]), "cells must not fold back"),
        (mesh(SQUARE, [(0, 1, 2, 4)]), "cells must be numbers of nodes, from 0 to 3, got 4"),
        (mesh(SQUARE, [(0, 1)]), "cells must have the shape"),
        (mesh(SQUARE, [(0, 1, 2, 3)], regions={"a": [0, 0]}), "regions must hold each of the 1 cells once"),
        (mesh([*SQUARE, (2, 0.5), (2, 0), (2, 1), (1, 0.5)], [(0, 1, 2, 3), (1, 5, 4, 7)]), "one piece"),
        (body(held="rim"), "held.0. must be one of inner, outer"),
        (body(held=st.Held(((0.2, 0.3), (0.0, 1.0)))), "held.0. must hold a side of a cell or more"),
        (body(held=3), "held.0. must be a Held, got 3"),
        (body(held=[3]), "held.0. must be a Held"),
        (lambda: st.Held("inner", "x"), "directions.0. must be one of r, theta, z"),
        (lambda: st.Held((0, 1)), "place must be the name of a place or a box"),
        (lambda: st.Held(((1, 0), (0, 1))), "place must have ranges whose first number is not above the second"),
        (body(material={"disc": STEEL}), "material must be given for all regions, disc, hat, got none for hat"),
        (body(material={"disc": STEEL, "hub": STEEL}), "material must be one of disc, hat"),
        (body(material=7800.0), "material must be a Material"),
        (body(material=st.Material(1e7, 1e3, 0.4999)), "material must have a Poisson's ratio from -0.99 to 0.499"),
        (body(material=st.Material(2e11, 1e-300)), "material and profile must hold numbers of ordinary size"),
        (body(residual_at=[(0.1, 0.02)]), "residual_at.0. must be .r, z. in the profile"),
        (body(residual_at=[0.1]), "residual_at.0. must be a place"),
        (body(residual_at=0.1), "residual_at must be places"),
        (body(profile=BOXES), "profile must be a RectangleProfile"),
        (body(cutoff=0.0), "cutoff must be above 0"),
        (body(cutoff=1e8), "cutoff must leave at most 10000 cells"),
        (body(orders=-1), "orders must be at least 0"),
        (body(axis=(0, 0, 0)), "axis must be a direction"),
        (body(axis=(0, 1)), "axis must be three numbers"),
        (body(origin=(0, 1, math.inf)), "origin.2. must be finite"),
        (lambda: BODY.at((0.1, 0.0, 0.02)), "position must be .r, theta, z. in the profile"),
        (lambda: BODY.at(0.1), "position must be three numbers"),
        (lambda: BODY.modes(held_x=True), "held_x must be False"),
        (
            lambda: replace(BODY, cutoff=10.0).modes(),
            "cutoff must leave at least one mode .first at [0-9.]+ Hz., got 10.0",
        ),
    ],
)
def test_bad_profiles_are_refused_in_one_line(make, words):
    with pytest.raises(st.ArgumentError, match=words) as refused:
        make()
    assert "\n" not in str(refused.value)


def test_nothing_but_numbers_is_taken_for_a_mesh():
    for nodes, cells in (
        ("abc", [(0, 1, 2)]),
        (SQUARE, [(0, 1, 2.5)]),
        ([(0, math.nan)] * 3, [(0, 1, 2)]),
        (SQUARE, []),
    ):
        with pytest.raises(st.ArgumentError):
            st.MeshProfile(nodes, cells)


def test_units_of_finite_element_programs_raise_doubts():
    """Millimetres, tonnes and MPa: right frequencies in millimetres, wrong ones in metres."""
    tonnes = "did you mean t/mm3, as in finite-element programs?"
    odd = replace(BODY, material={"disc": IRON, "hat": st.Material(2.1e11, 7.8e-9)})
    assert list(doubts_of("disc", odd)) == [f"disc, hat: density of 7.8e-09 kg/m3; {tonnes}"]
    odd = replace(BODY, material=st.Material(7e4, 2.7e-9))
    assert [line.split("; ")[1] for line in doubts_of("disc", odd)] == [
        "did you mean MPa?",
        tonnes,
    ]
    assert not list(doubts_of("disc", BODY))
