"""A slow twin of the march for everything: any bodies, connections, tracks and laws, several contacts.

Written from the equations of the model in their two-position form, with one matrix for all modes of all bodies::

    q[n+1] = A q[n] - B q[n-1] + L f[n]

for the forces f of loads and contacts. The exact scheme takes its matrices from the exponential of the state matrix
over a step forwards and one backwards. The contacts are solved together by trying every combination of their states,
the velocities of sliding from root finding.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations, product
from types import SimpleNamespace

import numpy as np
from scipy.linalg import expm
from scipy.linalg.lapack import dgesv

import stridula as st
from kernels.twin import stuck_until
from kernels.way_twin import on_its_way

SEPARATED, STICKING, SLIDING = 0, 1, 2
KEPT = ["normal", "tangential", "status", "landings", "share", "position", "gap", "height", "state", "solutions"]
KEPT += ["stored", "drive", "contact", "friction", "convection", "damping"]


# The recurrence.


def central(stiffness, damping, h):
    """A, B, L of ``q'' + D q' + K q = f`` with centred differences."""
    one = np.eye(len(stiffness))
    left = np.linalg.inv(one / h**2 + damping / (2 * h))
    return left @ (2 * one / h**2 - stiffness), left @ (one / h**2 - damping / (2 * h)), left


def exact(stiffness, damping, h):
    """A, B, L of exact motion: a step forwards and one backwards share the velocity in the middle."""
    e, f, j = transition(stiffness, damping, h)
    e_back, f_back, j_back = transition(stiffness, damping, -h)
    turn = np.linalg.solve(f_back.T, f.T).T
    return e - turn @ e_back, -turn, j - turn @ j_back


def transition(stiffness, damping, h):
    """Position after a time `h` from position, velocity and constant force: three matrices."""
    n = len(stiffness)
    rate = np.zeros((3 * n, 3 * n))
    rate[:n, n : 2 * n] = rate[n : 2 * n, 2 * n :] = np.eye(n)
    rate[n : 2 * n, :n], rate[n : 2 * n, n : 2 * n] = -stiffness, -damping
    # Scaled to displacements: velocities in units of 1/h, forces in units of 1/h².
    units = np.repeat([1.0, abs(h), h**2], n)
    passed = expm(rate * h * units[:, None] / units) / units[:, None] * units
    return np.split(passed[:n], 3, axis=1)


def before_start(scheme, stiffness, damping, h, q, v, f):
    """Position a step before the start, of motion through `q` with `v` under the constant force `f`."""
    a, b, load = scheme(stiffness, damping, h)
    if scheme is central:
        return np.linalg.solve(np.eye(len(q)) + b, a @ q + load @ f - 2 * h * v)
    e, by_velocity, by_force = transition(stiffness, damping, -h)
    return e @ q + by_velocity @ v + by_force @ f


# The laws of friction.


def has_state(law):
    return isinstance(law, (st.LuGre, st.RateAndState))


def held_up_to(law, was_sticking):
    """Ratio of forces up to which a contact sticks."""
    if isinstance(law, st.Coulomb):
        return law.coefficient
    if isinstance(law, st.StaticKinetic) and not was_sticking:
        return law.kinetic
    return law.static


def curve(law, speed):
    """Ratio of forces in sliding at `speed`."""
    if isinstance(law, st.Coulomb):
        return law.coefficient
    if isinstance(law, st.StaticKinetic):
        return law.kinetic
    if isinstance(law, st.LinearWeakening):
        return max(law.static - law.slope * speed, law.kinetic)
    exponent, viscous = (law.exponent, law.viscous) if isinstance(law, st.Stribeck) else (1.0, 0.0)
    return law.kinetic + (law.static - law.kinetic) * np.exp(-((speed / law.velocity) ** exponent)) + viscous * speed


def state_after(law, state, v, h):
    """Internal state after `h` at the constant slip velocity `v`."""
    speed = abs(v)
    if isinstance(law, st.LuGre):
        limit = (law.kinetic + (law.static - law.kinetic) * np.exp(-((v / law.velocity) ** 2))) / law.stiffness
        if speed * h < 1e-9 * limit:
            return state + (v - speed * state / limit) * h
        return np.sign(v) * limit + (state - np.sign(v) * limit) * np.exp(-speed * h / limit)
    distance = law.slip_distance
    if law.evolution == "aging":
        if speed * h < 1e-9 * distance:
            return state + (1 - speed * state / distance) * h
        return distance / speed + (state - distance / speed) * np.exp(-speed * h / distance)
    if speed == 0:
        return state
    return distance / speed * (speed * state / distance) ** np.exp(-speed * h / distance)


