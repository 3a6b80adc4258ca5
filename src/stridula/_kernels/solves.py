"""Step 5 for a contact of one run, or of several side by side, under any law of friction."""

from typing import Any

from . import layout as at
from .compiled import inlined, overloaded, pasted, strict, strict_pasted
from .contact import SLIDING, STICKING, ratio_under, solve_contact, turn_round
from .contact_values import Before, Compliance
from .friction import set_valued
from .lanes import (
    Array,
    Number,
    Numbers,
    Pair,
    Runs,
    anywhere,
    choose,
    everywhere,
    held,
    lane,
    magnitude,
    spread,
    with_lane,
)
from .law_columns import NEW_STATE
from .slipping import STOPPED
from .vectors import LANES, VECTOR


def solve(
    gap: Number,
    slip: Number,
    strayed: Number,
    w: Compliance,
    law: int,
    laws: Array,
    number: int,
    before: Before,
    let_go: Number,
    step: Number,
) -> Numbers:
    """Return normal force, tangential force, status and whether it jams, all as numbers of runs."""
    return solve_one_run(gap, slip, strayed, w, law, laws, number, before, let_go, step)


def next_on_way(
    touch: Pair,
    gap: Number,
    slip: Number,
    strayed: Number,
    w: Compliance,
    law: int,
    laws: Array,
    number: int,
    before: Before,
    let_go: Number,
    step: Number,
) -> Numbers:
    """Return the past parts of the ratios for the next step, the internal states, and shares of stick of this step.

    `touch` are normal force and status. Where bodies are apart, states are those of new contacts.
    """
    return next_on_way_of_run(touch, gap, slip, strayed, w, law, laws, number, before, let_go, step)


@strict_pasted
def coulomb(gap: Number, slip: Number, w: Compliance, mu: Number) -> Numbers:
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


@strict_pasted
def turned_round(
    gap: Number,
    slip: Number,
    last_slip: Number,
    w: Compliance,
    mu: Number,
    normal: Number,
    tangential: Number,
    status: Number,
) -> Numbers:
    """Return forces and status under Coulomb's law where the slip ends within the step (5d), else as given.

    `last_slip` is zero for contacts that did not slide.
    """
    turns, pressed, turned, slides = turn_round(gap, slip, last_slip, w, mu, mu)
    turns = choose(turns, choose(gap < 0.0, magnitude(last_slip), 0.0), 0.0) > 0.0
    normal, tangential = choose(turns, pressed, normal), choose(turns, turned, tangential)
    return normal, tangential, choose(turns, choose(slides, 2.0, 1.0), status)


@strict
def solve_one_run(
    gap: Number,
    slip: Number,
    strayed: Number,
    w: Compliance,
    law: int,
    laws: Array,
    number: int,
    before: Before,
    let_go: Number,
    step: Number,
) -> Numbers:
    """Do `solve` for one run."""
    normal, tangential, new, jammed = solve_contact(
        gap, slip, strayed, w, law, laws, number, before, let_go > 0.5, step
    )
    return normal, tangential, float(new), 1.0 if jammed else 0.0


@strict
def next_on_way_of_run(
    touch: Pair,
    gap: Number,
    slip: Number,
    strayed: Number,
    w: Compliance,
    law: int,
    laws: Array,
    number: int,
    before: Before,
    let_go: Number,
    step: Number,
) -> Numbers:
    """Do `next_on_way` for one run."""
    if touch[1] < 0.5:
        return 0.0, laws[number, NEW_STATE], 0.0
    if law == at.COULOMB or (set_valued(law) and w.tt == 0.0):
        return 0.0, before.state, 1.0 if touch[1] == STICKING else 0.0
    _, past, state, _, stuck = ratio_under(
        touch[0], gap, slip, strayed, w, law, laws, number, before, let_go > 0.5, step
    )
    return past, state, stuck


@strict
def lanes_of(before: Before, i: int) -> Before:
    """Return the numbers in a lane of what a contact carries."""
    status, last, earlier, state, normal, tangential, past = before
    return Before(
        lane(status, i),
        lane(last, i),
        lane(earlier, i),
        lane(state, i),
        lane(normal, i),
        lane(tangential, i),
        lane(past, i),
    )


@strict
def solve_runs(
    gap: Number,
    slip: Number,
    strayed: Number,
    w: Compliance,
    law: int,
    laws: Array,
    number: int,
    before: Before,
    let_go: Number,
    step: Number,
) -> Numbers:
    """Do `solve` for vectors of runs."""
    normal, tangential, new, jammed = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for i in range(LANES):
        one = solve_one_run(
            lane(gap, i),
            lane(slip, i),
            lane(strayed, i),
            Compliance(lane(w.nn, i), lane(w.nt, i), lane(w.tn, i), lane(w.tt, i)),
            law,
            laws,
            number + i,
            lanes_of(before, i),
            lane(let_go, i),
            step,
        )
        normal, tangential = with_lane(normal, i, one[0]), with_lane(tangential, i, one[1])
        new, jammed = with_lane(new, i, one[2]), with_lane(jammed, i, one[3])
    return normal, tangential, new, jammed


