"""Systems that the tests share: the steel pair of the model page, driven in every way."""

from __future__ import annotations

from math import cos, pi, radians, sin

import stridula as st

STEEL = st.Material(young=2.1e11, density=7800.0)
STRIP = st.Rectangle(0.020, 0.004)

# For tests of the march alone: few modes, so that a step of 5 us is far below both limits.
CUTOFF = 15e3
STEP = 5e-6
SCHEMES = [st.CentralDifference(), st.ExactModal()]
SCHEME_NAMES = ["central", "exact"]


def slider(angle: float = 45.0, **changes) -> st.FiniteElementBeam:
    """A steel strip of 0.5 m at `angle` [deg], modes below 15 kHz."""
    words = {"length": 0.5, "elements": 10, "damping": 0.02, "cutoff": CUTOFF} | changes
    return st.FiniteElementBeam(STEEL, STRIP, angle=radians(angle), **words)


def track(**changes) -> st.ModalBeam:
    """A steel strip of 0.8 m, modes below 15 kHz."""
    words = {"length": 0.8, "damping": 0.02, "cutoff": CUTOFF} | changes
    return st.ModalBeam(STEEL, STRIP, **words)


def pair(drives, mu: float, angle: float = 45.0, at: float = 0.2, gap: float = 1e-6, rod=None, bar=None) -> st.System:
    """The slider on the track; `drives` is a function of the slider that lists the drives."""
    rod = rod or slider(angle)
    bar = bar or track()
    contact = st.PointContact(rod.tip, bar, at=at, friction=st.Coulomb(mu), gap=gap)
    return st.System(contact, drives(rod))


def transverse(newtons: float = 0.5, **words):
    """A force across the slider at its root."""
    return lambda rod: [st.Force(rod.root, transverse=newtons, **words)]


def axial(newtons: float = -0.5, **words):
    """A force along the slider at its root; towards the track when negative."""
    return lambda rod: [st.Force(rod.root, axial=newtons, **words)]


def dragged(velocity: float = 0.01, load: float = 2.0, **words):
    """The root moves along x at `velocity` under `load`."""
    return lambda rod: [st.ImposedVelocity(rod.root, velocity, normal_load=load, **words)]


def shaken(rod):
    """A steady push and a harmonic one away from the modes, on a slider thrown at the track, with its weight."""
    return [
        st.Force(rod.root, transverse=0.5),
        st.Force(rod.at(0.3), y=-0.4, history=st.Harmonic(137.0, mean=0.2, phase=0.3)),
        st.InitialVelocity(rod, x=0.02, y=-0.01),
        st.Gravity(),
    ]


# Every regime and every kind of drive: name -> function that makes the system.
CASES = {
    "stable": lambda: pair(transverse(0.2), mu=0.5),
    "squeal": lambda: pair(transverse(), mu=1.5),
    "judder": lambda: pair(axial(), mu=1.1, at=0.6),
    "dragged digging in": lambda: pair(dragged(), mu=1.2, angle=-45.0),
    "dragged hard": lambda: pair(dragged(load=50.0), mu=1.2, angle=-45.0),
    "dragged on a ramp": lambda: pair(dragged(velocity=0.02, history=st.Ramp(0.013)), mu=0.8, angle=-30.0),
    "dragged to and fro": lambda: pair(dragged(velocity=0.02, history=st.Harmonic(80.0, mean=0.5)), mu=0.8),
    "shaken, thrown and heavy": lambda: pair(shaken, mu=0.7, angle=30.0),
    "forced track": lambda: pair(
        lambda rod: [st.Force(rod.root, y=-1.0), st.Force(track().at(0.3), y=3.0, history=st.Harmonic(95.0))], mu=0.3
    ),
}


def every_step(system: st.System, steps: int, scheme=None, **words):
    """Simulate `steps` steps of 5 us and record each."""
    return st.simulate(system, steps * STEP, scheme=scheme, step=STEP, sample_rate=1.0 / STEP, **words)


def world_of_transverse(newtons: float, angle: float) -> tuple[float, float]:
    """World components of a transverse force on a slider at `angle` [deg]: ``(cos a, -sin a)``."""
    return newtons * cos(angle * pi / 180.0), -newtons * sin(angle * pi / 180.0)