def ratio_with_state(law, state, v):
    """Ratio of forces at slip velocity `v`."""
    if isinstance(law, st.LuGre):
        limit = (law.kinetic + (law.static - law.kinetic) * np.exp(-((v / law.velocity) ** 2))) / law.stiffness
        return law.stiffness * state + law.damping * (v - abs(v) * state / limit) + law.viscous * v
    exponent = (law.reference + law.b * np.log(law.velocity * state / law.slip_distance)) / law.a
    return law.a * np.arcsinh(v / (2 * law.velocity) * np.exp(exponent))


def state_of_new(law):
    if isinstance(law, st.RateAndState):
        return law.slip_distance / law.velocity if law.initial_state is None else law.initial_state
    return 0.0


LAWS = SimpleNamespace(
    curve=curve,
    held_up_to=held_up_to,
    state_after=state_after,
    ratio_with_state=ratio_with_state,
    set_valued=lambda law: not has_state(law),
)


# The contacts of one step.


def states_of(before):
    """Possible states of a contact: `given` is the ratio of its forces, if its motion at the start determines it."""
    if before.given is not None:
        return "open", "given"
    return ("open", "stick", 1, -1, "back") if isinstance(before.law, st.Coulomb) else ("open", "way")


def solved(left, right):
    """Solution of a few equations, as by np.linalg.solve, which takes several times as long for so few."""
    *_, solution, singular = dgesv(left, right)
    if singular:
        raise np.linalg.LinAlgError("Singular matrix")
    return solution


def turned(gap, slip, own, before, let_go):
    """Whether the slip of a contact ends within the step: then (holds, normal, tangential), else None.

    It slides on for a share of the step; for the rest it is held, or slides back. Forces are means over the step.
    """
    if before.status != SLIDING or not isinstance(before.law, st.Coulomb) or before.last_slip == 0 or gap >= 0:
        return None
    ratio = np.sign(before.last_slip) * curve(before.law, 0.0)
    stiff = own[0, 0] - np.array([ratio, -ratio]) * own[0, 1]
    if stiff.min() <= 0:
        return None
    on, back = (-gap / one * np.array([1.0, r]) for one, r in zip(stiff, (ratio, -ratio), strict=True))
    farther = slip + own[1] @ (on * [1, -1])
    if farther * before.last_slip >= 0:
        return None
    share = before.last_slip / (before.last_slip - farther)
    rest = solved(own, [-gap, before.last_slip - slip]) * [1, -1]
    holds = abs(rest[1]) <= held_up_to(before.law, not let_go) * rest[0]
    return holds, *(share * on + (1 - share) * (rest if holds else back))


