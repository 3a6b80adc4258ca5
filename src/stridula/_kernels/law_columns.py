"""Columns of the parameters of a law of friction, and whether it sticks exactly.

The names in `PARAMETERS` are those of the laws' own parameters; several laws share columns.
"""

from .layout import AGING, COULOMB, LINEAR_WEAKENING, LUGRE, SLIP, STATIC_KINETIC, STRIBECK

# Set-valued laws and bristles: the ratio at rest; those that weaken; bristles.
STATIC, KINETIC, VELOCITY, EXPONENT, VISCOUS = range(5)
SLOPE, FLOOR, END = range(1, 4)
BRISTLE_STIFFNESS, BRISTLE_DAMPING, BRISTLE_VISCOUS = range(3, 6)
# Rate and state: the ratio at the reference velocity, and its changes with the logarithms of velocity and age.
REFERENCE, DIRECT, EVOLVING, SLIP_DISTANCE, REFERENCE_VELOCITY = range(5)
# State of a new contact.
NEW_STATE = 7
LAW_COLUMNS = 8

_WEAKENING = {"static": STATIC, "kinetic": KINETIC, "velocity": VELOCITY}
_RATE_AND_STATE = {
    "reference": REFERENCE,
    "a": DIRECT,
    "b": EVOLVING,
    "slip_distance": SLIP_DISTANCE,
    "velocity": REFERENCE_VELOCITY,
}
PARAMETERS = {
    COULOMB: {"coefficient": STATIC},
    STATIC_KINETIC: {"static": STATIC, "kinetic": KINETIC},
    STRIBECK: {**_WEAKENING, "exponent": EXPONENT, "viscous": VISCOUS},
    LINEAR_WEAKENING: {"static": STATIC, "slope": SLOPE, "kinetic": FLOOR, "end": END},
    LUGRE: {
        **_WEAKENING,
        "stiffness": BRISTLE_STIFFNESS,
        "damping": BRISTLE_DAMPING,
        "viscous": BRISTLE_VISCOUS,
    },
    AGING: _RATE_AND_STATE,
    SLIP: _RATE_AND_STATE,
}
# Whether a law sticks exactly, by its code.
SET_VALUED = tuple(code in (COULOMB, STATIC_KINETIC, STRIBECK, LINEAR_WEAKENING) for code in sorted(PARAMETERS))
