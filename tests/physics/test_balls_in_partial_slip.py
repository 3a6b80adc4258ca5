"""Two equal balls pressed on each other and pulled to and fro across the contact: the loss in a cycle.

Cattaneo and Mindlin assume friction along the pull only, as it is exactly for a Poisson's ratio of 0. Both balls are
elastic half-spaces, divided into sectors of rings with Boussinesq's and Cerruti's influence; nothing of the package
computes it. Between equal balls pressure does not move the surfaces past each other.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from math import pi, sqrt
from typing import NamedTuple

import numpy as np
import pytest

import stridula as st

RADIUS, SHEAR, FRICTION, PRESSED = 0.05, 2e8, 0.4, 9.1954
# Rings within the radius that sticks, rings beyond it, and sectors of each ring.
COARSE, FINE, SECTORS = (4, 3), (8, 6), 8
# Chords of an arc; places along a radius and an arc over which displacements are averaged.
CHORDS, PLACES = 4, (3, 12)
STEP, RISE, REST = 1e-5, 80, 60
# Largest relative error of the loss with the rings of FINE, of second order in the rings beyond the radius that sticks.
TOLERANCE = 1.0 / FINE[1] ** 2
CASES = [(0.5, 0.0), (0.9, 0.0), (0.5, 0.3), (0.9, 0.3)]


class Known(NamedTuple):
    """Closed form for a pull of a share of the force of full slip: lengths [m], loss in a cycle [J]."""

    radius: float
    stuck: float
    shift: float
    loss: float


class Rings(NamedTuple):
    """Outlines of all patches (patches, corners, 2), places in them (patches, places, 2), shares of these, areas."""

    outline: np.ndarray
    place: np.ndarray
    share: np.ndarray
    area: np.ndarray


class Found(NamedTuple):
    """A run, its steps at the ends of pulls, mean squared distances of patches from the axis [m²], mass of a ball."""

    run: object
    ends: np.ndarray
    squared: np.ndarray
    mass: float


def closed_form(share, poisson, friction=FRICTION):
    """Return the answer for two equal balls (Johnson 1985, 7.2 and 7.4), both of which yield.

    The loss is the area of the loop of the pull over the shift, ``9 (2 - nu) (mu N)² / 5 G a`` times a function of the
    share; each ball has half of the shift, so that one on a rigid body would lose half as much.
    """
    radius = (3.0 * (1.0 - poisson) * PRESSED * RADIUS / (4.0 * SHEAR)) ** (1.0 / 3.0)
    left, whole = 1.0 - share, friction * PRESSED
    shift = 3.0 * (2.0 - poisson) * whole / (8.0 * SHEAR * radius) * (1.0 - left ** (2.0 / 3.0))
    loop = 1.0 - left ** (5.0 / 3.0) - 5.0 * share / 6.0 * (1.0 + left ** (2.0 / 3.0))
    loss = 9.0 * (2.0 - poisson) * whole**2 / (5.0 * SHEAR * radius) * loop
    return Known(radius, radius * left ** (1.0 / 3.0), shift, loss)


def ring_edges(known, within, beyond):
    """Return the edges of rings: narrow ones where friction ends to stick, and one more outside the contact."""
    inner = known.stuck * (1.0 - (1.0 - np.arange(within) / within) ** 2)
    outer = np.linspace(known.stuck, known.radius, beyond + 1)
    return np.concatenate([inner, outer, [2.0 * outer[-1] - outer[-2]]])


def rings(edges):
    """Return the sectors of rings; outlines have the areas of the sectors."""
    turn = 2.0 * pi / SECTORS
    chord = turn / CHORDS
    (out, out_share), (along, along_share) = (
        (0.5 * (t + 1.0), 0.5 * w) for t, w in (np.polynomial.legendre.leggauss(count) for count in PLACES)
    )
    found = []
    for near, far in pairwise(edges):
        radius = np.sqrt(near**2 + (far**2 - near**2) * out)
        for sector in range(SECTORS):
            arc = sqrt(chord / np.sin(chord)) * around(sector * turn + chord * np.arange(CHORDS + 1))
            place = radius[:, None, None] * around(turn * (sector + along))
            share = np.outer(out_share, along_share)
            area = (far**2 - near**2) * turn / 2.0
            found.append(([*(far * arc), *(near * arc[::-1])], place.reshape(-1, 2), share.ravel(), area))
    return Rings(*(np.array(each) for each in zip(*found, strict=True)))


def around(angle):
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def over_outline(outline, place):
    """Return the integrals of 1, cos 2t and sin 2t over the distance r, for the polar places (r, t) in an outline."""
    found = np.zeros((3, *place.shape[:-1]))
    for start, end in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        length = np.hypot(*(end - start))
        if length == 0.0:
            continue
        along = (end - start) / length
        across = np.array([along[1], -along[0]])
        below = (start - place) @ across
        ends = [(one - place) @ along for one in (start, end)]
        rise = np.diff([np.arcsinh(one / np.abs(below)) for one in ends], axis=0)[0]
        sine, cosine = np.diff([(one, np.abs(below)) / np.hypot(below, one) for one in ends], axis=0)[0]
        double = 2.0 * np.arctan2(across[1], across[0])
        even, odd = 2.0 * sine - rise, 2.0 * np.sign(below) * cosine
        found += below * np.array(
            [rise, np.cos(double) * even + np.sin(double) * odd, np.sin(double) * even - np.cos(double) * odd]
        )
    return found


def influence(patches, poisson):
    """Return mean displacements of patches of both balls towards each other for unit forces on patches, (3 n, 3 n)."""
    integrals = np.array([over_outline(outline, patches.place) for outline in patches.outline])
    mean = np.einsum("jkiq,iq->kij", integrals, patches.share) / patches.area
    plain, even, odd = 0.5 * (mean + mean.transpose(0, 2, 1)) / (pi * SHEAR)
    count, half = len(patches.area), 0.5 * poisson
    found = np.zeros((count, 3, count, 3))
    found[:, 0, :, 0] = (1.0 - half) * plain + half * even
    found[:, 2, :, 2] = (1.0 - half) * plain - half * even
    found[:, 0, :, 2] = found[:, 2, :, 0] = half * odd
    found[:, 1, :, 1] = (1.0 - poisson) * plain
    return found.reshape(3 * count, 3 * count)


def histories(rise):
    """Return the histories of pressing and of the pull from 0 to 1, -1 and 1, and the steps at the ends of pulls."""
    steps, factors = [rise + REST], [0.0]
    for goal, turns in ((1.0, 1), (-1.0, 2), (1.0, 2)):
        steps += [steps[-1] + turns * rise, steps[-1] + turns * rise + REST]
        factors += [goal, goal]
    pull = st.Sampled((STEP * np.array(steps)).tolist(), factors)
    return st.Sampled((0.0, STEP * rise), (0.0, 1.0)), pull, np.array(steps[2::2]) - 1


@lru_cache
def pulled(share, poisson, grid=FINE, rise=RISE, friction=FRICTION):
    """Press the balls, pull them to and fro by a share of the force of full slip, and wait at each end."""
    known = closed_form(share, poisson)
    patches = rings(ring_edges(known, *grid))
    squared = np.einsum("iqc,iq->i", patches.place**2, patches.share)
    rate = 0.5 / STEP
    stiffness = np.linalg.inv(influence(patches, poisson))
    points = {str(number): tuple(range(3 * number, 3 * number + 3)) for number in range(len(squared))}
    # All modes have the same frequency, and hardly vibrate.
    plane = st.ReducedBody(stiffness / rate**2, stiffness, points, damping=0.9, name="half-space")
    mass = 1.5 * PRESSED * RADIUS / known.radius**2 / (2.0 * rate) ** 2
    ball = st.ModalBody(np.zeros(3), {"middle": np.eye(3) / sqrt(mass)}, 4.0 * rate, name="ball")
    contacts = [
        st.PointContact(ball.at("middle"), plane.at(name), friction=st.Coulomb(friction), gap=gap, name=name)
        for name, gap in zip(points, (squared / (2.0 * RADIUS)).tolist(), strict=True)
    ]
    pressing, pulling, ends = histories(rise)
    middle = ball.at("middle")
    drives = [
        st.Force(middle, y=-PRESSED, history=pressing),
        st.Force(middle, x=share * FRICTION * PRESSED, history=pulling),
    ]
    probes = [st.Displacement(middle, "x"), st.ModalMotion(plane), st.ModalMotion(ball)]
    duration = STEP * float(ends[-1] + 1)
    run = st.simulate(st.System(contacts, drives), duration, sample_rate=1.0 / STEP, probes=probes)
    assert int(run.unsolved_steps.sum()) == 0
    assert np.abs(run.ledger_residual).max() < 1e-10 * run.drive_work.max()
    return Found(run, ends, squared, mass)


def loss(found):
    """Return the loss to friction between the last two ends of pulls in the same direction [J]."""
    spent = found.run.friction_loss.values[found.ends]
    return float(spent[2] - spent[0])


@pytest.mark.parametrize("share", [0.3, 0.5, 0.9])
def test_the_closed_form_is_the_area_of_the_loop(share):
    """From one end, a change of the pull shifts the balls by twice the shift of a first pull by half of it."""
    pull = share * np.linspace(-1.0, 1.0, 20001)
    first = np.array([closed_form(half, 0.3).shift for half in (share - pull) / 2.0])
    unloading = closed_form(share, 0.3).shift - 2.0 * first
    area = 2.0 * FRICTION * PRESSED * np.trapezoid(unloading, pull)
    assert area == pytest.approx(closed_form(share, 0.3).loss, rel=1e-5)


@pytest.mark.parametrize(("share", "poisson"), CASES)
def test_a_cycle_of_the_pull_loses_what_mindlin_found(share, poisson):
    known, found = closed_form(share, poisson), pulled(share, poisson)
    assert loss(found) == pytest.approx(known.loss, rel=TOLERANCE)
    shift = found.run.displacement.values[found.ends, 0]
    np.testing.assert_allclose(shift, known.shift * np.array([1.0, -1.0, 1.0]), rtol=TOLERANCE)


@pytest.mark.parametrize(("share", "poisson"), CASES)
def test_balls_stick_in_the_middle_and_slip_round_it(share, poisson):
    """Every patch within the closed form's radius sticks throughout, and every patch round it slides in every pull."""
    known, (run, ends, squared, _) = closed_form(share, poisson), pulled(share, poisson)
    far = np.sqrt(squared)
    normal, tangential = run.normal_force.values[ends], run.tangential_force.values[ends]
    np.testing.assert_array_equal(normal > 0.0, np.broadcast_to(far < known.radius, normal.shape))
    slid = run.status_share.values[:, :, 2] > 0.0
    for start, end in pairwise(ends):
        np.testing.assert_array_equal(slid[start + 1 : end].any(axis=0), (far > known.stuck) & (far < known.radius))
    missing = FRICTION * normal - np.abs(tangential[:, :, 0])
    # The squared radius of a hemisphere of traction is 5/2 of its mean squared distance.
    np.testing.assert_allclose(np.sqrt(2.5 * normal @ squared / normal.sum(axis=1)), known.radius, rtol=TOLERANCE)
    np.testing.assert_allclose(np.sqrt(2.5 * missing @ squared / missing.sum(axis=1)), known.stuck, rtol=TOLERANCE)


