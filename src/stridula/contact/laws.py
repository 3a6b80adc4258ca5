"""The laws of friction that there are, in the order in which messages and the schema list them."""

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