@strict
def next_on_way_of_runs(
    touch: Numbers,
    gap: Number,
    slip: Number,
    strayed: Number,
    w: Compliance,
    law: int,
    laws: Array,
    number: int,
    before: Before,
    let_go: Number,
    step: Number,
) -> Numbers:
    """Do `next_on_way` for vectors of runs."""
    past, state, stuck = spread(0.0), before.state, spread(0.0)
    if law == at.COULOMB:
        return past, state, stuck
    for i in range(LANES):
        one = next_on_way_of_run(
            (lane(touch[0], i), lane(touch[1], i)),
            lane(gap, i),
            lane(slip, i),
            lane(strayed, i),
            Compliance(lane(w.nn, i), lane(w.nt, i), lane(w.tn, i), lane(w.tt, i)),
            law,
            laws,
            number + i,
            lanes_of(before, i),
            lane(let_go, i),
            step,
        )
        past, state = with_lane(past, i, one[0]), with_lane(state, i, one[1])
        stuck = with_lane(stuck, i, one[2])
    return past, state, stuck


@overloaded(solve)
def _overload_solve(
    gap: Any, slip: Any, strayed: Any, w: Any, law: Any, laws: Any, number: Any, before: Any, let_go: Any, step: Any
) -> Any:
    chosen = solve_runs if gap is VECTOR else solve_one_run
    return lambda gap, slip, strayed, w, law, laws, number, before, let_go, step: chosen(
        gap, slip, strayed, w, law, laws, number, before, let_go, step
    )


@overloaded(next_on_way)
def _overload_next_on_way(
    touch: Any,
    gap: Any,
    slip: Any,
    strayed: Any,
    w: Any,
    law: Any,
    laws: Any,
    number: Any,
    before: Any,
    let_go: Any,
    step: Any,
) -> Any:
    chosen = next_on_way_of_runs if slip is VECTOR else next_on_way_of_run
    return lambda touch, gap, slip, strayed, w, law, laws, number, before, let_go, step: chosen(
        touch, gap, slip, strayed, w, law, laws, number, before, let_go, step
    )


@inlined
def carried_by(carried: Array, i: int, runs: Runs) -> Before:
    """Return what contact `i` carries from the steps before."""
    base = i * at.CARRIED
    return Before(
        held(carried, base + at.STATUS, runs),
        held(carried, base + at.LAST_SLIP, runs),
        held(carried, base + at.EARLIER_SLIP, runs),
        held(carried, base + at.FRICTION_STATE, runs),
        held(carried, base + at.LAST_NORMAL, runs),
        held(carried, base + at.LAST_TANGENTIAL, runs),
        held(carried, base + at.PAST_RATIO, runs),
    )


@inlined
def strayed(carried: Array, i: int, runs: Runs) -> Number:
    """Return the distance of contact `i` from the anchor of its stick."""
    base = i * at.CARRIED
    stuck = magnitude(held(carried, base + at.STATUS, runs) - STICKING) < 0.5
    away = held(carried, base + at.MATERIAL, runs) - held(carried, base + at.ANCHOR, runs)
    return choose(stuck, away, runs.zero)


@inlined
def resting(status: Number) -> Number:
    """Return the status of a step for the next one: a contact that stopped sticks."""
    return choose(status > STOPPED - 0.5, STICKING + 0.0 * status, status)


@inlined
def anchor_after(anchor: Number, place: Number, status: Number, was: Number) -> Number:
    """Return the anchor of a stick after a step: a contact that came to rest in it is anchored at its `place`."""
    sticks, stuck = magnitude(status - STICKING) < 0.5, magnitude(was - STICKING) < 0.5
    began = choose(status > STOPPED - 0.5, 1.0, choose(stuck, 0.0 * status, choose(sticks, 1.0, 0.0 * status)))
    return choose(began > 0.5, place, anchor)


@pasted
def forces_of_one(
    gap: Number,
    slip: Number,
    away: Number,
    w: Compliance,
    law: int,
    laws: Array,
    number: int,
    at_rest: Number,
    before: Before,
    let_go: Number,
    step: Number,
    zero: Number,
) -> Numbers:
    """Return normal force, tangential force, status and whether it jams, for one contact."""
    if law == at.COULOMB and everywhere(w.tt > 0.0):
        normal, tangential, status, jammed = coulomb(gap, slip + away, w, at_rest)
        slid = choose(before.status > SLIDING - 0.5, before.slip, zero)
        on = choose(status > SLIDING - 0.5, tangential * slid, zero) > 0.0
        if anywhere(choose(on, zero, choose(gap < 0.0, magnitude(slid), zero)) > 0.0):
            normal, tangential, status = turned_round(gap, slip, slid, w, at_rest, normal, tangential, status)
        return normal, tangential, status, jammed
    return solve(gap, slip, away, w, law, laws, number, before, let_go, step)
