"""The tables of drives and their histories in a scenario file."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ..drives import Gravity
from ..histories import Harmonic as HarmonicHistory
from . import fields as is_
from .fields import Table


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
    """times, rising; the same twice is a jump [s]"""
    value: list[is_.Ratio]
    """factors at those times"""


History = Annotated[Constant | Ramp | Harmonic | Sampled, Field(discriminator="kind")]


class Force(Table):
    kind: Literal["force"]
    """force, imposed velocity, gravity, initial velocity, initial state or initial equilibrium"""
    body: str = "slider"
    """body it acts on: slider, track or its name"""
    point: is_.Point | None = None
    """where it acts: tip, root, centre, the name of a point or a position [m]; root or centre if left out"""
    axial: is_.Newtons = 0.0
    """component along the body's axis, tip to root: a push towards the track is negative [N]"""
    transverse: is_.Newtons = 0.0
    """component along (cos angle, -sin angle) [N]"""
    x: is_.Newtons = 0.0
    """component along world x [N]"""
    y: is_.Newtons = 0.0
    """component along world y, from the track towards the slider [N]"""
    history: History | None = None
    """factor over time, constant if left out"""


class ImposedVelocity(Table):
    kind: Literal["imposed velocity"]
    """force, imposed velocity, gravity, initial velocity, initial state or initial equilibrium"""
    body: str = "slider"
    """beam whose root moves: slider or its name"""
    velocity: is_.Velocity
    """velocity of the slider's root along the track [m/s]"""
    normal_load: is_.Newtons = 0.0
    """force on the root towards the track [N]"""
    history: History | None = None
    """factor on the velocity over time, constant if left out"""


class Weight(Table):
    kind: Literal["gravity"]
    """force, imposed velocity, gravity, initial velocity, initial state or initial equilibrium"""
    acceleration: is_.Acceleration = Gravity.acceleration
    """acceleration of free fall [m/s²]"""


class InitialVelocity(Table):
    kind: Literal["initial velocity"]
    """force, imposed velocity, gravity, initial velocity, initial state or initial equilibrium"""
    body: str = "slider"
    """body that moves at the start: slider, track or its name"""
    x: is_.Velocity = 0.0
    """velocity along world x [m/s]"""
    y: is_.Velocity = 0.0
    """velocity along world y [m/s]"""


class InitialState(Table):
    kind: Literal["initial state"]
    """force, imposed velocity, gravity, initial velocity, initial state or initial equilibrium"""
    body: str = "slider"
    """point mass or reduced body that starts so: slider, track or its name"""
    displacement: is_.Vector | None = None
    """displacement of every degree of freedom at the start, zero if left out [m]"""
    velocity: is_.Vector | None = None
    """velocity of every degree of freedom at the start, zero if left out [m/s]"""


class InitialEquilibrium(Table):
    kind: Literal["initial equilibrium"]
    """force, imposed velocity, gravity, initial velocity, initial state or initial equilibrium"""
    status: is_.Statuses | None = None
    """separated, sticking or sliding, one for all contacts or a list with one for each; all slide if left out"""
    velocity: is_.Velocities | None = None
    """slip velocity where nothing prescribes it, one for all contacts or a list with one for each [m/s]"""
    mode: is_.Mode | None = None
    """mode of vibration on top: its number from 0 on, by rising frequency, or most unstable; none if left out"""
    amplitude: is_.Distance = 0.0
    """largest displacement of a contact point in that mode [m]"""
    phase: is_.Angle = 0.0
    """phase of that displacement at the start [rad]"""


Drive = Annotated[
    Force | ImposedVelocity | Weight | InitialVelocity | InitialState | InitialEquilibrium,
    Field(discriminator="kind"),
]
