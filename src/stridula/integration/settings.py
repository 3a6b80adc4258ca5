"""Settings of a run: one value, whose fields are arguments of `simulate` and keys of scenarios."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, TypedDict, TypeVar

from ..checks import ArgumentError, instance, positive
from ..declared import Frequency, Time, declared
from ..lowering.schemes import CentralDifference, ExactModal, Scheme
from ..records import Probe
from .contact_solve import GaussSeidel
from .surface_records import ALL_POINTS

# Numbers that a run rounds to whole steps and samples; they are checked with the system.
SAMPLING = ("step", "sample_rate", "motion_rate")
# Entry in docstrings that the entries of all settings replace.
ENTRY = "**settings\n    Settings of the run."
EXACT = ExactModal()
BY_NAME = inspect.Parameter.KEYWORD_ONLY
Taking = TypeVar("Taking", bound=Callable[..., Any])


class Given(TypedDict, total=False):
    """The same settings as keyword arguments, for type checkers."""

    scheme: Scheme | None
    step: float | None
    sample_rate: float
    probes: Sequence[Probe] | None
    contact_solve: GaussSeidel | None
    surface_rate: float | str | None
    motion_rate: float | None


@dataclass(frozen=True)
class Settings:
    """Settings of a run.

    Parameters
    ----------
    scheme : CentralDifference or ExactModal, optional
        Time scheme; the exact modal one if left out.
    step : float, optional
        Time step [s], by default from the modes kept and from lumped masses on springs and contacts; reduced to a whole
        division of the sample interval, and for several systems the shortest of theirs. A run that continues a record
        has its step.
    sample_rate : float, optional
        Samples per second to record [Hz]; with a step given, the nearest rate at which a sample is a whole number
        of steps.
    probes : sequence of probes, optional
        Further quantities to record: Displacement, Velocity, Acceleration, Reaction, SupportForce, ConnectionForce,
        ModalDisplacement, ModalVelocity or ModalMotion; the acceleration of the track's centre along y if left out and
        the track is a beam.
    contact_solve : GaussSeidel, optional
        Settings of the simultaneous solution of several contacts; a single contact is solved exactly.
    surface_rate : float or str, optional
        Rate of maps of surfaces [Hz], with no other record of their points; the nearest rate at which an interval is a
        whole number of samples. If left out, maps at 1 kHz, and the variables of points that sound and regimes need,
        for surfaces with known areas. With ``"all"``, and by default in plain records, every point is a contact of the
        record.
    motion_rate : float, optional
        Rate at which the motion of bodies is recorded, from which `radiate` computes their sound [Hz]; the nearest rate
        at which an interval is a whole number of samples. At least ``1 / duration``, as the run is rounded to whole
        intervals. The motion of all bodies, unless `probes` have a ModalMotion.
        If left out, only such probes, at the sample rate.
    """

    scheme: Scheme = EXACT
    step: Time | None = None
    sample_rate: Frequency = 100e3
    probes: Sequence[Probe] | None = None
    contact_solve: GaussSeidel | None = None
    surface_rate: float | str | None = None
    motion_rate: Frequency | None = None

    def __post_init__(self) -> None:
        if self.scheme is None:
            object.__setattr__(self, "scheme", EXACT)

    @property
    def solve(self) -> GaussSeidel:
        """Solution of several contacts."""
        return GaussSeidel() if self.contact_solve is None else self.contact_solve

    @property
    def of_run(self) -> dict[str, Any]:
        """All settings by name, as arguments of `simulate`."""
        return {name: getattr(self, name) for name in NAMES}

    @property
    def others(self) -> dict[str, Any]:
        """Declared numbers other than those of the sampling, by name, where they are not the default ones."""
        return {
            field.name: getattr(self, field.name)
            for field in declared(Settings)
            if field.name not in SAMPLING and getattr(self, field.name) != field.default
        }

    def check(self) -> None:
        """Raise ArgumentError at the first setting that no system allows."""
        _check_rate(self.surface_rate)
        if self.motion_rate is not None:
            positive("motion_rate", self.motion_rate)
        for field in declared(Settings):
            value = getattr(self, field.name)
            if field.name not in SAMPLING and not (value is None and field.is_optional):
                field.kind.check(field.name, value)
        instance("scheme", self.scheme, (CentralDifference, ExactModal))
        if self.probes is not None and not isinstance(self.probes, Sequence):
            raise ArgumentError("probes", "be a list of probes", self.probes)
        instance("contact_solve", self.solve, GaussSeidel)


NAMES = tuple(field.name for field in fields(Settings))


def settings_of(function: str, given: Mapping[str, Any]) -> Settings:
    """Return the keyword arguments of a function as settings; TypeError if one is not a setting."""
    unknown = next((name for name in given if name not in NAMES), None)
    if unknown is not None:
        raise TypeError(f"{function}() got an unexpected keyword argument {unknown!r}")
    return Settings(**given)


def shows_settings(taking: Taking) -> Taking:
    """Show the settings in the docstring of a class that has them, or of a function and in its signature."""
    _, _, entries = (inspect.getdoc(Settings) or "").partition("Parameters\n----------\n")
    taking.__doc__ = (inspect.getdoc(taking) or "").replace(ENTRY, entries)
    if inspect.isfunction(taking):
        signature, types = inspect.signature(taking), Given.__annotations__
        own = [one for one in signature.parameters.values() if one.kind is not inspect.Parameter.VAR_KEYWORD]
        each = [
            inspect.Parameter(one.name, BY_NAME, default=one.default, annotation=types[one.name].__forward_arg__)
            for one in fields(Settings)
        ]
        shown = sorted([*each, *own], key=lambda one: one.kind)
        taking.__signature__ = signature.replace(parameters=shown)  # type: ignore[attr-defined]
    return taking


def _check_rate(surface_rate: float | str | None) -> None:
    """Raise ArgumentError unless a value is a rate of maps of surfaces, ``"all"`` or None."""
    if isinstance(surface_rate, str):
        if surface_rate != ALL_POINTS:
            raise ArgumentError("surface_rate", f"be a rate in Hz or {ALL_POINTS!r}", surface_rate)
    elif surface_rate is not None:
        positive("surface_rate", surface_rate)
