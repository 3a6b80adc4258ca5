"""A body of revolution: a disc, a wheel, a bell or a glass by Fourier finite elements on its profile."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Annotated, Any, ClassVar
from weakref import WeakSet

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, at_least, brief, choice, finite, instance, listed, within_a_turn
from ...declared import CountFrom0, Each, Frequency, Number, Own, check_declared
from ...doubtful import doubts_of_size, warn_of
from ...histories import HISTORIES, Constant, History
from ...ordinary import NotOrdinary, of_ordinary_size
from ..body_surfaces import HIGHEST, RingSurface, largest_part
from ..cards import HasCard
from ..damping import DampingLaw, checked_damping, damping_rates
from ..drawn_surfaces import DrawnRings, DrawnSurface
from ..long_searches import search_told
from ..losses import losses_of, one_loss, with_losses
from ..modes import Modes, hashed_once
from ..points import BodyPoint, CircularPath
from ..sections import Material
from ..turning import Turning
from .profile_mesh import MOST_KNOWN, ProfileMesh
from .profiles import PROFILES, Profile
from .ring_surfaces import cut_outline

if TYPE_CHECKING:
    from .fourier_elements import FourierElements
    from .profile_modes import Family

DIRECTIONS = ("r", "theta", "z")
Z = (0.0, 0.0, 1.0)
POSITION = "three numbers, (r, theta, z)"
# Distance of a place from one of `residual_at` that is rounding [m].
SAME_PLACE = 1e-9
# Largest side of a cell as a share of 1 / k of the shortest waves: in thick parts, and in parts so thin that cells of
# their thickness would be finer than bending needs; in between it is a share of the thickness.
# Frequencies are within 1e-3, and within 5e-3 where corners point inwards.
CELL_OF_WAVE, CELL_OF_BENDING, CELL_OF_THICKNESS = 0.4, 0.1, 0.5
# Lower bound of the squared speed of surface waves, the slowest without bending, over that of shear waves.
SURFACE_WAVES = 0.75
# Poisson's ratios beyond which displacement elements lose the pressure, or the shear, to rounding.
LEAST_POISSON, MOST_POISSON = -0.99, 0.499
# Largest mass and stiffness [kg, N/m], so that their squares are finite.
LARGEST = 1e100
# Share of a turn that is due to rounding where a body moves straight.
STRAIGHT = 1e-6
# A free ring of order n bends like a beam of n - 1 waves or more in length.
ORDERS_MORE = 2
# Most degrees of freedom in all orders round the axis together: a few minutes of work; and with cells that are chosen
# for the shortest waves.
MOST_UNKNOWNS, MOST_CHOSEN = 20_000_000, 400_000


@hashed_once
@dataclass(frozen=True)
class Held:
    """A part of a profile that does not move in some directions.

    Parameters
    ----------
    place : str or tuple
        Name of a place of the profile, or a box: its range of r and its range of z [m]. Every profile has ``inner``,
        ``outer``, ``bottom`` and ``top``, its edges of least and largest r, least and largest z; with several regions
        each region is also a place, and so are its edges, such as ``hat.inner``; lines have ``start`` and ``end``;
        meshes have their named edges. In a box, sides of cells that lie entirely inside are held.
    directions : str or sequence of str, optional
        Held directions out of ``r``, ``theta`` and ``z``; all if left out.

    Raises
    ------
    ValueError
        If an argument is out of its range.
    """

    place: Any
    directions: Any = DIRECTIONS

    def __post_init__(self) -> None:
        given = (self.directions,) if isinstance(self.directions, str) else self.directions
        if not isinstance(given, Sequence) or not given:
            raise ArgumentError("directions", f"be one or more of {', '.join(DIRECTIONS)}", self.directions)
        words = tuple(choice(f"directions[{k}]", one, DIRECTIONS) for k, one in enumerate(given))
        object.__setattr__(self, "directions", tuple(one for one in DIRECTIONS if one in words))
        if not isinstance(self.place, str):
            object.__setattr__(self, "place", _box(self.place))

    @property
    def components(self) -> tuple[int, ...]:
        """Numbers of its directions: 0 for r, 1 for theta, 2 for z."""
        return tuple(DIRECTIONS.index(one) for one in self.directions)

    def sides(self, mesh: ProfileMesh) -> Array:
        """Return the held sides of cells, shape (sides, 2)."""
        if not isinstance(self.place, str):
            return mesh.sides_within(*self.place)
        return mesh.sides_of(self.place)


@hashed_once
@dataclass(frozen=True)
class AxisymmetricBody(HasCard):
    """A body of revolution, at rest or turning about its axis, by Fourier finite elements on its profile.

    Round the axis its displacement varies as ``u_r = U cos n theta``, ``u_theta = V sin n theta``,
    ``u_z = W cos n theta``, or as these turned by a quarter of a wave, with U, V and W on the profile in quadratic
    elements of three-dimensional elasticity. Modes of order n above 0 come in pairs of the same frequency. Modes are
    sorted by increasing frequency, the two of a pair one after the other; rigid motions, of frequency zero, come first.

    Parameters
    ----------
    profile : RectangleProfile, LineProfile or MeshProfile
        Its section through the axis, the half with r >= 0.
    material : Material or mapping
        Material, or the material of each region of the profile by its name; Poisson's ratios from -0.99 to 0.499.
    cutoff : float
        Keep all the modes up to this frequency [Hz].
    held : str, Held or sequence of these, optional
        Parts of the profile that do not move, such as ``"inner"`` or ``Held("bottom", "z")``; if left out it is free.
    orders : int, optional
        Highest number of waves round the axis that is kept; if left out, all orders with modes below the cutoff.
    damping : float, sequence of float, Rayleigh, RisingDamping or SampledDamping, optional
        Damping ratio of every mode [1], from 0 to 1 (1 excluded), one for each mode in their order, or a law of their
        frequency.
    residual_at : sequence of tuple of float, optional
        Places (r, z) of the profile [m] where forces act, at any angle: modes of the same orders beyond the cutoff
        still respond statically to these forces and to gravity, by residual shapes without mass, which come last.
    axis : tuple of float, optional
        Direction of its axis of revolution in the world, of any length.
    origin : tuple of float, optional
        World place of the point of its axis where z is 0 [m].
    turning : float, optional
        Angular velocity about the axis, counter-clockwise with the axis pointing at the viewer [rad/s]. Points stay
        fixed in space, the material moves past them.
    turning_history : Constant, Ramp, Harmonic or Sampled, optional
        Factor on the angular velocity over time.
    name : str, optional
        Name in records; distinguishes equal bodies.

    Raises
    ------
    ValueError
        If an argument is out of its range, if a region has no material, or if a held place is empty; from `modes` on,
        if no mode lies below the cutoff, or if it turns and nothing holds its axis.

    Notes
    -----
    Rotation is assumed slow: waves are carried round and Coriolis forces act, both of first order in the angular
    velocity; stiffening and softening by rotation, of second order, are neglected.
    """

    kind: ClassVar[str] = "axisymmetric"
    point_names: ClassVar[tuple[str, ...]] = ()
    has_positions: ClassVar[bool] = True
    has_translation: ClassVar[bool] = True
    has_surface: ClassVar[bool] = True
    is_spatial: ClassVar[bool] = True
    profile: Profile
    material: Any
    cutoff: Frequency
    held: Any = ()
    orders: CountFrom0 | None = None
    damping: Annotated[float | Sequence[float] | DampingLaw, Own("damping")] = 0.0
    residual_at: Any = ()
    axis: Annotated[Sequence[float], Each(Number())] = Z
    origin: Annotated[Sequence[float], Each(Number("m"))] = (0.0, 0.0, 0.0)
    turning: Annotated[float, Number("rad/s")] = 0.0
    turning_history: History = field(default_factory=Constant)
    name: str = ""

    def __post_init__(self) -> None:
        instance("profile", self.profile, PROFILES)
        object.__setattr__(self, "material", _materials(self.material, self.profile.region_names))
        check_declared(self)
        is_one = isinstance(self.held, str) or not isinstance(self.held, Sequence)
        given = (self.held,) if is_one else self.held
        object.__setattr__(self, "held", tuple(Held(one) if isinstance(one, str) else one for one in given))
        for number, one in enumerate(self.held):
            instance(f"held[{number}]", one, Held)
        object.__setattr__(self, "damping", checked_damping(self.damping))
        axis, origin = _triple("axis", self.axis), _triple("origin", self.origin)
        length = math.hypot(*axis)
        if not 0.0 < length < math.inf:
            raise ArgumentError("axis", "be a direction, of a length above 0", self.axis)
        object.__setattr__(self, "axis", tuple(one / length + 0.0 for one in axis))
        object.__setattr__(self, "origin", origin)
        instance("turning_history", self.turning_history, HISTORIES)
        instance("name", self.name, str)
        object.__setattr__(self, "residual_at", _places(self.residual_at))
        # All fields are final, so from here on it can be hashed.
        self._check_held()
        self._check_unknowns()
        for number, place in enumerate(self.residual_at):
            if self.mesh.cell_at(*place) is None:
                raise ArgumentError(f"residual_at[{number}]", "be (r, z) in the profile", place)
        sizes = (self.total_mass, *(one.young * self.mesh.size for one in self.materials.values()))
        if not all(1.0 / LARGEST < size < LARGEST for size in sizes):
            raise NotOrdinary("material and profile")
        warn_of(doubts_of_size(self.largest_side))

    @property
    def materials(self) -> dict[str, Material]:
        """Material of each region of the profile, by its name."""
        if isinstance(self.material, tuple):
            return dict(self.material)
        return dict.fromkeys(self.profile.region_names, self.material)

    @property
    def largest_side(self) -> float:
        """Larger of its diameter and its height [m]."""
        r, z = self.mesh.nodes.T
        return max(2.0 * float(r.max()), float(np.ptp(z)))

    @property
    def dimensions(self) -> str:
        """Size in words."""
        r, z = self.mesh.nodes.T
        return f"{2.0 * r.max():.4g} m across, {np.ptp(z):.4g} m high"

    @property
    def posture(self) -> str:
        """Orientation in words."""
        turns = f", turns at {self.turning:.4g} rad/s" if self.turning else ""
        return f"axis along ({', '.join(f'{one:.4g}' for one in self.axis)}){turns}"

    @property
    def axes(self) -> Array:
        """World components of its axes, which are x, y and z, shape (3, 3)."""
        return np.eye(3)

    @property
    def frame(self) -> Array:
        """World components of the directions theta = 0 and theta = 90 degrees and of its axis, shape (3, 3).

        The world's x, y and z, turned the shortest way from z to the axis; from -z to the axis where it points down.
        """
        (a, b, c) = self.axis
        sign = math.copysign(1.0, c)
        share = -1.0 / (sign + c)
        first = [1.0 + sign * a * a * share, sign * a * b * share, -sign * a]
        return np.array([first, [a * b * share, sign + b * b * share, -b], self.axis]) + 0.0

    @property
    def unknowns(self) -> int:
        """Degrees of freedom in all orders round the axis together, whose modes are searched for."""
        return self.mesh.unknowns * (self._highest_order + 1)

    @property
    def total_mass(self) -> float:
        """Mass [kg]."""
        volumes = self.mesh.volumes
        materials = self.materials
        return float(sum(materials[one].density * volumes[cells].sum() for one, cells in self.mesh.regions.items()))

    @property
    def mesh(self) -> ProfileMesh:
        """Cells of the profile."""
        return _mesh(self)

    @property
    def numbers(self) -> Array:
        """Numbers of each mode, shape (modes, 3).

        Order n; number within its order and kind, from 0, residual shapes last; 0 for the cosine of a pair, 1 for the
        sine. In order 0, modes with 0 do not twist and modes with 1 are torsion.
        """
        return _solution(self).numbers

    def modes(self, held_x: bool = False) -> Modes:
        """Return the modes, translation of shape (3, modes); `held_x` is for driven ends and must be false."""
        if held_x:
            raise ArgumentError("held_x", "be False for an AxisymmetricBody: it has no driven end", held_x)
        return _solution(self).modes

    def trace(self, position: Any, held_x: bool = False) -> Array:
        """Return the rows that give the world displacement (x, y, z) at `position` from the modes.

        Parameters
        ----------
        position : tuple of float
            Distance r from the axis [m], angle theta round it [rad], place z along it [m].
        held_x : bool, optional
            Must be false.

        Returns
        -------
        ndarray, shape (3, modes)
            Displacements for unit modes [kg^(-1/2)].
        """
        self.modes(held_x)
        r, theta, z = self._position(position)
        return np.asarray(self._directions(theta).T @ _solution(self).cylindrical(r, theta, z))

    def place(self, position: Any) -> Array:
        """Return the world place of a point (r, theta, z) at rest [m], shape (3,)."""
        r, theta, z = self._position(position)
        radial, _, axial = self._directions(theta)
        return np.asarray(self.origin + r * radial + z * axial)

    def surface(self, frequency: float = HIGHEST) -> RingSurface:
        """Return the outer surface as rings with its mode shapes, fine enough for sound up to a frequency [Hz]."""
        return _surface(self, largest_part(frequency))

    @property
    def drawn(self) -> DrawnRings:
        """Surface for drawing: the outline of its profile with the mode shapes there."""
        solution, mesh = _solution(self), self.mesh
        used, sides = _outline(mesh)
        shapes = []
        for points, values in zip(*solution.elements.shape_functions(*mesh.nodes[used].T), strict=True):
            shapes.append(np.einsum("cpk,p->ck", solution.shapes[:, points], values)[:, solution.columns])
        orders, _, phases = solution.numbers.T
        return DrawnRings(
            mesh.nodes[used],
            sides,
            np.array(shapes),
            orders,
            phases,
            np.asarray(self.frame),
            np.array(self.origin),
        )

    @property
    def drawn_at_rest(self) -> DrawnSurface:
        """Surface for drawing, without modes, which need not be known."""
        used, sides = _outline(self.mesh)
        still, no_modes = np.zeros((used.size, 3, 0)), np.zeros(0, dtype=int)
        return DrawnRings(
            self.mesh.nodes[used], sides, still, no_modes, no_modes, self.frame, np.array(self.origin)
        ).at_rest

    @property
    def has_modes_at_hand(self) -> bool:
        """Whether its modes are already computed."""
        return self in _SOLVED

    def turning_velocity(self, position: Any) -> Array:
        """Return the velocity of the material at a point (r, theta, z) due to turning alone [m/s], shape (3,)."""
        r, theta, _ = self._position(position)
        return np.asarray(self.turning * r * self._directions(theta)[1])

    def circle_at(self, position: Any, abscissa: float | None = None) -> tuple[float, Any, Array]:
        """Return the radius of a point's circle [m], the point at an abscissa [m], its direction there, shape (3,)."""
        r, theta, z = self._position(position)
        theta += (abscissa or 0.0) / r if r > 0.0 else 0.0
        return r, (r, theta, z), self._directions(theta)[1]

    @property
    def waves_round(self) -> Turning:
        """Pairs of modes and the way they are carried round: by its turning, or with velocity 0 at rest."""
        modes = self.modes()
        if modes.turning is not None:
            return modes.turning
        first = np.flatnonzero((self.numbers[:, 0] > 0) & (self.numbers[:, 2] == 0))
        order = self.numbers[first, 0].astype(float).tolist()
        return Turning(0.0, np.stack([first, first + 1], axis=1).tolist(), order, order)

    def circle(self, position: Any, velocity: float = 0.0, history: History | None = None) -> CircularPath:
        """Return the circle round the axis through a point (r, theta, z) [m, rad, m], as a track for other bodies.

        Parameters
        ----------
        position : tuple of float
            The point where the abscissa is zero.
        velocity : float, optional
            Velocity at which a slider on it is carried along as a whole [m/s].
        history : Constant, Ramp, Harmonic or Sampled, optional
            Factor on that velocity over time.
        """
        point = _point("position", position)
        return CircularPath(self, point, velocity, Constant() if history is None else history)

    def at(self, position: Any) -> BodyPoint:
        """Return the point at a distance r from the axis [m], an angle theta [rad] and a place z along it [m].

        Raises
        ------
        ValueError
            If it is not in the body, or if theta is not from -2 pi to 2 pi.
        """
        return BodyPoint(self, _point("position", position))

    # The argument that gives places residual shapes.
    yields_by: ClassVar[str] = "residual_at"

    def yields_at(self, position: Any) -> bool:
        """Return whether a place has residual shapes of its own."""
        r, _, z = self._position(position)
        return any(np.hypot(r - own[0], z - own[1]) <= SAME_PLACE for own in self.residual_at)

    def check_position(self, position: Any) -> None:
        """Raise ValueError if `position`, (r, theta, z) in metres and radians, is not in the body."""
        self._position(position)

    def _position(self, position: Any) -> tuple[float, float, float]:
        r, theta, z = _triple("position", position, POSITION)
        if self.mesh.cell_at(r, z) is None:
            raise ArgumentError("position", "be (r, theta, z) in the profile", position)
        return r, theta, z

    def _directions(self, theta: float) -> Array:
        """Return the world components of the directions r, theta and z at an angle, shape (3, 3)."""
        first, second, axial = self.frame
        cosine, sine = math.cos(theta), math.sin(theta)
        return np.array([cosine * first + sine * second, cosine * second - sine * first, axial])

    def _check_held(self) -> None:
        for number, one in enumerate(self.held):
            name = f"held[{number}]"
            if isinstance(one.place, str):
                choice(name, one.place, self.mesh.place_names)
            if not len(one.sides(self.mesh)):
                raise ArgumentError(name, "hold a side of a cell or more", got=f"none at {brief(one.place)}")

    def _check_unknowns(self) -> None:
        """Raise ValueError, before anything is computed, if the search for modes would take too long."""
        unknowns, chosen = self.unknowns, self.profile.follows_waves
        most = MOST_CHOSEN if chosen else MOST_UNKNOWNS
        if unknowns > most:
            way = "or give the profile a size" if chosen else "or take a coarser mesh"
            words = f"{self.cutoff!r} Hz, which has {unknowns} in {self._highest_order + 1} orders: lower it, {way}"
            raise ArgumentError("cutoff", f"leave at most {most} degrees of freedom", self.cutoff, got=words)

    def _cell(self, thickness: float, region: str) -> float:
        """Return the largest side of the cells of parts of a thickness in a region [m]."""
        if self.profile.size is not None:
            return self.profile.size
        wave = 1.0 / _shortest_waves([self.materials[region]], thickness, self.cutoff)
        return min(CELL_OF_WAVE * wave, max(CELL_OF_THICKNESS * thickness, CELL_OF_BENDING * wave))

    @property
    def _highest_order(self) -> int:
        """Upper bound of the orders that have waves below the cutoff."""
        waves = _shortest_waves(tuple(self.materials.values()), self.mesh.thinnest, self.cutoff)
        highest = math.ceil(float(self.mesh.nodes[:, 0].max()) * waves) + ORDERS_MORE
        return highest if self.orders is None else min(highest, self.orders)


