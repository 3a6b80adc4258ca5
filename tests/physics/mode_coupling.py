"""A mass of two degrees of freedom that flutters on a belt at 1 kHz (Hoffmann, Fischer, Allgaier & Gaul 2002)."""

from __future__ import annotations

from math import pi

import stridula as st
from stridula.verification.systems.mode_coupling import hoffmann

HERTZ, DAMPING = 1000.0, 0.02
MODEL = hoffmann(scale=(2 * pi * HERTZ) ** 2 / 2.0, damping=4.0 * pi * HERTZ * DAMPING, foot=0.01)


def flutter(friction: float, speed: float = 1.0, stops: float = 0.0, load: float = 100.0) -> st.System:
    """The mass behind a contact spring on a belt, which may stop at a time [s]."""
    if load < 0.0:
        raise ValueError("it is pressed")
    body = MODEL.body()
    history = st.Sampled((stops, stops + 1e-3), (1.0, 0.0)) if stops else st.Constant()
    belt = st.RigidTrack(velocity=-speed, history=history)
    contact = st.PointContact(body.at("floor"), belt, friction=st.Coulomb(friction))
    return st.System(contact, [st.Force(body.at("mass"), y=-load), st.InitialState(body, velocity=(1e-3, 0.0, 0.0))])
