"""All friction laws, in the order of messages and the schema."""

from __future__ import annotations

from ..checks import instance
from .along_track import FrictionAlongTrack
from .around_track import FrictionAroundTrack
from .coulomb import Coulomb, StaticKinetic
from .friction_law import FrictionLaw
from .lugre import LuGre
from .over_temperature import FrictionOverTemperature
from .rate_and_state import RateAndState
from .tabulated import TabulatedFriction
from .weakening import ExponentialWeakening, LinearWeakening, Stribeck

LAWS: tuple[type[FrictionLaw], ...] = (
    Coulomb,
    StaticKinetic,
    Stribeck,
    ExponentialWeakening,
    LinearWeakening,
    LuGre,
    RateAndState,
    TabulatedFriction,
    FrictionOverTemperature,
    FrictionAlongTrack,
    FrictionAroundTrack,
)


def check_friction(name: str, value: object) -> None:
    """Raise ValueError unless an argument is a law of friction, of this package or of a user."""
    if not isinstance(value, FrictionLaw):
        instance(name, value, LAWS)
