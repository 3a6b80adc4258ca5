"""Heat of friction at default settings: temperatures of blocks and of a slab, and friction that fades."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..bodies import PointMass
from ..connections import Spring
from ..contact import Coulomb, FrictionLaw, FrictionOverTemperature, HeatedLayers, PointContact, RigidTrack
from ..drives import Force, InitialEquilibrium
from ..integration import simulate
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, schemes

# Blocks of the test manual: pressure [Pa], side [m] and unit depth [m], coefficient, speed [m/s] and duration [s]; heat
# capacity per volume [J/(m³ K)]; rises printed for the block and for the base, four times as large [K].
PRESSURE, SIDE, DEPTH, MU, SPEED, LASTS = 1e7, 1.25e-3, 1e-3, 0.2, 1.0, 3.75e-3
PER_VOLUME, PRINTED = 2700.0 * 900.0, {"block": (1.0, 1.235), "base": (4.0, 0.309)}
# Fading brake: load [N], speed [m/s], coefficients at two temperatures [degC], layer, and duration [s].
LOAD, FAST, COLD, HOT = 500.0, 4.0, (20.0, 0.5), (220.0, 0.1)
LAYER, BRAKING = HeatedLayers(30.0, cooling=2.0, ambient=20.0), 20.0
# Slab: area [m²], thickness [m], conductivity [W/(m K)], density [kg/m³], specific heat [J/(kg K)], times [s].
AREA, THICKNESS, CONDUCTS, DENSITY, HEAT, TIMES = 1e-3, 8e-3, 2.0, 2500.0, 1000.0, (10.0, 30.0, 60.0)
# Terms of the series for the slab.
TERMS = np.arange(1, 200)


def held_block(friction: FrictionLaw, heating: HeatedLayers, load: float, speed: float) -> System:
    """Return a block held by a spring on a belt, from its sliding equilibrium on."""
    block = PointMass(0.1)
    contact = PointContact(block.centre, RigidTrack(velocity=speed), friction=friction, heating=heating)
    drives = [Force(block.centre, y=-load), InitialEquilibrium("sliding")]
    return System(contact, drives, [Spring(block.centre, stiffness=1e6)])


def heated_block() -> Outcome:
    """Two blocks that rub share the heat evenly: each warms by its share over its heat capacity."""
    rows, curves = list[Row](), list[Curve]()
    for scheme in schemes():
        for name, (times, printed) in PRINTED.items():
            layer = HeatedLayers(times * PER_VOLUME * SIDE * SIDE * DEPTH, share=0.5)
            system = held_block(Coulomb(MU), layer, PRESSURE * SIDE * DEPTH, SPEED)
            run = simulate(system, LASTS, scheme=scheme)
            rise = float(run["temperature"][-1]) - layer.ambient
            exact = 0.5 * MU * PRESSURE * SPEED * LASTS / (times * PER_VOLUME * SIDE)
            rows += [
                Row(f"rise of the {name}", printed, rise, 5e-4, "the digits printed", "K", scheme.name),
                Row(f"rise of the {name}, closed form", exact, rise, 1e-9 * exact, "round-off", "K", scheme.name),
            ]
            curves.append(Curve(1e3 * run["time"].values, run["temperature"].values, f"{name}, {scheme.name}"))
    return Outcome(rows, Sketch("time [ms]", "temperature [degC]", curves))


def fading_friction() -> Outcome:
    """A layer under friction that falls with its temperature: ``C T' = share mu(T) N v - h (T - ambient)``."""
    law = FrictionOverTemperature([COLD[0], HOT[0]], [Coulomb(COLD[1]), Coulomb(HOT[1])])
    slope = (HOT[1] - COLD[1]) / (HOT[0] - COLD[0])
    capacity, power = float(np.sum(LAYER.capacity)), LAYER.share * LOAD * FAST
    rate = (LAYER.cooling - slope * power) / capacity
    final = LAYER.ambient + COLD[1] * power / (rate * capacity)
    rows, curves = list[Row](), list[Curve]()
    for scheme in schemes():
        run = simulate(held_block(law, LAYER, LOAD, FAST), BRAKING, scheme=scheme, sample_rate=1000.0)
        time, found = run["time"].values, run["temperature"].values
        known = final + (LAYER.ambient - final) * np.exp(-rate * time)
        pulls = -run["tangential_force"].values
        worst = int(np.abs(found - known).argmax())
        cooled = float(run["heat"][-1] - run["stored_heat"][-1])
        lost = LAYER.cooling * float(np.sum(final - LAYER.ambient + (LAYER.ambient - final) * _mean(rate))) * BRAKING
        force = LOAD * (COLD[1] + slope * (known[-1] - COLD[0]))
        words = "a hundred-thousandth"
        rows += [
            Row("temperature", known[worst], found[worst], 1e-5 * known[worst], words, "degC", scheme.name),
            Row("friction at the end", force, pulls[-1], 1e-5 * force, words, "N", scheme.name),
            Row("heat to the surroundings", lost, cooled, 1e-5 * lost, words, "J", scheme.name),
        ]
        curves.append(Curve(time, found, scheme.name))
    return Outcome(rows, Sketch("time [s]", "temperature [degC]", curves))


