"""Places of the numbers in the flat arrays of the march."""

# Rows of the coefficient block, one column a mode; those of coupled modes are matrices instead.
B, R, LOAD, HALF_OVER_LOAD, HALF_LOSS = range(5)
COEFFICIENT_ROWS = 5

# Matrices of the coupled modes, which are the first modes.
KEPT, STIFFNESS, MOBILITY, IMPULSE, LOSS, TURN, KINETIC, ELASTIC = range(8)
MATRICES = 8

# Rows of the state block.
Q, D = range(2)

# Rows of a contact: relative displacement of the tip against the fixed part of the track, along normal and tangent.
NORMAL, TANGENTIAL = range(2)

# Spans of blocks of modes that a contact depends on: first block, end, kind; products of waves of two angles that their
# modes consist of, 0 for waves of one angle; whether of cosines.
BEGIN, END, KIND, PRODUCTS, COSINES = range(5)
SPAN = 5
# Kinds of span: rows are constant; waves of a path along the normal and along the tangent; all modes of a body that the
# contact moves round.
CONSTANT, PATH_NORMAL, PATH_TANGENTIAL, ROUND = range(4)

# Names that end in _B are those of tangent b, which only contacts in space have. Their columns are unused in the plane.

# Motion imposed on a contact: of the tip and of the track along the tangent, of the gap.
TIP_MOTION, TRACK_MOTION, GAP_MOTION, TIP_MOTION_B, TRACK_MOTION_B = range(5)
MOTIONS = 5

# Constants of a contact: initial place, gap, ends of its path; rate along the path and value at abscissa zero of the
# two angles whose sines are the modes of the path, on a circle of the angle from the initial place; ratio at rest of
# the law of friction; stiffness of the contact itself, 0 if rigid, its exponent, damping, damping rate over the force,
# and size of its sawtooth under unit forces on all such contacts.
(
    START,
    GAP,
    LOW,
    HIGH,
    ALONG,
    ALONG_PHASE,
    ACROSS,
    ACROSS_PHASE,
    AT_REST,
    YIELD_STIFFNESS,
    YIELD_EXPONENT,
    YIELD_DAMPING,
    YIELD_RATE,
    YIELD_REACH,
) = range(14)
CONTACT_CONSTANTS = 14

# Laws of friction.
(
    COULOMB,
    STATIC_KINETIC,
    STRIBECK,
    LINEAR_WEAKENING,
    CURVE,
    IN_SERIES,
    LUGRE,
    AGING,
    SLIP,
) = range(9)

# Scalars that each contact carries from step to step: material abscissa of the tip, anchor of the stick, last status,
# tip's abscissa at the last two steps, last slip and the one before, internal state of the law, forces and gap of the
# last step, share of the last step in which it was closed if it still is, gap of the step before the last, part of the
# ratio of the next step's forces that lies before it, share of the last step in which it stuck, gap of the step before
# the last two; under a profile its height at the last step and at the one before, and slip by the contact forces in the
# last step; temperatures of its layers, or its temperature and the time of its history.
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
    EARLIER_GAP,
    PAST_RATIO,
    STUCK_SHARE,
    EARLIEST_GAP,
    LAST_HEIGHT,
    EARLIER_HEIGHT,
    PUSHED,
    MATERIAL_B,
    ANCHOR_B,
    ABSCISSA_B,
    LAST_SLIP_B,
    EARLIER_SLIP_B,
    FRICTION_STATE_B,
    LAST_TANGENTIAL_B,
    PAST_RATIO_B,
    TEMPERATURE,
) = range(28)
LAYERS = 8
CARRIED = TEMPERATURE + LAYERS

