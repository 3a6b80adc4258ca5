"""The tables of drives and their histories in a scenario file."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ..drives import Gravity
from ..histories import Harmonic as HarmonicHistory
from . import fields as is_
from .fields import BodyName, Table


class Constant(Table):
    kind: Literal["constant"]
    """constant, ramp, harmonic or sampled"""


class Ramp(Table):
    kind: Literal["ramp"]
    """constant, ramp, harmonic or sampled"""
    duration: is_.Time
    """length of the straight rise from zero [s]"""


class Harmonic(Table):
    kind: Literal["harmonic"]
    """constant, ramp, harmonic or sampled"""
    frequency: is_.Frequency
    """frequency of the sine [Hz]"""
    amplitude: is_.Ratio = HarmonicHistory.amplitude
    """amplitude of the sine, as a factor"""
    mean: is_.Ratio = HarmonicHistory.mean
    """mean about which it swings, as a factor"""
    phase: is_.Angle = HarmonicHistory.phase
    """phase at the start [rad]"""


class Sampled(Table):
    kind: Literal["sampled"]
    """constant, ramp, harmonic or sampled"""
    time: list[is_.Instant]
    """times, rising [s]"""
    value: list[is_.Ratio]
    """factors at those times"""


History = Annotated[Constant | Ramp | Harmonic | Sampled, Field(discriminator="kind")]


class Force(Table):
    kind: Literal["force"]
    """force, imposed velocity, gravity or initial velocity"""
    body: BodyName = "slider"
    """body it acts on: slider or track"""
    point: is_.Point = "root"
    """where it acts: tip, root, centre or a position [m]"""
    axial: is_.Newtons = 0.0
    """component along the body's axis, tip to root: a push towards the track is negative [N]"""
    transverse: is_.Newtons = 0.0
    """component along (cos angle, -sin angle) [N]"""
    x: is_.Newtons = 0.0
    """component along the track [N]"""
    y: is_.Newtons = 0.0
    """component along the track's normal, towards the slider [N]"""
    history: History | None = None
    """factor over time, constant if left out"""


class ImposedVelocity(Table):
    kind: Literal["imposed velocity"]
    """force, imposed velocity, gravity or initial velocity"""
    velocity: is_.Velocity
    """velocity of the slider's root along the track [m/s]"""
    normal_load: is_.Newtons = 0.0
    """force on the root towards the track [N]"""
    history: History | None = None
    """factor on the velocity over time, constant if left out"""


class Weight(Table):
    kind: Literal["gravity"]
    """force, imposed velocity, gravity or initial velocity"""
    acceleration: is_.Acceleration = Gravity.acceleration
    """acceleration of free fall [m/s²]"""


class InitialVelocity(Table):
    kind: Literal["initial velocity"]
    """force, imposed velocity, gravity or initial velocity"""
    body: BodyName = "slider"
    """body that moves at the start: slider or track"""
    x: is_.Velocity = 0.0
    """velocity along the track [m/s]"""
    y: is_.Velocity = 0.0
    """velocity along the track's normal [m/s]"""


Drive = Annotated[Force | ImposedVelocity | Weight | InitialVelocity, Field(discriminator="kind")]
