"""Many contact points: a patch test through two meshes, a coin that slides and spins, a squealing pin on a disc."""

from __future__ import annotations

from dataclasses import replace
from math import log, pi
from typing import Any

import numpy as np

from ..analysis.stability import sliding_stability
from ..arrays import Array
from ..bodies import Material, ReducedBody, SolidBody, SolidMesh
from ..connections import Spring
from ..contact import Coulomb, PointContact, RigidTrack, SurfaceContact
from ..drives import Force, InitialEquilibrium, InitialState
from ..histories import Constant
from ..integration import simulate
from ..linear.equilibrium import find_equilibrium
from ..linear.structure import Structure
from ..lowering.schemes import Scheme
from ..records import Displacement
from ..scenarios.load import load_scenario
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme

ROUND_OFF = "round-off"
# Highest frequency of the modes [Hz]; omitted modes add static flexibility at the faces.
PRESSURE, CUTOFF = 1e6, 5e4
# Stationary ratio of the velocities of a coin, and its friction there, over the weight and the radius.
RATIO, DRAG, MOMENT = 0.652998, 0.616031, 0.471694
RADIUS, WEIGHT, FRICTION = 0.1, 10.0, 0.2
# The rig of Allgaier and others, as in the Ansys manual.
MEASURED, BAND = 2215.0, (500.0, 4000.0)
# Growth of undamped modes due to rounding, over the frequency.
EXPONENT = 1e-6


def patches(overlay: bool = True) -> System:
    """Return a soft block under a uniform pressure on a hard one of another mesh; neither bulges."""
    soft, hard = Material(2e9, 1200.0, 0.0), Material(2e11, 7800.0, 0.0)
    upper = SolidMesh.block((0.05, 0.01, 0.03), (3, 1, 2)).moved((0.0, 0.02, 0.0))
    pad = SolidBody(upper, soft, cutoff=CUTOFF, contact_faces=["bottom", "top"], name="pad")
    lower = SolidMesh.block((0.05, 0.02, 0.03), (4, 2, 5))
    base = SolidBody(lower, hard, fixed=["bottom"], cutoff=CUTOFF, contact_faces=["top"], name="base")
    face = SurfaceContact(pad, "bottom", base, "top", stiffness=1e12, overlay=overlay, name="face")
    top = pad.face_points("top")
    loads = [
        Force(pad.at(place), y=-PRESSURE * area)
        for place, area in zip(top.place.tolist(), top.area.tolist(), strict=True)
    ]
    springs = [Spring(pad.at(top.place[0].tolist()), stiffness=1e3, direction=way) for way in "xz"]
    return System(face, loads, springs)


def patch_test() -> Outcome:
    """A uniform pressure passes unchanged through faces of different meshes."""
    system = patches()
    (surface,) = system.faces
    found = find_equilibrium(Structure(system), np.full(len(system.contacts), 0.1))
    pressures = found.normal_force / surface.areas
    worst = float(pressures[np.abs(pressures - PRESSURE).argmax()])
    area = 0.05 * 0.03
    rows = [
        Row("pressure at the worst point", PRESSURE, worst, 1e-9 * PRESSURE, ROUND_OFF, "Pa"),
        Row("area of the face", area, float(surface.areas.sum()), 1e-12 * area, ROUND_OFF, "m2"),
    ]
    curve = Curve(np.arange(pressures.size), pressures, "points of both meshes", marks=True)
    return Outcome(rows, Sketch("point of the face", "pressure [Pa]", [curve]))


def coin(rings: int, around: int, speed: float, spin: float) -> tuple[System, Array]:
    """Return a disc of 1 kg that slides along x and spins about y, and the places of its points.

    Each point always carries its share of the weight.
    """
    nodes, weights = np.polynomial.legendre.leggauss(rings)
    radii, shares = RADIUS * np.sqrt(0.5 * (nodes + 1.0)), np.repeat(0.5 * weights, around) / around
    angles = 2.0 * pi * (np.arange(around) + 0.5 * np.arange(rings)[:, None]) / around
    places = np.stack([(radii[:, None] * np.cos(angles)).ravel(), (radii[:, None] * np.sin(angles)).ravel()], axis=1)
    count = len(places)
    mass = np.diag(np.concatenate([[1.0, 1.0, 0.5 * RADIUS**2], 1e-3 * shares]))
    points = {}
    for k, (x, z) in enumerate(places):
        rows = np.zeros((3, count + 3))
        rows[0, [0, 2]], rows[1, 3 + k], rows[2, [1, 2]] = (1.0, z), 1.0, (1.0, -x)
        points[f"p{k}"] = rows
    body = ReducedBody(mass, np.zeros_like(mass), points, name="coin")
    contacts = [
        PointContact(body.at(point), RigidTrack(name=f"below {point}"), friction=Coulomb(FRICTION), name=point)
        for point in points
    ]
    loads = [Force(body.at(f"p{k}"), y=-WEIGHT * share) for k, share in enumerate(shares.tolist())]
    thrown = InitialState(body, velocity=[speed, 0.0, spin, *np.zeros(count)])
    return System(contacts, [*loads, thrown]), places


