"""The compiled ledger against plain NumPy: exactly the same samples are accepted."""

from __future__ import annotations

import numpy as np
import pytest

from stridula._kernels.books.ledger import CONTACT_TOLERANCE, LEDGER_TOLERANCE, Account, believed, keep_beside
from stridula._kernels.layout import columns as at


def created(energies, before, initial, largest, of_loads, passive, dissipative, damped_alone):
    """Return the first sample at which energy was created, or None; written from the rules."""
    terms = np.abs(energies[: at.DAMPING_LOSS + 1])
    largest_yet = np.maximum(np.maximum.accumulate(terms.max(axis=0)), max(largest, of_loads))
    scale = LEDGER_TOLERANCE * largest_yet
    work = energies[at.CONTACT_WORK]
    residual = energies[at.STORED] - initial + energies[at.DAMPING_LOSS] - energies[at.DRIVE_WORK] - work
    given = work - energies[at.CONVECTION_WORK]
    wrong = (np.abs(residual) > scale) | (energies[at.STORED] < -scale)
    wrong |= passive & (given > CONTACT_TOLERANCE * largest_yet + of_loads)
    for takes, loss in ((dissipative, at.FRICTION_LOSS), (damped_alone, at.DAMPING_LOSS)):
        if takes:
            wrong |= np.diff(energies[loss], prepend=before[loss]) < -scale
    found = np.flatnonzero(wrong)
    return int(found[0]) if found.size else None


def ledger(random, samples):
    """Return energies that nearly balance, wrong by about the tolerance here and there."""
    energies = np.zeros((at.ENERGIES, samples))
    for row in (at.DRIVE_WORK, at.FRICTION_LOSS, at.DAMPING_LOSS):
        energies[row] = np.cumsum(random.random(samples))
    energies[at.CONTACT_WORK] = -energies[at.FRICTION_LOSS]
    balance = energies[at.DRIVE_WORK] + energies[at.CONTACT_WORK] - energies[at.DAMPING_LOSS]
    energies[at.STORED] = balance - balance.min()
    size = np.abs(energies).max()
    for row in range(at.DAMPING_LOSS + 1):
        place = random.integers(samples)
        energies[row, place:] += random.choice([0.0, 0.0, 0.0, 1e-9, -1e-9, 2e-8, -2e-8, 0.1]) * size
    return energies, float(-balance.min())


@pytest.mark.parametrize("seed", range(60))
def test_accepted_samples_are_those_of_plain_numpy(seed):
    random = np.random.default_rng(seed)
    energies, initial = ledger(random, 80)
    before = np.zeros(at.ENERGIES)
    largest, of_loads = random.choice([0.0, 1.0, 1e3]), random.choice([0.0, 1e-6])
    flags = bool(random.integers(2)), bool(random.integers(2)), bool(random.integers(2))
    bad = int(random.integers(80)) if seed % 3 == 0 else 80
    energies[random.integers(at.ENERGIES), bad:] = np.nan
    expected = created(energies[:, :bad], before, initial, largest, of_loads, *flags)
    found, ended, met = believed(energies, 0, 80, Account(before, initial, largest, of_loads, *flags))
    if expected is not None:
        assert (found, ended) == (expected, at.ENERGY_CREATED)
    elif bad < 80:
        assert (found, ended) == (bad, at.NOT_FINITE)
    else:
        assert (found, ended) == (80, -1)
        assert met == max(largest, np.abs(energies[: at.DAMPING_LOSS + 1]).max())


def test_ledgers_of_both_kinds_are_tried():
    kinds = set()
    for seed in range(60):
        energies, initial = ledger(np.random.default_rng(seed), 80)
        kinds.add(created(energies, np.zeros(at.ENERGIES), initial, 1.0, 0.0, True, True, True) is None)
    assert kinds == {True, False}


def test_energies_of_one_of_several_runs_are_kept_from_a_sample_on():
    energies = np.random.default_rng(0).random((5, at.ENERGIES, 3))[..., 1]
    kept = np.full((at.ENERGIES, 9), -1.0)
    keep_beside(energies, 4, kept, 3)
    np.testing.assert_array_equal(kept[:, 3:7], energies[:4].T)
    assert (kept[:, :3] == -1.0).all()
    assert (kept[:, 7:] == -1.0).all()
