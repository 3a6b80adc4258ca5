"""Systems that would take too long or too much memory are refused before any work, in one line that names the cause."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.bodies.reduction import sparse_reduction
from stridula.bodies.revolution import profile_mesh
from stridula.bodies.revolution.profile_mesh import ProfileMesh

STEEL = st.Material(210e9, 7800.0, 0.3)
THIN = """base = "glass"
[bodies.glass.profile]
shape = "line"
points = [[0.002, 0.0], [0.03, 0.17]]
thickness = 1e-7
"""
HIGH = """base = "glass"
[bodies.glass]
cutoff = "200 kHz"
"""


@pytest.fixture
def nothing_computed(monkeypatch):
    def crossing(nodes, outline, margin):
        assert len(outline) < 2 * profile_mesh.MOST_MADE
        return

    monkeypatch.setattr("stridula.bodies.revolution.profile_mesh._first_crossing", crossing)
    monkeypatch.setattr(
        "stridula.bodies.revolution.axisymmetric_body._families", lambda body: pytest.fail("modes are computed")
    )


@pytest.mark.usefixtures("nothing_computed")
@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            THIN,
            r"bodies.glass.cutoff must leave at most 10000 cells, got \d+ and more: give a larger size, or a larger ",
        ),
        (HIGH, r"bodies.glass.cutoff must leave at most 400000 degrees of freedom, got 200000.0 Hz, which has \d+ in "),
    ],
)
def test_profiles_that_need_too_many_cells_are_refused(text, words, tmp_path):
    (tmp_path / "own.toml").write_text(text)
    with pytest.raises(ValueError, match=f"^{words}") as refused:
        st.load_scenario(tmp_path / "own.toml")
    assert "\n" not in str(refused.value)


@pytest.mark.usefixtures("nothing_computed")
def test_a_size_of_cells_allows_a_higher_cutoff():
    line = {"points": [(0.03, 0.0), (0.03, 0.17)], "thickness": 0.001}
    with pytest.raises(st.ArgumentError, match=r"^cutoff must .*: lower it, or give the profile a size$"):
        st.AxisymmetricBody(st.LineProfile(**line), STEEL, 400e3)
    st.AxisymmetricBody(st.LineProfile(**line, size=1e-3), STEEL, 400e3)
    with pytest.raises(st.ArgumentError, match=r"^cutoff must .*: lower it, or take a coarser mesh$"):
        st.AxisymmetricBody(st.LineProfile(**line, size=1e-4), STEEL, 30e6)


def test_unknowns_are_those_of_the_elements():
    fourier_elements = pytest.importorskip("stridula.bodies.revolution.fourier_elements")
    nodes = np.array([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [1.0, 1.0], [2.0, 1.0], [3.0, 1.0]])
    for cells in ([[0, 1, 4, 3], [1, 2, 5, 4]], [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]]):
        mesh = ProfileMesh(nodes, np.array(cells), {"body": np.arange(len(cells))})
        assert mesh.unknowns == 3 * fourier_elements.fourier_elements(mesh, [STEEL]).count


@pytest.mark.parametrize("across", [False, True])
def test_crossings_are_found_wherever_they_are(across):
    """In profiles that are longer along r or along z, with sides in any order."""
    dice = np.random.default_rng(1)
    for size in (5, 300, 700):
        # A staircase whose last step meets one of the others, or does not.
        nodes = np.cumsum(np.abs(dice.standard_normal((size, 2))) * (1.0, 20.0), axis=0)
        outline = dice.permutation(np.stack([np.arange(size - 1), np.arange(1, size)], axis=1))
        nodes = nodes[:, ::-1] if across else nodes
        assert profile_mesh._first_crossing(nodes, outline, 0.0) is None
        middle = nodes[size // 2 : size // 2 + 2].mean(axis=0)
        bar = middle + np.array([[1e-3, -1e-3], [-1e-3, 1e-3]])
        found = profile_mesh._first_crossing(np.vstack([nodes, bar]), np.vstack([outline, [[size, size + 1]]]), 0.0)
        assert found in (size - 1, *np.flatnonzero((outline == [size // 2, size // 2 + 1]).all(axis=1)))


@pytest.mark.parametrize(
    "make",
    [
        lambda: st.SolidMesh.block((1.0, 1.0, 1.0), (40, 40, 40)),
        lambda: st.SolidBody.block((1.0, 1.0, 1.0), (10**6, 10**6, 10**6), STEEL),
        lambda: st.SolidMesh.sector((0.1, 0.2), (0.0, 1.0), {"a": 0.1, "b": 0.1}, (30, 30, 30)),
        lambda: st.SolidMesh.extrusion([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2, 3)], 1.0, 10**5),
    ],
)
def test_meshes_of_too_many_nodes_are_refused_before_they_are_made(make, monkeypatch):
    for name in ("block", "sector", "extrusion"):
        monkeypatch.setattr(f"stridula.bodies.solids.shapes.{name}", lambda *given: pytest.fail("it is made"))
    with pytest.raises(st.ArgumentError, match=r"^(divisions|layers) must make at most 200000 nodes, got \d+"):
        make()


def test_the_number_of_nodes_is_known_beforehand(monkeypatch):
    given = ((1.0, 1.0, 1.0), (3, 4, 5))
    nodes = len(st.SolidMesh.block(*given).nodes)
    monkeypatch.setattr("stridula.bodies.solids.solid_mesh.MOST_NODES", nodes)
    st.SolidMesh.block(*given)
    monkeypatch.setattr("stridula.bodies.solids.solid_mesh.MOST_NODES", nodes - 1)
    with pytest.raises(st.ArgumentError, match=rf"must make at most {nodes - 1} nodes, got {nodes}$"):
        st.SolidMesh.block(*given)


def test_a_search_for_far_too_many_modes_is_not_begun(monkeypatch):
    monkeypatch.setattr("stridula.bodies.solids.solid_body.reduce_sparse", lambda *given: pytest.fail("it is begun"))
    body = st.SolidBody.block((0.1, 0.1, 0.1), (7, 7, 7), STEEL, cutoff=1e6)
    with pytest.raises(st.ArgumentError, match=r"^cutoff must leave at most 2000 modes of a mesh, got 1e.06 Hz, be"):
        body.modes()


def test_the_estimate_of_modes_is_a_lower_bound():
    body = st.SolidBody.block((0.1, 0.1, 0.1), (6, 6, 6), STEEL, cutoff=40e3)
    shear = STEEL.young / 2.6
    expected = 1e-3 * 8.0 * np.pi / 3.0 * (40e3 / np.sqrt(shear / STEEL.density)) ** 3
    assert expected < body.modes().count < sparse_reduction.MOST_MODES


@pytest.mark.parametrize("value", [1e12, 1e308])
@pytest.mark.parametrize(
    "make",
    [
        lambda value: st.SolidBody.block((0.1, 0.1, 0.1), (2, 2, 2), STEEL, cutoff=value),
        lambda value: st.ModalBeam(STEEL, st.Rectangle(0.01, 0.01), 1.0, cutoff=value),
        lambda value: st.Harmonic(frequency=value),
        lambda value: st.load_scenario("glass", {"bodies.glass.cutoff": value}),
    ],
)
def test_frequencies_beyond_any_vibration_are_refused(make, value):
    with pytest.raises(ValueError, match=r"(cutoff|frequency) must be below 1e\+12"):
        make(value)


@pytest.mark.parametrize("form", ["{ a = 1 }", "['rising']", "7"])
def test_a_form_of_damping_is_a_word(form, tmp_path):
    (tmp_path / "own.toml").write_text(f'base = "squeal"\n[damping]\nform = {form}\nratio = 0.1\n')
    with pytest.raises(ValueError, match=r"^damping must have a form that is one of rayleigh, rising, sampled, got "):
        st.load_scenario(tmp_path / "own.toml")
