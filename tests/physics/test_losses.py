"""Loss factors of materials: damping of modes against closed forms and complex eigenvalues."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg

import stridula as st
from stridula.bodies.solids.elements import assembled

LOSS = 0.02
STEEL = st.Material(2.1e11, 7800.0, 0.3, loss_factor=LOSS)
PLAIN = st.Material(2.1e11, 7800.0, 0.3)
SECTION = st.Rectangle(0.02, 0.005)


def bodies(material):
    profile = st.RectangleProfile({"disc": ((0.05, 0.1), (-0.005, 0.005))})
    return {
        "finite-element beam": st.FiniteElementBeam(material, SECTION, 0.4, cutoff=2e3, damping=0.01),
        "modal beam": st.ModalBeam(material, SECTION, 0.4, cutoff=2e3, damping=0.01),
        "plate": st.ModalPlate(material, 0.002, 0.4, 0.3, cutoff=800.0, damping=0.01),
        "disc": st.AxisymmetricBody(profile, material, 6e3, "inner", damping=0.01),
        "solid": st.SolidBody.block((0.1, 0.01, 0.02), (5, 1, 1), material, cutoff=2e4, damping=0.01),
    }


@pytest.mark.parametrize("name", bodies(STEEL))
def test_a_body_of_one_material_has_half_its_loss_factor_as_further_damping_ratio(name):
    lossy, plain = bodies(STEEL)[name].modes(), bodies(PLAIN)[name].modes()
    elastic = (plain.angular_frequency > 0.0) & np.isfinite(plain.angular_frequency)
    assert elastic.sum() > 3
    np.testing.assert_array_equal(lossy.angular_frequency, plain.angular_frequency)
    expected = plain.damping_rate + LOSS * np.where(elastic, plain.angular_frequency, 0.0)
    np.testing.assert_allclose(lossy.damping_rate, expected, rtol=1e-12)
    np.testing.assert_allclose(lossy.damping_rate[elastic] / plain.damping_rate[elastic], 2.0, rtol=1e-9)


def test_tension_of_a_string_stores_energy_without_a_loss():
    """The loss is that of bending: its share of the squared frequency, ``E I k^4 / (E I k^4 + T k^2)``."""
    string = st.ModalBeam(STEEL, st.Rectangle(1e-3, 1e-3), 0.33, cutoff=4e3, tension=50.0)
    modes, wave = string.modes(), np.pi / 0.33 * np.arange(1, 5)
    bending = 2.1e11 * 1e-12 / 12.0 * wave**4
    expected = LOSS * bending / (bending + 50.0 * wave**2) * modes.angular_frequency[:4]
    np.testing.assert_allclose(modes.damping_rate[:4], expected, rtol=1e-9)


def layered(loss_below, loss_above):
    """A cantilever of two layers: a stiff one and a soft one on it."""
    mesh = st.SolidMesh.block((0.1, 0.01, 0.02), (6, 2, 1))
    heights = mesh.nodes[mesh.elements].mean(axis=1)[:, 1]
    groups = {"below": np.flatnonzero(heights < 0.005), "above": np.flatnonzero(heights > 0.005)}
    materials = {
        "below": st.Material(7e10, 2700.0, 0.3, loss_factor=loss_below),
        "above": st.Material(2e9, 1200.0, 0.4, loss_factor=loss_above),
    }
    mesh = st.SolidMesh(mesh.nodes, mesh.elements, mesh.kind, volumes=groups, faces=mesh.faces)
    return st.SolidBody(mesh, materials, fixed=["left"], cutoff=3e4, residual_flexibility=False)


def test_a_body_of_two_materials_has_the_damping_of_its_complex_stiffness():
    """The ratio of imaginary and real part of the eigenvalues of ``K (1 + i loss)``, to the square of the loss."""
    body = layered(1e-3, 2e-3)
    mesh = body.mesh
    parts = [(material, mesh.volumes[name]) for name, material in body.materials.items()]

    def matrices(those):
        mass, stiffness = assembled(mesh.element_kind, mesh.nodes, mesh.elements, those)
        return np.kron(mass.toarray(), np.eye(3)), stiffness.toarray()

    mass, stiffness = matrices(parts)
    stiffness = stiffness + sum(1j * part[0].loss_factor * matrices([part])[1] for part in parts)
    free = body._free
    values = scipy.linalg.eigvals(stiffness[np.ix_(free, free)], mass[np.ix_(free, free)])
    values = values[np.argsort(values.real)]
    modes = body.modes()
    kept = modes.angular_frequency.size
    assert kept > 4
    losses = modes.damping_rate / modes.angular_frequency
    np.testing.assert_allclose(losses, (values.imag / values.real)[:kept], rtol=1e-5)
    assert losses.min() > 1e-3
    assert np.ptp(losses) > 1e-5


def test_a_lossless_layer_dilutes_the_loss():
    one, other, both = (layered(*losses).modes().damping_rate for losses in ((0.01, 0.0), (0.0, 0.02), (0.01, 0.02)))
    np.testing.assert_allclose(one + other, both, rtol=1e-6)
    assert (one > 0.0).all()
    assert (other > 0.0).all()


def test_regions_of_a_disc_add_up_to_the_whole():
    """Equal loss factors of both regions are that of the body, and each alone is a part of it."""

    def disc(inside, outside):
        profile = st.RectangleProfile({"hub": ((0.05, 0.07), (-0.01, 0.01)), "rim": ((0.07, 0.1), (-0.005, 0.005))})
        materials = {
            "hub": st.Material(2.1e11, 7800.0, 0.3, loss_factor=inside),
            "rim": st.Material(1.1e11, 7200.0, 0.26, loss_factor=outside),
        }
        modes = st.AxisymmetricBody(profile, materials, 8e3, "inner").modes()
        return modes.damping_rate / modes.angular_frequency

    hub, rim, both = disc(LOSS, 0.0), disc(0.0, LOSS), disc(LOSS, LOSS)
    np.testing.assert_allclose(both, LOSS, rtol=1e-12)
    np.testing.assert_allclose(hub + rim, LOSS, rtol=1e-9)
    assert (hub > 0.0).all()
    assert (rim > hub).any()


def test_a_ringing_body_loses_the_energy_of_its_loss_factor():
    """A beam of a lossy material decays by ``exp(-loss w t / 2)``."""
    beam = st.ModalBeam(STEEL, SECTION, 0.4, cutoff=200.0, name="beam")
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, beam.at(0.2), gap=1.0)
    drives = [st.InitialVelocity(beam, y=0.1)]
    run = st.simulate(st.System(contact, drives), 0.2, sample_rate=2e4)
    angular, time = beam.modes().angular_frequency[0], run["time"].values
    energy = run["kinetic_and_elastic"].values
    fallen = np.log(energy[-1] / energy[0]) / (time[-1] - time[0])
    assert fallen == pytest.approx(-LOSS * angular, rel=0.02)


@pytest.mark.parametrize("loss", [-0.1, 1.0, float("nan")])
def test_loss_factors_out_of_range_are_refused(loss):
    with pytest.raises(ValueError, match=r"^loss_factor must be"):
        st.Material(2.1e11, 7800.0, loss_factor=loss)
