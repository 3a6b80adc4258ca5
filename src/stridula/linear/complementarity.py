"""Sets of closed contacts: each closed one pushes, each open one has a gap.

The forces and gaps of a set come from a function, so that the search knows nothing of bodies. Friction makes the
problem unsymmetric: it may have one solution, several, or none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product

import numpy as np

from ..arrays import Array

# A function that returns the margins of a set: the force of each closed contact and the gap of each open one. A
# negative margin is a violation.
Margins = Callable[[Array], Array]
# After this number of sets without fewer violations than the best one, contacts change one at a time.
PATIENCE = 10
# Largest number of sets that are tried, for each contact.
TRIES = 30


def searched(margins: Margins, start: Array) -> Array | None:
    """Return a set without violations, None if none was found.

    All violating contacts change together (Kostreva 1978, Júdice & Pires 1994). If this does not reduce their number
    for a while, the last of them changes alone (Murty 1974), which ends for every matrix whose principal minors are
    positive.

    Parameters
    ----------
    margins : callable
        Returns the margins of a set, shape (contacts,).
    start : ndarray of bool, shape (contacts,)
        Closed contacts of the first set.
    """
    closed, fewest, patience = start.copy(), start.size + 1, PATIENCE
    alone: set[bytes] = set()
    for _ in range(TRIES * start.size + TRIES):
        wrong = np.flatnonzero(~(margins(closed) >= 0.0))
        if not wrong.size:
            return closed
        if wrong.size < fewest:
            fewest, patience, alone = wrong.size, PATIENCE, set()
        if patience:
            patience -= 1
        else:
            if closed.tobytes() in alone:
                return None
            alone.add(closed.tobytes())
            wrong = wrong[-1:]
        closed = closed.copy()
        closed[wrong] = ~closed[wrong]
    return None


def all_sets(margins: Margins, count: int) -> Iterator[Array]:
    """Yield every set of `count` contacts without violations, those with more closed contacts first.

    Parameters
    ----------
    margins : callable
        Returns the margins of a set, shape (contacts,).
    count : int
        Number of contacts.
    """
    for closed in sorted(product((True, False), repeat=count), key=lambda one: -sum(one)):
        if (margins(np.array(closed)) >= 0.0).all():
            yield np.array(closed)
