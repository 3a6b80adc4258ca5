"""Contacts between bodies: friction laws, rigid tracks, point and surface contacts."""

from .along_track import FrictionAlongTrack
from .around_track import FrictionAroundTrack
from .coulomb import Coulomb, StaticKinetic
from .fits import FrictionFit, fit_friction
from .friction_law import FrictionLaw
from .heating import HEATINGS, HeatedLayers, Heating, TemperatureHistory
from .laws import LAWS
from .lugre import LuGre
from .over_temperature import FrictionOverTemperature
from .point_contact import PointContact
from .profile import Profile
from .random_fields import FrictionField, random_field
from .rate_and_state import RateAndState
from .rigid_track import RigidTrack
from .run_out import RunOut
from .stiffness import STIFFNESSES, ContactStiffness, HertzStiffness, LinearStiffness, PowerStiffness
from .surface_contact import SurfaceContact
from .surface_points import SurfacePoints
from .tabulated import TabulatedFriction
from .weakening import ExponentialWeakening, LinearWeakening, Stribeck

__all__ = [
    "HEATINGS",
    "LAWS",
    "STIFFNESSES",
    "ContactStiffness",
    "Coulomb",
    "ExponentialWeakening",
    "FrictionAlongTrack",
    "FrictionAroundTrack",
    "FrictionField",
    "FrictionFit",
    "FrictionLaw",
    "FrictionOverTemperature",
    "HeatedLayers",
    "Heating",
    "HertzStiffness",
    "LinearStiffness",
    "LinearWeakening",
    "LuGre",
    "PointContact",
    "PowerStiffness",
    "Profile",
    "RateAndState",
    "RigidTrack",
    "RunOut",
    "StaticKinetic",
    "Stribeck",
    "SurfaceContact",
    "SurfacePoints",
    "TabulatedFriction",
    "TemperatureHistory",
    "fit_friction",
    "random_field",
]
