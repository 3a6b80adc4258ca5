"""Where each number lives in the flat arrays of the march."""

# Rows of the coefficient block, one column a mode; those of coupled modes are matrices instead.
B, R, LOAD, HALF_OVER_LOAD, HALF_LOSS = range(5)
COEFFICIENT_ROWS = 5

# Matrices of the coupled modes, which come first among the modes.
KEPT, STIFFNESS, MOBILITY, IMPULSE, LOSS, TURN, KINETIC, ELASTIC = range(8)
MATRICES = 8

# Rows of the state block.
Q, D = range(2)

# Rows of a contact: relative displacement of the tip against the fixed part of the track, along normal and tangent.
NORMAL, TANGENTIAL = range(2)

# Spans of the modes that a contact sees: fixed rows; bending and axial modes of a track that the tip moves along, on a
# plate those in its plane. Then how many half-waves these have along the track, on a plate along its two sides; along
# the second none on a beam.
FIXED, FIXED_END, BENDING, BENDING_END, AXIAL, AXIAL_END, WAVES, CROSS_WAVES = range(8)
SPANS = 8

# Rows of the half-waves of each mode of a plate along its two sides: the place of their sine and cosine. That of one
# half-wave is 0, that of none the last, at twice the number of all modes.
ALONG, ACROSS = range(2)

# Rows of what products of sines and cosines, along one side times across, give of a mode in the plane of a plate: of
# its motion along the line, then of the slope of that.
SINE_COSINE, COSINE_SINE, BOTH_COSINES, BOTH_SINES = range(4)

# Motion imposed on a contact: of the tip and of the track along the tangent, of the gap.
TIP_MOTION, TRACK_MOTION, GAP_MOTION = range(3)
MOTIONS = 3

# Constants of a contact. On a track that the tip moves along: its ends; phase of a half-wave at abscissa zero and its
# rate along the track, on a plate of both sides; amplitude of a mode.
START, GAP, LAW, LOW, HIGH, PHASE, WAVENUMBER, CROSS_PHASE, CROSS_WAVENUMBER, AMPLITUDE = range(10)
CONTACT_CONSTANTS = 10

# Laws of friction, and the parameters of each, the state of a new contact last.
COULOMB, STATIC_KINETIC, STRIBECK, LINEAR_WEAKENING, LUGRE, AGING, SLIP = range(7)
LAW_PARAMETERS = 8

# Scalars that each contact carries from step to step: material abscissa of the tip, anchor of the stick, last status,
# tip's abscissa at the last two steps, last slip and the one before, internal state of the law, forces and gap of the
# last step, share of the last step in which it was closed if it still is.
(
    MATERIAL,
    ANCHOR,
    STATUS,
    ABSCISSA,
    ABSCISSA_BEFORE,
    LAST_SLIP,
    EARLIER_SLIP,
    FRICTION_STATE,
    LAST_NORMAL,
    LAST_TANGENTIAL,
    LAST_GAP,
    CLOSED_SHARE,
) = range(12)
CARRIED = 12

# Columns of the energy record, one row a sample; all but the stored energy are carried from step to step.
STORED, DRIVE_WORK, CONTACT_WORK, FRICTION_LOSS, CONVECTION_WORK, DAMPING_LOSS, ITERATIONS, UNSOLVED = range(8)
ENERGIES = 8

# Columns of the record of a contact, one row a sample: shares of the time, and the status of the most steps last.
(
    NORMAL_FORCE,
    TANGENTIAL_FORCE,
    SEPARATED,
    STICKING,
    SLIDING,
    CONTACT_POSITION,
    CONTACT_HEIGHT,
    CONTACT_GAP,
    SLIP_VELOCITY,
    JAMMED,
    LANDINGS,
    LAW_STATE,
    DOMINANT,
) = range(13)
COLUMNS = 13

# Kinds of probe rows: on positions, on centred velocities, on second differences.
DISPLACEMENT, VELOCITY, ACCELERATION = range(3)

# What ended a march.
FINISHED, OFF_TRACK, NOT_FINITE, CONTACT_UNSOLVED, ENERGY_CREATED = range(5)
