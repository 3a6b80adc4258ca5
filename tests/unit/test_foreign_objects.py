"""Methods called with objects that they were not made for refuse them in one line."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import stridula as st

STEEL = st.Material(210e9, 7800.0, 0.3)
BEAM = st.FiniteElementBeam(STEEL, st.Rectangle(0.01, 0.01), 0.5, 0.3, elements=4)
CUBE = st.SolidBody.block((1.0, 1.0, 1.0), (1, 1, 1), STEEL)
SYSTEM = st.load_scenario("squeal").system
FOREIGN = {
    "nothing": None,
    "a text": "x",
    "a number": 1.5,
    "a list": [["x"]],
    "a Dataset": xr.Dataset(),
    "an object": object(),
    "another body": CUBE,
}


@pytest.mark.parametrize("body", FOREIGN.values(), ids=FOREIGN)
def test_bodies_of_no_system_have_no_name_in_it(body):
    with pytest.raises(
        st.ArgumentError, match=r"^body must be a body of the system \(slider, track\), got "
    ) as refused:
        SYSTEM.body_name(body)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("vector", FOREIGN.values(), ids=FOREIGN)
@pytest.mark.parametrize(
    "body", [BEAM, CUBE, st.PointMass(1.0), st.RigidBody(1.0, name="ball")], ids=lambda body: body.kind
)
def test_displacements_are_numbers(body, vector):
    with pytest.raises(st.ArgumentError, match=r"^(vector|nodal) must (be|have) ") as refused:
        body.modal_coordinates(vector)
    assert "\n" not in str(refused.value)


def test_displacements_of_a_beam_are_those_of_its_nodes():
    with pytest.raises(st.ArgumentError, match=r"^nodal must have the shape \(15,\), got \(3,\)"):
        BEAM.modal_coordinates(np.zeros(3))


@pytest.mark.parametrize("name", [["left"], {"left": 1}, None, 1.0])
@pytest.mark.parametrize(
    "method", [CUBE.face_points, CUBE.face, CUBE.mesh.nodes_of, lambda name: CUBE.mesh.named(name, [0])]
)
def test_names_are_texts(method, name):
    with pytest.raises(st.ArgumentError, match=r"^(name|face|group) must be "):
        method(name)


@pytest.mark.parametrize("cells", [[[0, 1, np.nan]], [[0, 1, 1e300]], [[0, 1, 2j]], [["a", "b", "c"]]])
def test_cells_of_profiles_are_whole_numbers(cells):
    with pytest.raises(st.ArgumentError, match=r"^cells must be (whole numbers|an array of numbers), got "):
        st.MeshProfile([(0.1, 0.0), (0.2, 0.0), (0.1, 0.1)], cells)
