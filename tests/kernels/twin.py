"""A slow twin of the march, written from the equations of the model in their two-position form.

For every mode ``q[n+1] = a q[n] - b q[n-1] + l f[n]`` with the modal force ``f[n]`` of drives and contact, sines by
np.sin, the contact by trying each of its states in turn, and everything kept in lists.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

import stridula as st


def central(w, z, h):
    """Coefficients a, b, l of ``q'' + 2 z w q' + w² q = f`` with centred differences."""
    return (2 - w**2 * h**2) / (1 + z * w * h), (1 - z * w * h) / (1 + z * w * h), h**2 / (1 + z * w * h)


def exact(w, z, h):
    """Coefficients a, b, l of exact free motion; a unit constant force moves the rest point to 1/w² exactly."""
    wd = w * np.sqrt(1 - z**2)
    rigid = w == 0
    a = 2 * np.exp(-z * w * h) * np.cos(wd * h)
    b = np.exp(-2 * z * w * h)
    return a, b, np.where(rigid, h**2, (1 - a + b) / np.where(rigid, 1, w**2))


def position_before(scheme, w, z, h, velocity, force, b, load):
    """q[-1] of a motion that starts at 0 with `velocity` under a constant `force`."""
    if scheme is central:
        # Two equations: q[1] = -b q[-1] + l f and (q[1] - q[-1]) / 2h = v.
        return (load * force - 2 * h * velocity) / (1 + b)
    before = np.empty_like(w)
    for k in range(w.size):
        if w[k] == 0:
            before[k] = -velocity[k] * h + force[k] * h**2 / 2
            continue
        # The two complex roots of the motion about its rest point, evaluated at t = -h.
        rest = force[k] / w[k] ** 2
        root = complex(-z[k] * w[k], w[k] * np.sqrt(1 - z[k] ** 2))
        share = (velocity[k] + rest * root.conjugate()) / (root - root.conjugate())
        before[k] = rest + 2 * (share * np.exp(-root * h)).real
    return before


def contact_states(gap, slip, w, mu, last_slip=0.0):
    """Return every consistent (status, normal force, tangential force), each state tried on its own.

    `w` is the compliance, shape (2, 2); the relative displacement (along y, along x) grows by ``w @ (N, -T)``. A
    contact that slid by `last_slip` in the step before may come to rest within this one. Then it slid on for a share
    of the step, and for the rest it sticks or slides back: forces are those of both parts, by their shares.
    """
    if last_slip and gap < 0:
        sense = np.sign(last_slip)
        on, farther = slide(gap, slip, w, sense * mu)
        back, _ = slide(gap, slip, w, -sense * mu)
        if on[0] > 0 and back[0] > 0 and farther * sense < 0:
            share = last_slip / (last_slip - farther)
            normal, minus_tangential = np.linalg.solve(w, [-gap, last_slip - slip])
            holds = abs(minus_tangential) <= mu * normal
            rest = np.array([normal, -minus_tangential]) if holds else back
            return [(1 if holds else 2, *(share * on + (1 - share) * rest))]
    found = []
    if gap >= 0:
        found.append((0, 0.0, 0.0))
    normal, minus_tangential = np.linalg.solve(w, [-gap, -slip])
    if gap < 0 and normal >= 0 and abs(minus_tangential) <= mu * normal:
        found.append((1, normal, -minus_tangential))
    for sense in (1, -1):
        if gap >= 0:
            continue
        forces, slip_after = slide(gap, slip, w, sense * mu)
        if forces[0] > 0 and sense * slip_after > 0:
            found.append((2, *forces))
    return found


def slide(gap, slip, w, ratio):
    """Forces of a contact that slides with a ratio of the forces, no normal force if it jams, and the slip after."""
    stiff = w[0, 0] - ratio * w[0, 1]
    forces = -gap / stiff * np.array([1.0, ratio]) if stiff > 0 else np.zeros(2)
    return forces, slip + w[1] @ (forces * [1, -1])


