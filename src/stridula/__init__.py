"""Friction noise in the time domain: elastic bodies in exact contact that squeal, squeak or judder."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .extras import named_extras, on_first_use
from .version import __version__

_HOME = {
    "bodies": (
        "AxisymmetricBody",
        "BodyPoint",
        "Circle",
        "CircularPath",
        "FiniteElementBeam",
        "Held",
        "Line",
        "LineProfile",
        "Material",
        "MatrixFace",
        "MeshPart",
        "MeshProfile",
        "ModalBeam",
        "ModalBody",
        "ModalPlate",
        "Modes",
        "PointMass",
        "Rayleigh",
        "Rectangle",
        "RectangleProfile",
        "ReducedBody",
        "RigidBody",
        "RisingDamping",
        "SampledDamping",
        "Section",
        "SolidBody",
        "SolidMesh",
        "read_parts",
    ),
    "contact": (
        "Coulomb",
        "ExponentialWeakening",
        "FrictionFit",
        "FrictionLaw",
        "FrictionAlongTrack",
        "FrictionOverTemperature",
        "HeatedLayers",
        "HertzStiffness",
        "LinearStiffness",
        "LinearWeakening",
        "LuGre",
        "PointContact",
        "PowerStiffness",
        "Profile",
        "RateAndState",
        "RigidTrack",
        "StaticKinetic",
        "Stribeck",
        "SurfaceContact",
        "TabulatedFriction",
        "TemperatureHistory",
        "fit_friction",
        "random_field",
    ),
    "checks": ("ArgumentError",),
    "connections": ("Bushing", "CubicSpring", "Dashpot", "RigidJoint", "Spring", "TabulatedSpring"),
    "doubtful": ("DoubtfulValue",),
    "drives": ("Force", "Gravity", "ImposedVelocity", "InitialEquilibrium", "InitialState", "InitialVelocity"),
    "histories": ("Constant", "Harmonic", "Ramp", "Sampled"),
    "signals": ("read_signal", "read_signals", "write_signal"),
    "system": ("System",),
    "records": (
        "Acceleration",
        "Displacement",
        "ModalDisplacement",
        "ModalMotion",
        "ModalVelocity",
        "Reaction",
        "SupportForce",
        "Velocity",
    ),
    "records.files": ("load", "save"),
    "records.export": ("export",),
    "records.plain": ("PlainRecord",),
    "records.compare": ("compare",),
    "records.repeated": ("repeat_cycle",),
    "scenarios": ("Scenario", "ScenarioError", "list_scenarios", "load_scenario", "scenario_schema", "scenario_text"),
    "integration": (
        "CentralDifference",
        "Diverged",
        "ExactModal",
        "GaussSeidel",
        "Interrupted",
        "Progress",
        "simulate",
        "simulate_many",
    ),
    "acoustics.levels": ("equivalent_level", "harmonic_levels", "sound_level", "third_octave_levels"),
    "acoustics.sensation": ("loudness", "loudness_over_time", "roughness", "sharpness"),
    "acoustics.squeals": ("squeal_events",),
    "acoustics.listening": ("PlayableSound", "listen"),
    "acoustics.wav": ("SoundFile", "read_wav", "write_wav"),
    "analysis.mobilities": ("mobility",),
    "analysis.mode_effects": ("what_helps",),
    "analysis.stability": ("sliding_stability",),
    "analysis": ("regime", "worn"),
    "analysis.record_card": ("RecordCard", "card"),
    "bars": ("show_progress",),
    "cycles": ("NoCycle", "limit_cycle", "lyapunov_exponent"),
    "acoustics": ("Air", "Bridge", "radiate", "radiation_damping", "radiation_efficiency"),
    "reports": ("Report", "report"),
    "studies": (
        "CalibrationProgress",
        "Grid",
        "LatinHypercube",
        "RandomPoints",
        "Range",
        "StepCheck",
        "SweepProgress",
        "Target",
        "agreement",
        "basin",
        "calibrate",
        "check_step",
        "critical_value",
        "ensemble",
        "follow_cycle",
        "mode_probability",
        "mode_sensitivity",
        "mode_surrogate",
        "modify",
        "orbit_diagram",
        "regime_probability",
        "root_loci",
        "sensitivity",
        "squeal_survey",
        "sweep",
    ),
}
_MODULE = {name: module for module, names in _HOME.items() for name in names}
# Modules that are public themselves.
_PUBLIC = (
    "acoustics",
    "analysis",
    "bodies",
    "connections",
    "contact",
    "cycles",
    "drives",
    "histories",
    "integration",
    "papers",
    "plot",
    "records",
    "reports",
    "scenarios",
    "studies",
    "verification",
)
__all__ = ["__version__", *_MODULE]


def __getattr__(name: str) -> Any:
    """Import a public module, or a public name from its module, on first use, so that `import stridula` is fast."""
    if name in _PUBLIC:
        with named_extras():
            return import_module(f".{name}", __name__)
    return on_first_use(__name__, _MODULE, name)


def __dir__() -> list[str]:
    return sorted((*__all__, *_PUBLIC))
