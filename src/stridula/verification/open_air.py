"""Sound of bodies in open air: spheres, a thin disc, thin plates, a bar, the balance of power, filters in time.

A sphere and a disc as bodies of revolution, by rings of sources; a sphere and a bar as meshes, by the pressure on their
surface; plates as sheets of dipoles. Their motions are prescribed: shapes take the place of modes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import pi

import numpy as np

from ..acoustics.air import Air
from ..acoustics.convolution import Convolution
from ..acoustics.delays import Sampling
from ..acoustics.dipoles import moved_area
from ..acoustics.equivalent_sources import Radiator
from ..acoustics.free_responses import free_responses
from ..acoustics.panels import Panel
from ..acoustics.ring_sources import RingSources
from ..acoustics.sheets import SheetDipoles, sheet_of
from ..acoustics.surface_pressures import SurfacePressures
from ..arrays import Array
from ..bodies import Rectangle, RectangleProfile, SolidMesh
from ..bodies.body_surfaces import RingSurface
from ..bodies.revolution.ring_surfaces import cut_outline
from ..bodies.solids.surfaces import cut_faces
from .case import Case, Curve, Outcome, Row, Sketch

AIR = Air()
RADIUS = 0.1
# Wavenumbers times the radius; near pi a standing wave fits into the sphere.
NUMBERS = (0.1, 1.0, 3.0, pi, 8.0)
PLACES = np.array([[0.3, 0.4, 0.5], [0.0, 0.0, 0.25], [0.12, 0.05, 0.02]])
STILL = 1e-6


def ring_sphere(parts: int = 24, radius: float = RADIUS) -> RingSurface:
    """Return a sphere of rings that pulsates, and oscillates along its axis and across it."""
    angles = (np.arange(2 * parts) + 0.5) * pi / (2 * parts)
    normals = np.stack([np.sin(angles), np.cos(angles)], axis=1)
    shapes = np.stack([np.ones(2 * parts), normals[:, 1], normals[:, 0]], axis=1)
    widths = np.full(2 * parts, radius * pi / (2 * parts))
    orders = np.array([0, 0, 1])
    return RingSurface(radius * normals, normals, widths, shapes, orders, 0 * orders, np.eye(3), np.zeros(3))


def meshed_sphere(parts: int = 6, radius: float = RADIUS) -> SurfacePressures:
    """Return a meshed sphere, mapped from a cube, that pulsates, and oscillates along z and along x."""
    mesh = SolidMesh.block([2.0, 2.0, 2.0], [parts] * 3)
    square = (mesh.nodes - 1.0) ** 2
    first, second = square[:, [1, 2, 0]], square[:, [2, 0, 1]]
    nodes = radius * (mesh.nodes - 1.0) * np.sqrt(1.0 - 0.5 * (first + second) + first * second / 3.0)
    one = np.ones((len(nodes), 1))
    shapes = np.stack([nodes / radius, one * [0.0, 0.0, 1.0], one * [1.0, 0.0, 0.0]], axis=2)
    return SurfacePressures(cut_faces(SolidMesh(nodes, mesh.elements, mesh.kind), shapes, 0.01))


def disc(thickness: float, radius: float = RADIUS) -> RingSurface:
    """Return a disc that oscillates along its axis, and bends with two waves around it."""
    mesh = RectangleProfile({"disc": ((0.0, radius), (0.0, thickness))}).mesh(lambda size, name: radius)
    places, normals, widths = cut_outline(mesh, radius / 8.0)
    shapes = np.stack([normals[:, 1], normals[:, 1] * (places[:, 0] / radius) ** 2], axis=1)
    orders = np.array([0, 2])
    return RingSurface(places, normals, widths, shapes, orders, 0 * orders, np.eye(3), np.zeros(3))


def of_sphere(wavenumber: float, places: Array) -> Array:
    """Return the pressures of a sphere that pulsates, oscillates along z and along x, for unit accelerations.

    ``rho a² / (1 + i k a) exp(-i k (R - a)) / R`` and ``rho a³ cos(theta) (1 + i k R) / (2 + 2 i k a - k² a²)
    exp(-i k (R - a)) / R²`` (Morse & Ingard 1968, Theoretical Acoustics, section 7.1).
    """
    away, ka = np.linalg.norm(places, axis=1), wavenumber * RADIUS
    late = np.exp(-1j * wavenumber * (away - RADIUS))
    pulsating = RADIUS**2 / (1.0 + 1j * ka) * late / away
    dipole = RADIUS**3 / (2.0 + 2j * ka - ka**2) * (1.0 + 1j * wavenumber * away) * late / away**2
    return AIR.density * np.stack([pulsating, dipole * places[:, 2] / away, dipole * places[:, 0] / away], axis=1)


def heard(radiator: Radiator, wavenumber: float, places: Array) -> Array:
    """Return the pressures of a body at places for unit accelerations, shape (places, shapes)."""
    return np.asarray(AIR.density * radiator.heard(radiator.fit(wavenumber), wavenumber, places))


def spheres() -> Outcome:
    """Spheres that pulsate and oscillate, as rings of sources and as a mesh."""
    rows, curves = [], []
    for words, radiator, tolerance, reason in (
        ("rings", RingSources(ring_sphere()), 1e-3, "24 rings: sources at a depth of 1.5 spacings leave exp(-3 pi)"),
        ("mesh", meshed_sphere(), 0.03, "patches of a twelfth of the wavelength and more, constant over each"),
    ):
        worst = []
        for number in NUMBERS:
            known = of_sphere(number / RADIUS, PLACES)
            found = heard(radiator, number / RADIUS, PLACES)
            scale = np.abs(known).max(axis=0)
            worst.append((np.abs(found - known) / scale).max(axis=0))
        for shape, what in enumerate(("pulsating", "oscillating along z", "oscillating along x")):
            error = max(float(one[shape]) for one in worst)
            rows.append(Row(f"{words}, {what}: largest error of the pressure", 0.0, error, tolerance, reason))
        curves.append(Curve(np.array(NUMBERS), np.array(worst).max(axis=1), words, marks=True))
    return Outcome(rows, Sketch("ka", "largest error of the pressure", curves, logarithmic=True))


def discs() -> Outcome:
    """A thin disc that oscillates along its axis: the added mass of the air, from the far field at low frequency."""
    far, rows, shares = 100.0, [], []
    thicknesses = np.array([0.2, 0.1, 0.05]) * RADIUS
    for thickness in thicknesses:
        pressure = heard(RingSources(disc(float(thickness))), STILL, np.array([[0.0, 0.0, far]]))[0, 0]
        carried = 4.0 * pi * far**2 * float(pressure.real) / AIR.density
        shares.append((carried - pi * RADIUS**2 * float(thickness)) / RADIUS**3)
    # Thickness and thickness times its logarithm: the corrections of right-angled edges to a thin disc.
    terms = np.stack([np.ones(3), thicknesses / RADIUS, thicknesses / RADIUS * np.log(thicknesses / RADIUS)], axis=1)
    limit = float(np.linalg.solve(terms, np.array(shares))[0])
    reason = "the thickness taken to zero from a twentieth of the radius, which makes ten times of an error of 0.4 %"
    rows.append(Row("added mass over density times radius cubed", 8.0 / 3.0, limit, 0.1, reason))
    curves = [Curve(thicknesses / RADIUS, np.array(shares), "obtained", marks=True)]
    return Outcome(rows, Sketch("thickness over radius", "added mass over rho a³", curves))


def bar() -> Outcome:
    """A slender bar of square section: the added mass of the air per length in its middle, as for the section."""
    width, lengths, far = 0.01, np.array([0.12, 0.2]), 200.0
    carried = []
    for length in lengths:
        mesh = SolidMesh.block([width, width, float(length)], [2, 2, 12])
        sideways = np.tile([1.0, 0.0, 0.0], (len(mesh.nodes), 1))[:, :, None]
        radiator = SurfacePressures(cut_faces(mesh, sideways, 0.01))
        pressure = heard(radiator, STILL, np.array([[far, 0.5 * width, 0.5 * length]]))[0, 0]
        carried.append(4.0 * pi * far**2 * float(pressure.real) / AIR.density)
    obtained = float(np.diff(carried)[0] / np.diff(lengths)[0]) / width**2
    known = moved_area(Rectangle(width, width)) / width**2
    reason = "patches of a fifth of the width: pressures at edges go as the distance to the power of 2/3"
    rows = [Row("area of the air moved over the section", known, obtained, 0.04 * known, reason)]
    return Outcome(
        rows, Sketch("length [m]", "volume of air moved [m³]", [Curve(lengths, np.array(carried), "obtained")])
    )


def rigid_plate(length: float, width: float) -> SheetDipoles:
    """Return a thin plate that moves as a rigid body."""
    waves = np.full((1, 2), 1e-9)
    panel = Panel(length, width, 0.0, 1.0, waves, np.ones(1), np.zeros(1), (0.0, length), lambda at: (at, at))
    sheet = sheet_of(panel, 0.0)
    return SheetDipoles(replace(sheet, shapes=np.ones_like(sheet.shapes), coarser=None))


def air_carried(length: float, width: float) -> float:
    """Return the added mass of a rigid plate over that of a cylinder of its width and length."""
    far = 1e3 * length
    pressure = heard(rigid_plate(length, width), STILL, np.array([[0.5 * length, 0.5 * width, far]]))[0, 0]
    return 4.0 * pi * far**2 * float(pressure.real) / AIR.density / (0.25 * pi * width**2 * length)


def plates() -> Outcome:
    """Thin rectangular plates that oscillate along their normal: the added mass of the air, from the far field."""
    ratios, known = np.array([1.0, 1.25, 1.5, 2.0, 4.0, 10.0]), [0.579, 0.642, 0.690, 0.757, 0.872, 0.947]
    found = [air_carried(0.1 * float(ratio), 0.1) for ratio in ratios]
    rows = [
        Row(f"added mass over that of a cylinder, sides as 1 to {ratio:g}", one, obtained, 1e-3, "digits of the table")
        for ratio, one, obtained in zip(ratios, known, found, strict=True)
    ]
    curves = [Curve(ratios, np.array(found), "obtained", marks=True), Curve(ratios, np.array(known), "table")]
    return Outcome(rows, Sketch("longer side over shorter side", "added mass over that of a cylinder", curves))


def power() -> Outcome:
    """Power over a far sphere against power at the surface, for a bending disc."""
    surface, far, rows = disc(0.02), 30.0, []
    radiator = RingSources(surface)
    for number in (2.0, 6.0):
        wavenumber = number / RADIUS
        nodes, weights = np.polynomial.legendre.leggauss(24)
        across = np.sqrt(1.0 - nodes**2)
        # The second shape varies as cos 2 theta around the axis, whose square has the mean 1/2.
        places = far * np.stack([across, 0.0 * nodes, nodes], axis=1)
        pressure = heard(radiator, wavenumber, places)[:, 1]
        arriving = far**2 / (2.0 * AIR.impedance) * pi * float(weights @ np.abs(pressure) ** 2)
        near = 1e-3 * RADIUS
        at = surface.places + near * surface.normals
        close = heard(radiator, wavenumber, np.stack([at[:, 0], 0.0 * at[:, 0], at[:, 1]], axis=1))[:, 1]
        # Velocity is acceleration over i w.
        flow = (close * np.conj(surface.shapes[:, 1] / (1j * wavenumber * AIR.speed))).real
        leaving = 0.5 * pi * float((surface.places[:, 0] * surface.widths) @ flow)
        reason = "edges resolved to 3 %, pressure a thousandth of the radius above the surface"
        rows.append(
            Row(f"power that arrives over power that leaves, ka = {number:g}", 1.0, arriving / leaving, 0.03, reason)
        )
    x = np.array([2.0, 6.0])
    curves = [Curve(x, np.array([row.obtained for row in rows]), "obtained", marks=True)]
    return Outcome(rows, Sketch("ka", "power far away over power at the surface", curves))


def tones() -> Outcome:
    """Filters in time: steady tones through the impulse responses against the closed form at their frequency."""
    interval, bandwidth, place = 1e-5, 20e3, PLACES[:1]
    distance = np.linalg.norm(place, axis=1) - RADIUS
    sent = free_responses(ring_sphere(40), place, distance, AIR, Sampling(interval, bandwidth))
    rows, time = [], np.arange(4096) * interval
    frequencies = np.array([333.3, 2000.0, 7777.0, 15000.0])
    for frequency in frequencies:
        tone = np.sin(2.0 * pi * frequency * time)
        sound = Convolution(sent.responses, time.size)
        sound.add(np.stack([tone, tone, tone]), slice(None))
        late = time > 0.5 * time[-1]
        found = sound.signals()[0, late]
        turn = 2.0 * pi * frequency * time[late]
        sine, cosine = np.linalg.lstsq(np.stack([np.sin(turn), np.cos(turn)], axis=1), found, rcond=None)[0]
        known = of_sphere(2.0 * pi * float(frequency) / AIR.speed, place)[0].sum()
        error = abs(sine + 1j * cosine - known) / abs(known)
        reason = "truncation of a response at its end, 5e-3, affects all frequencies"
        rows.append(Row(f"tone of {frequency:.5g} Hz: error of pressure", 0.0, float(error), 1e-3, reason))
    taps = sent.responses[0]
    curve = Curve(1e3 * interval * (taps.first + np.arange(len(taps.taps))), taps.taps[:, 0], "pulsating sphere")
    return Outcome(rows, Sketch("time [ms]", "impulse response [Pa s²/m]", [curve]))


def cases() -> Iterator[Case]:
    """Yield the cases of sound in open air."""
    morse = "Morse & Ingard 1968, Theoretical Acoustics; derived in the module"
    yield Case("sphere-in-air", "Pulsating and oscillating spheres", morse, spheres)
    yield Case(
        "disc-in-air",
        "Added mass of air on an oscillating thin disc",
        "Lamb 1932, Hydrodynamics, section 102",
        discs,
    )
    yield Case("bar-in-air", "Added mass of air on an oscillating slender bar", "conformal mapping of its section", bar)
    yield Case(
        "plate-in-air",
        "Added mass of air on oscillating thin plates",
        "DNV-RP-C205, added mass of rectangular plates",
        plates,
    )
    yield Case("power-in-air", "Power at the surface of a bent disc and far away", "conservation of energy", power)
    yield Case("tones-in-air", "Steady tones through impulse responses", morse, tones)


CASES = tuple(cases())
