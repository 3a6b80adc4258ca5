"""One contact: its traces at an abscissa, motions imposed on it, and what it carries from step to step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

import stridula as st

from .heat import Heat
from .laws import ElasticFriction, curve, has_state, ratio_with_state, state_after, state_of_new
from .way import SEPARATED, SLIDING, STICKING, Before, Free


class Traces(NamedTuple):
    """Rows of gap and slip over all modes, and slopes of the track, along it and normal to it."""

    gap: np.ndarray
    slip: np.ndarray
    slopes: np.ndarray


class Imposed(NamedTuple):
    """Imposed motions: of the tip and of the track along the tangent, and of the gap [m]."""

    tip: float
    track: float
    lift: float


class Contact:
    """One contact. Its traces, and the motions imposed on it, are those of the step."""

    def __init__(self, contact, bodies):
        self.contact, self.bodies = contact, bodies
        a = contact.inclination
        self.upright, self.tangent = np.array([-np.sin(a), np.cos(a)]), np.array([np.cos(a), np.sin(a)])
        # A frozen contact has its other point at any abscissa.
        frozen = isinstance(contact.track, st.BodyPoint)
        self.other = bodies.trace(contact.track) if frozen else np.zeros((2, bodies.size))
        self.apart = bodies.trace(contact.tip) - self.other
        self.surface, self.pushed = surface_of(contact.track), 0.0
        self.heat = Heat(contact)
        self.above = contact.gap + self.surface(contact.at)

    # Steps 2 and 3.

    def freeze(self, trial, t):
        """Take traces and imposed motions at the end of the step for all of it."""
        self.imposed = self.imposed_at(t)
        self.traces = self.traces_at(self.place(trial))
        # The forces are expected to advance it as in the last step.
        self.tried = self.material(trial)
        self.rise = self.surface(self.contact.at + self.tried + self.pushed)

    def traces_at(self, x):
        track, moved, slopes = self.contact.track, self.other.copy(), np.zeros((2, self.bodies.size))
        if isinstance(track, (st.ModalBeam, st.ModalPlate)):
            shapes_of = beam_shapes if isinstance(track, st.ModalBeam) else plate_shapes
            span, bending = self.bodies.spans[track], track.harmonics[0]
            bent, along = slice(span.start, span.start + bending), slice(span.start + bending, span.stop)
            (moved[1, bent], slopes[1, bent]), (moved[0, along], slopes[0, along]) = shapes_of(track, x)
        against = self.apart + self.other - moved
        return Traces(self.upright @ against, self.tangent @ against, slopes)

    def imposed_at(self, t):
        tip, track, other, t = np.zeros(2), np.zeros(2), self.contact.track, np.array([t])
        for drive in self.bodies.system.drives:
            if isinstance(drive, st.ImposedVelocity):
                shift = np.array([drive.velocity * drive.history.integral(t)[0], 0.0])
                tip += shift * (self.contact.tip.body == drive.point.body)
                track += shift * (self.contact.track_body == drive.point.body)
        if isinstance(other, st.RigidTrack):
            track += other.velocity * other.history.integral(t)[0] * self.tangent
            track += other.normal_velocity * other.normal_history.integral(t)[0] * self.upright
        return Imposed(self.tangent @ tip, self.tangent @ track, self.upright @ (tip - track))

    def place(self, q):
        """Abscissa of the tip; of a frozen contact, against the other point."""
        return self.contact.at + self.imposed.tip + self.tangent @ self.apart @ q

    def height(self, q):
        return self.above + self.imposed.lift + self.upright @ self.apart @ q

    def gap(self, q):
        return self.above + self.imposed.lift + self.traces.gap @ q - self.rise

    def material(self, q):
        """Place of the tip in the material of the track, from the initial one."""
        return self.imposed.tip - self.imposed.track + self.traces.slip @ q

    def slip(self, touch, q):
        """Slip in the step; none in a stick under Coulomb's law, whose round-off would add up in the ledger."""
        stays = touch.status == STICKING and touch.way is None
        return 0.0 if stays else self.material(q) - self.last_material

    def free(self, trial, w):
        """Its trial gap and slip."""
        slip, strayed = self.material(trial) - self.last_material, self.last_material - self.anchor
        return Free(self.gap(trial), slip, strayed, w)

    # Between the steps.

    def begin(self, q, q_before, velocity, h):
        """Start from the motion of the bodies; it is closed if its gap is zero."""
        earlier, later = self.imposed_at(-h), self.imposed_at(h)
        self.imposed = earlier
        self.place_before, self.traces = self.place(q_before), self.traces_at(self.contact.at)
        self.rise_before = self.surface(self.contact.at + self.material(q_before))
        self.imposed = self.imposed_at(0.0)
        self.rise = self.last_rise = self.surface(self.contact.at + self.material(q))
        self.last_place, self.last_gap = self.place(q), self.gap(q)
        self.last_material = self.anchor = self.material(q)
        slip = self.traces.slip @ (q - q_before) + self.imposed.tip - earlier.tip - (self.imposed.track - earlier.track)
        speed = self.traces.slip @ velocity + (later.tip - earlier.tip - later.track + earlier.track) / (2 * h)
        self.closed = self.stuck = 0.0
        law = self.contact.law
        self.before = now = Before(law, state=state_of_new(law))
        if self.last_gap == 0.0 and speed == 0.0:
            now.status, slip = STICKING, 0.0
        now.slip, now.earlier_slip = slip, 3 * slip - 2 * h * speed
        if has_state(law):
            # A joint begins without deflection, and without force.
            is_joint = isinstance(law, ElasticFriction)
            later = 0 if is_joint else state_after(law, now.state, speed, h)
            now.given = 0.0 if is_joint else ratio_with_state(law, (now.state + later) / 2, speed)
        elif speed != 0.0:
            now.given = np.sign(speed) * curve(law, abs(speed))

    def press(self, touch, pushed):
        """Have the forces of `touch` before the start, which advance it in a step."""
        self.pushed = pushed
        self.closed, self.stuck = float(touch.status != SEPARATED), float(touch.status == STICKING)
        self.before.status = self.before.status or touch.status
        self.before.normal, self.before.tangential = touch.normal, touch.tangential
        self.before.past = touch.tangential / touch.normal / 2 if touch.normal else 0.0

    def shares(self, touch, alone):
        """Shares of the last step in each status, which the forces of this step reveal."""
        before, closed = self.before, self.closed
        if before.status != SEPARATED and touch.status == SEPARATED:
            # Until its force changed sign.
            missing = alone.gap / (alone.w[0, 0] - before.tangential / before.normal * alone.w[0, 1])
            closed = max(0.0, closed - missing / (before.normal + missing))
        held = closed * (before.status == STICKING)
        if not has_state(before.law) and not isinstance(before.law, st.Coulomb):
            held = closed * self.stuck
        elif before.status == STICKING and touch.status == SLIDING and isinstance(before.law, st.Coulomb):
            held *= self.stuck_until(alone)
        return [1 - closed, held, closed - held]

    def stuck_until(self, alone):
        """Share of the last step in which a contact that slides now still stuck, until its force left the cone."""
        pressed, needed = np.linalg.solve(alone.w, [-alone.gap, -alone.slip - alone.strayed]) * [1, -1]
        sense, mu = np.sign(needed), self.before.law.coefficient
        last, now = mu * self.before.normal - sense * self.before.tangential, mu * pressed - sense * needed
        return last / (last - now) if now < 0 else 1.0

    def keep(self, touch, alone, q):
        """Carry a step on to the next."""
        last, way, slip = self.before, touch.way, self.slip(touch, q)
        was_open = last.status == SEPARATED
        self.closed = 0.0 if touch.status == SEPARATED else alone.gap / (alone.gap - self.last_gap) if was_open else 1.0
        self.stuck = way.stuck if way else 0.0
        self.last_gap, self.last_material = self.gap(q), self.last_material + slip
        self.place_before, self.last_place = self.last_place, self.place(q)
        self.rise_before, self.last_rise = self.last_rise, self.rise
        self.pushed = self.material(q) - self.tried
        if self.stuck < 1 or last.status != STICKING:
            self.anchor = self.last_material
        self.before = Before(
            last.law,
            status=touch.status,
            slip=0.0 if self.stuck == 1 else slip,
            earlier_slip=last.slip,
            state=way.state if way else state_of_new(last.law),
            normal=touch.normal,
            tangential=touch.tangential,
            past=way.past if way else 0.0,
        )


