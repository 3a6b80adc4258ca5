"""Sound of spheres in decibels: printed levels, pressures on the surface and away from it, and an elastic ball."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import pi

import numpy as np
from scipy.optimize import brentq
from scipy.special import spherical_jn

from ..acoustics.equivalent_sources import Radiator
from ..acoustics.ring_sources import RingSources
from ..acoustics.surface_pressures import SurfacePressures
from ..arrays import Array
from ..bodies import Material, SolidBody, SolidMesh
from ..bodies.solids.kinds import outer_faces
from .case import Case, Curve, Outcome, Row, Sketch
from .open_air import AIR, PLACES, RADIUS, meshed_sphere, of_sphere, ring_sphere

STEEL = Material(2.1e11, 7850.0, 0.3)
# NAFEMS sphere: radius [m], amplitude of the velocity [m/s], speed of sound [m/s], density [kg/m³], and effective
# values of the pressure on it [dB] by frequency [Hz].
BIG, SPEED, SOUND, DENSITY = 1.0, 0.1, 340.0, 1.225
LEVELS = {20.0: 114.160, 40.0: 118.843, 60.0: 120.777, 80.0: 121.725, 100.0: 122.246}
REFERENCE = 20e-6
# Wavenumbers times the radius, below the first standing wave in the sphere.
NUMBERS = (0.1, 0.5, 1.0, 2.0, 3.0, pi)
BAR = "tolerance of the benchmark, 0.1 dB"


def level_of_nafems(frequency: float) -> float:
    """Return the level on a sphere that pulsates [dB], ``rho c v k a / sqrt(1 + k² a²)`` as an effective value."""
    ka = 2.0 * pi * frequency / SOUND * BIG
    amplitude = DENSITY * SOUND * SPEED * ka / np.sqrt(1.0 + ka**2)
    return float(20.0 * np.log10(amplitude / np.sqrt(2.0) / REFERENCE))


def pulsating() -> Outcome:
    """NAFEMS pulsating sphere: levels on its surface, with rings and with a mesh."""
    rows, curves, frequencies = [], [], np.array(list(LEVELS))
    for words, _, _, on_surface in _spheres(BIG):
        found = []
        for frequency, level in LEVELS.items():
            wavenumber = 2.0 * pi * frequency / SOUND
            pressure = on_surface(wavenumber)[:, 0]
            acceleration = 2.0 * pi * frequency * SPEED
            # The level farthest from the known one, among all places on the surface.
            levels = 20.0 * np.log10(DENSITY * acceleration * np.abs(pressure) / np.sqrt(2.0) / REFERENCE)
            found.append(float(levels[np.abs(levels - level).argmax()]))
            rows.append(Row(f"{words}: level at {frequency:g} Hz", level, found[-1], 0.1, BAR, "dB"))
        curves.append(Curve(frequencies, np.array(found), words, marks=True))
    curves.append(Curve(frequencies, np.array([level_of_nafems(one) for one in frequencies]), "closed form"))
    return Outcome(rows, Sketch("frequency [Hz]", "level [dB]", curves))


def oscillating() -> Outcome:
    """A sphere that oscillates along z: its pressure on the surface and away from it, by rings and by a mesh."""
    rows, curves = [], []
    for words, radiator, at, on_surface in _spheres(RADIUS):
        worst = []
        for number in NUMBERS:
            wavenumber = number / RADIUS
            on = on_surface(wavenumber)[:, 1]
            away = radiator.heard(radiator.fit(wavenumber), wavenumber, PLACES)[:, 1]
            pairs = ((on, of_sphere(wavenumber, at)[:, 1]), (away, of_sphere(wavenumber, PLACES)[:, 1]))
            worst.append([_decibels(AIR.density * one, known) for one, known in pairs])
        largest = np.array(worst)
        for column, where in enumerate(("on the surface", "away from it")):
            rows.append(Row(f"{words}: largest error {where}", 0.0, float(largest[:, column].max()), 0.1, BAR, "dB"))
            curves.append(Curve(np.array(NUMBERS), largest[:, column], f"{words}, {where}", marks=True))
    return Outcome(rows, Sketch("ka", "largest error [dB]", curves))


def ball() -> Outcome:
    """A steel ball as a `SolidBody`: two of its frequencies, the sound of its breathing mode, and the power of that."""
    body, rows = elastic_ball(), []
    modes = body.modes()
    elastic = np.flatnonzero(modes.frequency > 0.0)
    reason = "ten quadratic elements across, five and more to a wavelength of the mode"
    for words, known, number in (
        ("n = 2", oblate(), elastic[5]),
        ("n = 0", breathing(), _breathing_mode(body)),
    ):
        found = float(modes.frequency[number])
        rows.append(Row(f"spheroidal mode {words}", known, found, 2e-3 * known, reason, "Hz"))
    surface = body.surface()
    column = int(_breathing_mode(body) - np.count_nonzero(modes.massless[: _breathing_mode(body)]))
    amplitude, radiator = abs(breathing_amplitude()), SurfacePressures(surface)
    worst = []
    for number in NUMBERS:
        wavenumber = number / RADIUS
        fit = radiator.fit(wavenumber)
        parts = [fit.strengths[0][:, column], radiator.heard(fit, wavenumber, PLACES)[:, column]]
        knowns = [of_sphere(wavenumber, one)[:, 0] for one in (surface.points, PLACES)]
        errors = [
            float(np.abs(20.0 * np.log10(AIR.density * np.abs(one) / amplitude / np.abs(known))).max())
            for one, known in zip(parts, knowns, strict=True)
        ]
        worst.append(errors)
    largest = np.array(worst)
    for where, error in zip(("on the surface", "away from it"), largest.max(axis=0).tolist(), strict=True):
        rows.append(Row(f"sound of the breathing mode: largest error of the level {where}", 0.0, error, 0.1, BAR, "dB"))
    for number in (1.0, pi):
        share = _arriving_over_leaving(radiator, column, number / RADIUS)
        reason = "balance of energy, to 2 %"
        rows.append(Row(f"power that arrives over work on the air, ka = {number:.4g}", 1.0, share, 0.02, reason))
    curves = [
        Curve(np.array(NUMBERS), largest[:, column], where, marks=True)
        for column, where in enumerate(("on the surface", "away from it"))
    ]
    return Outcome(rows, Sketch("ka", "error of the breathing mode [dB]", curves))


def elastic_ball(parts: int = 4, layers: int = 3) -> SolidBody:
    """Return a free ball of steel: a cube in the middle, and six blocks from its sides to the sphere."""
    cube = 0.45 * RADIUS
    line, depth = np.linspace(-1.0, 1.0, parts + 1), np.linspace(0.0, 1.0, layers + 1)
    u, v, s = np.meshgrid(line, line, depth, indexing="ij")
    inner = cube * np.stack([u, v, np.ones_like(u)], axis=-1)
    outer = np.stack([np.tan(0.25 * pi * u), np.tan(0.25 * pi * v), np.ones_like(u)], axis=-1)
    outer *= RADIUS / np.linalg.norm(outer, axis=-1, keepdims=True)
    side = inner + s[..., None] * (outer - inner)
    turned = [np.roll(sign * side, shift, axis=-1) for shift in range(3) for sign in (1.0, -1.0)]
    blocks = [cube * np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1), *turned]
    nodes, elements = _joined(blocks)
    mesh = SolidMesh(nodes, elements, "hexahedron").quadratic()
    places = mesh.nodes.copy()
    element, face = outer_faces(mesh.element_kind, mesh.elements).T
    outside = np.unique(mesh.elements[element[:, None], mesh.element_kind.face_nodes[face]])
    places[outside] *= RADIUS / np.linalg.norm(places[outside], axis=1, keepdims=True)
    return SolidBody(SolidMesh(places, mesh.elements, mesh.kind), STEEL, cutoff=1.05 * breathing(), name="ball")


def breathing() -> float:
    """Return the frequency of the breathing mode [Hz], ``tan x = x / (1 - x² (cl / cs)² / 4)`` for x = w a / cl."""
    ratio = 0.25 * (_longitudinal() / _transverse()) ** 2

    def rest(x: float) -> float:
        return float(np.sin(x) * (1.0 - ratio * x**2) - x * np.cos(x))

    return float(brentq(rest, 0.5 * pi, pi, xtol=1e-12)) * _longitudinal() / (2.0 * pi * RADIUS)


def breathing_amplitude() -> float:
    """Return the radial motion of the surface in the breathing mode [kg^(-1/2)], which varies as ``j1(w r / cl)``."""
    wavenumber = 2.0 * pi * breathing() / _longitudinal()
    nodes, weights = np.polynomial.legendre.leggauss(40)
    r = 0.5 * RADIUS * (nodes + 1.0)
    mass = 2.0 * pi * RADIUS * STEEL.density * float(weights @ (r * spherical_jn(1, wavenumber * r)) ** 2)
    return float(spherical_jn(1, wavenumber * RADIUS) / np.sqrt(mass))


def oblate() -> float:
    """Return the lowest frequency of spheroidal modes with n = 2 [Hz], from Lamb's determinant (Lamb 1882)."""

    def determinant(eta: float, n: int = 2) -> float:
        xi = eta * _transverse() / _longitudinal()
        long, longer, trans, transer = (spherical_jn(m, x) for x in (xi, eta) for m in (n, n + 1))
        normal = (n**2 - n - 0.5 * eta**2) * long + 2.0 * xi * longer
        tangent = (n - 1) * long - xi * longer
        shear = n * (n + 1) * ((n - 1) * trans - eta * transer)
        along = (n**2 - 1 - 0.5 * eta**2) * trans + eta * transer
        return float(normal * along - shear * tangent)

    # The first change of sign of the determinant.
    eta = np.linspace(1.0, 4.0, 301)
    values = np.array([determinant(one) for one in eta])
    first = int(np.flatnonzero(values[:-1] * values[1:] < 0.0)[0])
    return float(brentq(determinant, eta[first], eta[first + 1])) * _transverse() / (2.0 * pi * RADIUS)


