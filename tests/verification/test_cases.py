"""Every case is within its tolerance; a wrong law, mass, body or scheme is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from documented import documented

import stridula as st
from stridula.verification import (
    chains,
    clockwork,
    derivatives,
    falling,
    impacts,
    instabilities,
    jams,
    joints,
    laws,
    linings,
    orders,
    partial_slip,
    plates,
    shaken,
    sliders,
    stability,
    strings,
    surfaces,
)
from stridula.verification.case import schemes, table_row
from stridula.verification.cases import CASES


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_case(case):
    known = [row for row in documented("verification/verification.json") if row["case"] == case.name]
    rows = known or [table_row(case, row) for row in case.run().rows]
    short = [row for row in rows if not row["holds"]]
    assert rows
    assert not short, "\n".join("{quantity} {scheme}: {obtained} for {expected}".format(**row) for row in short)


def missed(outcome) -> set[str]:
    return {row.quantity for row in outcome.rows if not row.holds}


def test_a_plate_of_another_poissons_ratio_falls_short(monkeypatch):
    """Negative control: 1e-4 more moves each mode in the plane by more than its last digit."""
    monkeypatch.setattr(plates, "STEEL", replace(plates.STEEL, poisson=0.3001))
    assert sum(name.startswith("mode") for name in missed(plates.in_plane())) == len(plates.PRINTED_IN_PLANE)


def test_a_ball_on_a_plane_of_another_material_or_friction_falls_short(monkeypatch):
    """Negative control: Poisson's ratio 0.02 off, then friction 3 % off."""
    monkeypatch.setattr(partial_slip, "GRIDS", (7, 11))
    right = partial_slip.Material
    monkeypatch.setattr(partial_slip, "Material", lambda young, density, poisson: right(young, density, poisson - 0.02))
    assert {"7 squares across: approach", "11 squares across: approach"} <= missed(partial_slip.cattaneo())
    monkeypatch.setattr(partial_slip, "Material", right)
    law = partial_slip.Coulomb
    monkeypatch.setattr(partial_slip, "Coulomb", lambda friction: law(0.97 * friction))
    assert "11 squares across: shift" in missed(partial_slip.cattaneo())


def test_points_of_one_mesh_another_friction_and_another_rig_fall_short(monkeypatch):
    """Negative controls: the patch test by points of one mesh, a coin and a pin with other coefficients of friction."""
    both, load, law = surfaces.patches, surfaces.load_scenario, surfaces.Coulomb
    monkeypatch.setattr(surfaces, "patches", lambda: both(overlay=False))
    assert missed(surfaces.patch_test()) == {"pressure at the worst point"}
    monkeypatch.setattr(surfaces, "Coulomb", lambda friction: law(0.99 * friction))
    assert {"friction at the start", "its moment at the start"} <= missed(surfaces.spinning())
    monkeypatch.setattr(surfaces, "load_scenario", lambda name: load(name, {"friction": 0.3}))
    assert "frequency" in missed(surfaces.pin_on_disc())


def test_derivatives_of_another_spring_at_the_contact_fall_short(monkeypatch):
    """Negative control: the spring of the closed form is 1e-9 softer than that of the mass."""
    monkeypatch.setattr(derivatives, "AT_CONTACT", derivatives.AT_CONTACT * (1.0 - 1e-9))
    short = missed(derivatives.hoffmann_derivatives())
    assert "friction 0.75: product by friction, real" in short
    assert "friction 0.9, exponent 0.157 + 1.423i: growth by friction" in short


def test_a_slider_with_another_friction_falls_short(monkeypatch):
    """Negative control: friction 1 % off moves the turning points by 2 n 1e-6 m."""
    run = sliders.Slider.run
    off = st.Coulomb(0.101)
    monkeypatch.setattr(sliders.Slider, "run", lambda self, *words: run(replace(self, friction=off), *words))
    assert {"turning point 1", "turning point 2", "turning point 3"} <= missed(sliders.sdnd100())


