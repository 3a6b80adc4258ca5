"""Loads on the modes, and their work."""

from ..lanes.compiled import inlined, pasted
from ..lanes.operations import Array, Runs, add, anywhere, held, hold, magnitude, read
from ..layout import columns as at
from ..layout.parts import Parts
from ..layout.rows import CONTACTS
from .blocks import set_load, work_of_unit_load


@inlined
def differ(signals: Array, n: int, loads: int, runs: Runs) -> bool:
    """Return whether a load at step `n` differs from that at the step before."""
    if n == 0 or n >= signals.shape[0]:
        return n == 0
    for j in range(loads):
        column = j * runs.columns + runs.first
        if anywhere(magnitude(read(signals, n, column, runs.zero) - read(signals, n - 1, column, runs.zero)) > 0.0):
            return True
    return False


@inlined
def credit_loads(parts: Parts, n: int, runs: Runs) -> None:
    """Add the work of the loads up to step `n` since their amplitudes last changed, and begin anew."""
    sizes, modes, signals = parts.sizes, parts.modes, parts.imposed.signals
    first = CONTACTS + sizes.rows + sizes.loads
    for j in range(sizes.loads):
        work = work_of_unit_load(modes.rows, first + j, sizes.blocks, runs)
        if n > 0:
            factor = read(signals, n - 1 if signals.shape[0] > 1 else 0, j * runs.columns + runs.first, runs.zero)
            given = factor * (work - held(modes.given, j, runs))
            add(parts.state.energies, at.DRIVE_WORK, runs, given)
        hold(modes.given, j, runs, work)


@pasted
def change_loads(parts: Parts, n: int, runs: Runs) -> None:
    """Apply the loads of step `n`, if they differ from those before, or if the pulls of springs are to be added."""
    sizes, signals = parts.sizes, parts.imposed.signals
    changed = differ(signals, n, sizes.loads, runs)
    if changed:
        credit_loads(parts, n, runs)
    if changed or sizes.springs:
        now = n if signals.shape[0] > 1 else 0
        for j in range(sizes.loads):
            factor = read(signals, now, j * runs.columns + runs.first, runs.zero)
            set_load(parts.modes.rows, j, CONTACTS + sizes.rows + j, sizes.blocks, runs, factor)