def _shortest_waves(materials: Sequence[Material], thickness: float, cutoff: float) -> float:
    """Return an upper bound of the wavenumber of the shortest waves below a cutoff [Hz] in layers [rad/m].

    In a plate ``k² <= k_b² + k_s²`` with the waves of Kirchhoff's plate and of shear (Mindlin 1951). Waves in layers
    are no slower than in a plate as heavy as the heaviest layer and as soft as the softest.
    """
    angular, density = 2.0 * math.pi * cutoff, max(one.density for one in materials)
    bending = angular * math.sqrt(12.0 * density / min(one.young for one in materials)) / thickness
    shear = max(2.0 * (1.0 + one.poisson) / one.young for one in materials) * density / SURFACE_WAVES
    return math.sqrt(bending + angular**2 * shear)


@dataclass(frozen=True, eq=False)
class _Solution:
    elements: FourierElements
    modes: Modes
    numbers: Array
    # Number of the shape (U, V, W) of each mode in `shapes`.
    columns: Array
    shapes: Array

    def cylindrical(self, r: float, theta: Any, z: float) -> Array:
        """Return the displacements along r, theta and z for unit modes, shape (3, modes) or (3, angles, modes)."""
        u, v, w = self._along_profile(r, z)
        order, _, side = self.numbers.T
        turned = np.multiply.outer(theta, order)
        cosine, sine = np.cos(turned), np.sin(turned)
        along = np.where(side == 0, cosine, sine)
        return np.array([u * along, v * np.where(side == 0, sine, -cosine), w * along])

    def _along_profile(self, r: float, z: float) -> Array:
        """Return the amplitudes along r, theta and z of unit modes at a place of the profile, shape (3, modes)."""
        found = self._amplitudes.get((r, z))
        if found is None:
            points, values = self.elements.shape_functions(r, z)
            found = np.einsum("cpk,p->ck", self.shapes[:, points], values)[:, self.columns]
            if len(self._amplitudes) < MOST_KNOWN:
                self._amplitudes[r, z] = found
        return found

    @cached_property
    def _amplitudes(self) -> dict[tuple[float, float], Array]:
        """Amplitudes at places that were asked for: systems in series have the same points."""
        return {}