def test_stick_slip_without_a_static_friction_falls_short(monkeypatch):
    run = sliders.Slider.run
    off = st.StaticKinetic(0.39, 0.25)
    monkeypatch.setattr(sliders.Slider, "run", lambda self, *words: run(replace(self, friction=off), *words))
    assert missed(sliders.belt()) >= {"time of slip", "time of stick", "period", "lowest", "highest", "least velocity"}


def test_falling_friction_of_another_slope_falls_short(monkeypatch):
    right = falling.laws()
    law, ratio, slope = right["linear weakening"]
    off = st.LinearWeakening(law.static + 0.001 * falling.BELT, slope=slope + 0.001, kinetic=law.kinetic)
    monkeypatch.setattr(falling, "laws", lambda: {"linear weakening": (off, ratio, slope)})
    assert "linear weakening: growth" in missed(falling.falling())


def test_mode_coupling_with_a_softer_contact_falls_short(monkeypatch):
    model = instabilities.hoffmann()
    softer = model.stiffness.copy()
    softer[1:, 1:] -= 0.001 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    monkeypatch.setattr(instabilities, "hoffmann", lambda: replace(model, stiffness=softer))
    assert {"friction 0.9: growth", "coefficient of friction at flutter"} <= missed(instabilities.hoffmann_case())


def test_mode_coupling_with_other_dampers_falls_short(monkeypatch):
    """Negative control: one damper 1 % off."""
    model, words = instabilities.sinou((0.02, 0.06)), (0.3, schemes()[0], 1e-5, 0.06)
    off = replace(model, damping=model.damping @ np.diag([1.0, 1.01, 1.0, 1.0]))
    assert all(row.holds for row in instabilities._rows(model, *words))
    seen = instabilities.Coupled.seen
    monkeypatch.setattr(instabilities.Coupled, "seen", lambda self, *rest: seen(off, *rest))
    short = {row.quantity for row in instabilities._rows(model, *words) if not row.holds}
    assert "friction 0.3: growth" in short


def test_sliding_in_the_other_sense_is_another_pair(monkeypatch):
    formula = stability.Pair.formula
    monkeypatch.setattr(stability.Pair, "formula", lambda self, friction: formula(self, -friction))
    short = [row for row in stability._formula_rows() if not row.holds]
    assert len(short) > 5
    assert not any(row.quantity.startswith("friction 0:") for row in short)


def test_a_rod_of_another_length_grows_otherwise(monkeypatch):
    monkeypatch.setattr(stability, "FINE", replace(stability.Pair(), slider=0.151))
    assert {row.quantity for row in stability._printed_rows() if not row.holds} >= {
        "friction 1.5, near 891 Hz: frequency",
        "friction 1.5, near 891 Hz: growth",
    }


@pytest.mark.parametrize("scheme", schemes(), ids=lambda scheme: scheme.name)
def test_the_closed_form_of_the_impact_tells_masses_apart(scheme):
    """Negative control: the march of a consistent mass is far from the closed form of a lumped one."""
    run = impacts.hit("consistent", scheme, 0.5)
    rows = impacts._impact_rows(run, "lumped", scheme, 0.5)
    assert "force at every step" in next(row.quantity for row in rows if not row.holds).partition(": ")[2]


def test_a_softer_bar_falls_short(monkeypatch):
    """Negative control: 3 % less stiff, its plateau is 1.5 % lower."""
    softer = replace(impacts.WALL, young=0.97 * impacts.WALL.young).body("lumped")
    monkeypatch.setattr(impacts.Bar, "body", lambda self, mass: softer)
    scheme = schemes()[0]
    rows = impacts._impact_rows(impacts.hit("lumped", scheme, 0.5), "lumped", scheme, 0.5)
    assert any("mean force" in row.quantity and not row.holds for row in rows)


def test_another_gravity_moves_the_bouncing_bar(monkeypatch):
    real = impacts.Gravity
    monkeypatch.setattr(impacts, "Gravity", lambda acceleration: real(1.02 * acceleration))
    run = impacts.drop(impacts.BALL, "lumped", schemes()[0], 0.9, impacts.PERIOD)
    short = {row.quantity for row in impacts._bounce_rows(run, "lumped", 0.9, schemes()[0]) if not row.holds}
    assert {"lumped mass: touches", "lumped mass: height at 0.5 s"} <= short


