"""Step 5 for a contact of one run, or of several side by side, under any law of friction."""

from ..lanes.compiled import inlined, pasted, strict_pasted
from ..lanes.operations import Array, Number, Pair, Runs, anywhere, choose, everywhere, held, magnitude
from ..layout import columns as at
from ..layout.contact_values import Before, Compliance, Free, Law, Touch, Way
from ..layout.parts import Contacts
from .exact import NO_WAY, SLIDING, STICKING, new_way, solve_contact, turn_round, way_under
from .friction import set_valued
from .lanewise import lanewise
from .slipping import STOPPED


@lanewise(Touch(0.0, 0.0, 0.0, 0.0, NO_WAY))
def solve(free: Free, law: Law, before: Before, step: Number) -> Touch:
    """Return forces, status and whether it jams, of a contact under any law."""
    return solve_contact(free, law, before, step)


@lanewise(NO_WAY)
def way_of(touch: Pair, free: Free, law: Law, before: Before, step: Number) -> Way:
    """Return the way of a contact, one of several, with these normal force and status.

    Where bodies are apart, states are those of new contacts.
    """
    normal, status = touch
    if status < 0.5:
        return new_way(law)
    if set_valued(law.code) and free.w.tt == 0.0:
        return Way(0.0, before.state, 1.0 if status == STICKING else 0.0)
    return way_under(normal, free, law, before, step)


@lanewise(NO_WAY)
def way_apart(law: Law) -> Way:
    """Do `new_way`, in each run."""
    return new_way(law)


@inlined
def no_way(runs: Runs) -> Way:
    """Return the way of contacts that none is asked of."""
    return Way(runs.zero, runs.zero, runs.zero)


@strict_pasted
def coulomb(gap: Number, slip: Number, w: Compliance, mu: Number) -> Touch:
    """Do `solve` under Coulomb's law without branches (5a to 5c); `slip` is the distance to the anchor of sticking.

    The result equals that of `exact.solve_coulomb`, as a test checks.
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
    nothing = choose(apart, 0.0, 0.0)
    return Touch(
        choose(apart, 0.0, normal),
        choose(apart, 0.0, tangential),
        choose(apart, 0.0, choose(slides, 2.0, 1.0)),
        choose(apart, 0.0, jammed),
        Way(nothing, nothing, nothing),
    )


@strict_pasted
def turned_round(gap: Number, slip: Number, last_slip: Number, w: Compliance, mu: Number, touch: Touch) -> Touch:
    """Return the contact under Coulomb's law where the slip ends within the step (5d), else as given.

    `last_slip` is zero for contacts that did not slide.
    """
    turns, pressed, turned, slides = turn_round(gap, slip, last_slip, w, mu, mu)
    turns = choose(turns, choose(gap < 0.0, magnitude(last_slip), 0.0), 0.0) > 0.0
    return Touch(
        choose(turns, pressed, touch.normal),
        choose(turns, turned, touch.tangential),
        choose(turns, choose(slides, 2.0, 1.0), touch.status),
        touch.jammed,
        touch.way,
    )


@inlined
def law_of(i: int, contacts: Contacts, runs: Runs) -> Law:
    """Return the law of contact `i`."""
    at_rest = held(contacts.constants, i * at.CONTACT_CONSTANTS + at.AT_REST, runs)
    return Law(contacts.codes[i], contacts.laws, i * runs.columns + runs.first, at_rest, runs.zero)


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
def strayed(carried: Array, base: int, material: int, anchor: int, runs: Runs) -> Number:
    """Return the distance of a contact from the anchor of its stick, along the tangent of these columns."""
    stuck = magnitude(held(carried, base + at.STATUS, runs) - STICKING) < 0.5
    away = held(carried, base + material, runs) - held(carried, base + anchor, runs)
    return choose(stuck, away, runs.zero)


@inlined
def strayed_in_plane(carried: Array, i: int, runs: Runs) -> Number:
    """Return the distance of contact `i` from the anchor of its stick."""
    return strayed(carried, i * at.CARRIED, at.MATERIAL, at.ANCHOR, runs)


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
def solve_in_plane(free: Free, law: Law, before: Before, step: Number, zero: Number) -> Touch:
    """Do `solve`, for Coulomb's law without branches."""
    gap, w = free.gap, free.w
    if law.code == at.COULOMB and everywhere(w.tt > 0.0):
        touch = coulomb(gap, free.slip + free.strayed, w, law.at_rest)
        slid = choose(before.status > SLIDING - 0.5, before.slip, zero)
        on = choose(touch.status > SLIDING - 0.5, touch.tangential * slid, zero) > 0.0
        if anywhere(choose(on, zero, choose(gap < 0.0, magnitude(slid), zero)) > 0.0):
            touch = turned_round(gap, free.slip, slid, w, law.at_rest, touch)
        return touch
    return solve(free, law, before, step)
