"""Where each number lives in the flat arrays of the march."""

# Rows of the coefficient block, one column a mode: slider modes, bending modes of the track, axial modes of the track.
B, R, CH, HALF_OVER_CH, HALF_LOSS, TIP_X, TIP_Y = range(7)
COEFFICIENT_ROWS = 7

# Rows of the state block.
Q, D = range(2)

# Constants of a march.
STEP, START, GAP, WAVENUMBER, AMPLITUDE, LENGTH, MU, W_NN, W_NT, W_TT = range(10)
CONSTANTS = 10

# Scalars carried from step to step: material abscissa of the tip, anchor of the stick, last status, tip's abscissa at
# the last two steps, and the accumulated energies.
MATERIAL, ANCHOR, STATUS, ABSCISSA, ABSCISSA_BEFORE, DRIVE, CONTACT, FRICTION, CONVECTION, DAMPING = range(10)
CARRIED = 10

# Columns of the record, one row a sample.
(
    NORMAL_FORCE,
    TANGENTIAL_FORCE,
    SEPARATED,
    STICKING,
    SLIDING,
    CONTACT_POSITION,
    CONTACT_HEIGHT,
    CONTACT_GAP,
    SLIP,
    JAMMED,
    STORED,
    DRIVE_WORK,
    CONTACT_WORK,
    FRICTION_LOSS,
    CONVECTION_WORK,
    DAMPING_LOSS,
) = range(16)
COLUMNS = 16

# Kinds of probe rows: on positions, on centred velocities, on second differences.
DISPLACEMENT, VELOCITY, ACCELERATION = range(3)

# What ended a march.
FINISHED, OFF_TRACK, NOT_FINITE = range(3)
