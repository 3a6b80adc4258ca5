"""Mirror images, changes of frame and of scale."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from physics.cases import CASES, SCHEME_NAMES, SCHEMES, STEEL, STRIP, every_step, pair

STEPS = 3000


def mirrored(system: st.System) -> st.System:
    """The system seen from behind: x -> L - x, angle -> -angle.

    The transverse direction (cos a, -sin a) becomes minus that of the mirrored slider, the axial one its own.
    """
    rod = replace(system.slider, angle=-system.slider.angle)
    bar = system.track
    contact = replace(system.contact, tip=rod.tip, at=bar.length - system.contact.at)

    def reflect(drive):
        if isinstance(drive, st.Force):
            if drive.point.body == bar:
                return replace(drive, point=bar.at(bar.length - drive.point.position), axial=-drive.axial, x=-drive.x)
            return replace(drive, point=rod.at(drive.point.position), transverse=-drive.transverse, x=-drive.x)
        if isinstance(drive, st.ImposedVelocity):
            return replace(drive, point=rod.root, velocity=-drive.velocity)
        if isinstance(drive, st.InitialVelocity):
            return replace(drive, body=rod if drive.body == system.slider else bar, x=-drive.x)
        return drive

    return st.System(contact, [reflect(drive) for drive in system.drives])


def differences(one, other, length) -> list[float]:
    """Largest differences of the mirrored records over their peaks: normal, tangential, position, energy."""

    def off(a, b):
        return float(np.abs(a - b).max() / np.abs(b).max())

    return [
        off(one.normal_force.values, other.normal_force.values),
        off(-one.tangential_force.values, other.tangential_force.values),
        off(length - one.contact_position.values, other.contact_position.values),
        off(one.kinetic_and_elastic.values, other.kinetic_and_elastic.values),
    ]


@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
@pytest.mark.parametrize("name", CASES)
def test_mirror_image(name, scheme):
    """The mirrored system gives the mirrored run. L - x rounds an abscissa by 1e-16 m, the sines by k times that; a
    perturbation of 1e-9 of the gap moves forces by up to 1e-7 over as many steps, so one of 1e-10 by less than 1e-6."""
    system = CASES[name]()
    system = replace(system, contact=replace(system.contact, gap=1e-8))
    run, image = (every_step(s, STEPS, scheme) for s in (system, mirrored(system)))
    np.testing.assert_array_equal(run.status.values, image.status.values)
    assert set(run.status.values) - {0}
    assert max(differences(image, run, system.track.length)) < 1e-6


def test_mirror_harness_rejects_half_a_mirror():
    """Negative control: the slider mirrored but not the force."""
    system = CASES["squeal"]()
    half = mirrored(system)
    half = replace(half, drives=[replace(half.drives[0], transverse=-half.drives[0].transverse)])
    run, image = (every_step(s, STEPS, SCHEMES[1]) for s in (system, half))
    assert max(differences(image, run, system.track.length)) > 0.1


@pytest.mark.parametrize("velocity", [0.05, -0.3])
@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
def test_galileo_frictionless(scheme, velocity):
    """Upright and without friction nothing acts along x: an imposed velocity and a throw are the same motion."""
    rod = st.FiniteElementBeam(STEEL, STRIP, 0.5, elements=10, damping=0.02, cutoff=15e3)
    pressed = st.Force(rod.root, y=-3.0)
    thrown = pair(lambda _: [st.InitialVelocity(rod, x=velocity), pressed], 0.0, rod=rod, at=0.4)
    dragged = pair(lambda _: [st.ImposedVelocity(rod.root, velocity, 3.0)], 0.0, rod=rod, at=0.4)
    one, other = (every_step(s, 20_000, scheme) for s in (thrown, dragged))
    assert (one.normal_force > 0).mean() > 0.3
    np.testing.assert_allclose(one.contact_position, other.contact_position, atol=1e-12)
    scale = float(one.normal_force.max())
    np.testing.assert_allclose(one.normal_force, other.normal_force, atol=1e-6 * scale)


def reaction_against_constraint(velocity, factor=1.0):
    """Largest difference of the normal force between a dragged slider and a thrown one under the same reaction.

    Undamped slider with all its modes and central differences: held or free, its motion solves the same equations
    ``M (u[n+1] - 2 u[n] + u[n-1]) / h² + K u[n] = f[n]``, so that the reaction recorded under the imposed velocity, put
    on a free slider, keeps its root at v t.
    """
    rod = st.FiniteElementBeam(STEEL, STRIP, 0.5, angle=-0.7, elements=4)
    step, steps = 5e-6, 2000
    words = {"scheme": st.CentralDifference(), "step": step, "sample_rate": 1 / step}
    dragged = pair(lambda _: [st.ImposedVelocity(rod.root, velocity, 20.0)], 1.2, rod=rod, gap=1e-7)
    probes = [st.Reaction(rod, "x"), st.Displacement(rod.root, "x")]
    run = st.simulate(dragged, steps * step, probes=probes, **words)
    # The first sample is at one step; before contact the load along y bends the held slider from the first instant.
    times = np.arange(1, steps + 1) * step
    held = run.reaction.values[:, 0]
    first = first_reaction(dragged, rod, step)
    history = st.Sampled((0.0, *times), (factor * first, *(factor * held)))
    thrown = pair(
        lambda _: [
            st.InitialVelocity(rod, x=velocity),
            st.Force(rod.root, y=-20.0),
            st.Force(rod.root, x=1.0, history=history),
        ],
        1.2,
        rod=rod,
        gap=1e-7,
    )
    free = st.simulate(thrown, steps * step, probes=[st.Displacement(rod.root, "x")], **words)
    assert (run.normal_force > 0).mean() > 0.1
    np.testing.assert_allclose(run.displacement.values[:, 0], velocity * times, atol=1e-15)
    slipped = np.abs(free.displacement.values[:, 0] - velocity * times).max()
    return slipped, float(np.abs(run.normal_force - free.normal_force).max() / run.normal_force.max())


def first_reaction(system, rod, step):
    """Reaction along x at the first instant: of the mass rows on the acceleration that the load gives at rest."""
    modes = rod.modes(held_x=True)
    acceleration = rod.trace(rod.length, held_x=True)[1] * -20.0
    assert modes.count == acceleration.size
    return float(rod.root_reaction(True).mass[0] @ acceleration)


@pytest.mark.parametrize("velocity", [0.02, -0.02])
def test_galileo_with_the_reaction_in_place_of_the_constraint(velocity):
    """The root stays at v t within 1e-9 m of a travel of 2e-4 m, and the contact forces are the same to 1e-5 of the
    peak: the reaction is a difference of rows of K q, K of order 1e9, that rounds by 1e-13 N x the steps squared."""
    slipped, off = reaction_against_constraint(velocity)
    assert slipped < 1e-9
    assert off < 1e-5


def test_galileo_harness_rejects_a_wrong_reaction():
    """Negative control: one part in a hundred of the reaction left out."""
    assert reaction_against_constraint(0.02, factor=0.99)[1] > 1e-3
    assert reaction_against_constraint(0.02, factor=-1.0)[0] > 1e-6


@pytest.mark.parametrize("power", [3, -2])
def test_scale_of_forces_and_lengths(power):
    """Linear bodies and laws without scale, an upright tip that stays where it is: forces and gap times 2^p give
    motions and contact forces times 2^p, bit for bit but for the last bit of the abscissa, 1e-16 of it, as in the
    mirror."""
    factor = 2.0**power
    rod = st.FiniteElementBeam(STEEL, STRIP, 0.5, elements=10, damping=0.02, cutoff=15e3)

    def drives(size):
        return lambda _: [st.Force(rod.root, y=-size, history=st.Harmonic(70.0, mean=1.0, amplitude=0.8))]

    one = every_step(pair(drives(2.0), 0.0, rod=rod, gap=1e-6), 20_000)
    other = every_step(pair(drives(2.0 * factor), 0.0, rod=rod, gap=1e-6 * factor), 20_000)
    assert (one.normal_force > 0).mean() > 0.1
    force, energy = one.normal_force.values, one.kinetic_and_elastic.values
    np.testing.assert_allclose(other.normal_force.values / factor, force, rtol=0, atol=1e-6 * force.max())
    np.testing.assert_allclose(other.kinetic_and_elastic.values / factor**2, energy, rtol=0, atol=1e-6 * energy.max())