@pytest.mark.parametrize(("share", "poisson"), CASES)
def test_forces_are_within_the_cone_and_carry_the_loads(share, poisson):
    run, ends, _, _ = pulled(share, poisson)
    normal, tangential = run.normal_force.values, np.linalg.norm(run.tangential_force.values, axis=2)
    assert normal.min() >= 0.0
    assert np.max(tangential - FRICTION * normal) <= 1e-9 * FRICTION * normal.max()
    pull = share * FRICTION * PRESSED * np.array([1.0, -1.0, 1.0])
    np.testing.assert_allclose(run.normal_force.values[ends].sum(axis=1), PRESSED, rtol=1e-3)
    np.testing.assert_allclose(run.tangential_force.values[ends, :, 0].sum(axis=1), pull, rtol=1e-3)


@pytest.mark.parametrize("share", [0.5, 0.9])
def test_the_loss_converges_with_the_number_of_rings(share):
    """At second order: its error falls by four with twice the rings, here at least by three."""
    known = closed_form(share, 0.0)
    coarse, fine = (abs(loss(pulled(share, 0.0, grid)) - known.loss) for grid in (COARSE, FINE))
    assert fine < coarse / 3.0


@pytest.mark.parametrize("share", [0.5, 0.9])
def test_balls_move_slowly(share):
    """Kinetic energy is small beside the loss, the ball's inertia beside the pull; half the pace changes little."""
    run, ends, _, mass = pulled(share, 0.0)
    kinetic = 0.5 * (run.modal_motion.values[ends[0] :] ** 2).sum(axis=1)
    inertia = mass * np.diff(run.displacement.values[ends[0] :, 0], 2) / STEP**2
    assert kinetic.max() < 0.01 * loss(pulled(share, 0.0))
    assert np.abs(inertia).max() < 0.01 * share * FRICTION * PRESSED
    assert loss(pulled(share, 0.0, FINE, 2 * RISE)) == pytest.approx(loss(pulled(share, 0.0)), rel=1e-3)


def test_another_coefficient_of_friction_is_noticed():
    known = closed_form(0.5, 0.0)
    assert loss(pulled(0.5, 0.0, FINE, RISE, 0.95 * FRICTION)) > (1.0 + 2.0 * TOLERANCE) * known.loss
