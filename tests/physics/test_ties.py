"""Tied parts against one mesh: frequencies, rigid motions, uniform strains, sliding, losses."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
import scipy.sparse
from scipy.spatial.transform import Rotation

import stridula as st
from stridula.bodies.solids import ties
from stridula.bodies.solids.assembly import _cut
from stridula.bodies.solids.elements import assembled
from stridula.bodies.solids.kinds import KINDS
from stridula.bodies.solids.solid_body import _assembled

STEEL = st.Material(2.1e11, 7800.0, 0.3)
LINING = st.Material(5e9, 2500.0, 0.3)
BEAM = {"lengths": (0.1, 0.03, 0.02), "divisions": (3, 2, 2)}
RIGHT = (0.1, 0.0, 0.0)


def of_kind(mesh, kind):
    """Return a mesh of hexahedra of 20 nodes as one of another kind, with the same groups."""
    given = {"nodes": mesh.nodes, "elements": mesh.elements, "kind": mesh.kind}
    given |= {"volumes": dict(mesh.volumes), "faces": dict(mesh.faces), "node_sets": {}}
    if kind.startswith("tetra"):
        given = _cut(given)
    if not KINDS[kind].middles:
        elements = given["elements"][:, : len(KINDS[kind].corners)]
        used, number = np.unique(elements, return_inverse=True)
        given |= {"nodes": given["nodes"][used], "elements": number.reshape(elements.shape), "kind": kind}
    return st.SolidMesh(**given)


def part_of(mesh, those, random):
    """Return some elements of a mesh, their nodes in random order, with the faces on its surface."""
    used = random.permutation(np.unique(mesh.elements[those]))
    number = np.full(len(mesh.nodes), -1)
    number[used] = np.arange(used.size)
    part = st.SolidMesh(mesh.nodes[used], number[mesh.elements[those]], mesh.kind)
    place = np.full(len(mesh.elements), -1)
    place[those] = np.arange(those.size)
    faces = {name: one[np.isin(one[:, 0], those)] for name, one in mesh.faces.items()}
    faces = {name: np.column_stack([place[one[:, 0]], one[:, 1]]) for name, one in faces.items() if one.size}
    return st.SolidMesh(part.nodes, part.elements, part.kind, faces=faces | {"every": part.outer_faces})


def between(first, second):
    """Return meshes with the faces on their surfaces that coincide as "seam"."""
    found = []
    for mesh, other in ((first, second), (second, first)):
        ours, theirs = (one.nodes[one.face("every").nodes].mean(axis=1) for one in (mesh, other))
        near = scipy.spatial.cKDTree(theirs).query(ours)[0] < 1e-9
        faces = {**mesh.faces, "seam": mesh.faces["every"][near]}
        found.append(st.SolidMesh(mesh.nodes, mesh.elements, mesh.kind, faces=faces))
    return found


def wavy(mesh, random):
    """Return a mesh bent, twisted, turned and shifted at random."""
    x, y, z = mesh.nodes.T
    shift = 0.004 * np.stack([np.sin(40.0 * y + 50.0 * z), np.sin(35.0 * x), np.cos(30.0 * x + 20.0 * y)], axis=1)
    nodes = Rotation.random(random_state=int(random.integers(1000))).apply(mesh.nodes + shift * random.uniform(0.5, 1))
    return st.SolidMesh(nodes, mesh.elements, mesh.kind, faces=mesh.faces)


def elastic(body):
    frequency = body.modes().frequency
    return frequency[(frequency > 0.0) & np.isfinite(frequency)]


def within(mesh, matrix):
    """Return a matrix of all degrees of freedom as one of those that follow no others."""
    onto = scipy.sparse.kron(mesh.shares, scipy.sparse.eye_array(3)).tocsr()[:, np.repeat(mesh.leads, 3)]
    return onto.T @ matrix @ onto


def halves(second, offset=RIGHT, tolerance=None, kinds=("hexahedron20",) * 2, size=(0.1, 0.03, 0.02)):
    """Return a beam of two halves, the second with other divisions, at an offset."""
    first = of_kind(st.SolidMesh.block(**BEAM), kinds[0])
    other = of_kind(st.SolidMesh.block(size, second), kinds[1]).moved(offset)
    return st.SolidMesh.tied({"one": first, "other": other}, [("one/right", "other/left")], tolerance)


@pytest.mark.parametrize("kind", ["tetra", "tetra10", "hexahedron", "hexahedron20"])
@pytest.mark.parametrize("seed", [1, 2])
def test_halves_of_any_mesh_equal_the_whole(kind, seed):
    """Cut along a random, rough seam, the nodes of each half in random order."""
    random = np.random.default_rng(seed)
    whole = wavy(of_kind(st.SolidMesh.block((0.2, 0.03, 0.02), (6, 2, 2)), kind), random)
    along = of_kind(st.SolidMesh.block((0.2, 0.03, 0.02), (6, 2, 2)), kind)
    middle = along.nodes[along.elements].mean(axis=1)[:, 0]
    is_first = middle < 0.1 + 0.02 * random.standard_normal(middle.size)
    is_first = np.where(np.abs(middle - 0.1) < 0.05, is_first, middle < 0.1)
    parts = [part_of(whole, np.flatnonzero(those), random) for those in (is_first, ~is_first)]
    one, other = between(*parts)
    tied = st.SolidMesh.tied({"one": one, "other": other}, [("one/seam", "other/seam")])
    assert tied.leads.sum() == len(whole.nodes)
    assert len(tied.outer_faces) == len(whole.outer_faces)
    bodies = [
        st.SolidBody(mesh, STEEL, fixed=[fixed], cutoff=3e4, linear=kind == "hexahedron")
        for mesh, fixed in ((whole, "left"), (tied, "one/left"))
    ]
    expected, found = (elastic(body) for body in bodies)
    assert len(expected) > 5
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_halves_that_do_not_match_approach_the_whole():
    """A few per mille from the whole on coarse meshes; the error falls with refinement of both halves."""
    exact = elastic(st.SolidBody.block((0.2, 0.03, 0.02), (20, 6, 6), STEEL, fixed=["left"], cutoff=1.2e4))
    wholes = [
        elastic(st.SolidBody.block((0.2, 0.03, 0.02), (8 * k, 2 * k, 2 * k), STEEL, fixed=["left"], cutoff=1.22e4))
        for k in (1, 2)
    ]
    errors = []
    for share, whole in enumerate(wholes, 1):
        first = st.SolidMesh.block((0.1, 0.03, 0.02), (4 * share, 2 * share, 2 * share))
        second = st.SolidMesh.block((0.1, 0.03, 0.02), (4 * share, 3 * share, 3 * share)).moved(RIGHT)
        tied = st.SolidMesh.tied({"one": first, "other": second}, [("one/right", "other/left")])
        found = elastic(st.SolidBody(tied, STEEL, fixed=["one/left"], cutoff=1.22e4))[: len(exact)]
        np.testing.assert_allclose(found, whole[: len(exact)], rtol=4e-3)
        errors.append(np.abs(found / exact - 1.0).max())
    assert errors[1] < 0.25 * errors[0]


def fields(nodes):
    """Return rigid motions and uniform strains, shape (3 nodes, 12)."""
    slopes = np.einsum("ni,jk->nkij", nodes, np.eye(3)).reshape(3 * len(nodes), 9)
    return np.hstack([np.tile(np.eye(3), (len(nodes), 1)), slopes])


CASES = [("hexahedron20", "hexahedron20"), ("tetra10", "hexahedron20"), ("hexahedron", "tetra"), ("tetra10", "tetra10")]


@pytest.mark.parametrize("kinds", CASES, ids="-".join)
@pytest.mark.parametrize("gap", [0.0, 3e-4, -2e-4])
def test_rigid_motions_and_uniform_strains_are_exact(kinds, gap):
    random = np.random.default_rng(7)
    mesh = halves((3, 3, 3), (0.1 + gap, *random.uniform(-2e-4, 2e-4, 2)), kinds=kinds)
    moved = fields(mesh.nodes)
    followed = scipy.sparse.kron(mesh.shares, scipy.sparse.eye_array(3)) @ moved
    np.testing.assert_allclose(followed, moved, atol=1e-13)
    body = st.SolidBody(mesh, STEEL, cutoff=3e4)
    assert (body.modes().frequency[:6] == 0.0).all()
    assert elastic(body)[0] > 1e3
    assert body.total_mass == pytest.approx(2.0 * 0.1 * 0.03 * 0.02 * 7800.0, rel=1e-12)
    own = within(body.mesh, scipy.sparse.kron(_assembled(body)[0], scipy.sparse.eye_array(3)))
    up = np.tile([0.0, 1.0, 0.0], body.mesh.leads.sum())
    assert up @ own @ up == pytest.approx(body.total_mass, rel=1e-12)
    rigid = body.shapes[:, :6]
    largest = np.abs(_assembled(body)[1]).max() * np.abs(rigid).max() ** 2
    assert np.abs(rigid.T @ (_assembled(body)[1] @ rigid)).max() < 1e-12 * largest


def test_shares_of_the_projection_would_strain_rotations(monkeypatch):
    """Negative control: across a gap, nodes that follow their projection do not turn with the face."""
    places = ties.local_places
    monkeypatch.setattr(ties, "local_places", lambda *given: np.clip(places(*given), 0.0, 1.0))
    mesh = halves((3, 3, 3), (0.1003, 0.0, 0.0))
    moved = fields(mesh.nodes)
    assert np.abs(scipy.sparse.kron(mesh.shares, scipy.sparse.eye_array(3)) @ moved - moved).max() > 1e-4


def strained(first, second):
    """Return the error of a bar of two tied halves under tension, relative to its strain in the norm of energy."""
    one, other = (st.SolidMesh.block((0.03, 0.03, 0.02), (2, *sides)) for sides in (first, second))
    mesh = st.SolidMesh.tied({"one": one, "other": other.moved((0.03, 0.0, 0.0))}, [("one/right", "other/left")])
    _, stiffness = _assembled(st.SolidBody(mesh, STEEL))
    exact = mesh.nodes * [1.0, -STEEL.poisson, -STEEL.poisson]
    load = np.zeros((len(mesh.nodes), 3))
    for name, sign in (("one/left", -1.0), ("other/right", 1.0)):
        load[:, 0] += sign * STEEL.young * st.bodies.solids.places.face_mean(mesh, name) * 0.03 * 0.02
    onto = scipy.sparse.kron(mesh.shares, scipy.sparse.eye_array(3)).tocsr()[:, np.repeat(mesh.leads, 3)]
    # Forces left over by the exact state, within the space of the ties.
    left = onto.T @ (stiffness @ exact.ravel() - load.ravel())
    off = np.linalg.lstsq((onto.T @ stiffness @ onto).toarray(), left, rcond=1e-12)[0]
    return np.sqrt(abs(off @ left) / (exact.ravel() @ stiffness @ exact.ravel()))


@pytest.mark.parametrize(("first", "second"), [((2, 2), (4, 4)), ((1, 2), (3, 2)), ((1, 1), (2, 3))])
def test_tension_is_exact_across_faces_that_each_lie_on_one(first, second):
    """Shape functions of the larger face are then among those of the smaller ones."""
    assert strained(first, second) < 1e-9


def test_tension_is_nearly_exact_across_other_faces():
    """Shape functions with a kink within a face are not among those of the face; their share falls with refinement."""
    coarse, fine = strained((2, 2), (3, 3)), strained((4, 4), (6, 6))
    assert 0.01 < coarse < 0.05
    assert fine < 0.75 * coarse


def test_a_pad_on_a_disc_equals_one_mesh():
    layers = {"disc": 0.01, "pad": 0.008}
    whole = st.SolidMesh.sector((0.08, 0.12), (0.0, 1.0), layers, (2, 6, 1))
    disc = st.SolidMesh.sector((0.08, 0.12), (0.0, 1.0), 0.01, (2, 6, 1))
    pad = st.SolidMesh.sector((0.08, 0.12), (0.0, 1.0), 0.008, (2, 6, 1)).moved((0.0, 0.01, 0.0))
    tied = st.SolidMesh.tied({"disc": disc, "pad": pad}, [("disc/top", "pad/bottom")])
    materials = {"disc": STEEL, "pad": LINING}
    one = st.SolidBody(whole, materials, fixed=["bottom"], cutoff=4e4, contact_faces={"top": 4})
    other = st.SolidBody(tied, materials, fixed=["disc/bottom"], cutoff=4e4, contact_faces={"pad/top": 4})
    np.testing.assert_allclose(elastic(other), elastic(one), rtol=1e-9)
    # Compliance at the patches and at a place on the seam, on either side of it.
    for ours, theirs in (("pad/top[2]", "top[2]"), ((0.05, 0.01, 0.0866), (0.05, 0.01, 0.0866))):
        np.testing.assert_allclose(compliance(other, ours), compliance(one, theirs), rtol=1e-6, atol=1e-16)
    assert one.surface(2e3).areas.sum() == pytest.approx(other.surface(2e3).areas.sum(), rel=1e-12)
    assert len(one.drawn.polygons) == len(other.drawn.polygons)


def compliance(body, place):
    """Return the static compliance of a held body at a place [m/N], shape (3, 3)."""
    trace, modes = body.trace(place), body.modes()
    stiffness = np.where(modes.massless, 1.0, modes.angular_frequency**2)
    return trace / stiffness @ trace.T


def test_a_small_pad_on_a_ring_hides_what_it_covers():
    ring = st.SolidMesh.sector((0.08, 0.12), (0.0, 2.0 * np.pi), 0.01, (4, 24, 1))
    pad = st.SolidMesh.sector((0.088, 0.112), (0.2, 1.1), 0.008, (3, 7, 1)).moved((0.0, 0.01, 0.0))
    mesh = st.SolidMesh.tied({"ring": ring, "pad": pad}, [("ring/top", "pad/bottom")])
    outer = len(ring.outer_faces) + len(pad.outer_faces)
    hidden = outer - len(mesh.outer_faces)
    # 21 faces of the pad, and those of the ring whose middles it covers: two of four across and three round.
    assert hidden == 21 + 2 * 3
    body = st.SolidBody(mesh, {"ring": STEEL, "pad": LINING}, cutoff=3e3)
    assert (body.modes().frequency[:6] == 0.0).all()
    shapes = body.shapes.reshape(len(body.mesh.nodes), 3, -1)
    place = (0.1 * np.sin(0.55), 0.01, 0.1 * np.cos(0.55))
    seam = body.trace(place)
    opposite = body.mesh.node_at(place, 5e-3)
    assert np.abs(shapes[opposite] - seam).max() < 0.2 * np.abs(shapes).max()


def blocks(order):
    """Return four blocks round an edge, tied in some order, and the whole."""
    parts = {
        f"{i}{j}": st.SolidMesh.block((0.02, 0.02, 0.02), (2, 2, 2)).moved((0.02 * i, 0.02 * j, 0.0))
        for i in range(2)
        for j in range(2)
    }
    pairs = [("00/right", "10/left"), ("01/right", "11/left"), ("00/top", "01/bottom"), ("10/top", "11/bottom")]
    return st.SolidMesh.tied(parts, [pairs[k] for k in order]), st.SolidMesh.block((0.04, 0.04, 0.02), (4, 4, 2))


@pytest.mark.parametrize("seed", range(4))
def test_parts_round_an_edge_equal_one_mesh(seed):
    """Nodes on the edge follow others that follow, or have several ties."""
    random = np.random.default_rng(seed)
    tied, whole = blocks(random.permutation(4))
    assert tied.leads.sum() == len(whole.nodes)
    np.testing.assert_allclose(elastic(st.SolidBody(tied, STEEL)), elastic(st.SolidBody(whole, STEEL)), rtol=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_parts_round_an_edge_that_do_not_match_turn_rigidly(seed):
    random = np.random.default_rng(seed)
    parts = {
        f"{i}{j}": st.SolidMesh.block((0.02, 0.02, 0.02), random.integers(2, 4, 3).tolist()).moved(
            (0.02 * i, 0.02 * j, 0.0)
        )
        for i in range(2)
        for j in range(2)
    }
    pairs = [("00/right", "10/left"), ("01/right", "11/left"), ("00/top", "01/bottom"), ("10/top", "11/bottom")]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", st.DoubtfulValue)
        mesh = st.SolidMesh.tied(parts, [pairs[k] for k in random.permutation(4)])
    moved = fields(mesh.nodes)
    followed = scipy.sparse.kron(mesh.shares, scipy.sparse.eye_array(3)) @ moved
    np.testing.assert_allclose(followed, moved, atol=1e-12)
    # Nodes that others follow follow none.
    shares = mesh.shares
    assert abs(shares @ shares - shares).max() < 1e-12
    body = st.SolidBody(mesh, STEEL)
    assert (body.modes().frequency[:6] == 0.0).all()
    whole = elastic(st.SolidBody.block((0.04, 0.04, 0.02), (6, 6, 3), STEEL))
    np.testing.assert_allclose(elastic(body)[:6], whole[:6], rtol=0.05)


def test_nodes_that_held_ones_follow_are_held():
    """As in one mesh, if only the following half is named."""
    whole = st.SolidMesh.block((0.2, 0.03, 0.02), (6, 2, 2))
    held = np.flatnonzero((whole.nodes[:, 1] == 0.0) & (whole.nodes[:, 0] > 0.0999))
    one = st.SolidBody(whole.named("held", held), STEEL, fixed=["held"], cutoff=3e4)
    other = st.SolidBody(halves((3, 2, 2)), STEEL, fixed=["other/bottom"], cutoff=3e4)
    np.testing.assert_allclose(elastic(other), elastic(one), rtol=1e-9)


def sliding(body, face, force):
    """Return a body pressed on a moving plane by a force on its top."""
    plane = st.RigidTrack(1.0)
    contact = st.SurfaceContact(body, face, plane, friction=st.Coulomb(0.5), stiffness=1e12, name="rub")
    return st.System(contact, [st.Force(body.at("push"), y=force)])


def layered(matching):
    """Return a pad of a plate on a lining as one mesh, or tied, held at its back."""
    materials = {"lining": LINING, "plate": STEEL}
    whole = st.SolidMesh.block((0.04, 0.015, 0.02), (4, 3, 2))
    height = whole.nodes[whole.elements].mean(axis=1)[:, 1]
    volumes = {"lining": np.flatnonzero(height < 0.01), "plate": np.flatnonzero(height > 0.01)}
    whole = st.SolidMesh(whole.nodes, whole.elements, whole.kind, volumes=volumes, faces=whole.faces)
    lining = st.SolidMesh.block((0.04, 0.01, 0.02), (4, 2, 2) if matching else (6, 3, 3))
    plate = st.SolidMesh.block((0.04, 0.005, 0.02), (4, 1, 2)).moved((0.0, 0.01, 0.0))
    tied = st.SolidMesh.tied({"plate": plate, "lining": lining}, [("plate/bottom", "lining/top")])
    common = {"points": {"push": (0.02, 0.015, 0.01)}, "cutoff": 4e4, "damping": 0.01}
    one = st.SolidBody(whole, materials, fixed={"left": "xz"}, contact_faces={"bottom": 6}, **common)
    held = {"plate/left": "xz", "lining/left": "xz"}
    other = st.SolidBody(tied, materials, fixed=held, contact_faces={"lining/bottom": 6}, **common)
    return one, other


def test_tied_bodies_slide_as_one_mesh():
    one, other = layered(matching=True)
    theories = [st.sliding_stability(sliding(*given, -500.0)) for given in ((one, "bottom"), (other, "lining/bottom"))]
    frequencies, growths = ([theory[name].values for theory in theories] for name in ("frequency", "growth_rate"))
    np.testing.assert_allclose(frequencies[1][:8], frequencies[0][:8], rtol=1e-5)
    np.testing.assert_allclose(growths[1][:8], growths[0][:8], rtol=1e-3)
    runs = [st.simulate(sliding(*given, -500.0), 5e-4) for given in ((one, "bottom"), (other, "lining/bottom"))]
    forces = [run.normal_force.values for run in runs]
    assert forces[0].max() > 100.0
    np.testing.assert_allclose(forces[1], forces[0], rtol=1e-4, atol=0.01)


def test_a_tied_body_that_does_not_match_slides_nearly_as_one_mesh():
    one, other = layered(matching=False)
    theories = [st.sliding_stability(sliding(*given, -500.0)) for given in ((one, "bottom"), (other, "lining/bottom"))]
    first, second = (theory.frequency.values[theory.frequency.values > 0.0][:4] for theory in theories)
    np.testing.assert_allclose(second, first, rtol=0.02)


def test_a_shim_damps_by_its_share_of_the_strain_energy():
    """Half the loss factors weighted by strain energies, from the stiffness of each part alone."""
    materials = {
        "plate": STEEL,
        "shim": st.Material(5e8, 1300.0, 0.4, loss_factor=0.3),
        "lining": st.Material(5e9, 2500.0, 0.3, loss_factor=0.02),
    }
    plate = st.SolidMesh.block((0.06, 0.02, 0.004), (6, 2, 1)).moved((0.0, 0.0, 0.0105))
    shim = st.SolidMesh.block((0.06, 0.02, 0.0005), (8, 3, 1)).moved((0.0, 0.0, 0.01))
    lining = st.SolidMesh.block((0.06, 0.02, 0.01), (5, 2, 2))
    mesh = st.SolidMesh.tied(
        {"plate": plate, "shim": shim, "lining": lining}, [("plate/back", "shim/front"), ("lining/front", "shim/back")]
    )
    body = st.SolidBody(mesh, materials, fixed=["plate/left"], cutoff=2e4, residual_flexibility=False)
    modes = body.modes()
    mesh = body.mesh
    energy = {
        name: (body.shapes * (assembled(mesh.element_kind, mesh.nodes, mesh.elements, [part])[1] @ body.shapes)).sum(0)
        for name, part in {name: (one, mesh.volumes[name]) for name, one in materials.items()}.items()
    }
    np.testing.assert_allclose(sum(energy.values()), modes.angular_frequency**2, rtol=1e-6)
    lost = sum(materials[name].loss_factor * one for name, one in energy.items()) / modes.angular_frequency**2
    assert lost.size > 4
    np.testing.assert_allclose(modes.damping_rate / (2.0 * modes.angular_frequency), 0.5 * lost, rtol=1e-6)
    assert lost.max() > 0.05
    assert lost.min() < 0.8 * lost.max()