@dataclass
class Trail:
    """Results of the twin, a list entry for each step, and its last two positions."""

    normal: list = field(default_factory=list)
    tangential: list = field(default_factory=list)
    status: list = field(default_factory=list)
    landings: list = field(default_factory=list)
    share: list = field(default_factory=list)
    position: list = field(default_factory=list)
    height: list = field(default_factory=list)
    gap: list = field(default_factory=list)
    stored: list = field(default_factory=list)
    drive: list = field(default_factory=list)
    contact: list = field(default_factory=list)
    friction: list = field(default_factory=list)
    convection: list = field(default_factory=list)
    damping: list = field(default_factory=list)
    consistent_states: list = field(default_factory=list)
    last: tuple = ()


def drives_of(system, slider, track, held, h):
    """Return the modal force of all drives as a function of time, and the initial modal velocity."""
    rod, bar = system.slider, system.track
    parts, velocity = [], np.zeros(slider.count + track.count)
    for drive in system.drives:
        if isinstance(drive, st.Force):
            a = rod.angle if drive.point.body == rod else np.pi / 2
            along = np.array([np.sin(a), np.cos(a)]) * drive.axial
            across = np.array([np.cos(a), -np.sin(a)]) * drive.transverse
            if drive.point.body == bar:
                across = -across  # A track's transverse direction is +y, not (cos a, -sin a) at 90 degrees.
            world = along + across + np.array([drive.x, drive.y])
            on_rod = drive.point.body == rod
            row = np.concatenate(
                [
                    world @ rod.trace(drive.point.position, held) if on_rod else np.zeros(slider.count),
                    np.zeros(track.count) if on_rod else world @ bar.trace(drive.point.position),
                ]
            )
            parts.append((row, drive.history.factor))
        elif isinstance(drive, st.ImposedVelocity):
            row = np.concatenate([-drive.normal_load * rod.trace(rod.length, held)[1], np.zeros(track.count)])
            parts.append((row, np.ones_like))
            inertia = np.concatenate([-drive.velocity * slider.translation[0], np.zeros(track.count)])
            # The impulses of the inertia force add up to the change of velocity.
            factor = drive.history.factor
            parts.append((inertia, lambda t, factor=factor: (factor(t + h / 2) - factor(t - h / 2)) / h))
        elif isinstance(drive, st.Gravity):
            row = -drive.acceleration * np.concatenate([slider.translation[1], track.translation[1]])
            parts.append((row, np.ones_like))
        elif isinstance(drive, st.InitialVelocity):
            body = np.array([drive.x, drive.y]) @ (slider if drive.body == rod else track).translation
            velocity += np.concatenate(
                [body, np.zeros(track.count)] if drive.body == rod else [np.zeros(slider.count), body]
            )

    def force(t):
        return sum((factor(np.array([t]))[0] * row for row, factor in parts), np.zeros(velocity.size))

    return force, velocity


def closed_until(closed, status, normal, tangential, gap, w):
    """Share of the previous step in which a contact of that `status` was closed, until its force changed sign."""
    if status == 0 or gap < 0:
        return closed
    missing = gap / (w[0, 0] - tangential / normal * w[0, 1])
    return max(0.0, closed - missing / (normal + missing))


def stuck_until(normal, tangential, gap, slip, w, mu):
    """Share of the previous step in which a contact that slides now still stuck, until its force left the cone."""
    pressed, needed = np.linalg.solve(w, [-gap, -slip]) * [1, -1]
    sense = np.sign(needed)
    margins = [mu * n - sense * t for n, t in ((normal, tangential), (pressed, needed))]
    return margins[0] / (margins[0] - margins[1]) if margins[1] < 0 else 1.0