def _mean(rate: float) -> float:
    """Return the mean of a decay over the braking."""
    return float(-np.expm1(-rate * BRAKING) / (rate * BRAKING))


def face_of_slab(time: Array, flux: float) -> Array:
    """Return the rise [K] of the face of a slab under a constant heat flux [W/m²], its back insulated.

    Carslaw & Jaeger 1959, section 3.8.
    """
    spread = CONDUCTS / (DENSITY * HEAT) * np.asarray(time) / THICKNESS**2
    waves = np.exp(-np.multiply.outer(spread, (TERMS * np.pi) ** 2)) / TERMS**2
    return np.asarray(flux * THICKNESS / CONDUCTS * (spread + 1.0 / 3.0 - 2.0 / np.pi**2 * waves.sum(axis=-1)))


def heated_slab() -> Outcome:
    """The face of a slab that rubs, in eight layers: heat equation under a constant flux."""
    layers = HeatedLayers.slab(
        AREA, thickness=THICKNESS, conductivity=CONDUCTS, density=DENSITY, specific_heat=HEAT, share=1.0
    )
    load, speed = 100.0, 1.0
    flux = MU * load * speed / AREA
    rows, curves = list[Row](), list[Curve]()
    for scheme in schemes():
        run = simulate(held_block(Coulomb(MU), layers, load, speed), TIMES[-1], scheme=scheme, sample_rate=10.0)
        rise = run["temperature"].values - layers.ambient
        for time in TIMES:
            known, found = float(face_of_slab(np.array(time), flux)), float(np.interp(time, run["time"].values, rise))
            rows.append(Row(f"rise after {time:g} s", known, found, 0.02 * known, "eight layers", "K", scheme.name))
        whole = float(run["stored_heat"][-1])
        rows.append(Row("stored heat", flux * AREA * TIMES[-1], whole, 1e-6 * whole, "a millionth", "J", scheme.name))
        curves.append(Curve(run["time"].values, rise, scheme.name))
    return Outcome(rows, Sketch("time [s]", "rise [K]", curves))


CASES = (
    Case(
        "heated-block",
        "Two blocks heated by their friction",
        "Ansys Mechanical APDL Verification Manual, VM229 (Wriggers & Miehe 1994, CMAME 113): 1.235 and 0.309 K",
        heated_block,
    ),
    Case(
        "fading-friction",
        "A block whose friction falls as it warms",
        "closed form: a linear equation for the temperature",
        fading_friction,
    ),
    Case(
        "heated-slab",
        "The face of a slab heated by friction",
        "Carslaw & Jaeger 1959, Conduction of Heat in Solids, section 3.8",
        heated_slab,
    ),
)