def test_a_rod_of_another_angle_jams_elsewhere():
    found = jams.found_limit(np.radians(45.5), schemes()[0], 1e-3)
    assert abs(found - jams.painleve_limit(np.radians(45.0))) > 0.01


def test_bristles_of_another_strength_fall_short(monkeypatch):
    off = replace(laws.PULL, friction=replace(laws.BRISTLES, static=1.49))
    known = laws.lugre_reference()
    monkeypatch.setattr(laws, "PULL", off)
    monkeypatch.setattr(laws, "lugre_reference", lambda: known)
    assert {"step 0.001 s: peak force", "step 0.001 s: period"} <= missed(laws.lugre())


def test_the_wrong_law_of_evolution_falls_short(monkeypatch):
    stepped = laws._stepped
    monkeypatch.setattr(laws, "_stepped", lambda word, *rest: stepped("slip" if word == "aging" else "aging", *rest))
    assert {"aging law: coefficient after D", "slip law: coefficient after D"} <= missed(laws.age_steps())


def test_a_tighter_string_falls_short(monkeypatch):
    """Negative control: a millionth more tension is half a millionth of each frequency."""
    tighter = 1.000001 * strings.TENSION
    real = strings.ModalBeam
    monkeypatch.setattr(strings, "ModalBeam", lambda *words, **keys: real(*words, **keys | {"tension": tighter}))
    assert {f"partial {k}" for k in (1, 2, 4, 8, 16, 40)} <= missed(strings.frequencies())


def test_supports_that_are_changed_for_each_other_fall_short(monkeypatch):
    real, other = strings.SupportForce, {"left": "right", "right": "left"}
    monkeypatch.setattr(strings, "SupportForce", lambda string, end="left": real(string, other[end]))
    assert {f"force at {place} of the length, {end}" for place in (0.1, 0.25) for end in other} <= missed(
        strings.supports()
    )


@pytest.mark.parametrize("push", [3.0, "half the least"])
def test_a_bow_beyond_schellengs_limits_makes_no_helmholtz_motion(push):
    """Negative control: pressed too hard or too little, the string slips otherwise than once a period."""
    case = strings.Bowed(0.1, 1.0)
    case = replace(case, push=0.5 * case.least / case.most if isinstance(push, str) else push)
    short = {row.quantity for row in strings.motion(case, case.run(), "bow") if not row.holds}
    assert "bow: slips per period" in short


def test_a_string_out_of_tune_falls_short(monkeypatch):
    """Negative control: a period 2 % shorter, where the corner of Helmholtz motion takes 0.9 % to pass."""
    case = strings.Bowed(0.2, 0.3)
    string = case.string
    sharp = replace(string, tension=1.04 * string.tension)
    monkeypatch.setattr(strings.Bowed, "string", property(lambda self: sharp))
    short = {row.quantity for row in strings.motion(case, case.run(), "bow") if not row.holds}
    assert "bow: period" in short


def test_a_stiffer_joint_and_another_friction_are_missed(monkeypatch):
    monkeypatch.setattr(joints, "JOINT", 1.01 * joints.JOINT)
    assert "first harmonic" in missed(joints.damper())
    monkeypatch.undo()
    monkeypatch.setattr(joints, "LIMIT", 1.01 * joints.LIMIT)
    assert "first harmonic" in missed(joints.damper())
    monkeypatch.undo()
    contact = joints.PointContact
    monkeypatch.setattr(
        joints, "PointContact", lambda *on, **own: contact(*on, **{**own, "stiffness": 1.001 * 1973.92})
    )
    assert "lowest point" in missed(joints.fall())


def test_a_chain_on_other_springs_is_missed(monkeypatch):
    spring = chains.CubicSpring
    # Softer, it has left the upper branch at the printed peak.
    changed = {"stiffness": chains.GROUND, "cubic": 0.9 * chains.CUBIC}
    monkeypatch.setattr(chains, "CubicSpring", lambda point, **own: spring(point, **{**own, **changed}))
    assert missed(chains.cubic_chain()) == {"first harmonic at the peak", "the same"}


