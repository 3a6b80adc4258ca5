"""Bodies meshed in space against closed forms, published results and dense algebra."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize
import scipy.sparse

import stridula as st
from stridula.bodies.reduction.sparse_reduction import SparseProblem, reduce_sparse
from stridula.bodies.solids.elements import assembled
from stridula.bodies.solids.kinds import KINDS
from stridula.bodies.solids.solid_body import _assembled

STEEL = st.Material(2.1e11, 7800.0, 0.3)
SMALL = {"mesh": st.SolidMesh.block((0.1, 0.03, 0.02), (4, 2, 1)), "materials": STEEL}
CORNERS = {"corner": (0.1, 0.03, 0.02), "edge": (0.05, 0.0, 0.02)}


def matrices(body):
    """Return dense mass and stiffness of all nodes."""
    mass, stiffness = _assembled(body)
    return np.kron(mass.toarray(), np.eye(3)), stiffness.toarray()


def elastic(body):
    frequency = body.modes().frequency
    return frequency[(frequency > 0.0) & np.isfinite(frequency)]


def test_simply_supported_plate_of_nafems():
    """FV52 on 4 x 4 x 1 hexahedra of 20 nodes: the ratios to the closed forms that OptiStruct publishes, to the digit.

    Line supports do not hold a solid: the bending modes fall without limit as the mesh is refined, so that the mesh is
    part of the case.
    """
    mesh = st.SolidMesh.block((10.0, 10.0, 1.0), (4, 4, 1))
    x, y, z = mesh.nodes.T
    edges = np.flatnonzero((z == 0.0) & ((x == 0.0) | (x == 10.0) | (y == 0.0) | (y == 10.0)))
    body = st.SolidBody(mesh.named("edges", edges), st.Material(2e11, 8000.0, 0.3), fixed={"edges": "z"}, cutoff=210.0)
    assert (body.modes().frequency[:3] == 0.0).all()
    expected = np.array([45.897, 109.44, 109.44, 167.89, 193.59, 206.19, 206.19])
    ratios = [0.9760, 1.0101, 1.0101, 1.0072, 1.0017, 1.0022, 1.0022]
    np.testing.assert_allclose(elastic(body) / expected, ratios, atol=0.5e-4 + 0.005 / 45.897)


BAR = st.SolidBody(
    st.SolidMesh.block((0.4, 0.02, 0.01), (30, 4, 3)), STEEL, points={"end": (0.4, 0.02, 0.01)}, cutoff=15e3
)


def timoshenko(length, width, height, material, count):
    """Natural frequencies [Hz] of a free-free beam with shear (Cowper's coefficient) and rotatory inertia."""
    area, second = width * height, width * height**3 / 12.0
    nu = material.poisson
    shear = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu) * material.young / (2.0 * (1.0 + nu))
    rigidity, mass, rotatory = material.young * second, material.density * area, material.density * second

    def state(frequency):
        w = 2.0 * np.pi * frequency
        # w' = phi + Q / kGA, phi' = M / EI, M' = -rho I w² phi - Q, Q' = -rho A w² w
        system = np.array(
            [
                [0.0, 1.0, 0.0, 1.0 / (shear * area)],
                [0.0, 0.0, 1.0 / rigidity, 0.0],
                [0.0, -rotatory * w**2, 0.0, -1.0],
                [-mass * w**2, 0.0, 0.0, 0.0],
            ]
        )
        scale = np.array([1.0, 1.0 / length, rigidity / length**2, rigidity / length**3])
        ends = scipy.linalg.expm(system / scale[:, None] * scale[None] * length)
        return np.linalg.det(ends[2:, :2])

    first = 4.73004**2 / (2.0 * np.pi * length**2) * np.sqrt(rigidity / mass)
    grid = np.arange(0.5 * first, 60.0 * first, 0.1 * first)
    signs = [state(f) for f in grid]
    roots = [
        scipy.optimize.brentq(state, low, high)
        for low, high, one, other in zip(grid, grid[1:], signs, signs[1:], strict=False)
        if one * other < 0.0
    ]
    return np.array(roots[:count])