def spinning(rings: int = 4, around: int = 12, spin: float = 20.0) -> Outcome:
    """A coin stops sliding and spinning together, at one ratio of both for any start; here it starts at this ratio."""
    system, places = coin(rings, around, RATIO * RADIUS * spin, spin)
    # The error is of second order in the angle between the points of a ring.
    share, reason = (pi / around) ** 2 / 12.0, "second order of the distance of the points"
    curves = [Curve(np.array([0.0, 1.4]), np.full(2, RATIO), "closed form")]

    def rows(scheme: Scheme) -> list[Row]:
        run = simulate(system, 1.4, scheme=scheme, step=2e-4, sample_rate=1e3, probes=[])
        forces, slips = run["tangential_force"].values, run["slip_velocity"].values
        moment = (forces[..., 0] * places[:, 1] - forces[..., 1] * places[:, 0]).sum(axis=1)
        turning = (slips[..., 0] * places[:, 1] - slips[..., 1] * places[:, 0]).sum(axis=1) / (places**2).sum()
        stopped = int(np.flatnonzero(np.abs(slips).max(axis=(1, 2)) > 1e-9)[-1])
        half = stopped // 2
        ratios = slips[:half, :, 0].mean(axis=1) / (RADIUS * turning[:half])
        curves.append(Curve(run["time"].values[:half], ratios, scheme.name))
        drag, spun = DRAG * FRICTION * WEIGHT, MOMENT * FRICTION * WEIGHT * RADIUS
        return [
            Row("friction at the start", drag, float(forces[5, :, 0].sum()), share * drag, reason, "N", scheme.name),
            Row("its moment at the start", spun, float(moment[5]), share * spun, reason, "N m", scheme.name),
            # The ratio deviates from the stable one as much as the forces.
            Row("v / R w half way", RATIO, float(ratios[-1]), 2.0 * share * RATIO, reason, "1", scheme.name),
        ]

    return Outcome(by_scheme(rows), Sketch("time [s]", "v / R w", curves))


def pin_on_disc() -> Outcome:
    """The shipped rig, its loads at full from the start: one mode grows, in linear theory and in time."""
    shipped = load_scenario("pin-on-disc").system
    given: tuple[Any, ...] = tuple(shipped.drives)
    drives: list[Any] = [replace(drive, history=Constant()) for drive in given]
    system = replace(shipped, drives=drives)
    theory = sliding_stability(system)
    held, growing = theory["status"].values.tolist(), theory["growth_rate"].values
    frequencies = theory["frequency"].values
    band = (frequencies > BAND[0]) & (frequencies < BAND[1]) & (growing > EXPONENT * frequencies)
    number = int(np.where(band, growing, -np.inf).argmax())
    frequency, growth = float(frequencies[number]), float(growing[number])
    words = "support, prestress and mesh of the rig are not known in full"
    rows = [
        Row("modes that grow from 500 to 4000 Hz", 1.0, float(band.sum()), 0.0, "a count"),
        Row("frequency", MEASURED, frequency, 0.03 * MEASURED, words, "Hz"),
    ]
    probe = Displacement(shipped.contacts[2].tip, "x")
    curves: list[Curve] = []

    def in_time(scheme: Scheme) -> list[Row]:
        asked: dict[str, Any] = {"scheme": scheme, "step": 1e-6, "sample_rate": 1e5, "probes": [probe]}
        starts = [InitialEquilibrium(held), InitialEquilibrium(held, mode="most unstable", amplitude=1e-9)]
        rest, run = (simulate(replace(system, drives=[*drives, start]), 8e-3, **asked) for start in starts)
        away = run["displacement"].values.ravel() - rest["displacement"].values.ravel()
        # The means are over whole periods and are whole periods apart.
        periods, time = round(3.0 / frequency * 1e5), run["time"].values
        sizes = [float(np.sqrt(np.mean(away[at : at + periods] ** 2))) for at in (50, 50 + 4 * periods)]
        seen = log(sizes[1] / sizes[0]) / float(time[50 + 4 * periods] - time[50])
        curves.append(Curve(time, np.abs(away), scheme.name))
        return [Row("growth in time", growth, seen, 0.01 * growth, "a step of 1/440 of the period", "1/s", scheme.name)]

    rows += by_scheme(in_time)
    return Outcome(rows, Sketch("time [s]", "distance from equilibrium [m]", curves))


CASES = (
    Case("patch-test", "A uniform pressure through two unlike meshes", "equilibrium", patch_test),
    Case(
        "spinning-disc",
        "A coin that slides and spins on a floor",
        "Farkas, Bartels, Unger & Wolf 2003, Physical Review Letters 90",
        spinning,
    ),
    Case(
        "pin-on-disc",
        "A pin that leans on a turning disc: the squealing mode",
        "Allgaier, Gaul, Keiper & Willner 1999, as Ansys' VM275; growth: our linear theory",
        pin_on_disc,
    ),
)