def solve_contacts(gaps, slips, strayed, w, before, h, guess=None, let_go=()):
    """Return every consistent (combination, list of (status, normal, tangential)) of the contacts.

    `gaps` and `slips` are those without contact forces, which add ``w @ (N1, -T1, N2, ...)``; `strayed` is the distance
    of each stick from its anchor. `before` has the law, last slip, state and last status of each. With a
    `guess` that combination comes first, and the first that is consistent is enough. Contacts that `let_go` are held
    by their kinetic coefficient, and slide where they could also stick.
    """
    states = [states_of(b) for b in before]
    found = []
    for combination in ([] if guess is None else [guess]) + list(product(*states)):
        tried = forces_of(combination, gaps, slips, strayed, w, before, h, let_go)
        if tried is None or not np.all(np.isfinite(tried)):
            continue
        forces = tried
        outcome = []
        for i, kind in enumerate(combination):
            others = forces.copy()
            others[2 * i : 2 * i + 2] = 0.0
            gap, slip = gaps[i] + w[2 * i] @ others, slips[i] + w[2 * i + 1] @ others
            normal, tangential = forces[2 * i], -forces[2 * i + 1]
            own = w[2 * i : 2 * i + 2, 2 * i : 2 * i + 2]
            if (kind == "open") != (gap >= 0):
                break
            if kind == "open":
                outcome.append((SEPARATED, 0.0, 0.0))
                continue
            if kind == "given":
                outcome.append((SLIDING, normal, tangential))
                continue
            if kind == "way":
                if normal <= 0:
                    break
                status = on_its_way(LAWS, before[i], normal, gap, slip, strayed[i], own, h, i in let_go)[3]
                outcome.append((status, normal, tangential))
                continue
            turn = turned(gap, slip, own, before[i], i in let_go)
            if turn or kind == "back":
                if not turn or (kind == "stick") != turn[0] or kind in (1, -1):
                    break
                outcome.append((STICKING if turn[0] else SLIDING, normal, tangential))
                continue
            hold = solved(own, [-gap, -slip - strayed[i]])
            holds = (
                abs(hold[1]) <= held_up_to(before[i].law, before[i].status == STICKING and i not in let_go) * hold[0]
            )
            after = slips[i] + w[2 * i + 1] @ forces
            if kind == "stick" and holds:
                outcome.append((STICKING, normal, tangential))
            elif kind in (1, -1) and (not holds or i in let_go) and kind * (after + strayed[i]) > 0 and normal > 0:
                outcome.append((SLIDING, normal, tangential))
            else:
                break
        if len(outcome) == len(before):
            found.append((combination, outcome))
            if guess is not None:
                break
    return found


def forces_of(combination, gaps, slips, strayed, w, before, h, let_go):
    """Forces (N1, -T1, N2, ...) of a combination of states, or None.

    The ratio of a contact that reverses, or goes its way, depends on the forces of all: it is iterated.
    """
    free = [i for i, kind in enumerate(combination) if kind in ("back", "way")]
    ratios = {i: before[i].tangential / before[i].normal if before[i].normal > 0 else 0.0 for i in free}
    for _ in range(300):
        forces = forces_at(ratios, combination, gaps, slips, strayed, w, before)
        if forces is None or not np.all(np.isfinite(forces)):
            return None
        found = {}
        for i in free:
            others, pair = forces.copy(), slice(2 * i, 2 * i + 2)
            others[pair] = 0.0
            gap, slip = gaps[i] + w[2 * i] @ others, slips[i] + w[2 * i + 1] @ others
            if combination[i] == "way":
                if gap >= 0 or forces[2 * i] <= 0:
                    return None
                own = w[pair, pair]
                found[i] = on_its_way(LAWS, before[i], forces[2 * i], gap, slip, strayed[i], own, h, i in let_go)[0]
                continue
            turn = turned(gap, slip, w[pair, pair], before[i], i in let_go)
            if not turn:
                return None
            found[i] = turn[2] / turn[1]
        if all(abs(found[i] - ratios[i]) <= 1e-15 * max(abs(found[i]), 0.1) for i in free):
            break
        ratios = found
    return forces


def forces_at(ratios, combination, gaps, slips, strayed, w, before):
    """Forces of a combination, with given ratios where they are not those of sliding."""
    left, right = np.eye(len(w)), np.zeros(len(w))
    for i, kind in enumerate(combination):
        if kind == "open":
            continue
        left[2 * i], right[2 * i] = w[2 * i], -gaps[i]
        if kind == "stick":
            left[2 * i + 1], right[2 * i + 1] = w[2 * i + 1], -slips[i] - strayed[i]
            continue
        ratio = before[i].given if kind == "given" else ratios[i] if i in ratios else kind * curve(before[i].law, 0.0)
        left[2 * i + 1] = 0.0
        left[2 * i + 1, 2 * i : 2 * i + 2] = ratio, 1.0
    try:
        return solved(left, right)
    except np.linalg.LinAlgError:
        return np.full(len(w), np.nan)


# The system as matrices.


