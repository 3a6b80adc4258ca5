"""The laws of friction, each as its equation."""

from __future__ import annotations

import numpy as np

import stridula as st
from stridula.contact.elastic import ElasticFriction


def has_state(law):
    return isinstance(law, (st.LuGre, st.RateAndState, ElasticFriction))


def held_up_to(law, was_sticking):
    """Ratio of forces up to which a contact sticks."""
    if isinstance(law, st.Coulomb):
        return law.coefficient
    if isinstance(law, st.StaticKinetic) and not was_sticking:
        return law.kinetic
    if isinstance(law, st.TabulatedFriction):
        return law.holding if was_sticking else curve(law, 0.0)
    return law.static


def curve(law, speed):
    """Ratio of forces in sliding at `speed`."""
    if isinstance(law, st.Coulomb):
        return law.coefficient
    if isinstance(law, st.StaticKinetic):
        return law.kinetic
    if isinstance(law, st.TabulatedFriction):
        return float(law.coefficient_at(max(speed, 1e-300)))
    if isinstance(law, st.LinearWeakening):
        return max(law.static - law.slope * speed, law.kinetic)
    exponent, viscous = (law.exponent, law.viscous) if isinstance(law, st.Stribeck) else (1.0, 0.0)
    return law.kinetic + (law.static - law.kinetic) * np.exp(-((speed / law.velocity) ** exponent)) + viscous * speed


def size(v):
    """Of a velocity along one tangent or two."""
    return abs(v) if np.ndim(v) == 0 else np.linalg.norm(v)


def limit(law, speed):
    """Ratio of forces in steady sliding under LuGre's law, without its viscous part."""
    return law.kinetic + (law.static - law.kinetic) * np.exp(-((speed / law.velocity) ** 2))


def cut(ratio, most):
    """A ratio along one tangent or two, or one of the size `most` along it."""
    return ratio if size(ratio) <= most else most * ratio / size(ratio)


def rate_of_joint(law, state, v, h):
    """Mean rate over `h` of the deflection of a joint, implicit: the slip velocity unless its friction slips."""
    k, c = law.stiffness / law.normal_force, law.damping / law.normal_force
    ratio = cut(k * (state + v * h) + c * v, curve(law.friction, size(v)))
    return (ratio - k * state) / (k * h + c)


def state_between(law, state, v, stage, h):
    """Internal state after `h`, from the beginning of a stage that lasts `stage`, at the slip velocity at its end."""
    if isinstance(law, ElasticFriction):
        return state + h * rate_of_joint(law, state, v, stage)
    return state_after(law, state, v, h)


def state_after(law, state, v, h):
    """Internal state after `h` at the constant slip velocity `v`."""
    speed = size(v)
    if isinstance(law, ElasticFriction):
        return state + h * rate_of_joint(law, state, v, h)
    if isinstance(law, st.LuGre):
        # A relaxation of the bristles, to the direction of the slip.
        rate = law.stiffness * speed / limit(law, speed)
        if rate * h < 1e-9:
            return state + (v - rate * state) * h
        return v / rate + (state - v / rate) * np.exp(-rate * h)
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
    if isinstance(law, ElasticFriction):
        return cut((law.stiffness * state + law.damping * v) / law.normal_force, curve(law.friction, size(v)))
    if isinstance(law, st.LuGre):
        rate = v - law.stiffness * size(v) / limit(law, size(v)) * state
        return law.stiffness * state + law.damping * rate + law.viscous * v
    exponent = (law.reference + law.b * np.log(law.velocity * state / law.slip_distance)) / law.a
    return law.a * np.arcsinh(v / (2 * law.velocity) * np.exp(exponent))


def counts_as_sticking(law, state, v):
    """Whether a contact under a law with a state counts as sticking after a step with the slip velocity `v`."""
    if isinstance(law, ElasticFriction):
        felt = size(law.stiffness * state + law.damping * v) / law.normal_force
        return felt < (1 - 1e-9) * curve(law.friction, size(v))
    return size(v) < law.velocity


def state_of_new(law):
    """Internal state of a contact that closes."""
    if isinstance(law, st.RateAndState):
        return law.slip_distance / law.velocity if law.initial_state is None else law.initial_state
    return 0.0
