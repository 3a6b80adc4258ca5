"""Cards in notebooks: valid HTML, main facts, drawings to scale, no slow computation."""

from __future__ import annotations

import re
from html.parser import HTMLParser

import numpy as np
import pytest

import stridula as st
from stridula.bodies import cards as body_cards
from stridula.cards import MOST_LINES, edges_seen, flattened

STEEL = st.Material(2.1e11, 7800.0)
BEAM = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.01), 0.8, bending_modes=5, axial_modes=2, damping=0.01)
ROD = st.FiniteElementBeam(
    STEEL, st.Circle(0.01), 0.3, np.radians(20.0), name="rod", damping=st.RisingDamping(0.01, 1e-6)
)
PLATE = st.ModalPlate(STEEL, 0.002, 0.6, 0.4, bending_modes=(3, 3))
DISC = st.AxisymmetricBody(
    st.RectangleProfile({"disc": ((0.05, 0.15), (0.0, 0.02))}), STEEL, 2e3, "inner", axis=(0, 1, 0)
)
BLOCK = st.SolidBody.block((0.1, 0.05, 0.02), (4, 2, 2), STEEL, cutoff=2e4, points={"tip": 0})
PAIR = st.ReducedBody([[2.0, 0.0], [0.0, 2.0]], [[8e6, 0.0], [0.0, 2e6]], {"tip": (0, 1)}, damping=0.02)
LUMP = st.RigidBody(1.5, 0.1, {"tip": (0.0, 0.1, 0.0)}, name="<lump>")


class Page(HTMLParser):
    """The facts, the pictures and the balance of tags of a card."""

    def __init__(self, page):
        super().__init__()
        self.open, self.facts, self.boxes, self.paths, self.dots = [], {}, [], [], 0
        self.feed(page)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        if tag == "br":
            self.facts[self.name] += "\n"
            return
        self.open.append(tag)
        if tag == "svg":
            self.boxes.append([float(number) for number in given["viewbox"].split()])

    def handle_startendtag(self, tag, attrs):
        given = dict(attrs)
        if tag == "path":
            assert given["stroke"] == "currentColor"
            self.paths.append(given["d"])
        self.dots += tag == "circle"

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1] == "th":
            self.name = data
            self.facts[data] = ""
        elif self.open[-1] == "td":
            self.facts[self.name] += data

    @property
    def places(self):
        """All places of the paths [px]."""
        found = re.findall(r"(-?[\d.]+) (-?[\d.]+)", " ".join(self.paths))
        return np.array(found, dtype=float).reshape(-1, 2)


def page(thing) -> Page:
    return Page(thing._repr_html_())


@pytest.mark.parametrize(
    "thing", [BEAM, ROD, PLATE, DISC, BLOCK, PAIR, LUMP, st.PointMass(1.0)], ids=lambda one: one.kind
)
def test_cards_are_complete_and_drawings_stay_in_their_box(thing):
    card = page(thing)
    assert set(card.facts) & {"mass", "modes", "size"}
    for x, y, width, height in card.boxes:
        assert (x, y) == (0.0, 0.0)
        assert (card.places >= 0.0).all()
        assert (card.places <= [width, height]).all()
        assert width <= 280.0
        assert height <= 200.0


def test_facts_of_a_beam():
    facts = page(BEAM).facts
    frequency = BEAM.modes().frequency
    assert facts["material"] == "210 GPa, 7800 kg/m³, Poisson's ratio 0.3"
    assert facts["section"] == "rectangle, 0.02 m wide and 0.01 m high"
    assert facts["mass"] == f"{BEAM.total_mass:.4g} kg"
    assert facts["modes"] == f"7 from {frequency.min():.4g} Hz to {frequency.max() / 1e3:.4g} kHz"
    assert facts["damping"] == "0.01 of critical"


def test_facts_of_a_rod_that_leans_and_of_matrices():
    facts = page(ROD).facts
    assert facts["supports"] == "tip free, root guided"
    assert facts["modes"].endswith("; 2 rigid")
    ratios = ROD.modes().damping[2:]
    assert facts["damping"] == f"{ratios.min():.3g} to {ratios.max():.3g} of critical"
    assert page(PAIR).facts == {"modes": "2 from 159.2 Hz to 318.3 Hz", "damping": "0.02 of critical", "points": "tip"}


def test_names_are_text():
    text = LUMP._repr_html_()
    assert "&lt;lump&gt;" in text
    assert "<lump>" not in text


def test_a_rod_is_drawn_as_it_leans():
    (low, high) = page(ROD).places
    # y is downwards on the page.
    assert (high - low) @ [np.cos(ROD.angle), np.sin(ROD.angle)] == pytest.approx(0.0, abs=0.2)
    assert high[0] > low[0]
    assert high[1] < low[1]


def test_cards_do_not_compute_modes_of_large_bodies(monkeypatch):
    def search(*given):
        raise AssertionError("looked for modes")

    fresh = st.SolidBody.block((0.1, 0.05, 0.021), (6, 3, 2), STEEL, cutoff=2e4)
    monkeypatch.setattr("stridula.bodies.solids.solid_body._searched", search)
    facts = page(fresh).facts
    assert facts["modes"] == "found on first use, up to 20 kHz"
    assert "mass" not in facts
    monkeypatch.undo()
    fresh.modes()
    assert page(fresh).facts["modes"].endswith("6 rigid")
    assert page(fresh).facts["mass"] == f"{0.1 * 0.05 * 0.021 * 7800.0:.4g} kg"