@dataclass
class Matrices:
    """A system in modal coordinates, body by body in any order."""

    system: st.System
    spans: dict = field(default_factory=dict)

    def __post_init__(self):
        size = 0
        for body in self.system.bodies:
            count = body.modes(self.held(body)).count
            self.spans[body] = slice(size, size + count)
            size += count
        self.size = size
        self.stiffness, self.damping = np.zeros((size, size)), np.zeros((size, size))
        for body, span in self.spans.items():
            modes = body.modes(self.held(body))
            self.stiffness[span, span] = np.diag(modes.angular_frequency**2)
            own = np.diag(2 * modes.damping * modes.angular_frequency)
            self.damping[span, span] = own if modes.damping_matrix is None else modes.damping_matrix
        for joint in self.system.connections:
            axis = {"x": 0, "y": 1}[joint.direction]
            row = self.trace(joint.first)[axis] - (self.trace(joint.second)[axis] if joint.second else 0.0)
            if isinstance(joint, st.Spring):
                self.stiffness += joint.stiffness * np.outer(row, row)
            else:
                self.damping += joint.coefficient * np.outer(row, row)

    def held(self, body):
        return any(isinstance(d, st.ImposedVelocity) and d.point.body == body for d in self.system.drives)

    def spread(self, body, row):
        out = np.zeros((*np.shape(row)[:-1], self.size))
        out[..., self.spans[body]] = row
        return out

    def trace(self, point):
        return self.spread(point.body, point.body.trace(point.position, self.held(point.body)))

    def loads(self, h):
        """Modal force of all drives as a function of time; position and velocity at the start."""
        parts, q, v = [], np.zeros(self.size), np.zeros(self.size)

        def moved(body):
            return self.spread(body, body.modes(self.held(body)).translation)

        for drive in self.system.drives:
            if isinstance(drive, st.Force):
                body = drive.point.body
                along, across = np.array([1.0, 0.0]), np.array([0.0, 1.0])
                if isinstance(body, st.FiniteElementBeam):
                    s, c = np.sin(body.angle), np.cos(body.angle)
                    along, across = np.array([s, c]), np.array([c, -s])
                world = drive.axial * along + drive.transverse * across + np.array([drive.x, drive.y])
                parts.append((world @ self.trace(drive.point), drive.history.factor))
            elif isinstance(drive, st.ImposedVelocity):
                parts.append((-drive.normal_load * self.trace(drive.point)[1], np.ones_like))
                factor = drive.history.factor
                inertia = -drive.velocity * moved(drive.point.body)[0]
                parts.append((inertia, lambda t, f=factor: (f(t + h / 2) - f(t - h / 2)) / h))
            elif isinstance(drive, st.Gravity):
                parts += [(-drive.acceleration * moved(body)[1], np.ones_like) for body in self.spans]
            elif isinstance(drive, st.InitialVelocity):
                v += np.array([drive.x, drive.y]) @ moved(drive.body)
            elif isinstance(drive, st.InitialState):
                for into, values in ((q, drive.displacement), (v, drive.velocity)):
                    if values is not None:
                        into += self.spread(drive.body, drive.body.modal_coordinates(values))

        def force(t):
            return sum((factor(np.array([t]))[0] * row for row, factor in parts), np.zeros(self.size))

        return force, q, v


