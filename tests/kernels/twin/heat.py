"""Temperature of a contact: layers heated by friction, or a history, and the law of friction at it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import stridula as st

# Steps of the method of Runge and Kutta in a step of the march.
PARTS = 4


class Heat:
    """Temperatures of one contact, NaN without any."""

    def __init__(self, contact):
        self.heating, self.friction, self.time = contact.heating, contact.friction, 0.0
        self.layers = np.array([np.nan])
        if isinstance(self.heating, st.HeatedLayers):
            given = self.heating.ambient if self.heating.initial is None else self.heating.initial
            self.layers = np.full(len(self.heating.capacity), given, dtype=float)
        elif self.heating is not None:
            self.layers = np.array([self.prescribed(0.0)])

    def prescribed(self, time):
        return np.interp(time, self.heating.time, self.heating.temperature)

    def rates(self, values, power):
        """Balance of each layer: from its neighbour before, to that after, and from the surroundings."""
        given, flows = self.heating, np.zeros(values.size + 1)
        flows[0] = given.share * power
        flows[1:-1] = np.array(given.conductance) * (values[:-1] - values[1:])
        flows[-1] = given.cooling * (values[-1] - given.ambient)
        return (flows[:-1] - flows[1:]) / np.array(given.capacity)

    def warm(self, lost, h):
        """Carry the temperatures over a step in which so much was lost to friction [J]."""
        self.time += h
        if isinstance(self.heating, st.TemperatureHistory):
            self.layers[0] = self.prescribed(self.time)
        elif self.heating is not None:
            values, part, power = self.layers, h / PARTS, lost / h
            for _ in range(PARTS):
                first = self.rates(values, power)
                second = self.rates(values + part / 2 * first, power)
                third = self.rates(values + part / 2 * second, power)
                fourth = self.rates(values + part * third, power)
                values = values + part / 6 * (first + 2 * second + 2 * third + fourth)
            self.layers = values

    def law(self, law):
        """The law at the temperature, its numbers on straight lines."""
        if not isinstance(self.friction, st.FrictionOverTemperature):
            return law
        at, laws = self.friction.temperature, self.friction.laws
        names = ("coefficient",) if isinstance(laws[0], st.Coulomb) else ("static", "kinetic")
        values = {name: np.interp(self.layers[0], at, [getattr(one, name) for one in laws]) for name in names}
        return replace(laws[0], **{name: float(value) for name, value in values.items()})
