"""Bodies, contact and drives as one system, checked for consistency."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .bodies import FiniteElementBeam, ModalBeam
from .checks import instance
from .contact import PointContact
from .drives import Drive, Force, Gravity, ImposedVelocity, InitialVelocity


@dataclass(frozen=True)
class System:
    """A slider in contact with a track, and what drives them.

    Parameters
    ----------
    contact : PointContact
        Where they touch; names the slider (the tip's body) and the track.
    drives : sequence of Force, ImposedVelocity, Gravity or InitialVelocity, optional
        What pushes.

    Raises
    ------
    ValueError
        If a drive acts on a body that is not in contact, if more than one velocity is imposed, or if the slider is
        supported so that its root cannot follow an imposed velocity.
    """

    contact: PointContact
    drives: Sequence[Drive] = ()

    def __post_init__(self) -> None:
        instance("contact", self.contact, PointContact)
        if isinstance(self.drives, (str, bytes)) or not isinstance(self.drives, Sequence):
            raise ValueError(f"drives must be a list of drives, got {self.drives!r}")
        object.__setattr__(self, "drives", tuple(self.drives))
        for number, drive in enumerate(self.drives):
            instance(f"drives[{number}]", drive, (Force, ImposedVelocity, Gravity, InitialVelocity))
            self._check_body(f"drives[{number}]", drive)
        if len(self._imposed()) > 1:
            raise ValueError(f"drives must hold at most one ImposedVelocity, got {len(self._imposed())}")
        if self.imposed_velocity and self.slider.root_support not in ("guided", "free"):
            raise ValueError(
                "root_support must be guided or free under an imposed velocity, so that the root can move, "
                f"got {self.slider.root_support!r}"
            )
        if self.imposed_velocity and self.slider.tip_support != "free":
            raise ValueError(f"tip_support must be free under an imposed velocity, got {self.slider.tip_support!r}")

    @property
    def slider(self) -> FiniteElementBeam:
        """The body whose tip touches."""
        return self.contact.tip.body  # type: ignore[return-value]

    @property
    def track(self) -> ModalBeam:
        """The body it slides on."""
        return self.contact.track

    @property
    def imposed_velocity(self) -> ImposedVelocity | None:
        """The imposed velocity, if there is one."""
        return next(iter(self._imposed()), None)

    def _imposed(self) -> list[ImposedVelocity]:
        return [drive for drive in self.drives if isinstance(drive, ImposedVelocity)]

    def _check_body(self, name: str, drive: Drive) -> None:
        body = getattr(drive, "body", None) or getattr(getattr(drive, "point", None), "body", None)
        if body is not None and body not in (self.slider, self.track):
            raise ValueError(f"{name} must act on the slider or the track of this system, got a point of {body!r}")
        if isinstance(drive, InitialVelocity) and body == self.slider and drive.x and self._imposed():
            raise ValueError(
                f"{name}.x must be 0 under an imposed velocity, which already moves the slider, got {drive.x!r}"
            )

    def __str__(self) -> str:
        return "\n".join(
            [_beam("slider", self.slider), _beam("track", self.track), self._contact_line(), *self._pushes()]
        )

    def _contact_line(self) -> str:
        contact = self.contact
        return (
            f"contact  at {contact.at:.4g} m of {self.track.length:.4g} m, gap {contact.gap:.3g} m, "
            f"friction {contact.friction.coefficient:.4g}"
        )

    def _pushes(self) -> list[str]:
        return [f"drive    {_drive_words(drive)}" for drive in self.drives]


def _beam(name: str, beam: FiniteElementBeam | ModalBeam) -> str:
    frequency = beam.modes().frequency
    lean = f", leaning {math.degrees(beam.angle):.4g} deg" if isinstance(beam, FiniteElementBeam) else ""
    return (
        f"{name:<8} {beam.length:.4g} m, {beam.total_mass:.4g} kg{lean}, damping {beam.damping:.3g}, "
        f"{frequency.size} modes to {frequency.max():.4g} Hz"
    )


def _drive_words(drive: Drive) -> str:
    if isinstance(drive, Gravity):
        return f"gravity {drive.acceleration:.4g} m/s² along -y"
    if isinstance(drive, InitialVelocity):
        return f"initial velocity ({drive.x:.3g}, {drive.y:.3g}) m/s"
    kind = type(drive.history).__name__.lower()
    if isinstance(drive, ImposedVelocity):
        return f"imposed velocity {drive.velocity:.4g} m/s along x under {drive.normal_load:.4g} N, {kind}"
    parts = [
        f"{name} {getattr(drive, name):.4g} N" for name in ("axial", "transverse", "x", "y") if getattr(drive, name)
    ]
    return f"force {', '.join(parts) or '0 N'} at {drive.point.position:.4g} m, {kind}"