def shapes_of(body):
    return body.shapes[:, : body.modes().count].reshape(len(body.mesh.nodes), 3, -1)


@pytest.mark.parametrize(("direction", "sides"), [(2, (0.02, 0.01)), (1, (0.01, 0.02))], ids=["thin", "wide"])
def test_bar_bends_as_timoshenkos(direction, sides):
    """To (b / L)², width over length squared: Cowper's coefficient is of narrow sections."""
    frequency = BAR.modes().frequency
    kinetic = np.array([np.abs(shapes_of(BAR)[:, d]).mean(axis=0) for d in range(3)])
    own = (kinetic.argmax(axis=0) == direction) & (frequency > 0.0) & np.isfinite(frequency)
    expected = timoshenko(0.4, *sides, STEEL, 3)
    bending = frequency[own]
    nearest = np.array([bending[np.argmin(np.abs(bending - f))] for f in expected])
    np.testing.assert_allclose(nearest, expected, rtol=(0.02 / 0.4) ** 2)


def test_bar_stretches():
    """The first axial mode, with Rayleigh's correction for the inertia of the sides, ``(nu pi r / L)² / 2``."""
    frequency = BAR.modes().frequency
    shapes = shapes_of(BAR)
    along = np.abs(shapes[:, 0]).mean(axis=0) > 3.0 * np.abs(shapes[:, 1:]).mean(axis=(0, 1))
    own = frequency[along & (frequency > 0.0) & np.isfinite(frequency)]
    bar = 0.5 / 0.4 * np.sqrt(STEEL.young / STEEL.density)
    polar = (0.02**2 + 0.01**2) / 12.0
    lowered = bar * (1.0 - 0.5 * (STEEL.poisson * np.pi / 0.4) ** 2 * polar)
    np.testing.assert_allclose(own[0], lowered, rtol=1e-5)


def test_bar_twists():
    """The first mode of torsion: Saint-Venant's stiffness; warping adds less than (b / L)² = 0.25 %."""
    a, b = 0.02, 0.01
    odd = np.arange(1, 200, 2)
    stiff = a * b**3 / 3.0 * (1.0 - 192.0 * b / (np.pi**5 * a) * np.sum(np.tanh(odd * np.pi * a / (2 * b)) / odd**5))
    shear = STEEL.young / (2.0 * (1.0 + STEEL.poisson))
    polar = a * b * (a**2 + b**2) / 12.0
    expected = 0.5 / 0.4 * np.sqrt(shear * stiff / (STEEL.density * polar))
    frequency = elastic(BAR)
    assert np.min(np.abs(frequency / expected - 1.0)) < 2.5e-3


def test_free_body_has_six_zeros_and_its_mass():
    body = st.SolidBody(**SMALL, cutoff=60e3)
    modes = body.modes()
    assert (modes.angular_frequency[:6] == 0.0).all()
    assert modes.angular_frequency[6] > 1e3
    assert body.total_mass == pytest.approx(0.1 * 0.03 * 0.02 * 7800.0, rel=1e-12)
    # Rigid modes carry all of the mass, in each direction; elastic ones none.
    np.testing.assert_allclose(modes.translation @ modes.translation.T, body.total_mass * np.eye(3), atol=1e-9)
    assert np.abs(modes.translation[:, 6:]).max() < 1e-9
    assert modes.translation.shape == (3, modes.count)


def test_translation_moves_every_point_alike():
    body = st.SolidBody(**SMALL, points=CORNERS, cutoff=60e3)
    for direction in range(3):
        speeds = np.zeros((len(body.mesh.nodes), 3))
        speeds[:, direction] = 2.0
        start = body.modal_coordinates(speeds)
        for point in CORNERS:
            np.testing.assert_allclose(body.trace(point) @ start, 2.0 * np.eye(3)[direction], atol=1e-12)


