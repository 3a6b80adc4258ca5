"""The contact of one run, or of several side by side, under any law of friction."""

import numba
from numba.extending import overload

from . import layout as at
from .contact import FREE, HELD, STICKING, solve_contact
from .friction import next_state, set_valued
from .lanes import choose, lane, magnitude, spread, with_lane
from .vectors import LANES, VECTOR


def solve(gap, slip, strayed, w_nn, w_nt, w_tt, law, laws, run, state, last_slip, status, step):
    """Return normal force, tangential force, status and whether it is jammed, all as numbers of runs."""
    return solve_one_run(gap, slip, strayed, w_nn, w_nt, w_tt, law, laws, run, state, last_slip, status, step)


def next_states(law, laws, run, status, state, velocity, step):
    """Return the internal states after a step, those of new contacts where the bodies are apart."""
    return next_state_of_run(law, laws, run, status, state, velocity, step)


@numba.njit(cache=True, inline="always")
def coulomb(gap, slip, w_nn, w_nt, w_tt, mu):
    """Do `solve` under Coulomb's law without branches; `slip` is how far the tip is from where sticking would hold it.

    The same as `contact.solve_coulomb`, to which a test holds it.
    """
    share = 1.0 / (w_nn * w_tt - w_nt * w_nt)
    held = (w_nn * slip - w_nt * gap) * share
    pressed = (w_nt * slip - w_tt * gap) * share
    directed = choose(held < 0.0, -mu, mu)
    free = w_nn - directed * w_nt
    slides = magnitude(held) > mu * pressed
    normal = choose(slides, -gap / free, pressed)
    tangential = choose(slides, directed * normal, held)
    jammed = choose(free > 0.0, 0.0, choose(slides, 0.0, 1.0))
    apart = gap >= 0.0
    return (
        choose(apart, 0.0, normal),
        choose(apart, 0.0, tangential),
        choose(apart, 0.0, choose(slides, 2.0, 1.0)),
        choose(apart, 0.0, jammed),
    )


@numba.njit(cache=True)
def solve_one_run(gap, slip, strayed, w_nn, w_nt, w_tt, law, laws, run, state, last_slip, status, step):
    """Do `solve` for one run."""
    stuck = abs(status - STICKING) < 0.5
    held = slip + (strayed if stuck else 0.0)
    grip = HELD if stuck else FREE
    normal, tangential, new, jammed = solve_contact(
        gap, held, slip, w_nn, w_nt, w_tt, law, laws, run, state, last_slip, grip, step
    )
    return normal, tangential, float(new), 1.0 if jammed else 0.0


@numba.njit(cache=True)
def next_state_of_run(law, laws, run, status, state, velocity, step):
    """Do `next_states` for one run."""
    if set_valued(law):
        return state
    if status < 0.5:
        return laws[run, at.LAW_PARAMETERS - 1]
    return next_state(law, laws, run, state, velocity, step)


@numba.njit(cache=True)
def solve_runs(gap, slip, strayed, w_nn, w_nt, w_tt, law, laws, run, state, last_slip, status, step):
    """Do `solve` for vectors of runs."""
    normal, tangential, new, jammed = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for i in range(LANES):
        one = solve_one_run(
            lane(gap, i),
            lane(slip, i),
            lane(strayed, i),
            lane(w_nn, i),
            lane(w_nt, i),
            lane(w_tt, i),
            law,
            laws,
            run + i,
            lane(state, i),
            lane(last_slip, i),
            lane(status, i),
            step,
        )
        normal, tangential = with_lane(normal, i, one[0]), with_lane(tangential, i, one[1])
        new, jammed = with_lane(new, i, one[2]), with_lane(jammed, i, one[3])
    return normal, tangential, new, jammed


@numba.njit(cache=True)
def next_states_of_runs(law, laws, run, status, state, velocity, step):
    """Do `next_states` for vectors of runs."""
    if set_valued(law):
        return state
    for i in range(LANES):
        one = next_state_of_run(law, laws, run + i, lane(status, i), lane(state, i), lane(velocity, i), step)
        state = with_lane(state, i, one)
    return state


@overload(solve)
def _overload_solve(gap, slip, strayed, w_nn, w_nt, w_tt, law, laws, run, state, last_slip, status, step):
    chosen = solve_runs if gap is VECTOR else solve_one_run

    def implementation(gap, slip, strayed, w_nn, w_nt, w_tt, law, laws, run, state, last_slip, status, step):
        return chosen(gap, slip, strayed, w_nn, w_nt, w_tt, law, laws, run, state, last_slip, status, step)

    return implementation


@overload(next_states)
def _overload_next_states(law, laws, run, status, state, velocity, step):
    chosen = next_states_of_runs if state is VECTOR else next_state_of_run

    def implementation(law, laws, run, status, state, velocity, step):
        return chosen(law, laws, run, status, state, velocity, step)

    return implementation