@lru_cache(maxsize=16)
@of_ordinary_size("material, profile and cutoff")
def _mesh(body: AxisymmetricBody) -> ProfileMesh:
    try:
        return body.profile.mesh(body._cell)
    except ArgumentError as error:
        if error.argument != "size" or body.profile.size is not None:
            raise
        # The size depends on the waves, and they on the cutoff.
        raise error.renamed("cutoff") from None


@lru_cache(maxsize=16)
def _elements(body: AxisymmetricBody) -> FourierElements:
    # Here, not above: scikit-fem takes a third of a second to import.
    from .fourier_elements import fourier_elements

    return fourier_elements(body.mesh, [body.materials[name] for name in body.mesh.regions])


@lru_cache(maxsize=16)
def _families(body: AxisymmetricBody) -> list[Family]:
    from .profile_modes import Constraint, families

    mesh, elements = body.mesh, _elements(body)
    held = [Constraint(one.components, elements.points_on(one.sides(mesh))) for one in body.held]
    found = families(elements, held, body.cutoff, range(body._highest_order + 1), body.residual_at)
    lowest = min(one.lowest for one in found)
    if lowest > body.cutoff:
        words = f"leave at least one mode (first at {at_least(lowest)} Hz)"
        raise ArgumentError("cutoff", words, body.cutoff, got=f"{body.cutoff!r} Hz")
    return found


