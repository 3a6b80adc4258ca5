"""The march of the twin, in the six steps of *Contact in one step*, and its ledger."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

import stridula as st

from .contact import Contact
from .laws import has_state
from .modes import Bodies, before_start
from .states import Contacts, forces_of, solve
from .way import SEPARATED


def march(system: st.System, scheme, h: float, steps: int) -> SimpleNamespace:
    """March `steps` steps of `h` [s] and return everything; contact columns of shape (steps, contacts)."""
    bodies = Bodies(system)
    contacts = [Contact(one, bodies) for one in system.contacts]
    a, b, load = recurrence = scheme(bodies.stiffness, bodies.damping, h)
    drives = bodies.drives(h)
    q_before, q = start(contacts, bodies, scheme, h)
    # The velocity now is that of the increments of the last two steps, the earlier one extrapolated to the start.
    velocity = bodies.start()[1]
    ledger, kept, guess = Ledger(bodies.stiffness, recurrence, h, bodies.stored((q + q_before) / 2)), [], None
    for n in range(steps):
        # 1. Trial.
        force, pull = drives(n * h), bodies.pulls(q, velocity)
        trial = a @ q - b @ q_before + load @ (force + pull)
        # 2. Traces.
        for one in contacts:
            one.freeze(trial, (n + 1) * h)
        # 3. Trial gap and slip. 4. Compliance.
        rows = rows_of(contacts)
        free = without_forces(contacts, trial, rows @ load @ rows.T, h)
        # 5. State. All combinations of several contacts are tried at one step in ten, to count the consistent ones.
        found = solve(free, guess if n % 10 and len(contacts) > 1 else None)
        if not found:
            raise RuntimeError(f"no consistent state of the contacts at step {n}")
        guess, touches = found[0]
        # 6. Correction.
        push = rows.T @ forces_of(touches)
        q_new = trial + load @ push

        braked = bodies.losses(velocity, (q_new - q_before) / 2)
        ledger.add(contacts, touches, (force, pull, push, braked), (q_before, q, q_new), n)
        lost = [loss_of(one, touch, q_new) for one, touch in zip(contacts, touches, strict=True)]
        kept.append({"solutions": len(found), **books(contacts, touches, free, q_new), **vars(ledger.sums)})
        kept[-1]["temperature"] = warmed(contacts, lost, h)
        velocity = (3 * (q_new - q) - (q - q_before)) / (2 * h)
        q_before, q = q, q_new
    trail = SimpleNamespace(**{name: np.array([one[name] for one in kept]) for name in kept[0]})
    trail.last = q_before, q
    return trail


def rows_of(contacts):
    return np.array([row for one in contacts for row in one.traces[:2]])


def without_forces(contacts, trial, w, h):
    """All contacts at the end of a step without their forces, with their compliance."""
    own = [w[i : i + 2, i : i + 2] for i in range(0, len(w), 2)]
    free = [one.free(trial, part) for one, part in zip(contacts, own, strict=True)]
    return Contacts([one.before for one in contacts], free, w, h)


def start(contacts, bodies, scheme, h):
    """Return the positions a step before the start and at it, with the contacts at their start.

    Forces of contacts that are closed act before the start as they do in the first step.
    """
    q, velocity = bodies.start()
    a, b, load = scheme(bodies.stiffness, bodies.damping, h)
    force, still = bodies.drives(h)(0.0) + bodies.pulls(q, velocity), np.zeros(bodies.size)

    def under(f, q=q, velocity=velocity):
        return before_start(scheme, bodies.stiffness, bodies.damping, h, q, velocity, f)

    def begin(q_before):
        for one in contacts:
            one.begin(q, q_before, velocity, h)
        return [one for one in contacts if one.last_gap == 0.0]

    q_before = under(force)
    closed = begin(q_before)
    if closed:
        rows = rows_of(closed)
        answers = np.array([load @ row - b @ under(row, still, still) for row in rows])
        trial = a @ q - b @ q_before + load @ force
        for one in closed:
            one.freeze(trial, h)
        _, touches = solve(without_forces(closed, trial, rows @ answers.T, h))[0]
        q_before = under(force + rows.T @ forces_of(touches))
        begin(q_before)
        push = load @ rows.T @ forces_of(touches)
        for one, touch in zip(closed, touches, strict=True):
            one.press(touch, one.traces.slip @ push)
    for one in contacts:
        one.before.given = None
    return q_before, q


def books(contacts, touches, free, q):
    """Return what is kept of the contacts after a step, and carry them on."""
    forces, was = forces_of(touches), [one.before.status for one in contacts]
    shares = []
    for i, (one, touch) in enumerate(zip(contacts, touches, strict=True)):
        alone = free.alone(i, forces)
        shares.append(one.shares(touch, alone))
        one.keep(touch, alone, q)
    return {
        "normal": [touch.normal for touch in touches],
        "tangential": [touch.tangential for touch in touches],
        "status": [touch.status for touch in touches],
        "landings": [int(old == SEPARATED != one.status) for old, one in zip(was, touches, strict=True)],
        "share": shares,
        "position": [one.place(q) for one in contacts],
        "gap": [one.gap(q) for one in contacts],
        "height": [one.height(q) for one in contacts],
        "state": [one.before.state for one in contacts],
    }


def loss_of(one, touch, q_new):
    """Loss of a contact to friction in a step, before it is carried on [J]."""
    work = touch.tangential * one.slip(touch, q_new)
    return work if has_state(one.before.law) else abs(work)


def warmed(contacts, lost, h):
    """Heat the contacts by their losses and return their temperatures, at which their laws act from now on."""
    for one, loss in zip(contacts, lost, strict=True):
        one.heat.warm(loss, h)
        one.before.law = one.heat.law(one.before.law)
    return [one.heat.layers[0] for one in contacts]


class Ledger:
    """Works since the start, losses, and the energy stored at the last step [J]."""

    def __init__(self, stiffness, recurrence, h, in_springs):
        self.in_springs = in_springs
        self.stiffness, self.b, self.h, self.inverse = stiffness, recurrence.b, h, np.linalg.inv(recurrence.load)
        self.sums = SimpleNamespace(stored=0.0, drive=0.0, contact=0.0, friction=0.0, convection=0.0, damping=0.0)

    def add(self, contacts, touches, forces, positions, n):
        """Add step `n`: forces of drives, springs and contacts, losses in dashpots, and the last three positions."""
        (force, pull, push, braked), (q_before, q, q_new) = forces, positions
        middle, sums = (q_new - q_before) / 2, self.sums
        self.in_springs -= pull @ middle + braked
        sums.damping += braked
        sums.drive += force @ middle
        sums.contact += push @ middle
        for one, touch in zip(contacts, touches, strict=True):
            tip, track, lift = np.subtract(one.imposed, one.imposed_at((n - 1) * self.h)) / 2
            frame = touch.tangential * (tip - track) - touch.normal * lift
            sums.drive += frame
            sums.contact -= frame
            sums.friction += loss_of(one, touch, q_new)
            slope = (touch.normal * one.traces.slopes[1] - touch.tangential * one.traces.slopes[0]) @ q_new
            sums.convection += slope * (one.place(q_new) - one.place_before) / 2
            sums.convection += touch.normal * (one.rise - one.rise_before) / 2
        d, d_before = q_new - q, q - q_before
        sums.damping += middle @ self.inverse @ (d - self.b @ d_before) - self.kinetic(d) + self.kinetic(d_before)
        sums.stored = self.kinetic(d) + q_new @ self.stiffness @ q / 2 + self.in_springs

    def kinetic(self, d):
        return d @ self.inverse @ (d + self.b @ d) / 4
