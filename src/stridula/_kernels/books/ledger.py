"""Check of the energy ledger over a chunk of a march."""

from typing import NamedTuple

import numpy as np

from ..lanes.compiled import entry, strict
from ..lanes.operations import Array
from ..layout.columns import (
    CONTACT_WORK,
    CONVECTION_WORK,
    DAMPING_LOSS,
    DRIVE_WORK,
    ENERGIES,
    ENERGY_CREATED,
    FRICTION_LOSS,
    NOT_FINITE,
    STORED,
    STORED_IN_SPRINGS,
)

# Largest share of the largest energy that is accepted as round-off: residual of the ledger, stored energy below zero,
# losses that fall.
LEDGER_TOLERANCE = 1e-8
# Largest share of the largest energy that contacts may appear to supply: their work is centred over a step, their loss
# is not.
CONTACT_TOLERANCE = 1e-2


@entry
def keep_beside(chunk: Array, samples: int, rows: Array, first: int) -> None:
    """Copy the energies of one of several runs side by side, (samples, energies), to rows from a sample on."""
    for sample in range(samples):
        for k in range(ENERGIES):
            rows[k, first + sample] = chunk[sample, k]


class Account(NamedTuple):
    """What is known before a chunk of samples.

    Attributes
    ----------
    before : array
        Energies at the sample before it [J].
    initial, largest : float
        Stored energy at the start, and the largest energy before the chunk [J].
    of_loads : float
        Energy that the loads give to modes at rest in a step [J]: less is negligible.
    passive : bool
        Whether contacts must take energy on the whole.
    dissipative, damped_alone : bool
        Whether friction and damping must take energy in every step.
    """

    before: Array
    initial: float
    largest: float
    of_loads: float
    passive: bool
    dissipative: bool
    damped_alone: bool


@entry
def believed(rows: Array, first: int, samples: int, account: Account) -> tuple[int, int, float]:
    """Return the number of reliable samples from one on, the reason of their end or -1, and the largest energy.

    The ledger must close and the stored energy stay above zero; where they must, contacts take energy on the whole,
    friction and damping in every step.
    """
    for sample in range(first, first + samples):
        for k in range(ENERGIES):
            if not np.isfinite(rows[k, sample]):
                wrong, _ = _created(rows, first, sample - first, account)
                if wrong < 0:
                    return sample - first, NOT_FINITE, account.largest
                return wrong, ENERGY_CREATED, account.largest
    wrong, met = _created(rows, first, samples, account)
    return (samples, -1, met) if wrong < 0 else (wrong, ENERGY_CREATED, account.largest)


@strict
def _created(rows: Array, first: int, samples: int, account: Account) -> tuple[int, float]:
    """Return the first sample at which energy was created, -1 if there is none, and the largest energy."""
    met, friction, damping = account.largest, account.before[FRICTION_LOSS], account.before[DAMPING_LOSS]
    for sample in range(first, first + samples):
        for k in range(DAMPING_LOSS + 1):
            met = max(met, abs(rows[k, sample]))
        size = max(met, account.of_loads)
        slack = LEDGER_TOLERANCE * size
        work, stored = rows[CONTACT_WORK, sample], rows[STORED, sample]
        residual = stored - account.initial + rows[DAMPING_LOSS, sample] - rows[DRIVE_WORK, sample] - work
        given = work - rows[CONVECTION_WORK, sample]
        # Nonlinear springs may be stressed at the start, and give more than nothing.
        moving = stored - rows[STORED_IN_SPRINGS, sample]
        wrong = abs(residual) > slack or moving < -slack
        wrong |= account.passive and given > CONTACT_TOLERANCE * size + account.of_loads
        wrong |= account.dissipative and rows[FRICTION_LOSS, sample] - friction < -slack
        wrong |= account.damped_alone and rows[DAMPING_LOSS, sample] - damping < -slack
        if wrong:
            return sample - first, met
        friction, damping = rows[FRICTION_LOSS, sample], rows[DAMPING_LOSS, sample]
    return -1, met