# Bodies whose modes are computed.
_SOLVED: WeakSet[AxisymmetricBody] = WeakSet()


def _outline(mesh: ProfileMesh) -> tuple[Array, Array]:
    """Return the nodes of an outline, and its sides as pairs of indices of these nodes, shape (sides, 2)."""
    used, sides = np.unique(mesh.outline, return_inverse=True)
    return used, sides.reshape(-1, 2)


def _losses(body: AxisymmetricBody, elements: FourierElements, found: list[Family]) -> list[Array]:
    """Return the loss factors of the shapes of each family."""
    from .fourier_elements import fourier_elements

    materials = [body.materials[name] for name in body.mesh.regions]
    same = one_loss(materials)
    if same is not None:
        return [np.full(one.squared.size, same) for one in found]
    stiffened = fourier_elements(body.mesh, with_losses(materials))
    return [
        losses_of(
            elements.stiffness_of(one.kind.order),
            stiffened.stiffness_of(one.kind.order),
            one.shapes.reshape(3 * elements.count, -1),
        )
        for one in found
    ]


@lru_cache(maxsize=16)
def _solution(body: AxisymmetricBody) -> _Solution:
    # Damping and orientation have no influence on the shapes.
    plain = replace(body, damping=0.0, axis=Z, origin=(0.0, 0.0, 0.0), turning=0.0, turning_history=Constant(), name="")
    elements = _elements(plain)
    with search_told(body, 3 * elements.count * (body._highest_order + 1)):
        found = _families(plain)
    losses = _losses(body, elements, found)
    rows = [
        (squared, one.kind.order, one.kind.sides[0], index, number)
        for number, one in enumerate(found)
        for index, squared in enumerate(one.squared)
    ]
    rows.sort()
    numbers, columns, translation, squares, lags = [], [], [], [], []
    for column, (squared, order, _, index, number) in enumerate(rows):
        family = found[number]
        lags.append(_lag(elements, family, index))
        for side in family.kind.sides:
            numbers.append((order, index, side))
            columns.append(column)
            squares.append(squared)
            translation.append(_translation(body, elements, family, index, side))
    shapes = np.stack([found[number].shapes[:, :, index] for *_, index, number in rows], axis=2)
    angular = np.sqrt(squares)
    rates = np.zeros(angular.size)
    lost = np.array([losses[number][index] for *_, index, number in rows])[columns]
    moving = np.isfinite(angular)
    rates[moving] = damping_rates(body.damping, angular[moving], lost[moving])
    turning = _turning(body, np.array(numbers), angular, np.array(lags)[columns]) if body.turning else None
    modes = Modes(angular, rates, np.array(translation).T, turning=turning)
    solution = _Solution(elements, modes, np.array(numbers), np.array(columns), shapes)
    for array in (modes.angular_frequency, modes.translation, solution.numbers, shapes):
        array.flags.writeable = False
    _SOLVED.add(body)
    return solution