def surface_of(track):
    """Height of the surface of a track over the place along its material."""
    profile = track.profile if isinstance(track, st.RigidTrack) else None
    if profile is None:
        return lambda place: 0.0
    first, last = profile.place[0], profile.place[-1]
    if profile.periodic:
        wave = CubicSpline(profile.place, profile.height, bc_type="periodic")
        return lambda place: float(wave(first + (place - first) % (last - first)))
    bend = CubicSpline(profile.place, profile.height, bc_type=((1, 0.0), (1, 0.0)))
    return lambda place: float(bend(min(max(place, first), last)))


# Shapes of tracks: displacement and slope along the path, normal to the track and along it.


def beam_shapes(beam, x):
    size = np.sqrt(2 / beam.total_mass)
    waves = [np.pi / beam.length * np.arange(1, count + 1) for count in beam.harmonics]
    return [(size * np.sin(k * x), size * k * np.cos(k * x)) for k in waves]


def plate_shapes(plate, x):
    line = plate.line or st.Line((0.0, plate.width / 2))
    along = np.array([np.cos(line.direction), np.sin(line.direction)])
    place, sides = line.origin + x * along, np.array([plate.length, plate.width])
    size = 2 / np.sqrt(plate.material.density * plate.thickness * plate.length * plate.width)

    a, b = k = np.pi * (plate.numbers / sides).T
    (sx, sy), (cx, cy) = np.sin(k * place[:, None]), np.cos(k * place[:, None])
    bending = size * sx * sy, size * (along[0] * a * cx * sy + along[1] * b * sx * cy)

    a, b = k = np.pi * (plate.in_plane_numbers / sides).T
    (sx, sy), (cx, cy) = np.sin(k * place[:, None]), np.cos(k * place[:, None])
    # A mode of a half-wave along one side only has twice the modal mass.
    u, v = size / np.where(a * b == 0, np.sqrt(2), 1) * plate.polarisations.T * along[:, None]
    slope = along[0] * a * (u * cx * cy - v * sx * sy) + along[1] * b * (v * cx * cy - u * sx * sy)
    return bending, (u * sx * cy + v * cx * sy, slope)