@pytest.mark.parametrize("kind", list(KINDS))
def test_uniform_strain_of_distorted_elements_is_exact(kind):
    """Patch test: forces of the linear displacement sum to stress times area, and inner nodes carry none."""
    mesh = patch(kind)
    material = st.Material(1.0, 1.0, 0.3)
    every = np.arange(len(mesh.elements))
    _, stiffness = assembled(mesh.element_kind, mesh.nodes, mesh.elements, [(material, every)])
    gradient = np.array([[0.3, -0.2, 0.1], [0.5, 0.1, -0.4], [0.2, 0.6, -0.1]])
    strain = 0.5 * (gradient + gradient.T)
    shear, stretch = 1.0 / 2.6, 0.3 / (1.3 * 0.4)
    stress = 2.0 * shear * strain + stretch * np.trace(strain) * np.eye(3)
    forces = (stiffness @ (mesh.nodes @ gradient.T).ravel()).reshape(-1, 3)
    inside = (np.abs(mesh.nodes - 0.5) < 0.5 - 1e-12).all(axis=1)
    assert inside.any()
    assert np.abs(forces[inside]).max() < 1e-13
    right = mesh.nodes[:, 0] > 1.0 - 1e-12
    np.testing.assert_allclose(forces[right].sum(axis=0), stress[:, 0], atol=1e-12)


def patch(kind):
    """Return the unit cube in 2 x 2 x 2 cells, the middle node shifted, in elements of a kind with straight edges."""
    cube = st.SolidMesh.block((1.0, 1.0, 1.0), (2, 2, 2))
    nodes, corners = cube.nodes[:27], cube.elements[:, :8]
    middle = int(np.flatnonzero((nodes == 0.5).all(axis=1))[0])
    nodes = nodes.copy()
    nodes[middle] += [0.11, -0.07, 0.13]
    if kind.startswith("tetra"):
        cuts = np.array([[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]])
        mesh = st.SolidMesh(nodes, corners[:, cuts].reshape(-1, 4), "tetra")
    else:
        mesh = st.SolidMesh(nodes, corners, "hexahedron")
    if kind in ("tetra", "hexahedron"):
        return mesh
    mesh = mesh.quadratic()
    return mesh if kind != "hexahedron27" else of_27_nodes(mesh)


def of_27_nodes(mesh):
    """Return a mesh of straight hexahedra of 20 nodes and further nodes in the middle of faces and elements."""
    kind = mesh.element_kind
    faces = mesh.elements[:, np.array(kind.faces)]
    keys, number = np.unique(np.sort(faces.reshape(-1, 4), axis=1), axis=0, return_inverse=True)
    count = len(mesh.nodes)
    middles = mesh.nodes[keys].mean(axis=1)
    centres = mesh.nodes[mesh.elements[:, :8]].mean(axis=1)
    elements = np.column_stack(
        [
            mesh.elements,
            count + number.reshape(len(mesh.elements), 6),
            count + len(keys) + np.arange(len(mesh.elements)),
        ]
    )
    return st.SolidMesh(np.vstack([mesh.nodes, middles, centres]), elements, "hexahedron27")


@pytest.mark.parametrize("kind", list(KINDS))
def test_kinds_of_elements_agree(kind):
    """A cube held at one end: quadratic kinds to 1 %, linear ones are stiffer, never softer."""
    mesh = patch(kind)
    held = mesh.named("held", np.flatnonzero(mesh.nodes[:, 0] == 0.0))
    first = elastic(st.SolidBody(held, st.Material(1.0, 1.0, 0.3), fixed=["held"], linear=True))[0]
    fine = st.SolidMesh.block((1.0, 1.0, 1.0), (5, 5, 5))
    expected = elastic(st.SolidBody(fine, st.Material(1.0, 1.0, 0.3), fixed=["left"], cutoff=0.2))[0]
    assert expected * (1.0 - 1e-6) < first < expected * (1.05 if mesh.element_kind.middles else 1.6)


HELD = {"free": (), "held": ("left",), "on rollers": {"left": "x"}}


