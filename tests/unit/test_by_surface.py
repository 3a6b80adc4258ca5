"""Records of surfaces with one contact for each of them."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula import plot
from stridula.records.by_surface import by_surface


@pytest.fixture(scope="module")
def run():
    """Two blocks on a belt, one with a face of four points."""
    steel = st.Material(2.1e11, 7800.0, 0.3)
    block = st.SolidBody.block((0.02, 0.02, 0.02), (1, 1, 1), steel, contact_faces=["bottom"], name="block")
    face = st.SurfaceContact(
        block, "bottom", st.RigidTrack(velocity=0.5), friction=st.Coulomb(0.3), stiffness=1e11, name="sole"
    )
    other = st.RigidBody(mass=0.1, name="shoe")
    point = st.PointContact(
        other.centre, st.RigidTrack(velocity=0.5), friction=st.Coulomb(0.3), normal=(0, 1, 0), name="heel"
    )
    drives = [st.Gravity(), st.Force(block.at("top"), y=-20.0)]
    return st.simulate(st.System([point, face], drives), 2e-3, sample_rate=2e4, surface_rate="all")


def test_forces_add_up_and_shares_are_those_of_the_points(run):
    found = by_surface(run)
    assert found["contact"].values.tolist() == ["heel", "sole"]
    assert "surface" not in found.coords
    points = run.isel(contact=slice(1, None))
    for name in ("normal_force", "tangential_force", "landings"):
        np.testing.assert_allclose(found[name].sel(contact="sole"), points[name].sum("contact"))
        np.testing.assert_array_equal(found[name].sel(contact="heel"), run[name].sel(contact="heel"))
        assert found[name].attrs == run[name].attrs
        assert found[name].dims == run[name].dims
    np.testing.assert_allclose(found.status_share.sel(contact="sole"), points.status_share.mean("contact"))
    np.testing.assert_allclose(found.status_share.sum("contact_status"), 1.0)
    assert float(found.normal_force.sel(contact="sole")[-1]) > 15.0


def test_a_record_without_surfaces_stays_as_it_is(run):
    alone = run.isel(contact=[0]).drop_vars("surface")
    assert by_surface(alone) is alone


def test_a_figure_has_a_line_and_a_ribbon_for_each_surface(run):
    figure = plot.timeline(run, ["normal_force", "status"])
    forces, ribbons = figure.axes
    assert [text.get_text() for text in forces.get_legend().get_texts()] == ["heel", "sole"]
    assert [text.get_text() for text in ribbons.get_yticklabels()] == ["heel", "sole"]
    np.testing.assert_allclose(
        forces.lines[1].get_ydata(), run.normal_force.isel(contact=slice(1, None)).sum("contact")
    )
