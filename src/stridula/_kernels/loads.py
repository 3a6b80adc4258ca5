"""Loads on the modes, and their work."""

import numba

from . import layout as at
from .block_rows import CONTACTS
from .bookkeeping import add
from .lanes import anywhere, held, hold, magnitude, read
from .modes import OPTIONS, PASTED, set_load, work_of_unit_load


@numba.njit(**OPTIONS)
def differ(signals, n, loads, run, runs, zero):
    """Return whether a load at step `n` differs from that at the step before."""
    if n == 0 or n >= signals.shape[0]:
        return n == 0
    for j in range(loads):
        column = j * runs + run
        if anywhere(magnitude(read(signals, n, column, zero) - read(signals, n - 1, column, zero)) > 0.0):
            return True
    return False


@numba.njit(**OPTIONS)
def credit_loads(parts, n, run, runs, zero):
    """Add the work of the loads up to step `n` since their amplitudes last changed, and begin anew."""
    sizes, modes, signals = parts.sizes, parts.modes, parts.imposed.signals
    first = CONTACTS + 2 * sizes.contacts + sizes.loads
    for j in range(sizes.loads):
        work = work_of_unit_load(modes.rows, first + j, sizes.blocks, run, zero)
        if n > 0:
            factor = read(signals, n - 1 if signals.shape[0] > 1 else 0, j * runs + run, zero)
            given = factor * (work - held(modes.given, j, run, zero))
            add(parts.state.energies, at.DRIVE_WORK, run, given, zero)
        hold(modes.given, j, run, work)


@numba.njit(**PASTED)
def change_loads(parts, n, run, runs, zero):
    """Apply the loads of step `n`, if they differ from those before."""
    sizes = parts.sizes
    if differ(parts.imposed.signals, n, sizes.loads, run, runs, zero):
        credit_loads(parts, n, run, runs, zero)
        for j in range(sizes.loads):
            factor = read(parts.imposed.signals, n, j * runs + run, zero)
            set_load(parts.modes.rows, j, CONTACTS + 2 * sizes.contacts + j, sizes.blocks, run, factor)
