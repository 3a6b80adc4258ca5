"""Temperature of a contact: heat of friction in layers under it, or a given history."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, counted, instance, rising
from ..declared import Each, Number, OneOrEach, check_declared

# Largest number of layers in the march.
MOST_LAYERS = 8


class OverStep(NamedTuple):
    """Temperatures after a step: ``matrix @ temperatures + per_heat * heat + constant``.

    Attributes
    ----------
    share : float
        Share of the loss to friction that is heat for them.
    matrix : ndarray, shape (layers, layers)
        Temperatures after the step for those before.
    per_heat, constant : ndarray, shape (layers,)
        Rise for a heat that flows in evenly over the step [K/J], and what is there without temperatures and heat.
    capacity : ndarray, shape (layers,)
        Heat capacities [J/K].
    """

    share: float
    matrix: Array
    per_heat: Array
    constant: Array
    capacity: Array


@dataclass(frozen=True)
class HeatedLayers:
    """Layers under a contact that friction heats.

    They lie one behind the other, up to eight; the first is the one that rubs. With the heat capacities C, the
    temperatures T, the power ``P = |tangential force| |slip velocity|`` of friction and conductances G to the next
    layer, the last of which leads to the surroundings, it is ``C[0] T[0]' = share P - G[0] (T[0] - T[1])``, and so on
    to ``C[n] T[n]' = G[n-1] (T[n-1] - T[n]) - cooling (T[n] - ambient)``. One layer is a body of one temperature.

    Parameters
    ----------
    capacity : float or sequence of float
        Heat capacity of each layer [J/K], of the whole face on a `SurfaceContact`, whose points share it by their
        areas.
    conductance : float or sequence of float, optional
        Thermal conductance from each layer to the next [W/K], one fewer than layers.
    cooling : float, optional
        Thermal conductance from the last layer to the surroundings [W/K].
    ambient : float, optional
        Temperature of the surroundings [degC].
    initial : float or sequence of float, optional
        Temperature at the start of all layers, or of each [degC]; that of the surroundings if left out.
    share : float, optional
        Share of the heat of friction that goes into the layers [1]; the rest goes into the other body. Equal bodies
        share it evenly.

    Raises
    ------
    ValueError
        If an argument is out of its range, or the numbers of entries do not match.

    Examples
    --------
    >>> import stridula as st
    >>> block = st.HeatedLayers(capacity=120.0, cooling=0.4)
    >>> lining = st.HeatedLayers.slab(2e-3, thickness=0.01, conductivity=1.2, density=2500.0, specific_heat=900.0)
    >>> round(sum(lining.capacity), 6)
    45.0
    """

    kind: ClassVar[str] = "layers"
    # They follow time alone.
    by_place: ClassVar[float] = 0.0
    period: ClassVar[float] = 0.0
    capacity: Annotated[float | Sequence[float], OneOrEach(Number("J/K", above=0.0))]
    conductance: Annotated[float | Sequence[float], OneOrEach(Number("W/K", least=0.0))] = ()
    cooling: Annotated[float, Number("W/K", least=0.0)] = 0.0
    ambient: Annotated[float, Number("degC")] = 20.0
    initial: Annotated[float | Sequence[float], OneOrEach(Number("degC"))] | None = None
    share: Annotated[float, Number(least=0.0)] = 0.5

    def __post_init__(self) -> None:
        check_declared(self)
        for name in ("capacity", "conductance"):
            given: Any = getattr(self, name)
            object.__setattr__(self, name, given if isinstance(given, tuple) else (float(given),))
        count = self.layers
        if not 1 <= count <= MOST_LAYERS:
            raise ArgumentError("capacity", f"have 1 to {MOST_LAYERS} layers", got=str(count))
        if len(self._conductances) != count - 1:
            words = f"have one entry fewer than capacity, {count - 1}"
            raise ArgumentError("conductance", words, got=str(len(self._conductances)))
        if isinstance(self.initial, tuple) and len(self.initial) != count:
            raise ArgumentError("initial", f"be one temperature, or {count}", got=str(len(self.initial)))
        if self.share > 1.0:
            raise ArgumentError("share", "be between 0 and 1", self.share)

    @classmethod
    def slab(
        cls,
        area: float,
        *,
        thickness: float,
        conductivity: float,
        density: float,
        specific_heat: float,
        layers: int = MOST_LAYERS,
        transfer: float = 0.0,
        **others: Any,
    ) -> HeatedLayers:
        """Return the layers of a slab of a material that is heated on one side, such as a lining.

        The temperatures are those at equal distances from the rubbing face to the back, both included: differences of
        second order. Heat that has not yet reached the second of them is not resolved.

        Parameters
        ----------
        area, thickness : float
            Area [m²] and thickness of the slab [m].
        conductivity, density, specific_heat : float
            Thermal conductivity [W/(m K)], density [kg/m³] and specific heat [J/(kg K)] of the material.
        layers : int, optional
            Number of temperatures, from 2 to 8.
        transfer : float, optional
            Heat transfer from the back to the surroundings [W/(m² K)].
        **others
            Further arguments: `ambient`, `initial`, `share`.

        Raises
        ------
        ValueError
            If an argument is out of its range.
        """
        given = {"area": area, "thickness": thickness, "conductivity": conductivity, "density": density}
        for name, value in {**given, "specific_heat": specific_heat}.items():
            Number(above=0.0).check(name, value)
        Number(least=0.0).check("transfer", transfer)
        if isinstance(layers, bool) or not isinstance(layers, int) or not 2 <= layers <= MOST_LAYERS:
            raise ArgumentError("layers", f"be a whole number from 2 to {MOST_LAYERS}", layers)
        depth = thickness / (layers - 1)
        capacity = np.full(layers, density * specific_heat * area * depth)
        capacity[[0, -1]] *= 0.5
        conductance = [conductivity * area / depth] * (layers - 1)
        return cls(capacity.tolist(), conductance, transfer * area, **others)

    @property
    def layers(self) -> int:
        """Number of layers."""
        return len(self.capacity)  # type: ignore[arg-type]

    @property
    def _conductances(self) -> tuple[float, ...]:
        given: Any = self.conductance
        return given

    @property
    def start(self) -> Array:
        """Temperature of each layer at the start [degC], shape (layers,)."""
        return np.array(np.broadcast_to(self.ambient if self.initial is None else self.initial, self.layers), float)

    @property
    def rates(self) -> tuple[Array, Array]:
        """Change of the temperatures with each of them [1/s], shape (layers, layers), and without heat [K/s]."""
        capacity, matrix = np.array(self.capacity), np.zeros((self.layers, self.layers))
        for k, conductance in enumerate(self._conductances):
            matrix[k : k + 2, k : k + 2] += conductance * np.array([[-1.0, 1.0], [1.0, -1.0]])
        matrix[-1, -1] -= self.cooling
        constant = np.zeros(self.layers)
        constant[-1] = self.cooling * self.ambient
        return matrix / capacity[:, None], constant / capacity

    def over(self, step: float) -> OverStep:
        """Return the temperatures after a step [s]: exact for their equations."""
        # Imported here, as it takes longer than many a run.
        from scipy.linalg import expm

        count, (matrix, constant) = self.layers, self.rates
        capacity, whole = np.array(self.capacity), np.zeros((self.layers + 2, self.layers + 2))
        whole[:count, :count], whole[:count, count + 1] = matrix, constant
        whole[0, count] = 1.0 / (capacity[0] * step)
        after = expm(whole * step)[:count]
        return OverStep(self.share, after[:, :count], after[:, count], after[:, count + 1], capacity)

    @property
    def history(self) -> tuple[Sequence[float], Sequence[float]]:
        """Times [s] and temperatures [degC] that are prescribed: none."""
        return (), ()

    def of_part(self, part: float) -> HeatedLayers:
        """Return the layers under a part of the contact, a share of its area."""
        capacity, conductance = (tuple(part * one for one in of) for of in (self.capacity, self._conductances))  # type: ignore[union-attr]
        return replace(self, capacity=capacity, conductance=conductance, cooling=part * self.cooling)

    def __str__(self) -> str:
        return f"{counted(self.layers, 'layer')}, {sum(self.capacity):.4g} J/K, share {self.share:.3g}"  # type: ignore[arg-type]


@dataclass(frozen=True)
class TemperatureHistory:
    """Temperature of a contact over time, as measured.

    It is straight between the given times, and constant before the first and after the last. The time is that since the
    start; a record that is continued goes on from its end.

    Parameters
    ----------
    time : sequence of float
        Times at which the temperature is given [s], rising, from 0 on.
    temperature : sequence of float
        Temperature at each [degC].

    Raises
    ------
    ValueError
        If times do not increase, or the numbers of entries differ.
    """

    kind: ClassVar[str] = "history"
    by_place: ClassVar[float] = 0.0
    period: ClassVar[float] = 0.0
    time: Annotated[Sequence[float], Each(Number("s", least=0.0))]
    temperature: Annotated[Sequence[float], Each(Number("degC"))]

    def __post_init__(self) -> None:
        check_declared(self)
        if len(self.time) < 2:
            raise ArgumentError("time", "have two values or more", got=str(len(self.time)))
        rising("time", self.time)
        if len(self.time) != len(self.temperature):
            words = f"have as many values as time, {len(self.time)}"
            raise ArgumentError("temperature", words, got=str(len(self.temperature)))

    @property
    def layers(self) -> int:
        """Numbers that it carries from step to step: the temperature, and the time."""
        return 2

    @property
    def start(self) -> Array:
        """Temperature at the start [degC], and time [s]."""
        return np.array([float(np.interp(0.0, self.time, self.temperature)), 0.0])

    def over(self, step: float) -> OverStep:
        """Return the temperature, which the history replaces, and the time after a step [s]."""
        nothing = np.zeros(2)
        return OverStep(0.0, np.diag([0.0, 1.0]), nothing, np.array([0.0, step]), nothing)

    @property
    def history(self) -> tuple[Sequence[float], Sequence[float]]:
        """Times [s] and temperatures [degC] that are prescribed."""
        return self.time, self.temperature

    def of_part(self, part: float) -> TemperatureHistory:
        """Return the history of a part of the contact, which is the same."""
        return self

    def __str__(self) -> str:
        return f"{min(self.temperature):.4g} to {max(self.temperature):.4g} degC over {self.time[-1]:.4g} s"


def check_heating(given: Any, is_needed: bool) -> None:
    """Raise ValueError unless a contact has a temperature in one of these ways, or needs none."""
    if given is None and is_needed:
        words = "be given under friction that depends on the temperature: HeatedLayers or TemperatureHistory"
        raise ArgumentError("heating", words, got="none")
    if given is not None:
        instance("heating", given, HEATINGS)


Heating = HeatedLayers | TemperatureHistory
HEATINGS = (HeatedLayers, TemperatureHistory)
