"""A mass of two degrees of freedom that flutters on a belt at 1 kHz (Hoffmann, Fischer, Allgaier & Gaul 2002)."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np

import stridula as st

HERTZ, DAMPING = 1000.0, 0.02
FIRST, SECOND, BELOW = 2 * (2 - sqrt(3)) / 3, 2 * (2 + sqrt(3)) / 3, 4 / 3
SCALE = (2 * pi * HERTZ) ** 2 / 2.0


def grounded() -> np.ndarray:
    """Stiffness of the springs at 150 and 30 degrees, shape (2, 2)."""
    ways = [(k, np.array([np.cos(a), np.sin(a)])) for k, a in ((FIRST, 5 * pi / 6), (SECOND, pi / 6))]
    return SCALE * sum(k * np.outer(way, way) for k, way in ways)


def exponents(friction: float) -> np.ndarray:
    """Exponents of sliding [1/s], written from the equations: the contact spring presses, the belt drags to -x."""
    stiffness = grounded() + SCALE * BELOW * np.array([[0.0, -friction], [0.0, 1.0]])
    one, zero = np.eye(2), np.zeros((2, 2))
    return np.linalg.eigvals(np.block([[zero, one], [-stiffness, -4.0 * pi * HERTZ * DAMPING * one]]))


def flutter(friction: float, speed: float = 1.0, stops: float = 0.0, load: float = 100.0) -> st.System:
    """The mass behind a contact spring on a belt, which may stop at a time [s]."""
    if load < 0.0:
        raise ValueError("it is pressed")
    stiffness = np.zeros((3, 3))
    stiffness[:2, :2] = grounded()
    stiffness[1:, 1:] += SCALE * BELOW * np.array([[1.0, -1.0], [-1.0, 1.0]])
    damping = 4.0 * pi * HERTZ * DAMPING * np.diag([1.0, 1.0, 0.0])
    points = {"foot": (0, 2), "mass": (0, 1)}
    body = st.ReducedBody(np.diag([1.0, 1.0, 0.01]), stiffness, points, damping=damping, name="mass")
    history = st.Sampled((stops, stops + 1e-3), (1.0, 0.0)) if stops else st.Constant()
    belt = st.RigidTrack(velocity=-speed, history=history)
    contact = st.PointContact(body.at("foot"), belt, friction=st.Coulomb(friction))
    return st.System(contact, [st.Force(body.at("mass"), y=-load), st.InitialState(body, velocity=(1e-3, 0.0, 0.0))])