@lru_cache(maxsize=16)
def _surface(body: AxisymmetricBody, largest: float) -> RingSurface:
    solution = _solution(body)
    places, normals, widths = cut_outline(body.mesh, largest)
    moving = ~solution.modes.massless
    shapes = np.zeros((len(places), solution.shapes.shape[2]))
    parts = solution.elements.shape_functions(*places.T)
    for row, points, values, (across, along) in zip(shapes, *parts, normals, strict=True):
        u, _, w = np.einsum("cpk,p->ck", solution.shapes[:, points], values)
        row[:] = across * u + along * w
    order, _, side = solution.numbers[moving].T
    shapes = shapes[:, solution.columns[moving]]
    return RingSurface(places, normals, widths, shapes, order, side, body.frame, np.array(body.origin))


def _translation(body: AxisymmetricBody, elements: FourierElements, family: Family, index: int, side: int) -> Array:
    """Return the drive of a mode by a uniform acceleration along x, y and z [kg^(1/2)], shape (3,).

    ``integral rho u dV`` is zero except along the axis for order 0 and across it for order 1.
    """
    u, v, w = family.shapes[:, :, index]
    if family.kind.order == 0 and side == 0:
        return np.asarray(2.0 * math.pi * (elements.mass @ w).sum() * body.frame[2])
    if family.kind.order == 1:
        return np.asarray(math.pi * (elements.mass @ (u - v)).sum() * body.frame[side])
    return np.zeros(3)


