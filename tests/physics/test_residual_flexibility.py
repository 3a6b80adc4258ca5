"""Residual shapes: static flexibility of modes beyond a cutoff, against the whole body, a twin and closed forms."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest
import scipy.linalg

import stridula as st
from stridula.lowering.stepping import KEPT, STIFFNESS

from .lattice import lattice, matrices, on_feet, rows
from .test_equilibrium_starts import SCHEMES, change, growth, starting
from .test_space import dragged

SLIDING = 2
# Bars in traction: 0.5 m of steel, 1 cm² thick.
YOUNG, DENSITY, AREA, LENGTH = 2.0e11, 7800.0, 1e-4, 0.5


def flexibility(body: st.ReducedBody, first: str, second: str) -> np.ndarray:
    """Static displacement of one point for unit forces at another, without rigid motion."""
    stiffness = body.modes().stiffness
    elastic = stiffness > 0.0
    return (body.trace(first)[:, elastic] / stiffness[elastic]) @ body.trace(second)[:, elastic].T


@pytest.mark.parametrize("cutoff", [1000.0, 1500.0, 3000.0])
def test_points_are_as_soft_as_the_whole_body_makes_them(cutoff):
    whole, cut = lattice(None), lattice(cutoff)
    plain = lattice(cutoff, residual_flexibility=False)
    size = np.abs(flexibility(whole, "foot", "foot")).max()
    for first in rows():
        for second in rows():
            known = flexibility(whole, first, second)
            np.testing.assert_allclose(flexibility(cut, first, second), known, atol=1e-12 * size)
    assert np.abs(flexibility(plain, "foot", "foot") - flexibility(whole, "foot", "foot")).max() > 0.1 * size
    assert np.isfinite(plain.modes().frequency).all()
    assert cut.modes().massless.sum() <= 2 * len(rows()) + 2


def bar(cutoff: float | None, residual: bool, name: str, elements: int = 100) -> st.ReducedBody:
    """A bar along y, held at its far end."""
    size = LENGTH / elements
    mass, stiffness = np.zeros((elements + 1,) * 2), np.zeros((elements + 1,) * 2)
    for k in range(elements):
        mass[k : k + 2, k : k + 2] += DENSITY * AREA * size / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])
        stiffness[k : k + 2, k : k + 2] += YOUNG * AREA / size * np.array([[1.0, -1.0], [-1.0, 1.0]])
    free = slice(0, elements)
    return st.ReducedBody(
        mass[free, free],
        stiffness[free, free],
        {"tip": (None, 0)},
        cutoff=cutoff,
        residual_flexibility=residual,
        name=name,
    )


def pressed_together(cutoff: float | None, residual: bool) -> float:
    """Second frequency [Hz] of two equal bars whose tips touch: half a wave more on each than one alone has."""
    first, second = (bar(cutoff, residual, name) for name in ("first", "second"))
    contact = st.PointContact(first.at("tip"), second.at("tip"), friction=st.Coulomb(0.0))
    found = st.sliding_stability(st.System(contact, [st.Force(first.at("tip"), y=-1.0)])).frequency.values
    return float(np.sort(found[found > 1.0])[1])


def test_bars_in_contact_converge_with_the_cube_of_their_modes():
    """Two bars held at their ends are one of twice the length, whose even modes bend both: c / 2 l.

    Modes left out count with 1 / w² without residual shapes: the error falls as one over the modes kept; with them it
    is their inertia that is missing, 1 / w⁴.
    """
    exact = np.sqrt(YOUNG / DENSITY) / (2.0 * LENGTH)
    assert pressed_together(None, True) == pytest.approx(exact, rel=1e-3)
    wave = exact / 2.0
    errors = {
        residual: [
            pressed_together((2 * kept) * wave, residual) / pressed_together(None, True) - 1.0 for kept in (2, 4, 8)
        ]
        for residual in (False, True)
    }
    plain, soft = np.array(errors[False]), np.array(errors[True])
    assert (plain > 0.0).all()
    assert (soft > 0.0).all()
    assert np.all(np.abs(np.log2(plain[:-1] / plain[1:]) - 1.0) < 0.25)
    assert np.all(np.abs(np.log2(soft[:-1] / soft[1:]) - 3.0) < 0.25)
    assert soft[-1] < 0.02 * plain[-1]


@pytest.mark.parametrize("law", [st.Coulomb(0.3), st.StaticKinetic(0.4, 0.3)])
def test_equilibrium_is_that_of_the_whole_body(law):
    """Also for springs, loads and gravity."""
    known = st.sliding_stability(on_feet(law, None)).normal_force.values
    np.testing.assert_allclose(st.sliding_stability(on_feet(law)).normal_force, known, rtol=1e-10)
    plain = st.sliding_stability(on_feet(law, residual_flexibility=False)).normal_force.values
    assert np.abs(plain / known - 1.0).max() > 0.02


def test_mode_coupling_is_that_of_the_whole_body():
    """Without residual shapes another mode grows."""
    found = {}
    for name, system in {
        "whole": on_feet(st.Coulomb(0.9), None, belt=0.8),
        "cut": on_feet(st.Coulomb(0.9), belt=0.8),
        "plain": on_feet(st.Coulomb(0.9), belt=0.8, residual_flexibility=False),
    }.items():
        theory = st.sliding_stability(system)
        fastest = int(np.argmax(theory.growth_rate.values))
        found[name] = float(theory.frequency[fastest]), float(theory.growth_rate[fastest])
    np.testing.assert_allclose(found["cut"], found["whole"], rtol=0.03)
    assert found["plain"][0] > 1.5 * found["whole"][0]


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("law", [st.Coulomb(0.3), st.Stribeck(0.3, 0.2, 0.5, viscous=0.3)], ids=["coulomb", "stribeck"])
def test_a_start_in_equilibrium_stays_there(law, scheme):
    run = st.simulate(starting(on_feet(law, damping=0.05)), 0.02, scheme=scheme, probes=[])
    assert (run.status == SLIDING).all()
    assert change(run.normal_force) < 1e-9


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(
    ("law", "belt"), [(st.Coulomb(0.9), 0.8), (st.ExponentialWeakening(0.4, 0.2, 0.5), -0.8)], ids=["coupling", "slope"]
)
def test_growth_in_time_is_that_of_linear_theory(law, belt, scheme):
    system = on_feet(law, belt=belt)
    probe = st.Displacement(system.bodies[0].at("back"), "x")
    known, seen, _ = growth(system, probe, 2e-6, 4e-3, 20, scheme, amplitude=1e-10)
    assert known.real > 1.0
    assert seen == pytest.approx(known, rel=2e-3)


def test_a_massless_contact_counts_where_friction_does_not_depend_on_speed():
    """Only mass resists falling friction: tangential rows of such contacts act on modes alone."""
    theory = st.sliding_stability(on_feet(st.ExponentialWeakening(0.4, 0.2, 0.5)))
    highest = 2.0 * pi * theory.frequency.values.max()
    assert theory.growth_rate.values.max() < 0.1 * highest


class Twin:
    """The march written out: ``u = Phi q + r``, r after F f within a few steps, on a belt that always slides."""

    def __init__(self, body: st.ReducedBody, cutoff: float, step: float) -> None:
        mass, stiffness = matrices()
        squared, shapes = scipy.linalg.eigh(stiffness, mass)
        squared[:3] = 0.0
        self.row = shapes[list(rows()["foot"])][::-1]
        self.push = shapes[rows()["back"][1]]
        kept = np.sqrt(squared) <= 2.0 * pi * cutoff
        left = self.row[:, ~kept] / squared[~kept]
        self.flexibility, self.remainder = left @ self.row[:, ~kept].T, left @ self.push[~kept]
        self.row, self.push, self.squared, self.step = self.row[:, kept], self.push[kept], squared[kept], step
        self.load = np.full(kept.sum(), step**2)
        elastic = squared[kept] > 0.0
        self.load[elastic] = 4.0 * np.sin(np.sqrt(squared[kept][elastic]) * step / 2.0) ** 2 / squared[kept][elastic]

    def run(self, loads: np.ndarray, friction: float, height: float) -> tuple[np.ndarray, np.ndarray]:
        """Forces and gap; friction pulls the foot along x."""
        q, d = np.zeros_like(self.load), -0.5 * self.load * self.push * loads[0]
        forces, gaps = [], []
        whole = (self.row * self.load) @ self.row.T + STIFFNESS * self.flexibility
        residual, moved = np.zeros(2), np.zeros(2)
        for load in loads:
            trial = d - self.load * self.squared * q + self.load * self.push * load
            follows = residual + KEPT * moved - STIFFNESS * (residual - self.remainder * load)
            gap = height + self.row[0] @ (q + trial) + follows[0]
            normal = max(0.0, -gap / (whole[0, 0] + friction * whole[0, 1]))
            force = normal * np.array([1.0, friction])
            d = trial + self.load * (force @ self.row)
            q = q + d
            follows = follows + STIFFNESS * self.flexibility @ force
            residual, moved = follows, follows - residual
            gaps.append(height + self.row[0] @ q + residual[0])
            forces.append(normal)
        return np.array(forces), np.array(gaps)


def test_the_march_equals_the_one_written_out():
    """Landings and departures of a foot on a fast belt, a load at another point; forces and gap at every step."""
    step, count, friction, cutoff = 2e-6, 6000, 0.3, 1500.0
    body = lattice(cutoff, translation=None)
    history = st.Harmonic(600.0, mean=0.5)
    contact = st.PointContact(body.at("foot"), st.RigidTrack(velocity=50.0), gap=1e-5, friction=st.Coulomb(friction))
    system = st.System(contact, [st.Force(body.at("back"), y=-300.0, history=history)])
    run = st.simulate(system, count * step, step=step, sample_rate=1.0 / step, probes=[])
    twin = Twin(body, cutoff, step)
    loads = -300.0 * history.factor(np.arange(count) * step)
    forces, gaps = twin.run(loads, friction, contact.gap)
    assert int(run.landings.sum()) >= 3
    np.testing.assert_allclose(run.normal_force, forces, atol=1e-9 * forces.max())
    np.testing.assert_allclose(run.gap, gaps, atol=1e-9 * gaps.max())
    terms = ["kinetic_and_elastic", "damping_loss", "drive_work", "contact_work"]
    largest = max(np.abs(run[term].values).max() for term in terms)
    assert np.abs(run.ledger_residual.values).max() < 1e-12 * largest


def test_lost_energy_is_that_of_the_force_on_the_flexibility():
    """Lost in a step is (1 - b) / 4 l F of the square of how far the flexibility goes in two."""
    soft = bar(6000.0, True, "cut")
    residual = flexibility_along(bar(None, True, "whole")) - flexibility_along(bar(6000.0, False, "plain"))
    step = 1e-6
    track = st.RigidTrack(normal_velocity=0.1)
    run = st.simulate(
        st.System(st.PointContact(soft.at("tip"), track, friction=st.Coulomb(0.0)), []),
        2000 * step,
        step=step,
        sample_rate=1.0 / step,
        probes=[],
    )
    force = run.normal_force.values
    yielded = np.zeros(force.size + 2)
    for n, one in enumerate(force, start=1):
        moved = KEPT * (yielded[n] - yielded[n - 1]) - STIFFNESS * (yielded[n] - residual * one)
        yielded[n + 1] = yielded[n] + moved
    lost = (1.0 - KEPT) / (4.0 * STIFFNESS * residual) * (yielded[2:] - yielded[:-2]) ** 2
    np.testing.assert_allclose(np.diff(run.damping_loss.values), lost[1:], atol=1e-9 * lost.max())


@pytest.mark.parametrize("step", [2e-6, 8e-6])
def test_residual_flexibility_does_not_damp(step):
    """A flexibility that lagged a step behind would take 4 % of the growth at the longer step; a ninth of it, 0.5 %."""
    system = dragged(0.5, 0.002)
    probe = st.Displacement(system.slider.at("top"), "z")
    known, seen, _ = growth(system, probe, step, 4e-3, round(4e-5 / step), amplitude=1e-10)
    assert seen.real == pytest.approx(known.real, rel=0.001)


def flexibility_along(body: st.ReducedBody) -> float:
    return float((body.trace("tip")[1] ** 2 / body.modes().stiffness).sum())


def test_a_body_keeps_its_choice_in_files_and_scenarios(tmp_path):
    for residual in (True, False):
        body = lattice(residual_flexibility=residual)
        body.save(tmp_path / "body.npz")
        assert st.ReducedBody.read(tmp_path / "body.npz") == body
        other = st.ReducedBody.read(tmp_path / "body.npz", residual_flexibility=not residual)
        assert other == lattice(residual_flexibility=not residual) != body
        system = on_feet(residual_flexibility=residual)
        run = st.simulate(system, 1e-4, probes=[])
        again = st.load_scenario(run).system
        assert again.bodies[0].residual_flexibility is residual
        np.testing.assert_array_equal(st.simulate(again, 1e-4, probes=[]).normal_force, run.normal_force)


def test_a_continued_run_equals_an_uninterrupted_one():
    system = on_feet(st.Coulomb(0.9), belt=0.8)
    whole = st.simulate(system, 4e-3, probes=[])
    half = st.simulate(system, 2e-3, probes=[])
    rest = st.simulate(system, 2e-3, start=half, probes=[])
    np.testing.assert_array_equal(whole.normal_force[half.time.size :], rest.normal_force)


def test_residual_flexibility_must_be_a_boolean():
    with pytest.raises(st.ArgumentError, match="residual_flexibility must be a bool"):
        lattice(residual_flexibility=1.0)


def test_initial_motion_leaves_residual_shapes_at_rest():
    """They follow forces, neither velocities nor displacements at the start."""
    body = lattice()
    massless = body.modes().massless
    assert not body.modal_coordinates(np.arange(30.0))[massless].any()
    thrown = st.System(
        st.PointContact(body.at("foot"), st.RigidTrack(), gap=1.0, friction=st.Coulomb(0.3)),
        [st.InitialVelocity(body, y=1.0)],
    )
    run = st.simulate(thrown, 1e-3, probes=[])
    assert run.attrs["initial_energy"] == pytest.approx(0.5 * body.total_mass, rel=1e-12)
    again = st.simulate(replace(thrown, drives=[st.InitialVelocity(body, y=1.0)]), 1e-3, probes=[])
    np.testing.assert_allclose(again.contact_height, run.time * 1.0 + 1.0, rtol=1e-12)
