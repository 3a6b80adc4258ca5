"""Checked tables become a system: the dataclasses of the Python API."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from .. import histories
from ..bodies import BodyPoint, Circle, FiniteElementBeam, Material, ModalBeam, Rectangle, Section
from ..contact import Coulomb, PointContact
from ..drives import Drive, Force, Gravity, ImposedVelocity, InitialVelocity
from ..records import Acceleration, Displacement, Probe, Reaction, Velocity
from ..system import System
from .errors import ScenarioError

SECTIONS: dict[str, Callable[..., Any]] = {"rectangle": Rectangle, "circle": Circle, "general": Section}
HISTORIES: dict[str, Callable[..., Any]] = {
    "constant": histories.Constant,
    "ramp": histories.Ramp,
    "harmonic": histories.Harmonic,
    "sampled": histories.Sampled,
}
MOTIONS = {"displacement": Displacement, "velocity": Velocity, "acceleration": Acceleration}
Tables = dict[str, Any]
_ARGUMENT = re.compile(r"([a-z_]\w*(?:[.\[]\w+\]?)*) (must|and) ")


class Builder:
    """Builds a system and its probes from tables, and gathers every problem on the way.

    Parameters
    ----------
    tables : dict
        A checked scenario.
    words : callable
        Turns a path into the key as it was written.
    """

    def __init__(self, tables: Tables, words: Callable[[tuple[str | int, ...]], str]) -> None:
        self.tables, self.words = tables, words
        self.problems: list[str] = []

    def system(self) -> System:
        """Return the system."""
        slider = self._body("slider", FiniteElementBeam)
        track = self._body("track", ModalBeam)
        self._stop_at_problems()
        contact = self._contact(slider, track)
        drives = [self._drive(number, table, slider, track) for number, table in enumerate(self.tables["drives"])]
        self._stop_at_problems()
        with self._within():
            system = System(contact, drives)
        self._stop_at_problems()
        with self._within("slider"):
            slider.modes(system.imposed_velocity is not None)
        self._stop_at_problems()
        return system

    def probes(self, system: System) -> tuple[Probe, ...] | None:
        """Return the probes, None for the default ones."""
        declared = self.tables["simulation"].get("probes")
        if declared is None:
            return None
        probes = [self._probe(number, table, system) for number, table in enumerate(declared)]
        self._stop_at_problems()
        return tuple(probes)

    def _body(self, name: str, kind: Callable[..., Any]) -> Any:
        table = dict(self.tables[name])
        section = dict(table.pop("section"))
        with self._within(name, "section"):
            shape = SECTIONS[section.pop("shape")](**section)
        with self._within(name, "material"):
            material = Material(**table.pop("material"))
        with self._within(name):
            return kind(material, shape, **table)

    def _contact(self, slider: FiniteElementBeam, track: ModalBeam) -> Any:
        table = dict(self.tables["contact"])
        friction = Coulomb(table.pop("friction")["coefficient"])
        tip = self._point(("contact", "point"), slider, table.pop("point", "tip"))
        with self._within("contact"):
            return PointContact(tip, track, friction=friction, **table)

    def _drive(self, number: int, table: Tables, slider: FiniteElementBeam, track: ModalBeam) -> Any:
        path = ("drives", number)
        table = dict(table)
        kind = table.pop("kind")
        body: Any = {"slider": slider, "track": track}[table.pop("body", "slider")]
        if "history" in table:
            table["history"] = self._history((*path, "history"), table["history"])
        makers: dict[str, Callable[[], Drive]] = {
            "force": lambda: Force(self._point((*path, "point"), body, table.pop("point", "root")), **table),
            "imposed velocity": lambda: ImposedVelocity(slider.root, **table),
            "gravity": lambda: Gravity(**table),
            "initial velocity": lambda: InitialVelocity(body, **table),
        }
        with self._within(*path):
            return makers[kind]()

    def _history(self, path: tuple[str | int, ...], table: Tables) -> Any:
        values = {name: value for name, value in table.items() if name != "kind"}
        with self._within(*path):
            return HISTORIES[table["kind"]](**values)

    def _probe(self, number: int, table: Tables, system: System) -> Any:
        path = ("simulation", "probes", number)
        if table["quantity"] == "reaction":
            return Reaction(system.slider, table.get("direction", "moment"))
        body = getattr(system, table.get("body", "track"))
        point = self._point((*path, "point"), body, table.get("point", "centre"))
        with self._within(*path):
            return MOTIONS[table["quantity"]](point, table.get("direction", "y"))

    def _point(self, path: tuple[str | int, ...], body: Any, place: str | float) -> Any:
        if isinstance(place, float):
            try:
                return body.at(place)
            except ValueError as error:
                self.problems.append(str(error).replace("position", self.words(path), 1))
                return None
        names = ("tip", "root") if isinstance(body, FiniteElementBeam) else ("centre",)
        if place not in names:
            self.problems.append(f"{self.words(path)} must be {' or '.join(names)} or a position, got {place!r}")
            return None
        point: BodyPoint = getattr(body, place)
        return point

    @contextmanager
    def _within(self, *path: str | int) -> Iterator[None]:
        """Keep a ValueError as a problem, its argument named by the full key; what follows from others is no news."""
        known = len(self.problems)
        try:
            yield
        except ValueError as error:
            if len(self.problems) == known and "got None" not in str(error):
                self.problems.append(self._named(path, str(error)))

    def _named(self, path: tuple[str | int, ...], message: str) -> str:
        match = _ARGUMENT.match(message)
        if match is None:
            return f"{self.words(path)}: {message}" if path else message
        argument = match[1].replace("[", ".").replace("]", "")
        owner = ("slider",) if argument in ("root_support", "tip_support") else path
        return self.words((*owner, *argument.split("."))) + message[len(match[1]) :]

    def _stop_at_problems(self) -> None:
        if self.problems:
            raise ScenarioError(self.problems)