def _lag(elements: FourierElements, family: Family, index: int) -> float:
    """Return the angle by which the waves of a mode lag behind the material per angle that it turns [1].

    Coriolis forces ``-2 W z x u'`` couple the two modes of a pair by ``2 W g``, ``g = -2 pi integral rho U V r dr dz``.
    """
    u, v, _ = family.shapes[:, :, index]
    return float(-2.0 * math.pi * (u @ (elements.mass @ v))) if family.kind.order else 0.0


def _turning(body: AxisymmetricBody, numbers: Array, angular: Array, lags: Array) -> Turning:
    """Return the turning of the pairs of modes; the sine of each comes right after its cosine."""
    first = np.flatnonzero((numbers[:, 0] > 0) & (numbers[:, 2] == 0))
    order = numbers[first, 0].astype(float)
    lag = np.where(np.isinf(angular[first]), 0.0, lags[first])
    if (np.abs(order - lag)[angular[first] == 0.0] > STRAIGHT).any():
        raise ArgumentError("turning", "be 0 for a body that is free to tilt", body.turning)
    pairs = np.stack([first, first + 1], axis=1).tolist()
    return Turning(body.turning, pairs, order.tolist(), (order - lag).tolist(), body.turning_history)


def _materials(given: Any, regions: tuple[str, ...]) -> Material | tuple[tuple[str, Material], ...]:
    """Return one material, or pairs of a region and its material."""
    if isinstance(given, tuple):
        given = dict(given)
    if not isinstance(given, Mapping):
        return _solid("material", given)
    for name, material in given.items():
        choice("material", name, regions)
        _solid(f"material[{name!r}]", material)
    missing = [name for name in regions if name not in given]
    if missing:
        raise ArgumentError(
            "material", f"be given for all regions, {listed(regions)}", got=f"none for {listed(missing)}"
        )
    return tuple((name, given[name]) for name in regions)