def _longitudinal() -> float:
    poisson = STEEL.poisson
    stiffness = STEEL.young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    return float(np.sqrt(stiffness / STEEL.density))


def _transverse() -> float:
    return float(np.sqrt(STEEL.young / (2.0 * (1.0 + STEEL.poisson)) / STEEL.density))


def _breathing_mode(body: SolidBody) -> int:
    """Return the number of the mode with the largest outward motion of the surface."""
    surface = body.surface()
    moving = np.flatnonzero(~body.modes().massless)
    return int(moving[np.abs(surface.areas @ surface.shapes).argmax()])


def _joined(blocks: list[Array]) -> tuple[Array, Array]:
    """Return nodes and hexahedra of blocks, given as grids of places, joined at coincident nodes."""
    places, elements, first = [], [], 0
    for block in blocks:
        number = first + np.arange(block[..., 0].size).reshape(block.shape[:3])
        shift = [slice(None, -1), slice(1, None)]
        corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
        ours = np.stack([number[shift[i], shift[j], shift[k]].ravel() for i, j, k in corners], axis=1)
        points = block.reshape(-1, 3)
        along = points[ours[:, [1, 3, 4]] - first] - points[ours[:, :1] - first]
        inverted = np.linalg.det(along) < 0.0
        ours[inverted] = ours[inverted][:, [4, 5, 6, 7, 0, 1, 2, 3]]
        places.append(points)
        elements.append(ours)
        first += len(points)
    every = np.concatenate(places)
    _, kept, same = np.unique(np.round(every / RADIUS, 9) + 0.0, axis=0, return_index=True, return_inverse=True)
    return every[kept], same.ravel()[np.concatenate(elements)]


