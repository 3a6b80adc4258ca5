"""A track and a law from outside the package work like built-in ones, without registration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import stridula as st
from stridula import plot

from .user_classes import Cable, Halving

STEP = 5e-6


def rubbed(track, friction):
    rod = st.FiniteElementBeam(
        st.Material(2.1e11, 7800.0), st.Rectangle(0.02, 0.008), 0.3, np.radians(20.0), elements=4, damping=0.02
    )
    contact = st.PointContact(rod.tip, track, at=0.3, friction=friction)
    return st.System(contact, [st.Force(rod.root, x=6.0, y=-20.0)])


def run(system, duration=0.01):
    return st.simulate(system, duration, step=STEP, sample_rate=0.2 / STEP)


def test_a_track_from_outside_marches_as_the_beam_with_its_modes():
    """A cable with the frequencies of a beam is the beam: same shapes, no axial modes."""

    @dataclass(frozen=True)
    class LikeABeam(Cable):
        def modes(self, held_x=False):
            return BEAM.modes()

    BEAM = st.ModalBeam(st.Material(2.1e11, 7800.0), st.Rectangle(0.02, 0.008), 0.8, bending_modes=9, axial_modes=0)
    cable = LikeABeam(0.8, BEAM.total_mass, 1.0, 9)
    found, expected = (run(rubbed(track, st.Coulomb(0.3))) for track in (cable, BEAM))
    assert (found.normal_force.values > 0.0).any()
    for name in ("normal_force", "contact_position", "friction_loss", "acceleration"):
        np.testing.assert_allclose(found[name], expected[name], rtol=1e-9, atol=1e-9 * np.abs(expected[name]).max())


def test_a_track_and_a_law_from_outside_together_side_by_side_and_in_linear_theory():
    cable, law = Cable(0.8, 0.5, 200.0, 12), Halving(0.4, 0.05)
    system = rubbed(cable, law)
    alone = run(system)
    assert set(np.unique(alone.status)) >= {2}
    assert abs(alone.ledger_residual).max() < 1e-10 * alone.drive_work.max()
    slid = alone.status.values == 2
    ratio = alone.tangential_force.values[slid] / alone.normal_force.values[slid]
    assert ratio.max() <= law.coefficient * (1 + 1e-9)
    many = st.simulate_many([system] * 5, 0.01, step=STEP, sample_rate=0.2 / STEP)
    np.testing.assert_allclose(many[3].normal_force, alone.normal_force, rtol=1e-6, atol=1e-6)
    assert "halving" in alone.attrs["scenario"]
    theory = st.sliding_stability(rubbed(cable, st.Coulomb(0.3)))
    assert theory.sizes["mode"] > 10


def test_a_law_from_outside_is_drawn():
    law = Halving(0.4, 0.05)
    backward, forward, *_ = plot.friction(law).axes[0].lines
    for line, sense in ((backward, -1.0), (forward, 1.0)):
        speeds = np.abs(line.get_xdata())
        np.testing.assert_allclose(line.get_ydata(), sense * 0.2 * (1.0 + np.exp(-speeds / 0.05)), rtol=1e-12)