class Touch:
    """One contact: its rows at an abscissa, its imposed motions, and its state between steps."""

    def __init__(self, contact, matrices):
        self.contact, self.matrices = contact, matrices
        a = contact.inclination
        self.upright, self.tangent = np.array([-np.sin(a), np.cos(a)]), np.array([np.cos(a), np.sin(a)])
        self.tip = matrices.trace(contact.tip)
        frozen = isinstance(contact.track, st.BodyPoint)
        # The other point of a frozen contact, whose rows are the same everywhere.
        self.other = matrices.trace(contact.track) if frozen else np.zeros((2, matrices.size))
        self.along = self.tangent @ (self.tip - self.other)
        self.along_beam = isinstance(contact.track, st.ModalBeam)
        self.along_plate = isinstance(contact.track, st.ModalPlate)
        self.law = contact.friction
        self.status, self.state, self.anchor = SEPARATED, state_of_new(self.law), 0.0
        self.material = self.place = self.place_before = self.last_slip = self.past = 0.0
        self.earlier_slip = self.stuck = self.stuck_now = 0.0
        self.normal = self.tangential = self.closed = self.gap = 0.0
        self.given = None

    def rows(self, x):
        """Rows of gap and of tangential displacement with the track at abscissa `x`, and slopes of the track."""
        track, m = self.contact.track, self.matrices
        against, slopes = self.other.copy(), np.zeros((2, m.size))
        if self.along_beam:
            first, (bending, axial) = m.spans[track].start, track.harmonics
            size = np.sqrt(2 / track.total_mass)
            for side, start, count in ((1, first, bending), (0, first + bending, axial)):
                k = np.pi / track.length * np.arange(1, count + 1)
                against[side, start : start + count] = size * np.sin(k * x)
                slopes[side, start : start + count] = size * k * np.cos(k * x)
        if self.along_plate:
            first, (bending, _) = m.spans[track].start, track.harmonics
            span, flat = slice(first, first + bending), slice(first + bending, m.spans[track].stop)
            line = track.line or st.Line((0.0, track.width / 2))
            along = np.array([np.cos(line.direction), np.sin(line.direction)])
            place = line.origin + x * along
            size = 2 / np.sqrt(track.material.density * track.thickness * track.length * track.width)
            a, b = np.pi * (track.numbers / [track.length, track.width]).T
            against[1, span] = size * np.sin(a * place[0]) * np.sin(b * place[1])
            slopes[1, span] = size * a * along[0] * np.cos(a * place[0]) * np.sin(b * place[1])
            slopes[1, span] += size * b * along[1] * np.sin(a * place[0]) * np.cos(b * place[1])
            a, b = np.pi * (track.in_plane_numbers / [track.length, track.width]).T
            # A mode of a half-wave along one side only has twice the modal mass.
            size = size / np.where(a * b == 0, np.sqrt(2), 1)
            u, v = size * track.polarisations.T * along[:, None]
            sx, cx, sy, cy = np.sin(a * place[0]), np.cos(a * place[0]), np.sin(b * place[1]), np.cos(b * place[1])
            against[0, flat] = u * sx * cy + v * cx * sy
            slopes[0, flat] = along[0] * a * (u * cx * cy - v * sx * sy) + along[1] * b * (v * cx * cy - u * sx * sy)
        return self.upright @ (self.tip - against), self.tangent @ (self.tip - against), slopes

    def motions(self, t):
        """Imposed motions: of the tip and of the track along the tangent, and of the gap."""
        tip, track = np.zeros(2), np.zeros(2)
        t = np.array([t])
        for drive in self.matrices.system.drives:
            if isinstance(drive, st.ImposedVelocity):
                shift = np.array([drive.velocity * drive.history.integral(t)[0], 0.0])
                tip += shift * (self.contact.tip.body == drive.point.body)
                track += shift * (self.contact.track_body == drive.point.body)
        other = self.contact.track
        if isinstance(other, st.RigidTrack):
            track += other.velocity * other.history.integral(t)[0] * self.tangent
            track += other.normal_velocity * other.normal_history.integral(t)[0] * self.upright
        return self.tangent @ tip, self.tangent @ track, self.upright @ (tip - track)

    def abscissa(self, q, tip):
        """Abscissa of the tip, moved by `tip` along the tangent; of a frozen contact, against the other point."""
        return self.contact.at + self.along @ q + tip