def _spheres(radius: float) -> Iterator[tuple[str, Radiator, Array, Callable[[float], Array]]]:
    """Yield spheres of rings and of a mesh: name, radiator, points on it [m], pressures there by wavenumber."""
    rings, mesh = RingSources(ring_sphere(radius=radius)), meshed_sphere(radius=radius)
    places = rings.surface.places
    half = np.stack([places[:, 0], 0.0 * places[:, 0], places[:, 1]], axis=1)
    yield "rings", rings, half, lambda wavenumber: rings.heard(rings.fit(wavenumber), wavenumber, half)
    yield "mesh", mesh, mesh.surface.points, lambda wavenumber: mesh.fit(wavenumber).strengths[0]


def _decibels(found: Array, known: Array) -> float:
    """Return the largest error of amplitudes over the largest known one [dB]."""
    off = np.abs(found - known).max() / np.abs(known).max()
    return float(20.0 * np.log10(1.0 + off))


def _arriving_over_leaving(radiator: SurfacePressures, shape: int, wavenumber: float) -> float:
    """Return the power over a far sphere over the work on the air at the surface."""
    surface, far, count = radiator.surface, 30.0, 24
    heights, weights = np.polynomial.legendre.leggauss(count)
    angles = pi * np.arange(2 * count) / count
    across = np.sqrt(1.0 - heights**2)
    ways = np.stack([np.outer(across, np.cos(angles)), np.outer(across, np.sin(angles))], axis=-1)
    places = far * np.concatenate([ways, np.repeat(heights[:, None, None], 2 * count, axis=1)], axis=-1)
    fit = radiator.fit(wavenumber)
    pressure = AIR.density * radiator.heard(fit, wavenumber, places.reshape(-1, 3))[:, shape]
    mean = (np.abs(pressure) ** 2).reshape(count, -1).mean(axis=1)
    arriving = 2.0 * pi * far**2 * float(weights @ mean) / (2.0 * AIR.impedance)
    velocity = surface.shapes[:, shape] / (1j * wavenumber * AIR.speed)
    close = AIR.density * fit.strengths[0][:, shape]
    return arriving / (0.5 * float(surface.areas @ (close * np.conj(velocity)).real))


def cases() -> Iterator[Case]:
    """Yield the cases of radiating spheres."""
    nafems = "NAFEMS, pulsating sphere; rho c v k a / sqrt(1 + k² a²)"
    yield Case("sphere-pulsating", "Pulsating sphere of NAFEMS", nafems, pulsating)
    morse = "Morse & Ingard 1968, Theoretical Acoustics"
    yield Case("sphere-oscillating", "An oscillating sphere, on its surface and away from it", morse, oscillating)
    lamb = "Lamb 1882, Proc. London Math. Soc. 13, 189-212; Morse & Ingard 1968"
    yield Case("elastic-ball", "An elastic ball: its modes, its sound and the power", lamb, ball)


CASES = tuple(cases())