@pytest.mark.parametrize("fixed", list(HELD.values()), ids=list(HELD))
def test_static_displacements_at_points_are_those_of_a_direct_solve(fixed):
    """Kept modes and residual shapes together give the inverse of the stiffness, with inertia relief."""
    body = st.SolidBody(**SMALL, points=CORNERS, fixed=fixed, cutoff=30e3)
    modes = body.modes()
    mass, stiffness = matrices(body)
    free = body._free
    mass, stiffness = mass[np.ix_(free, free)], stiffness[np.ix_(free, free)]
    squared, shapes = scipy.linalg.eigh(stiffness, mass)
    rigid = int((modes.angular_frequency == 0.0).sum())
    assert rigid == {"free": 6, "held": 0, "on rollers": 3}[next(k for k, v in HELD.items() if v is fixed)]
    elastic_shapes = shapes[:, rigid:] / np.sqrt(squared[rigid:])
    rows = np.zeros((6, free.size))
    for number, point in enumerate(CORNERS):
        node = body.points[point]
        rows[3 * number + np.arange(3), 3 * node + np.arange(3)] = 1.0
    expected = rows[:, free] @ elastic_shapes
    expected = expected @ expected.T
    traces = np.vstack([body.trace(point) for point in CORNERS])[:, rigid:]
    found = traces / modes.stiffness[rigid:] @ traces.T
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())
    # Also under its own weight.
    weight = np.tile(np.eye(3), (free.size // 3, 1))[free]
    sag = rows[:, free] @ elastic_shapes @ (elastic_shapes.T @ (mass @ weight))
    if not rigid:
        full, _ = matrices(body)
        sag = (
            rows[:, free] @ elastic_shapes @ (elastic_shapes.T @ (full @ np.tile(np.eye(3), (free.size // 3, 1)))[free])
        )
        found = traces / modes.stiffness @ modes.translation.T
        np.testing.assert_allclose(found, sag, atol=1e-9 * np.abs(sag).max())


def test_without_residual_shapes_points_are_too_stiff():
    """Negative control."""
    stiff, soft = (
        st.SolidBody(**SMALL, points=CORNERS, fixed=["left"], cutoff=30e3, residual_flexibility=flag)
        for flag in (False, True)
    )
    assert not stiff.modes().massless.any()
    rows = [body.trace("corner") for body in (stiff, soft)]
    compliance = [row / body.modes().stiffness @ row.T for row, body in zip(rows, (stiff, soft), strict=True)]
    assert compliance[0][0, 0] < 0.9 * compliance[1][0, 0]


@pytest.mark.parametrize("fixed", list(HELD.values()), ids=list(HELD))
def test_residual_shapes_have_unit_stiffness_and_no_mass(fixed):
    body = st.SolidBody(**SMALL, points=CORNERS, fixed=fixed, cutoff=30e3)
    mass, stiffness = matrices(body)
    massless = body.modes().massless
    residual, kept = body.shapes[:, massless], body.shapes[:, ~massless]
    np.testing.assert_allclose(residual.T @ stiffness @ residual, np.eye(massless.sum()), atol=1e-10)
    sizes = np.sqrt(np.sum(residual * (mass @ residual), axis=0))
    assert np.abs(kept.T @ mass @ residual / sizes).max() < 1e-10
    np.testing.assert_allclose(kept.T @ mass @ kept, np.eye(kept.shape[1]), atol=1e-10)


@pytest.mark.parametrize("fixed", list(HELD.values()), ids=list(HELD))
def test_sparse_and_dense_reductions_agree(fixed):
    """Rounding of a dense eigenproblem is 10 eps of its largest eigenvalue: see tests/unit/test_reduced_body.py."""
    mesh = st.SolidMesh.block((0.1, 0.03, 0.02), (8, 3, 2))
    body = st.SolidBody(mesh, STEEL, fixed=fixed, cutoff=60e3)
    mass, stiffness = (matrix[np.ix_(body._free, body._free)] for matrix in matrices(body))
    assert len(mass) > 600
    squared = scipy.linalg.eigh(stiffness, mass, eigvals_only=True)
    squared = squared[squared < (2.0 * np.pi * 60e3) ** 2]
    found = body.modes().angular_frequency
    found = found[np.isfinite(found)]
    rounding = 10.0 * np.finfo(float).eps * np.max(np.diag(stiffness) / np.diag(mass)) * 10.0
    np.testing.assert_allclose(found**2, squared, rtol=1e-9, atol=rounding)


def test_equal_frequencies_are_all_found():
    """A square bar has pairs of bending modes; and eight equal chains have each frequency eight times."""
    chain = scipy.sparse.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(150, 150))
    stiffness = scipy.sparse.kron(scipy.sparse.eye_array(8), chain, format="csr")
    mass = scipy.sparse.eye_array(1200, format="csr")
    found = reduce_sparse(SparseProblem(mass, stiffness, np.zeros((1200, 0))), 0.03)
    one = 2.0 * np.sin(np.arange(1, 151) * np.pi / 302.0)
    expected = np.repeat(one[one < 0.06 * np.pi], 8)
    assert found.angular_frequency.size == expected.size > 60
    np.testing.assert_allclose(found.angular_frequency, expected, rtol=1e-9)


def test_ring_has_pairs_and_its_closed_form():
    """In-plane bending of a thin free ring, ``w² = E I n² (n² - 1)² / (rho A R⁴ (n² + 1))``.

    Shear and rotatory inertia lower w by a share of at most ``n² (h / R)² (1 + E / k G) / 24``.
    """
    mesh = st.SolidMesh.sector((0.0975, 0.1025), (0.0, 2.0 * np.pi), 0.005, (1, 96, 1), axis="y")
    frequency = elastic(st.SolidBody(mesh, STEEL, cutoff=1000.0))
    for n in (2, 3):
        inertia = 0.005**2 / 12.0
        squared = STEEL.young / STEEL.density * inertia * (n * (n**2 - 1)) ** 2 / (0.1**4 * (n**2 + 1))
        expected = np.sqrt(squared) / (2.0 * np.pi)
        lowered = n**2 * (0.005 / 0.1) ** 2 * (1.0 + 2.6 / (5.0 / 6.0)) / 24.0
        inside = (frequency > expected * (1.0 - lowered)) & (frequency < expected)
        assert inside.sum() == 2
        assert np.ptp(frequency[inside]) < 1e-6 * expected


def test_two_materials_in_a_row_stretch_as_two_springs():
    """A bar of a soft and a stiff half without Poisson's ratio, held and pulled: lengths over stiffnesses add."""
    mesh = st.SolidMesh.block((0.2, 0.01, 0.01), (4, 1, 1))
    x = mesh.nodes[mesh.elements].mean(axis=1)[:, 0]
    halves = {"soft": np.flatnonzero(x < 0.1), "stiff": np.flatnonzero(x > 0.1)}
    mesh = st.SolidMesh(mesh.nodes, mesh.elements, mesh.kind, halves, mesh.faces)
    soft, stiff = st.Material(1e9, 1000.0, 0.0), st.Material(4e9, 3000.0, 0.0)
    body = st.SolidBody(mesh, {"soft": soft, "stiff": stiff}, fixed=["left"])
    assert body.total_mass == pytest.approx(1e-5 * (1000.0 + 3000.0), rel=1e-12)
    modes = body.modes()
    pulled = body.face("right")
    nodes = np.unique(pulled.nodes)
    # Consistent shares of a pull along x on a face of 8 nodes: -1/12 at corners, 1/3 at middles.
    corner = np.isin(nodes, pulled.nodes[:, :4])
    pull = np.where(corner, -1.0 / 12.0, 1.0 / 3.0)
    rows = body.shapes[3 * nodes]
    stretch = (rows / modes.stiffness) @ (rows.T @ pull)
    np.testing.assert_allclose(stretch, 0.1 / (1e9 * 1e-4) + 0.1 / (4e9 * 1e-4), rtol=1e-9)
