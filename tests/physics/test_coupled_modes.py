"""Accelerations of modes that damping couples, against integration by DOP853, on random systems."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stridula.acoustics.coupled_modes import coupled_response

INTERVAL, SAMPLES = 1e-5, 1500
TIMES = INTERVAL * np.arange(SAMPLES)


def pulse(time):
    """A wave packet with contents below 10 kHz."""
    return np.exp(-(((time - 3e-3) / 3e-4) ** 2)) * np.sin(2.0 * np.pi * 2e3 * (time - 2.9e-3))


def integrated(stiffness, dissipation, push):
    size = len(stiffness)

    def change(time, state):
        bent, moving = state[:size], state[size:]
        return np.concatenate([moving, push * pulse(time) - stiffness @ bent - dissipation @ moving])

    found = solve_ivp(change, (0.0, TIMES[-1]), np.zeros(2 * size), "DOP853", TIMES, rtol=1e-9, atol=1e-13).y
    return push[:, None] * pulse(TIMES) - stiffness @ found[:size] - dissipation @ found[size:]


def system(seed):
    """A random system of up to seven modes; some of them rigid, joined by springs and by strong dashpots."""
    rng = np.random.default_rng(seed)
    size = int(rng.integers(2, 8))
    angular = 2.0 * np.pi * 10.0 ** rng.uniform(2.0, 3.9, size)
    angular[: rng.integers(0, 2)] = 0.0
    stiffness, dissipation = np.diag(angular**2), np.diag(0.02 * angular)
    for matrix, rate in ((stiffness, 1e7), (dissipation, 10.0 ** rng.uniform(2.0, 4.5))):
        row = rng.normal(size=size)
        matrix += rate * np.outer(row, row)
    return stiffness, dissipation, rng.normal(size=size)


@pytest.mark.parametrize("seed", range(40))
def test_modes_coupled_by_springs_and_dashpots_move_as_integrated(seed):
    stiffness, dissipation, push = system(seed)
    found, left_out = coupled_response(stiffness, dissipation, push[:, None] * pulse(TIMES), INTERVAL)
    known = integrated(stiffness, dissipation, push)
    assert left_out == 0
    assert np.abs(found - known)[:, 10:-10].max() < 2e-3 * np.abs(known).max()
    # Negative control: the damping of each mode alone.
    _, shapes = np.linalg.eigh(stiffness)
    alone = shapes @ np.diag(np.diag(shapes.T @ dissipation @ shapes)) @ shapes.T
    without, _ = coupled_response(stiffness, alone, push[:, None] * pulse(TIMES), INTERVAL)
    assert np.abs(without - known).max() > np.abs(found - known)[:, 10:-10].max()


@pytest.mark.parametrize("coefficient", [1e2, 2.0 * 2.0 * np.pi * 500.0, 1e5], ids=["weak", "critical", "strong"])
def test_a_damped_mass_moves_as_integrated(coefficient):
    """Two masses on springs, joined by a dashpot, which damps the difference of their motions."""
    stiffness = (2.0 * np.pi * 500.0) ** 2 * np.eye(2)
    dissipation = 0.5 * coefficient * np.array([[1.0, -1.0], [-1.0, 1.0]])
    push = np.array([1.0, 0.3])
    found, _ = coupled_response(stiffness, dissipation, push[:, None] * pulse(TIMES), INTERVAL)
    known = integrated(stiffness, dissipation, push)
    assert np.abs(found - known)[:, 10:-10].max() < 2e-3 * np.abs(known).max()


def test_modes_too_fast_for_the_samples_are_left_out():
    stiffness = np.diag((2.0 * np.pi * np.array([500.0, 49e3])) ** 2)
    dissipation = np.array([[100.0, 50.0], [50.0, 200.0]])
    found, left_out = coupled_response(stiffness, dissipation, np.ones((2, SAMPLES)), INTERVAL)
    assert left_out == 1
    assert np.abs(found[1]).max() < 1e-3 * np.abs(found[0]).max()
