"""The rows of a block of modes, of a block of waves and of a block of contact forces: all that is known of each."""

# Of a mode: state, share of an increment kept, stiffness of a step, loads of this step; increment and position without
# contact force, and push of the contacts, in a march of several contacts; amplitudes of its waves on a path and of
# their derivatives.
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
# From `NORMAL` on each contact has two rows, its displacement for a unit of the mode; then come unit loads and probes.
CONTACTS = NORMAL

# Of a wave: sine and cosine at the contact, in the last step and in this one in turn, and its number.
SINE, COSINE, NUMBER = 0, 1, 4
WAVE_ROWS = 5

# Of contact forces: relative displacement that they lead to; then the compliance, a row for a unit of each force; then
# as many rows for that of the constant rows alone.
DISPLACEMENT, COMPLIANCE = range(2)
