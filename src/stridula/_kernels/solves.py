"""Step 5 for a contact of one run, or of several side by side, under any law of friction."""

import numba
from numba.extending import overload

from . import layout as at
from .contact import SLIDING, STICKING, ratio_under, solve_contact, turn_round
from .friction import STRICT, set_valued
from .lanes import anywhere, choose, everywhere, held, lane, magnitude, spread, with_lane
from .law_columns import NEW_STATE
from .modes import OPTIONS, PASTED
from .slipping import STOPPED
from .vectors import LANES, VECTOR


def solve(gap, slip, strayed, w, law, laws, run, before, let_go, step):
    """Return normal force, tangential force, status and whether it jams, all as numbers of runs."""
    return solve_one_run(gap, slip, strayed, w, law, laws, run, before, let_go, step)


def next_on_way(touch, gap, slip, strayed, w, law, laws, run, before, let_go, step):
    """Return the past parts of the ratios for the next step, the internal states, and shares of stick of this step.

    `touch` are normal force and status. Where bodies are apart, states are those of new contacts.
    """
    return next_on_way_of_run(touch, gap, slip, strayed, w, law, laws, run, before, let_go, step)


@numba.njit(inline="always", **STRICT)
def coulomb(gap, slip, w, mu):
    """Do `solve` under Coulomb's law without branches (5a to 5c); `slip` is the distance to the anchor of sticking.

    The result equals that of `contact.solve_coulomb`, as a test checks.
    """
    w_nn, w_nt, w_tn, w_tt = w
    share = 1.0 / (w_nn * w_tt - w_nt * w_tn)
    held = (w_nn * slip - w_tn * gap) * share
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


@numba.njit(inline="always", **STRICT)
def turned_round(gap, slip, last_slip, w, mu, normal, tangential, status):
    """Return forces and status under Coulomb's law where the slip ends within the step (5d), else as given.

    `last_slip` is zero for contacts that did not slide.
    """
    turns, pressed, turned, slides = turn_round(gap, slip, last_slip, w, mu, mu)
    turns = choose(turns, choose(gap < 0.0, magnitude(last_slip), 0.0), 0.0) > 0.0
    normal, tangential = choose(turns, pressed, normal), choose(turns, turned, tangential)
    return normal, tangential, choose(turns, choose(slides, 2.0, 1.0), status)


@numba.njit(**STRICT)
def solve_one_run(gap, slip, strayed, w, law, laws, run, before, let_go, step):
    """Do `solve` for one run."""
    normal, tangential, new, jammed = solve_contact(gap, slip, strayed, w, law, laws, run, before, let_go > 0.5, step)
    return normal, tangential, float(new), 1.0 if jammed else 0.0


@numba.njit(**STRICT)
def next_on_way_of_run(touch, gap, slip, strayed, w, law, laws, run, before, let_go, step):
    """Do `next_on_way` for one run."""
    if touch[1] < 0.5:
        return 0.0, laws[run, NEW_STATE], 0.0
    if law == at.COULOMB or (set_valued(law) and w[3] == 0.0):
        return 0.0, before[3], 1.0 if touch[1] == STICKING else 0.0
    _, past, state, _, stuck = ratio_under(touch[0], gap, slip, strayed, w, law, laws, run, before, let_go > 0.5, step)
    return past, state, stuck


@numba.njit(**STRICT)
def lanes_of(values, i):
    """Return the numbers in a lane of what a contact carries."""
    status, last, earlier, state, normal, tangential, past = values
    return (
        lane(status, i),
        lane(last, i),
        lane(earlier, i),
        lane(state, i),
        lane(normal, i),
        lane(tangential, i),
        lane(past, i),
    )


@numba.njit(**STRICT)
def solve_runs(gap, slip, strayed, w, law, laws, run, before, let_go, step):
    """Do `solve` for vectors of runs."""
    normal, tangential, new, jammed = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for i in range(LANES):
        one = solve_one_run(
            lane(gap, i),
            lane(slip, i),
            lane(strayed, i),
            (lane(w[0], i), lane(w[1], i), lane(w[2], i), lane(w[3], i)),
            law,
            laws,
            run + i,
            lanes_of(before, i),
            lane(let_go, i),
            step,
        )
        normal, tangential = with_lane(normal, i, one[0]), with_lane(tangential, i, one[1])
        new, jammed = with_lane(new, i, one[2]), with_lane(jammed, i, one[3])
    return normal, tangential, new, jammed


