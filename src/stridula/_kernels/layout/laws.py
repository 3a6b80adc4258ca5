"""Columns of the parameters of laws of friction, and the laws that stick exactly.

Laws have the names of their codes in `columns`, parameters those of the laws' own `parameters`. Several laws share
columns. The kernels do not depend on the order of the codes.
"""

from . import columns as at

# Set-valued laws and bristles: the ratio at rest; those that weaken; bristles.
STATIC, KINETIC, VELOCITY, EXPONENT, VISCOUS = range(5)
SLOPE, FLOOR, END = range(1, 4)
BRISTLE_STIFFNESS, BRISTLE_DAMPING, BRISTLE_VISCOUS = range(3, 6)
# Rate and state: the ratio at the reference velocity, and its changes with the logarithms of velocity and age.
REFERENCE, DIRECT, EVOLVING, SLIP_DISTANCE, REFERENCE_VELOCITY = range(5)
# A curve over the slip speed in pieces: their number, that of the coefficients of each, and the slope beyond the last.
PIECES, ORDER, END_SLOPE = range(1, 4)
# Its sections over the normal force, of which a curve has one: their coefficients lie one behind the other, then the
# forces of sections and their ratios at rest.
SECTIONS = 6
# Behind those of a curve: the spring and the dashpot in series with the friction.
JOINT_STIFFNESS, JOINT_DAMPING = range(4, 6)
# State of a new contact.
NEW_STATE = 7
LAW_COLUMNS = 8
# Behind these columns, for a curve: the speeds between pieces, the speeds over which it bends there, and coefficients.
FIRST_SPEED = LAW_COLUMNS

_WEAKENING = {"static": STATIC, "kinetic": KINETIC, "velocity": VELOCITY}
_BRISTLES = {"stiffness": BRISTLE_STIFFNESS, "damping": BRISTLE_DAMPING, "viscous": BRISTLE_VISCOUS}
_AGES = {"slip_distance": SLIP_DISTANCE, "velocity": REFERENCE_VELOCITY}
_CURVE = {"static": STATIC, "pieces": PIECES, "order": ORDER, "end_slope": END_SLOPE, "sections": SECTIONS}
_RATE_AND_STATE = {"reference": REFERENCE, "a": DIRECT, "b": EVOLVING, **_AGES}
PARAMETERS = {
    "COULOMB": {"coefficient": STATIC},
    "STATIC_KINETIC": {"static": STATIC, "kinetic": KINETIC},
    "STRIBECK": {**_WEAKENING, "exponent": EXPONENT, "viscous": VISCOUS},
    "LINEAR_WEAKENING": {"static": STATIC, "slope": SLOPE, "kinetic": FLOOR, "end": END},
    "LUGRE": {**_WEAKENING, **_BRISTLES},
    "AGING": _RATE_AND_STATE,
    "SLIP": _RATE_AND_STATE,
    "CURVE": _CURVE,
    "IN_SERIES": {**_CURVE, "stiffness": JOINT_STIFFNESS, "damping": JOINT_DAMPING},
}
CODES = {name: getattr(at, name) for name in PARAMETERS}
# Whether a law sticks exactly, by its code.
_STICKS = {"COULOMB", "STATIC_KINETIC", "STRIBECK", "LINEAR_WEAKENING", "CURVE"}
SET_VALUED = tuple(name in _STICKS for name in sorted(CODES, key=CODES.__getitem__))
