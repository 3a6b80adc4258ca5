"""All bodies of a system as one matrix equation of their modes, and how these move on by a step (steps 1 and 6)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.integrate import simpson
from scipy.linalg import expm

import stridula as st


class Recurrence(NamedTuple):
    """The motion in two positions, ``q[n+1] = a q[n] - b q[n-1] + load f[n]``."""

    a: np.ndarray
    b: np.ndarray
    load: np.ndarray


def central(stiffness, damping, h):
    """The recurrence of ``q'' + D q' + K q = f`` with centred differences."""
    one = np.eye(len(stiffness))
    left = np.linalg.inv(one / h**2 + damping / (2 * h))
    return Recurrence(left @ (2 * one / h**2 - stiffness), left @ (one / h**2 - damping / (2 * h)), left)


def exact(stiffness, damping, h):
    """The recurrence of exact motion: a step forwards and one backwards share the velocity in the middle."""
    e, f, j = transition(stiffness, damping, h)
    e_back, f_back, j_back = transition(stiffness, damping, -h)
    turn = np.linalg.solve(f_back.T, f.T).T
    return Recurrence(e - turn @ e_back, -turn, j - turn @ j_back)


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
    if scheme is central:
        a, b, load = central(stiffness, damping, h)
        return np.linalg.solve(np.eye(len(q)) + b, a @ q + load @ f - 2 * h * v)
    e, by_velocity, by_force = transition(stiffness, damping, -h)
    return e @ q + by_velocity @ v + by_force @ f


def beyond(spring):
    """Pull of a nonlinear spring over its stretch, beyond that of its stiffness at the start."""
    if isinstance(spring, st.CubicSpring):
        return lambda s: spring.cubic * s**3
    x, f = np.array(spring.displacement), np.array(spring.force)
    # Two points far outside go on along the first and the last line.
    far = 1e3 * np.ptp(x)
    x = np.array([x[0] - far, *x, x[-1] + far])
    f = np.array([f[0] - far * (f[1] - f[0]) / (x[2] - x[1]), *f, f[-1] + far * (f[-1] - f[-2]) / (x[-2] - x[-3])])
    return lambda s: np.interp(s, x, f) - spring.rates[0] * s


def past_linear(dashpot):
    """Pull of a dashpot by a table over its velocity, beyond that of its smallest slope."""
    v, f = np.array(dashpot.velocity), np.array(dashpot.force)
    slopes = np.diff(f) / np.diff(v)

    def pull(velocity):
        line = np.clip(np.sum(velocity >= v) - 1, 0, slopes.size - 1)
        return f[line] + slopes[line] * (velocity - v[line]) - max(slopes.min(), 0.0) * velocity

    return pull


def fine(s):
    """Places from zero to a stretch."""
    return np.linspace(0.0, s, 20001)


class Bodies:
    """A system in modal coordinates, body by body in the order of the system."""

    def __init__(self, system):
        self.system, self.spans, self.size = system, {}, 0
        for body in system.bodies:
            count = self.modes(body).count
            self.spans[body] = slice(self.size, self.size + count)
            self.size += count
        self.stiffness, self.damping = np.zeros((2, self.size, self.size))
        for body, span in self.spans.items():
            modes = self.modes(body)
            self.stiffness[span, span] = np.diag(modes.angular_frequency**2)
            own = np.diag(2 * modes.damping * modes.angular_frequency)
            self.damping[span, span] = own if modes.damping_matrix is None else modes.damping_matrix
        self.bent, self.braked = [], []
        for joint in system.connections:
            axis = {"x": 0, "y": 1}[joint.direction]
            row = self.trace(joint.first)[axis] - (self.trace(joint.second)[axis] if joint.second else 0.0)
            if isinstance(joint, (st.CubicSpring, st.TabulatedSpring)):
                self.stiffness += joint.rates[0] * np.outer(row, row)
                self.bent.append((row, beyond(joint)))
            elif isinstance(joint, st.TabulatedDashpot):
                self.damping += joint.rates[1] * np.outer(row, row)
                self.braked.append((row, past_linear(joint)))
            elif isinstance(joint, st.Spring):
                self.stiffness += joint.stiffness * np.outer(row, row)
            else:
                self.damping += joint.coefficient * np.outer(row, row)

    def pulls(self, q, velocity):
        """Modal forces of nonlinear springs and dashpots beyond their linear parts."""
        moved = [(row, pull(row @ q)) for row, pull in self.bent]
        moved += [(row, pull(row @ velocity)) for row, pull in self.braked]
        return sum((-pulled * row for row, pulled in moved), np.zeros(self.size))

    def losses(self, velocity, way):
        """Energy that dashpots take on a way, without the work of their force at rest."""
        return sum((pull(row @ velocity) - pull(0.0)) * (row @ way) for row, pull in self.braked)

    def stored(self, q):
        """Energy of these forces, by Simpson's rule on short pieces."""
        bent = sum(simpson([pull(s) for s in way], x=way) for row, pull in self.bent for way in [fine(row @ q)])
        return bent + sum(pull(0.0) * (row @ q) for row, pull in self.braked)

    def held(self, body):
        return any(isinstance(d, st.ImposedVelocity) and d.point.body == body for d in self.system.drives)

    def modes(self, body):
        return body.modes(self.held(body))

    def spread(self, body, row):
        """The row of a body over the modes of all."""
        out = np.zeros((*np.shape(row)[:-1], self.size))
        out[..., self.spans[body]] = row
        return out

    def trace(self, point):
        """Displacement of a point along x and y."""
        return self.spread(point.body, point.body.trace(point.position, self.held(point.body)))

    def translation(self, body):
        return self.spread(body, self.modes(body).translation)

    def drives(self, h):
        """Modal force of all drives as a function of time."""
        parts = [part for drive in self.system.drives for part in self.forces_of(drive, h)]
        return lambda t: sum((factor(np.array([t]))[0] * row for row, factor in parts), np.zeros(self.size))

    def forces_of(self, drive, h):
        """Modal forces of a drive, each with its factor as a function of time."""
        if isinstance(drive, st.Force):
            along, across = np.eye(2)
            if isinstance(drive.point.body, st.FiniteElementBeam):
                s, c = np.sin(drive.point.body.angle), np.cos(drive.point.body.angle)
                along, across = np.array([s, c]), np.array([c, -s])
            world = drive.axial * along + drive.transverse * across + np.array([drive.x, drive.y])
            return [(world @ self.trace(drive.point), drive.history.factor)]
        if isinstance(drive, st.ImposedVelocity):
            factor = drive.history.factor
            inertia = -drive.velocity * self.translation(drive.point.body)[0]
            return [
                (-drive.normal_load * self.trace(drive.point)[1], np.ones_like),
                # The impulses of the inertia force add up to the change of velocity.
                (inertia, lambda t: (factor(t + h / 2) - factor(t - h / 2)) / h),
            ]
        if isinstance(drive, st.Gravity):
            return [(-drive.acceleration * self.translation(body)[1], np.ones_like) for body in self.spans]
        return []

    def start(self):
        """Position and velocity at the start."""
        q, v = np.zeros((2, self.size))
        for drive in self.system.drives:
            if isinstance(drive, st.InitialVelocity):
                v += np.array([drive.x, drive.y]) @ self.translation(drive.body)
            elif isinstance(drive, st.InitialState):
                for into, values in ((q, drive.displacement), (v, drive.velocity)):
                    if values is not None:
                        into += self.spread(drive.body, drive.body.modal_coordinates(values))
        return q, v
