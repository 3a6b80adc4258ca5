"""All friction laws, in the order of messages and the schema."""

from __future__ import annotations

from .coulomb import Coulomb, StaticKinetic
from .friction_law import FrictionLaw
from .lugre import LuGre
from .rate_and_state import RateAndState
from .weakening import ExponentialWeakening, LinearWeakening, Stribeck

LAWS: tuple[type[FrictionLaw], ...] = (
    Coulomb,
    StaticKinetic,
    Stribeck,
    ExponentialWeakening,
    LinearWeakening,
    LuGre,
    RateAndState,
)
