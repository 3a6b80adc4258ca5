"""Steps of a single contact between bodies of uncoupled modes."""

from .books.bookkeeping import credit, keep_books, keep_place
from .books.leaving import beyond_ends
from .books.recording import keep_probes
from .contact.solves import carried_by, law_of, strayed_in_plane, way_apart
from .contact.yielding import about_indentation, comes_close, solve_and_keep
from .contacts.profiles import follow_profile
from .lanes.compiled import inlined, pasted
from .lanes.operations import Array, Number, Runs, anywhere, choose, held, hold
from .layout import columns as at
from .layout.contact_values import Compliance, Free, Moved, Touch, Tried
from .layout.parts import Contacts, Parts, Timing
from .trying import try_one


@pasted
def solve_single(tried: Tried, contacts: Contacts, carried: Array, timing: Timing, runs: Runs) -> Touch:
    """Return the forces of a single contact (step 5)."""
    hold(contacts.now, at.GIVE, runs, runs.zero)
    hold(contacts.now, at.BEYOND, runs, runs.zero)
    if not anywhere(comes_close(0, tried.gap, contacts.constants, carried, runs) > 0.5):
        return Touch(runs.zero, runs.zero, runs.zero, runs.zero, way_apart(law_of(0, contacts, runs)))
    free, before = free_of(tried, carried, runs), carried_by(carried, 0, runs)
    touch: Touch = solve_and_keep(0, free, before, contacts, carried, timing.step, runs)
    return touch


@inlined
def free_of(tried: Tried, carried: Array, runs: Runs) -> Free:
    """Return the motion of a single contact without its forces; it is never let go."""
    return Free(tried.gap, tried.slip, strayed_in_plane(carried, 0, runs), tried.w, runs.zero)


@pasted
def touch_one(
    parts: Parts, n: int, loop: tuple[Touch, bool, int, Number], ended: Number, runs: Runs
) -> tuple[Tried, Touch, Number, Number]:
    """Complete a pending step of a single contact (step 6), try step `n`, and solve for the forces (steps 1 to 5).

    `loop` are forces and status of the step before, whether it is pending, the rows of its waves, the advance since.

    Returns
    -------
    tried, touch : tuple
        The contact without its forces; its forces.
    leaves, why : float or vector
        Where the contact leaves its path, and why.
    """
    contacts, state = parts.contacts, parts.state
    last, pending, sine, advance = loop
    after = n + 2 if parts.imposed.motion.shape[0] > 1 else 0
    tried, done = try_one(parts, after, last, pending, sine, runs)
    if pending:
        credit(state.energies, done.work, done.lost, done.slope * advance, runs)
        keep_probes(None, parts, n - 1, runs)
    # A run that has ended has no contact.
    w = Compliance(tried.w.nn, tried.w.nt, tried.w.tn, choose(ended > 0.0, 1.0, tried.w.tt))
    tried = Tried(tried.place, choose(ended > 0.0, runs.zero, tried.gap), tried.slip, w)
    leaves, why = runs.zero, runs.zero
    if parts.sizes.paths:
        leaves, why = beyond_ends(0, tried.place, contacts, state, runs)
    return tried, solve_single(tried, contacts, state.carried, parts.timing, runs), leaves, why


@pasted
def keep_one(parts: Parts, n: int, tried: Tried, touch: Touch, runs: Runs) -> Number:
    """Do the bookkeeping of a single contact; return half its advance in the last two steps."""
    contacts, carried, w = parts.contacts, parts.state.carried, tried.w
    normal, tangential = touch.normal, touch.tangential
    gap, slip = tried.gap + w.nn * normal - w.nt * tangential, tried.slip + w.tn * normal - w.tt * tangential
    place = tried.place + w.nt * normal - held(contacts.fixed, 2, runs) * tangential
    give, beyond = held(contacts.now, at.GIVE, runs), held(contacts.now, at.BEYOND, runs)
    free = about_indentation(free_of(tried, carried, runs), give, beyond)
    keep_books(0, free, touch, Moved(gap, slip), parts, n, runs)
    if contacts.profiles.shape[1]:
        follow_profile(0, normal, slip, contacts, parts.state, runs)
    hold(contacts.now, at.NORMAL_NOW, runs, normal)
    hold(contacts.now, at.TANGENTIAL_NOW, runs, tangential)
    return keep_place(0, carried, place, runs)