@numba.njit(**STRICT)
def next_on_way_of_runs(touch, gap, slip, strayed, w, law, laws, run, before, let_go, step):
    """Do `next_on_way` for vectors of runs."""
    past, state, stuck = spread(0.0), before[3], spread(0.0)
    if law == at.COULOMB:
        return past, state, stuck
    for i in range(LANES):
        one = next_on_way_of_run(
            (lane(touch[0], i), lane(touch[1], i)),
            lane(gap, i),
            lane(slip, i),
            lane(strayed, i),
            (lane(w[0], i), lane(w[1], i), lane(w[2], i), lane(w[3], i)),
            law,
            laws,
            run + i,
            lanes_of(before, i),
            lane(let_go, i),
            step,
        )
        past, state = with_lane(past, i, one[0]), with_lane(state, i, one[1])
        stuck = with_lane(stuck, i, one[2])
    return past, state, stuck


@overload(solve)
def _overload_solve(gap, slip, strayed, w, law, laws, run, before, let_go, step):
    chosen = solve_runs if gap is VECTOR else solve_one_run

    def implementation(gap, slip, strayed, w, law, laws, run, before, let_go, step):
        return chosen(gap, slip, strayed, w, law, laws, run, before, let_go, step)

    return implementation


@overload(next_on_way)
def _overload_next_on_way(touch, gap, slip, strayed, w, law, laws, run, before, let_go, step):
    chosen = next_on_way_of_runs if slip is VECTOR else next_on_way_of_run

    def implementation(touch, gap, slip, strayed, w, law, laws, run, before, let_go, step):
        return chosen(touch, gap, slip, strayed, w, law, laws, run, before, let_go, step)

    return implementation


@numba.njit(**OPTIONS)
def carried_by(carried, i, run, zero):
    """Return status, last two slips, internal state, forces and past part of the ratio of contact `i`."""
    base = i * at.CARRIED
    return (
        held(carried, base + at.STATUS, run, zero),
        held(carried, base + at.LAST_SLIP, run, zero),
        held(carried, base + at.EARLIER_SLIP, run, zero),
        held(carried, base + at.FRICTION_STATE, run, zero),
        held(carried, base + at.LAST_NORMAL, run, zero),
        held(carried, base + at.LAST_TANGENTIAL, run, zero),
        held(carried, base + at.PAST_RATIO, run, zero),
    )


@numba.njit(**OPTIONS)
def strayed(carried, i, run, zero):
    """Return the distance of contact `i` from the anchor of its stick."""
    base = i * at.CARRIED
    stuck = magnitude(held(carried, base + at.STATUS, run, zero) - STICKING) < 0.5
    away = held(carried, base + at.MATERIAL, run, zero) - held(carried, base + at.ANCHOR, run, zero)
    return choose(stuck, away, zero)


@numba.njit(**OPTIONS)
def resting(status):
    """Return the status of a step for the next one: a contact that stopped sticks."""
    return choose(status > STOPPED - 0.5, STICKING + 0.0 * status, status)


@numba.njit(**OPTIONS)
def anchor_after(anchor, place, status, was):
    """Return the anchor of a stick after a step: a contact that came to rest in it is anchored at its `place`."""
    sticks, stuck = magnitude(status - STICKING) < 0.5, magnitude(was - STICKING) < 0.5
    began = choose(status > STOPPED - 0.5, 1.0, choose(stuck, 0.0 * status, choose(sticks, 1.0, 0.0 * status)))
    return choose(began > 0.5, place, anchor)


@numba.njit(**PASTED)
def forces_of_one(gap, slip, away, w, law, laws, number, at_rest, before, let_go, step, zero):
    """Return normal force, tangential force, status and whether it jams, for one contact."""
    if law == at.COULOMB and everywhere(w[3] > 0.0):
        normal, tangential, status, jammed = coulomb(gap, slip + away, w, at_rest)
        slid = choose(before[0] > SLIDING - 0.5, before[1], zero)
        on = choose(status > SLIDING - 0.5, tangential * slid, zero) > 0.0
        if anywhere(choose(on, zero, choose(gap < 0.0, magnitude(slid), zero)) > 0.0):
            normal, tangential, status = turned_round(gap, slip, slid, w, at_rest, normal, tangential, status)
        return normal, tangential, status, jammed
    return solve(gap, slip, away, w, law, laws, number, before, let_go, step)