def march(system: st.System, scheme, h: float, steps: int) -> SimpleNamespace:
    """March `steps` steps of `h` [s] and return everything; contact columns of shape (steps, contacts)."""
    m = Matrices(system)
    a, b, load = scheme(m.stiffness, m.damping, h)
    force, q, velocity = m.loads(h)
    inverse = np.linalg.inv(load)
    touches = [Touch(contact, m) for contact in system.contacts]

    def kinetic(d):
        return d @ inverse @ (d + b @ d) / 4

    def begin(q_before):
        """Initialise the contacts; return those that are closed."""
        for one in touches:
            x = one.contact.at
            gap_row, slip_row, _ = one.rows(x)
            tip, track, _ = one.motions(0.0)
            tip_before, track_before, _ = one.motions(-h)
            tip_after, track_after, _ = one.motions(h)
            one.material = one.anchor = x + slip_row @ q
            one.last_slip = slip_row @ (q - q_before) + (tip - tip_before) - (track - track_before)
            one.place, one.place_before = one.abscissa(q, tip), one.abscissa(q_before, tip_before)
            speed = slip_row @ velocity + (tip_after - tip_before - track_after + track_before) / (2 * h)
            one.state = state_of_new(one.law)
            one.gap = one.contact.gap + gap_row @ q
            one.status = STICKING if one.gap == 0.0 and speed == 0.0 else SEPARATED
            if one.status == STICKING:
                one.last_slip = 0.0
            one.earlier_slip = 3 * one.last_slip - 2 * h * speed
            one.given = None
            if has_state(one.law):
                one.given = ratio_with_state(
                    one.law, (one.state + state_after(one.law, one.state, speed, h)) / 2, speed
                )
            elif speed != 0.0:
                one.given = np.sign(speed) * curve(one.law, abs(speed))
        return [one for one in touches if one.gap == 0.0]

    def start_under(f, q=q, velocity=velocity):
        return before_start(scheme, m.stiffness, m.damping, h, q, velocity, f)

    q_before = start_under(force(0.0))
    closed = begin(q_before)
    if closed:
        # Forces of closed contacts that act before the start as they do in the first step.
        rows = np.array([row for one in closed for row in one.rows(one.contact.at)[:2]])
        still = np.zeros(m.size)
        answers = np.array([load @ row - b @ start_under(row, still, still) for row in rows])
        first = a @ q - b @ q_before + load @ force(0.0)
        moved = [np.subtract(one.motions(h), one.motions(0.0)) for one in closed]
        there = [one.rows(one.abscissa(first, one.motions(h)[0])) for one in closed]
        gaps = [one.contact.gap + row[0] @ first + move[2] for one, row, move in zip(closed, there, moved, strict=True)]
        slips = [row[1] @ first - rows[2 * i + 1] @ q + moved[i][0] - moved[i][1] for i, row in enumerate(there)]
        _, found = solve_contacts(gaps, slips, [0.0] * len(closed), rows @ answers.T, closed, h)[0]
        pushes = np.array([value for _, normal, tangential in found for value in (normal, -tangential)])
        q_before = start_under(force(0.0) + pushes @ rows)
        begin(q_before)
        for one, (status, one.normal, one.tangential) in zip(closed, found, strict=True):
            one.closed, one.stuck = float(status != SEPARATED), float(status == STICKING)
            one.status = one.status or status
            one.past = one.tangential / one.normal / 2 if one.normal else 0.0
    for one in touches:
        one.given = None

    out = SimpleNamespace(**{name: [] for name in KEPT})
    guess = None
    work = dict.fromkeys(("drive", "contact", "friction", "convection", "damping"), 0.0)
    for n in range(steps):
        now, then = n * h, (n + 1) * h
        f = force(now)
        trial = a @ q - b @ q_before + load @ f
        motions = [one.motions(then) for one in touches]
        traces = [one.rows(one.abscissa(trial, motion[0])) for one, motion in zip(touches, motions, strict=True)]
        rows = np.array([row for trace in traces for row in trace[:2]])
        gaps = [
            one.contact.gap + motion[2] + trace[0] @ trial
            for one, motion, trace in zip(touches, motions, traces, strict=True)
        ]
        slips = [
            one.contact.at + motion[0] - motion[1] + trace[1] @ trial - one.material
            for one, motion, trace in zip(touches, motions, traces, strict=True)
        ]
        strayed = [one.material - one.anchor if one.status == STICKING else 0.0 for one in touches]
        # All combinations are tried at one step in ten, to count the consistent ones.
        compliance = rows @ load @ rows.T
        let_go = ()
        found = solve_contacts(gaps, slips, strayed, compliance, touches, h, guess if n % 10 else None)
        if not found:
            # The response of another foot may bring a sliding foot below its static limit: it still slides.
            feet = range(len(touches))
            for let_go in (subset for size in range(1, len(feet) + 1) for subset in combinations(feet, size)):
                found = solve_contacts(gaps, slips, strayed, compliance, touches, h, None, let_go)
                if found:
                    break
        out.solutions.append(len(found))
        if not found:
            raise RuntimeError(f"no consistent state of the contacts at step {n}")
        guess, found = found[0][0], found[0][1]
        forces = np.array([value for _, normal, tangential in found for value in (normal, -tangential)])
        push = rows.T @ forces
        q_new = trial + load @ push

        middle = (q_new - q_before) / 2
        work["drive"] += f @ middle
        work["contact"] += push @ middle
        landings, shares = [], []
        for i, (one, (status, normal, tangential)) in enumerate(zip(touches, found, strict=True)):
            w = compliance[2 * i : 2 * i + 2, 2 * i : 2 * i + 2]
            gap = gaps[i] + rows[2 * i] @ (q_new - trial)
            if status != SEPARATED and not isinstance(one.law, st.Coulomb):
                free = slips[i] + rows[2 * i + 1] @ (q_new - trial) - w[1] @ [normal, -tangential]
                _, one.past_now, one.state_now, _, one.stuck_now = on_its_way(
                    LAWS, one, normal, gap - w[0] @ [normal, -tangential], free, strayed[i], w, h, i in let_go
                )
            closed = one.closed
            if one.status != SEPARATED and status == SEPARATED:
                missing = gap / (w[0, 0] - one.tangential / one.normal * w[0, 1])
                closed = max(0.0, closed - missing / (one.normal + missing))
            alone = gap - w[0] @ [normal, -tangential]
            held = closed * (one.status == STICKING)
            if not has_state(one.law) and not isinstance(one.law, st.Coulomb):
                held = closed * one.stuck
            elif one.status == STICKING and status == SLIDING and not has_state(one.law):
                slip = slips[i] + rows[2 * i + 1] @ (q_new - trial) - w[1] @ [normal, -tangential] + strayed[i]
                held *= stuck_until(one.normal, one.tangential, alone, slip, w, held_up_to(one.law, True))
            shares.append([1 - closed, held, closed - held])
            one.closed = 0.0 if status == SEPARATED else 1.0 if one.status != SEPARATED else alone / (alone - one.gap)
            one.gap = gap
        out.share.append(shares)
        for one, motion, trace, (status, normal, tangential) in zip(touches, motions, traces, found, strict=True):
            tip, track, lift = np.subtract(motion, one.motions(now - h)) / 2
            frame = tangential * (tip - track) - normal * lift
            work["drive"] += frame
            work["contact"] -= frame
            material = one.contact.at + motion[0] - motion[1] + trace[1] @ q_new
            slip, place = material - one.material, one.abscissa(q_new, motion[0])
            work["friction"] += tangential * slip if has_state(one.law) else abs(tangential * slip)
            slope = (normal * trace[2][1] - tangential * trace[2][0]) @ q_new
            work["convection"] += slope * (place - one.place_before) / 2
            on_way = status != SEPARATED and not isinstance(one.law, st.Coulomb)
            if status == STICKING and on_way and not has_state(one.law):
                one.anchor = one.anchor if one.stuck_now == 1 and one.status == STICKING else material
            elif status == STICKING and one.status != STICKING:
                one.anchor = one.material
            one.past, one.earlier_slip = one.past_now if on_way else 0.0, one.last_slip
            if has_state(one.law):
                one.state = one.state_now if on_way else state_of_new(one.law)
            landings.append(int(one.status == SEPARATED and status != SEPARATED))
            rests = on_way and one.stuck_now == 1
            one.stuck = one.stuck_now if on_way else 0.0
            one.status, one.material, one.last_slip = status, material, 0.0 if rests else slip
            one.normal, one.tangential = normal, tangential
            one.place_before, one.place = one.place, place
        d = q_new - q
        if scheme is central:
            work["damping"] += middle @ m.damping @ middle / h
            stored = (d @ d / h**2 + q_new @ m.stiffness @ q) / 2
        else:
            work["damping"] += middle @ inverse @ (d - b @ (q - q_before)) - kinetic(d) + kinetic(q - q_before)
            stored = kinetic(d) + q_new @ m.stiffness @ q / 2
        out.stored.append(stored)
        for name, value in work.items():
            getattr(out, name).append(value)
        out.normal.append([normal for _, normal, _ in found])
        out.tangential.append([tangential for _, _, tangential in found])
        out.status.append([status for status, _, _ in found])
        out.landings.append(landings)
        out.position.append([one.place for one in touches])
        out.state.append([one.state for one in touches])
        out.gap.append(
            [
                one.contact.gap + motion[2] + trace[0] @ q_new
                for one, motion, trace in zip(touches, motions, traces, strict=True)
            ]
        )
        heights = []
        for one, motion in zip(touches, motions, strict=True):
            heights.append(one.contact.gap + motion[2] + one.upright @ (one.tip - one.other) @ q_new)
        out.height.append(heights)
        q_before, q = q, q_new
    out.last = (q_before, q)
    for name, values in vars(out).items():
        if name != "last":
            setattr(out, name, np.array(values))
    return out
