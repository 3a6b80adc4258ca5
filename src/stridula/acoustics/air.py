"""Air: its density and the speed of sound in it."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

from ..checks import ArgumentError, within

ZERO_CELSIUS = 273.15
# Mole fraction of carbon dioxide of standard air.
CARBON_DIOXIDE = 0.000314
# Range of Cramer's equation; that of the density is wider.
TEMPERATURES = (0.0, 30.0)
PRESSURES = (75e3, 102e3)


@dataclass(frozen=True)
class Air:
    """Humid air after IEC 61094-2:2009, annex F.

    Speed of sound: Cramer 1993, J. Acoust. Soc. Am. 93, 2510-2516, equation 15, within 300 ppm. Density: the CIPM-81/91
    equation, Davis 1992, Metrologia 29, 67-70, within 100 ppm. Carbon dioxide: mole fraction 0.000314.

    Parameters
    ----------
    temperature : float, optional
        Temperature [degrees Celsius], from 0 to 30.
    pressure : float, optional
        Static pressure [Pa], from 75 000 to 102 000.
    humidity : float, optional
        Relative humidity [1], from 0 to 1.

    Raises
    ------
    ValueError
        If an argument is out of the range of these equations.
    """

    temperature: float = 20.0
    pressure: float = 101325.0
    humidity: float = 0.5

    def __post_init__(self) -> None:
        within("temperature", self.temperature, *TEMPERATURES)
        if not PRESSURES[0] <= within("pressure", self.pressure, 0.0, math.inf) <= PRESSURES[1]:
            raise ArgumentError("pressure", f"be from {PRESSURES[0]:.0f} to {PRESSURES[1]:.0f}", self.pressure)
        within("humidity", self.humidity, 0.0, 1.0)

    @property
    def speed(self) -> float:
        """Speed of sound at low frequencies [m/s]."""
        t, p, w, c = self.temperature, self.pressure, self.water, CARBON_DIOXIDE
        return (
            331.5024
            + 0.603055 * t
            - 0.000528 * t**2
            + (51.471935 + 0.1495874 * t - 0.000782 * t**2) * w
            + (-1.82e-7 + 3.73e-8 * t - 2.93e-10 * t**2) * p
            + (-85.20931 - 0.228525 * t + 5.91e-5 * t**2) * c
            - 2.835149 * w**2
            - 2.15e-13 * p**2
            + 29.179762 * c**2
            + 0.000486 * w * p * c
        )

    @property
    def density(self) -> float:
        """Density [kg/m³]."""
        t, p, w = self.temperature, self.pressure, self.water
        kelvin = t + ZERO_CELSIUS
        first = (
            1.58123e-6
            - 2.9331e-8 * t
            + 1.1043e-10 * t**2
            + (5.707e-6 - 2.051e-8 * t) * w
            + (1.9898e-4 - 2.376e-6 * t) * w**2
        )
        compressibility = 1.0 - p / kelvin * first + (p / kelvin) ** 2 * (1.83e-11 - 0.765e-8 * w**2)
        mass = 3.48349e-3 + 1.44e-3 * (CARBON_DIOXIDE - 0.0004)
        return mass * p / (compressibility * kelvin) * (1.0 - 0.3780 * w)

    @property
    def attributes(self) -> dict[str, float]:
        """Attributes of a sound that describe the air."""
        given = {f"air_{name}": value for name, value in asdict(self).items()}
        return given | {"air_speed": self.speed, "air_density": self.density}

    @property
    def impedance(self) -> float:
        """Characteristic impedance, density times speed of sound [Pa s/m]."""
        return self.density * self.speed

    @property
    def water(self) -> float:
        """Mole fraction of water vapour [1] (Davis 1992: enhancement factor and saturation pressure)."""
        kelvin = self.temperature + ZERO_CELSIUS
        enhancement = 1.00062 + 3.14e-8 * self.pressure + 5.6e-7 * self.temperature**2
        saturation = math.exp(1.2378847e-5 * kelvin**2 - 1.9121316e-2 * kelvin + 33.93711047 - 6.3431645e3 / kelvin)
        return self.humidity * enhancement * saturation / self.pressure
