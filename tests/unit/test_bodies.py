"""Bodies, sections and materials: properties and refused arguments."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from stridula.bodies.beams_and_plates.finite_elements import element_mass
from stridula.checks import at_least

STEEL = st.Material(2.1e11, 7800.0)
STRIP = st.Rectangle(0.020, 0.004)
NAN, INF = float("nan"), float("inf")


def beam(**changes):
    words = {"material": STEEL, "section": STRIP, "length": 0.5, "elements": 4} | changes
    return st.FiniteElementBeam(**words)


def bar(**changes):
    words = {"material": STEEL, "section": STRIP, "length": 0.8, "bending_modes": 5, "axial_modes": 3} | changes
    return st.ModalBeam(**words)


def sheet(**changes):
    words = {"material": STEEL, "thickness": 0.002, "length": 0.4, "width": 0.3, "bending_modes": (4, 3)} | changes
    return st.ModalPlate(**words)


POSITIVE = [NAN, INF, -INF, -1.0, 0.0, True, "1", None, [1.0], 1j]
MAKERS = {
    "Material.young": (lambda v: st.Material(v, 7800.0), "young", POSITIVE),
    "Material.density": (lambda v: st.Material(2.1e11, v), "density", POSITIVE),
    "Material.poisson": (lambda v: st.Material(2.1e11, 7800.0, v), "poisson", [NAN, INF, -1.0, 0.5, "1", None]),
    "Line.origin": (lambda v: st.Line(v), "origin", [0.1, (0.1,), (0.1, 0.2, 0.3), None, "ab", (0.1, NAN)]),
    "Line.direction": (lambda v: st.Line((0.1, 0.1), v), "direction", [NAN, INF, 7.0, "1", None]),
    "ModalPlate.material": (lambda v: sheet(material=v), "material", [None, 1.0, "steel", STRIP]),
    "ModalPlate.thickness": (lambda v: sheet(thickness=v), "thickness", POSITIVE),
    "ModalPlate.length": (lambda v: sheet(length=v), "length", POSITIVE),
    "ModalPlate.width": (lambda v: sheet(width=v), "width", POSITIVE),
    "ModalPlate.bending_modes": (
        lambda v: sheet(bending_modes=v),
        "bending_modes",
        [None, 5, (5,), (5, 0), (5, 1.5), (True, 2), "ab"],
    ),
    "ModalPlate.damping": (lambda v: sheet(damping=v), "damping", [NAN, INF, -0.1, 1.0, "1", None]),
    "ModalPlate.cutoff": (lambda v: sheet(cutoff=v), "cutoff", [NAN, INF, -1.0, 0.0, 85.0, "1"]),
    "ModalPlate.line": (
        lambda v: sheet(line=v),
        "line",
        [0.1, (0.1, 0.1), st.Line((0.5, 0.1)), st.Line((0.1, 0.0)), st.Line((0.0, 0.0), 2.0), st.Line((0.0, 0.3), 0.8)],
    ),
    "ModalPlate.name": (lambda v: sheet(name=v), "name", [None, 1]),
    "ModalPlate.in_plane": (lambda v: sheet(in_plane=v), "in_plane", [None, 1, "true", (2, 2)]),
    "ModalPlate.in_plane_modes": (
        lambda v: sheet(in_plane_modes=v),
        "in_plane_modes",
        [None, 5, (5,), (0, 0), (-1, 2), (5, 1.5), (True, 2), "ab"],
    ),
    "ModalPlate.cutoff in the plane": (lambda v: sheet(in_plane=True, cutoff=v), "cutoff", [86.0, 6.7e3]),
    "ModalPlate.at": (lambda v: sheet().at(v), "position", [-0.1, 0.41, NAN, "centre", None, (0.1, 0.31), (0.1,)]),
    "Section.area": (lambda v: st.Section(v, 1e-9), "area", POSITIVE),
    "Section.second_moment": (lambda v: st.Section(1e-4, v), "second_moment", POSITIVE),
    "Rectangle.width": (lambda v: st.Rectangle(v, 0.01), "width", POSITIVE),
    "Rectangle.height": (lambda v: st.Rectangle(0.01, v), "height", POSITIVE),
    "Circle.diameter": (lambda v: st.Circle(v), "diameter", POSITIVE),
    "FiniteElementBeam.material": (lambda v: beam(material=v), "material", [None, 1.0, "steel", STRIP]),
    "FiniteElementBeam.section": (lambda v: beam(section=v), "section", [None, 1.0, "round", STEEL]),
    "FiniteElementBeam.length": (lambda v: beam(length=v), "length", POSITIVE),
    "FiniteElementBeam.angle": (
        lambda v: beam(angle=v),
        "angle",
        [NAN, INF, np.pi / 2, -np.pi / 2, 45.0, True, "45 deg", None],
    ),
    "FiniteElementBeam.elements": (lambda v: beam(elements=v), "elements", [0, -1, 1.0, 2.5, NAN, True, "4", None]),
    "FiniteElementBeam.damping": (lambda v: beam(damping=v), "damping", [NAN, INF, -0.01, 1.0, 2.0, True, "0", None]),
    "FiniteElementBeam.root_support": (
        lambda v: beam(root_support=v),
        "root_support",
        ["fixed", "", None, 1, "Guided"],
    ),
    "FiniteElementBeam.tip_support": (lambda v: beam(tip_support=v), "tip_support", ["fixed", "", None, 1]),
    "FiniteElementBeam.mass": (lambda v: beam(mass=v), "mass", ["full", None, 0.3]),
    "FiniteElementBeam.cutoff": (lambda v: beam(cutoff=v), "cutoff", [v for v in POSITIVE if v is not None]),
    "FiniteElementBeam.at": (lambda v: beam().at(v), "position", [NAN, INF, -1e-9, 0.5001, True, "tip", None]),
    "FiniteElementBeam.trace": (lambda v: beam().trace(v), "position", [NAN, INF, -1e-9, 0.5001, True, "tip", None]),
    "ModalBeam.material": (lambda v: bar(material=v), "material", [None, 1.0, "steel", STRIP]),
    "ModalBeam.section": (lambda v: bar(section=v), "section", [None, 1.0, "round", STEEL]),
    "ModalBeam.length": (lambda v: bar(length=v), "length", POSITIVE),
    "ModalBeam.bending_modes": (lambda v: bar(bending_modes=v), "bending_modes", [0, -1, 1.0, NAN, True, "4", None]),
    "ModalBeam.axial_modes": (lambda v: bar(axial_modes=v), "axial_modes", [-1, 1.0, NAN, True, "4", None]),
    "ModalBeam.damping": (lambda v: bar(damping=v), "damping", [NAN, INF, -0.01, 1.0, 2.0, True, "0", None]),
    "ModalBeam.cutoff": (lambda v: bar(cutoff=v), "cutoff", [*(v for v in POSITIVE if v is not None), 1.0]),
    "ModalBeam.tension": (lambda v: bar(tension=v), "tension", [NAN, INF, -1e-9, True, "700 N", None]),
    "ModalBeam.at": (lambda v: bar().at(v), "position", [NAN, INF, -1e-9, 0.8001, True, "centre", None]),
    "ModalBeam.trace": (lambda v: bar().trace(v), "position", [NAN, INF, -1e-9, 0.8001, True, "centre", None]),
    "BodyPoint.position": (lambda v: st.BodyPoint(beam(), v), "position", [NAN, INF, -1e-9, 0.5001, True, "tip", None]),
    "BodyPoint.body": (lambda v: st.BodyPoint(v, 0.0), "body", [None, 1.0, "slider", STEEL]),
}
CASES = [pytest.param(*rest[:2], v, id=f"{k}={v!r}"[:60]) for k, rest in MAKERS.items() for v in rest[2]]


@pytest.mark.parametrize(("make", "name", "value"), CASES)
def test_bad_arguments_are_named_with_value_and_range(make, name, value):
    with pytest.raises(ValueError, match=rf"^{name} must ") as caught:
        make(value)
    message = str(caught.value)
    assert repr(value) in message
    assert "\n" not in message


@pytest.mark.parametrize("mass", [5e-324, 1e-320, 1e-101])
def test_a_mass_too_small_for_arithmetic_is_refused(mass):
    with pytest.raises(ValueError, match=rf"^mass must be at least 1e-100, got {mass!r}$"):
        st.PointMass(mass)
    assert st.PointMass(1e-100).mass == 1e-100


def test_a_body_without_modes_is_reported_when_modes_are_requested():
    with pytest.raises(ValueError, match="cutoff must leave at least one mode"):
        beam(root_support="clamped", cutoff=1.0).modes()


def test_misspelt_support_suggests_the_nearest():
    with pytest.raises(ValueError, match="did you mean 'clamped'"):
        beam(root_support="clampd")


def test_sections():
    assert STRIP.area == pytest.approx(8e-5)
    assert STRIP.second_moment == pytest.approx(0.020 * 0.004**3 / 12)
    assert st.Circle(0.01).area == pytest.approx(np.pi * 0.005**2)
    assert st.Circle(0.01).second_moment == pytest.approx(np.pi * 0.005**4 / 4)


def test_descriptions_are_frozen_hashable_and_equal_by_value():
    for thing in (STEEL, STRIP, beam(), bar(), beam().tip, st.Coulomb(0.3)):
        assert hash(thing) == hash(replace(thing))
        assert thing == replace(thing)
        with pytest.raises(AttributeError):
            thing.anything = 1
        field = next(iter(thing.__dataclass_fields__))
        with pytest.raises(AttributeError):
            setattr(thing, field, getattr(thing, field))


@pytest.mark.parametrize("angle", [-1.2, 0.0, 0.5])
def test_axes_follow_the_convention(angle):
    """e1 = (sin a, cos a) from tip to root, t1 = (cos a, -sin a)."""
    along, across = beam(angle=angle).axes
    np.testing.assert_allclose(along, [np.sin(angle), np.cos(angle)])
    np.testing.assert_allclose(across, [np.cos(angle), -np.sin(angle)])
    np.testing.assert_array_equal(bar().axes, [[1, 0], [0, 1]])


@pytest.mark.parametrize("angle", [-1.2, 0.0, 0.5])
def test_rigid_motions_of_a_free_beam_have_the_right_signs(angle):
    """All modes together resolve a translation along x, one along y and a turn: each is reproduced at every point.

    Least squares on traces at the ends finds the modal coordinates of a rigid motion, which must then hold inside.
    """
    body = beam(angle=angle, root_support="free")
    rigid = body.modes().frequency == 0
    assert rigid.sum() == 3
    inside = [0.0, 0.11, 0.3, 0.5]
    rows = np.vstack([body.trace(s)[:, rigid] for s in inside])
    motions = {
        "x": np.tile([1.0, 0.0], 4),
        "y": np.tile([0.0, 1.0], 4),
        "turn": np.concatenate([(s - 0.25) * body.axes[1] for s in inside]),
    }
    for name, wanted in motions.items():
        found = rows @ np.linalg.lstsq(rows, wanted, rcond=None)[0]
        np.testing.assert_allclose(found, wanted, atol=1e-10, err_msg=name)


def test_total_mass_and_points():
    body, track = beam(), bar()
    assert body.total_mass == pytest.approx(7800 * 8e-5 * 0.5)
    assert (body.tip.position, body.root.position, track.centre.position) == (0.0, 0.5, 0.4)
    assert body.at(0.5) == body.root
    assert track.amplitude == pytest.approx(np.sqrt(2 / track.total_mass))


def test_supports_hold_their_degrees_of_freedom():
    """The traces at a pinned or clamped end vanish, at a guided or free one they do not."""
    for support, held in (("pinned", True), ("clamped", True), ("guided", False), ("free", False)):
        body = beam(root_support=support, angle=0.4)
        assert (np.abs(body.trace(0.5)).max() < 1e-9) == held
    x_held = beam(angle=0.4).trace(0.5, held_x=True)
    assert np.abs(x_held[0]).max() < 1e-9
    assert np.abs(x_held[1]).max() > 0.1


def test_a_cutoff_of_a_modal_beam_keeps_the_modes_up_to_it():
    whole = bar(bending_modes=60, axial_modes=30)
    cut = bar(cutoff=9e3)
    assert cut.harmonics == tuple(np.sum(np.array(f) <= 9e3) for f in np.split(whole.modes().frequency, [60]))
    exactly = bar(cutoff=float(whole.modes().frequency[3]))
    assert exactly.harmonics[0] == 4


@pytest.mark.parametrize("tension", [1e-3, 10.0, 1e3, 1e6])
def test_a_cutoff_of_a_string_keeps_the_modes_up_to_it(tension):
    """From a hardly stretched beam to a string that is hardly stiff."""
    whole = bar(bending_modes=300, axial_modes=30, tension=tension)
    cut = bar(cutoff=9e3, tension=tension)
    assert cut.harmonics == tuple(np.sum(np.array(f) <= 9e3) for f in np.split(whole.modes().frequency, [300]))
    exactly = bar(cutoff=float(whole.modes().frequency[3]), tension=tension)
    assert exactly.harmonics[0] == 4


def test_a_cutoff_below_the_first_mode_of_a_string_names_its_frequency():
    first = float(bar(tension=1e5).modes().frequency[0])
    words = rf"^cutoff must leave at least one bending mode \(first at {at_least(first)} Hz\)"
    with pytest.raises(ValueError, match=words):
        bar(tension=1e5, cutoff=0.99 * first)


def test_modal_beam_cannot_be_held():
    with pytest.raises(ValueError, match=r"^held_x must be False"):
        bar().modes(held_x=True)


def test_lumped_mass_is_the_scaled_diagonal_of_the_consistent_one():
    """Hinton, Rock & Zienkiewicz 1976: the consistent diagonal, scaled so that each direction carries the mass."""
    lumped, consistent = (element_mass(3.0, 0.2, kind) for kind in ("lumped", "consistent"))
    np.testing.assert_array_equal(lumped, np.diag(np.diag(lumped)))
    ratio = np.diag(lumped) / np.diag(consistent)
    np.testing.assert_allclose(ratio[[0, 3]], 0.6 / (2 * 0.6 / 3))
    np.testing.assert_allclose(ratio[[1, 2, 4, 5]], 0.6 / (2 * 156 / 420 * 0.6))
    for mass in (lumped, consistent):
        for motion in ([1, 0, 0, 1, 0, 0], [0, 1, 0, 0, 1, 0]):
            assert motion @ mass @ motion == pytest.approx(0.6)
    # A turn about the first end, exact for the consistent mass: rho S le³ / 3.
    turn = np.array([0.0, 0.0, 1.0, 0.0, 0.2, 1.0])
    assert turn @ consistent @ turn == pytest.approx(3.0 * 0.2**3 / 3)
