"""Rows of a block of modes, of a block of waves and of a block of contact forces."""

from ..lanes.compiled import inlined
from ..lanes.operations import Array
from .parts import Sizes

# Rows of a mode: state, share of an increment kept, stiffness of a step, loads of this step; in a march of several
# contacts, increment and position without contact force and push of the contacts; amplitudes of its waves on a path, or
# of two products of waves, and of their derivatives.
(
    Q,
    D,
    KEPT,
    STIFFNESS,
    FORCE,
    INCREMENT,
    POSITION,
    PUSH,
    AMPLITUDE,
    SLOPE,
    OTHER_AMPLITUDE,
    OTHER_SLOPE,
    NORMAL,
    TANGENTIAL,
) = range(14)
# From `NORMAL` on each contact has a row for its normal and one for each tangent, its displacements for a unit of the
# mode; unit loads, pulls and stretches of nonlinear springs, and probes follow.
CONTACTS = NORMAL

# Rows of a wave: sine and cosine at the contact, alternately for the last step and for this one, and its number.
SINE, COSINE, NUMBER = 0, 1, 4
WAVE_ROWS = 5
# Waves of the path of a contact: first block, blocks along and across, whether those along start from the multiple 0,
# and entry of the multiple 0 across.
FIRST, ALONG, ACROSS, FROM_ZERO, ZEROTH = range(5)
WAVE_SET = 5

# Rows of contact forces: relative displacement under them; then the compliance, a row for a unit of each force; then as
# many rows for the compliance of the constant rows alone.
DISPLACEMENT, COMPLIANCE = range(2)


@inlined
def has_b(first_rows: Array, i: int) -> bool:
    """Return whether contact `i` has a tangent b, as those in space do: a row after those of its normal and tangent."""
    return first_rows[i + 1] - first_rows[i] > 2


@inlined
def first_spring(sizes: Sizes) -> int:
    """Return the row of the unit pull of the first nonlinear spring; those of their stretches follow the pulls."""
    return CONTACTS + sizes.rows + 2 * sizes.loads


@inlined
def first_probe(sizes: Sizes) -> int:
    """Return the row of the first probe."""
    return first_spring(sizes) + 2 * sizes.springs