def test_a_mass_on_a_stiffer_contact_vibrates_otherwise(monkeypatch):
    """Negative control: half of the change of stiffness is that of frequency, also where it is whole turns."""
    contact, more = linings.PointContact, 1.0 + 2.0 / linings.PERIODS
    monkeypatch.setattr(linings, "PointContact", lambda *on, stiffness: contact(*on, stiffness=more * stiffness))
    assert missed(linings.vibration()) >= {f"{kilo} kHz: frequency" for kilo in (1, 10, 30, 100)}


def test_balls_on_a_stiffer_wall_bounce_otherwise(monkeypatch):
    """Negative control: 5 % of stiffness is 2 % of force and of time."""
    contact = linings.PointContact

    def stiffer(*on, stiffness):
        return contact(*on, stiffness=replace(stiffness, modulus=1.05 * stiffness.modulus))

    monkeypatch.setattr(linings, "PointContact", stiffer)
    short = missed(linings.impact())
    assert sum(name.endswith("largest force") for name in short) == len(linings.BALLS)
    assert sum(name.endswith("time of contact") for name in short) == len(linings.BALLS)


def test_a_lining_of_another_friction_falls_short(monkeypatch):
    """Negative control: friction 2 % off."""
    for name, values in (("SQUEALS", (1e3,)), ("SMALL", (0.8,)), ("LARGE", (0.9,))):
        monkeypatch.setattr(linings, name, values)
    run = linings.Lined.run
    monkeypatch.setattr(
        linings.Lined, "run", lambda self, *words: run(replace(self, friction=1.02 * self.friction), *words)
    )
    assert {"1000 Hz, friction 0.8: growth", "1000 Hz, friction 0.9, cycle: swing"} <= missed(linings.squeal())


@pytest.mark.parametrize("name", ["static and kinetic", "LuGre"])
def test_stick_slip_in_few_steps_under_another_law_falls_short(monkeypatch, name):
    """Negative control: static friction 2 % off."""
    right, run = clockwork.LAWS[name], clockwork.Slider.run
    off = replace(right, static=1.02 * right.static)
    monkeypatch.setattr(clockwork, "LAWS", {name: right})
    monkeypatch.setattr(clockwork.Slider, "run", lambda self, *words: run(replace(self, friction=off), *words))
    assert f"{name}, belt 0.4 m/s, 50 steps: swing" in missed(clockwork.clockwork())


@pytest.mark.parametrize("build", [shaken.by_a_force, shaken.through_a_spring])
def test_a_shaken_track_without_its_system_falls_short(monkeypatch, build):
    """Negative control: contacts alone are heard, and none presses."""
    radiate = shaken.radiate
    monkeypatch.setattr(shaken, "radiate", lambda run, _, places, bodies: radiate(run, bodies[0], places))
    assert not any(row.holds for row in build(shaken.beam(), "beam").rows()[0])


def test_a_beam_shaken_through_a_softer_spring_falls_short(monkeypatch):
    """Negative control: 2 % of stiffness."""
    spring = shaken.Spring
    soft = {"stiffness": 0.98 * shaken.SPRING, "direction": "y"}
    monkeypatch.setattr(shaken, "Spring", lambda *ends, **_: spring(*ends, **soft))
    assert not all(row.holds for row in shaken.through_a_spring(shaken.beam(), "beam").rows()[0])


class LazyStart(st.CentralDifference):
    """Central differences that forget the force in the first increment: a velocity off by f h / 2, of first order."""

    def first_increment(self, angular, damping, step, position, velocity, force):
        return super().first_increment(angular, damping, step, position, velocity, 0 * force)


def test_a_scheme_of_first_order_falls_short(monkeypatch):
    monkeypatch.setattr(orders, "schemes", lambda: [LazyStart()])
    assert {"order, forced beam", "order, thrown slider"} <= missed(orders.smooth())