def test_the_card_of_a_body_of_revolution_lists_computed_modes():
    turned = st.AxisymmetricBody(DISC.profile, STEEL, 2100.0, "inner", axis=(0, 1, 0))
    assert page(turned).facts["modes"] == "found on first use, up to 2.1 kHz"
    assert page(turned).facts["supports"] == "inner held"
    frequency = turned.modes().frequency
    assert (
        page(turned).facts["modes"]
        == f"{frequency.size} from {frequency.min() / 1e3:.4g} kHz to {frequency.max() / 1e3:.4g} kHz"
    )


def test_only_visible_edges_of_a_block_are_drawn():
    """Nine of twelve edges are visible, cut at the ends of elements; none lies within a face."""
    surface = BLOCK.drawn_at_rest
    edges = edges_seen(surface.place, surface.polygons, surface.normals)
    # Elements have a node in the middle of each edge.
    assert len(edges) == 2 * 3 * (4 + 2 + 2)
    corner = flattened(np.array([0.0, 0.0, 0.0]))
    assert not np.isclose(edges, corner, atol=1e-9).all(axis=2).any()


def test_a_system_in_the_plane_is_drawn_where_it_is():
    system = st.System(st.PointContact(ROD.tip, BEAM, at=0.4, friction=st.Coulomb(0.3)), [st.Force(ROD.root, y=-20.0)])
    card = page(system)
    assert card.dots == 1
    assert "rod: finite-element beam, 0.3 m" in card.facts["bodies"]
    assert card.facts["contacts"].startswith("contact 1: rod on track at 0.4 m, ")
    assert card.facts["contacts"].endswith(", friction 0.3")
    assert card.facts["drives"] == f"rod: {system.drives[0]}"
    assert "connections" not in card.facts
    (left, right), (tip, root) = card.places[2:], card.places[:2]
    if abs(left[1] - right[1]) > 1.0:
        (left, right), (tip, root) = (tip, root), (left, right)
    assert tip == pytest.approx(0.5 * (left + right), abs=0.2)
    assert np.linalg.norm(root - tip) / np.linalg.norm(right - left) == pytest.approx(0.3 / 0.8, rel=5e-3)


def test_a_system_in_space_and_one_of_many_contacts():
    contacts = [
        st.PointContact(BLOCK.at((0.01 * k, 0.0, 0.01)), st.RigidTrack(), name=f"foot {k}") for k in range(1, 10)
    ]
    card = page(st.System(contacts, [st.Gravity()]))
    lines = card.facts["contacts"].split("\n")
    assert lines[0] == "9 in all"
    assert lines[-1] == f"and {10 - MOST_LINES} more"
    assert len(lines) == MOST_LINES + 1
    assert card.dots == 9


def test_masses_on_springs_and_rigid_tracks_have_cards():
    bob = st.PointMass(1.0, name="bob")
    system = st.System(
        st.PointContact(bob.centre, st.RigidTrack(0.1)), connections=[st.Spring(bob.centre, stiffness=1e4)]
    )
    card = page(system)
    assert card.facts["connections"].endswith("from bob to the ground")
    assert "bob on a rigid track" in card.facts["contacts"]
    assert card.dots == 1


@pytest.fixture(scope="module")
def run():
    return st.load_scenario("squeal", {"duration": "20 ms"}).simulate()


def test_the_card_of_a_record_is_that_of_the_command_line(run):
    card = st.card(run)
    assert list(card.facts)[:3] == ["squeals", "pitch", "sound level"]
    assert "st.radiate(run, system)" in card.facts["sound level"]
    assert str(card).splitlines()[0].split(maxsplit=1) == ["squeals", card.facts["squeals"]]
    shown = page(card)
    assert shown.facts == card.facts
    assert len(shown.boxes) == 1
    assert run.attrs["title"] in card._repr_html_()


def test_the_picture_of_a_record_goes_from_the_least_to_the_largest_force(run):
    card = st.card(run)
    assert card.force.min() == run.normal_force.values.min()
    assert card.force.max() == run.normal_force.values.max()
    assert len(card.force) == 240
    still = st.card(run.assign(normal_force=run.normal_force * 0.0 + 5.0))
    assert page(still).boxes == []


def test_a_record_without_samples_has_a_card(run):
    for samples in (0, 1):
        assert not {"squeals", "pitch", "sound level"} & set(st.card(run.isel(time=slice(0, samples))).facts)


@pytest.mark.parametrize("wrong", [None, "run.nc", 3.0])
def test_other_datasets_have_no_card(wrong):
    with pytest.raises(ValueError, match="run must be a record of simulate"):
        st.card(wrong)


def test_a_record_without_its_numbers_is_refused(run):
    bare = run.copy()
    del bare.attrs["scheme"]
    with pytest.raises(ValueError, match="run must be a record with the attribute scheme"):
        st.card(bare)


def test_every_body_has_a_card():
    kinds = [getattr(st, name) for name in st.__all__ if hasattr(getattr(st, name), "total_mass")]
    assert len(kinds) >= 9
    assert all(issubclass(kind, body_cards.HasCard) for kind in kinds)