def march(system: st.System, scheme, h: float, steps: int) -> Trail:
    """March `steps` steps of `h` [s] and return everything."""
    rod, bar, mu = system.slider, system.track, system.contact.friction.coefficient
    driven = system.imposed_velocity
    held = driven is not None
    slider, track = rod.modes(held), bar.modes()
    w = np.concatenate([slider.angular_frequency, track.angular_frequency])
    z = np.concatenate([slider.damping, track.damping])
    bending, axial = bar.harmonics
    tip = np.hstack([rod.trace(0.0, held), np.zeros((2, track.count))])
    a, b, load = scheme(w, z, h)
    force, velocity = drives_of(system, slider, track, held, h)

    def track_rows(x):
        """Rows of u2 and w2 at abscissa x, and of their slopes."""
        rows, slopes = np.zeros((2, w.size)), np.zeros((2, w.size))
        size = np.sqrt(2 / (bar.material.density * bar.section.area * bar.length))
        for k in range(1, bending + 1):
            kk = k * np.pi / bar.length
            rows[1, slider.count + k - 1] = size * np.sin(kk * x)
            slopes[1, slider.count + k - 1] = size * kk * np.cos(kk * x)
        for k in range(1, axial + 1):
            kk = k * np.pi / bar.length
            rows[0, slider.count + bending + k - 1] = size * np.sin(kk * x)
            slopes[0, slider.count + bending + k - 1] = size * kk * np.cos(kk * x)
        return rows, slopes

    def imposed(t):
        return driven.velocity * driven.history.integral(np.array([t]))[0] if driven else 0.0

    out = Trail()
    q = np.zeros(w.size)
    q_before = position_before(scheme, w, z, h, velocity, force(0.0), b, load)
    material, anchor, status = system.contact.at, None, 0
    x = system.contact.at
    x_before = x + tip[0] @ q_before - (imposed(h) - imposed(0.0))
    drive = contact = friction = convection = damping = 0.0
    last_slip = last_normal = last_tangential = closed = 0.0
    gap_before = system.contact.gap
    for n in range(steps):
        driving = force(n * h)
        trial = a * q - b * q_before + load * driving
        x_trial = system.contact.at + imposed((n + 1) * h) + tip[0] @ trial
        rows, slopes = track_rows(x_trial)
        gap_row, slip_row = tip[1] - rows[1], tip[0] - rows[0]
        gap = system.contact.gap + gap_row @ trial
        material_trial = system.contact.at + imposed((n + 1) * h) + slip_row @ trial
        target = anchor if status == 1 else material
        compliance = np.array(
            [
                [np.sum(gap_row * load * gap_row), np.sum(gap_row * load * slip_row)],
                [np.sum(slip_row * load * gap_row), np.sum(slip_row * load * slip_row)],
            ]
        )
        states = contact_states(gap, material_trial - target, compliance, mu, last_slip if status == 2 else 0.0)
        closed = closed_until(closed, status, last_normal, last_tangential, gap, compliance)
        was, (status, normal, tangential) = status, states[0]
        held = closed * (was == 1)
        if was == 1 and status == 2:
            held *= stuck_until(last_normal, last_tangential, gap, material_trial - target, compliance, mu)
        out.share.append([1 - closed, held, closed - held])
        closed = 0.0 if status == 0 else 1.0 if was else gap / (gap - gap_before)
        if status == 1 and was != 1:
            anchor = material
        push = gap_row * normal - slip_row * tangential
        q_new = trial + load * push

        material_new = system.contact.at + imposed((n + 1) * h) + slip_row @ q_new
        x_new = system.contact.at + imposed((n + 1) * h) + tip[0] @ q_new
        middle = (q_new - q_before) / 2
        frame = tangential * (imposed((n + 1) * h) - imposed((n - 1) * h)) / 2
        drive += driving @ middle + frame
        contact += push @ middle - frame
        friction += abs(tangential * (material_new - material))
        convection += (normal * slopes[1] - tangential * slopes[0]) @ q_new * (x_new - x_before) / 2
        if scheme is central:
            damping += np.sum(2 * z * w * middle**2) / h
            stored = np.sum((q_new - q) ** 2 / h**2 + w**2 * q_new * q) / 2
        else:
            damping += np.sum((1 - b) * middle**2 / load)
            stored = np.sum(((1 + b) / 2 * (q_new - q) ** 2 + (1 - a + b) * q_new * q) / (2 * load))

        out.normal.append(normal)
        out.tangential.append(tangential)
        out.status.append(status)
        out.landings.append(int(was == 0 and status != 0))
        out.position.append(x_new)
        out.height.append(system.contact.gap + tip[1] @ q_new)
        out.gap.append(system.contact.gap + gap_row @ q_new)
        out.stored.append(stored)
        out.drive.append(drive)
        out.contact.append(contact)
        out.friction.append(friction)
        out.convection.append(convection)
        out.damping.append(damping)
        out.consistent_states.append(len(states))
        last_slip, last_normal, last_tangential = material_new - material, normal, tangential
        gap_before = out.gap[-1]
        x_before, x, material = x, x_new, material_new
        q_before, q = q, q_new
    out.last = (q_before, q)
    return out