# State of a contact in a step: gap, slip and abscissa, without its forces, then with them; forces, status, whether it
# jams; while the contacts are solved together whether it may touch, has broken away, has been let go. Additional give
# for a unit of force, and additional indentation without force. In the system of all contacts: numbers of the equations
# of its normal and its tangential force, below 0 without one, the ratio of these forces if it slides; forces and status
# to restore, and the status that it wants. Height of the profile of its track, slip without any contact force, and
# loss to friction.
(
    FREE_GAP,
    FREE_SLIP,
    PLACE,
    NEW_GAP,
    NEW_SLIP,
    NORMAL_NOW,
    TANGENTIAL_NOW,
    STATUS_NOW,
    JAMMED_NOW,
    MAY_TOUCH,
    BROKE,
    LET_GO,
    GIVE,
    BEYOND,
    NORMAL_EQUATION,
    TANGENTIAL_EQUATION,
    RATIO,
    NORMAL_KEPT,
    TANGENTIAL_KEPT,
    STATUS_KEPT,
    STATUS_WANTED,
    HEIGHT,
    TRIED_SLIP,
    LOST,
    FREE_SLIP_B,
    NEW_SLIP_B,
    TANGENTIAL_NOW_B,
    TANGENTIAL_EQUATION_B,
    RATIO_B,
    TANGENTIAL_KEPT_B,
) = range(30)
IN_STEP = 30

# Sums of each contact over the steps of a sample, and its place at the beginning of the sample.
(
    NORMALS,
    TANGENTIALS,
    STUCK,
    SLID,
    JAMS,
    TOUCHDOWNS,
    STUCK_STEPS,
    SLID_STEPS,
    FIRST_MATERIAL,
    TANGENTIALS_B,
    FIRST_MATERIAL_B,
) = range(11)
SUMS = 11

# Columns of the energy record, one row a sample; all but the stored energy are carried from step to step. That of
# nonlinear springs is the work against their pull, and part of the stored energy. The last are heat of friction that
# went into layers, and the part of it that is stored there.
(
    STORED,
    DRIVE_WORK,
    CONTACT_WORK,
    FRICTION_LOSS,
    CONVECTION_WORK,
    DAMPING_LOSS,
    ITERATIONS,
    UNSOLVED,
    STORED_IN_SPRINGS,
    HEAT,
    STORED_HEAT,
) = range(11)
ENERGIES = 11

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
    HOT,
    TANGENTIAL_FORCE_B,
    CONTACT_POSITION_B,
    SLIP_VELOCITY_B,
    LAW_STATE_B,
) = range(18)
COLUMNS = 18

# Kinds of probe rows: on positions, on centred velocities, on second differences.
DISPLACEMENT, VELOCITY, ACCELERATION = range(3)

# Reasons for the end of a march.
FINISHED, OFF_TRACK, NOT_FINITE, CONTACT_UNSOLVED, ENERGY_CREATED, TOO_STIFF = range(6)

# Numbers of a nonlinear spring: pull without a stretch, that for a stretch, that for its cube, the size of its sawtooth
# under a unit force, and 1 over twice the step, or 0: a dashpot pulls over the rate of its stretch, and has the size of
# the sawtooth's rate. Then a group for each kink: its place, the change of the stiffness above it and below it.
CONSTANT_PULL, LINEAR, CUBIC, SPRING_REACH, PER_RATE = range(5)
OF_SPRING, OF_KINK = 5, 3
# Numbers of the heating of a contact: share of its loss to friction that heats it; temperatures of its layers after a
# step [degC] for those before, for a loss [degC/J], and without both; heat capacities [J/K]; 1 if the second is the
# place along the track, and the share of a step by which the law looks ahead of it.
HEAT_SHARE, PER_LAYER = 0, 1
PER_LOSS = PER_LAYER + LAYERS * LAYERS
WITHOUT_LOSS, CAPACITY = PER_LOSS + LAYERS, PER_LOSS + 2 * LAYERS
BY_PLACE, AHEAD = CAPACITY + LAYERS, CAPACITY + LAYERS + 1
OF_HEATING = AHEAD + 1
# State of a nonlinear spring: its pull in this step, its stretch half a step before it, and its increment in the step
# before the last one.
PULL, STRETCH, EARLIER_INCREMENT = range(3)
SPRING_STATE = 3
