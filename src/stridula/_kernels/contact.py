"""The exact solve of one point contact with Coulomb friction over one step."""

import numba

SEPARATED, STICKING, SLIDING = 0, 1, 2


@numba.njit(cache=True)
def solve_contact(gap, slip, w_nn, w_nt, w_tt, mu):
    """Return (normal force, tangential force, status, jammed) that close `gap` and, when sticking, undo `slip`.

    `gap` and `slip` are the gap and the slip [m] at the end of the step without contact force; the compliances
    [m/N] are the relative displacement of the tip against the track for unit forces (on the tip and its opposite on the
    track). The tangential force acts on the track along +x. Exactly one state is consistent for a positive definite
    compliance and this order of trials finds it.
    """
    if gap >= 0.0:
        return 0.0, 0.0, SEPARATED, False
    determinant = w_nn * w_tt - w_nt * w_nt
    normal = (w_nt * slip - w_tt * gap) / determinant
    tangential = (w_nn * slip - w_nt * gap) / determinant
    sense = 1.0 if tangential >= 0.0 else -1.0
    sliding_compliance = w_nn - sense * mu * w_nt
    if abs(tangential) <= mu * normal:
        return normal, tangential, STICKING, sliding_compliance <= 0.0
    normal = -gap / sliding_compliance
    return normal, sense * mu * normal, SLIDING, False