def _solid(name: str, given: Any) -> Material:
    instance(name, given, Material)
    material: Material = given
    if not LEAST_POISSON <= material.poisson <= MOST_POISSON:
        allowed = f"have a Poisson's ratio from {LEAST_POISSON} to {MOST_POISSON} in a solid"
        raise ArgumentError(name, allowed, material, got=material.poisson)
    return material


def _point(name: str, values: Any) -> tuple[float, float, float]:
    """Return (r, theta, z) with an angle of at most a turn."""
    r, theta, z = _triple(name, values, POSITION)
    return r, within_a_turn(f"{name}[1]", theta), z


def _places(given: Any) -> tuple[tuple[float, float], ...]:
    if isinstance(given, str) or not isinstance(given, Sequence):
        raise ArgumentError("residual_at", "be places (r, z) of the profile", given)
    found = []
    for number, one in enumerate(given):
        name = f"residual_at[{number}]"
        if isinstance(one, str) or not isinstance(one, Sequence) or len(one) != 2:
            raise ArgumentError(name, "be a place (r, z) of the profile", one)
        found.append((finite(f"{name}[0]", one[0]), finite(f"{name}[1]", one[1])))
    return tuple(found)


def _box(place: Any) -> tuple[tuple[float, float], tuple[float, float]]:
    words = "be the name of a place or a box, its range of r and its range of z"
    if not isinstance(place, Sequence) or len(place) != 2:
        raise ArgumentError("place", words, place)
    ranges = []
    for axis, values in zip("rz", place, strict=True):
        if not isinstance(values, Sequence) or isinstance(values, str) or len(values) != 2:
            raise ArgumentError("place", words, place)
        low, high = (finite(f"place, {axis}[{k}]", one) for k, one in enumerate(values))
        if low > high:
            raise ArgumentError("place", "have ranges whose first number is not above the second", place)
        ranges.append((low, high))
    return ranges[0], ranges[1]


def _triple(name: str, values: Any, words: str = "three numbers") -> tuple[float, float, float]:
    if isinstance(values, str) or not isinstance(values, (Sequence, np.ndarray)) or len(values) != 3:
        raise ArgumentError(name, f"be {words}", values)
    x, y, z = (finite(f"{name}[{k}]", one) for k, one in enumerate(values))
    return x, y, z
