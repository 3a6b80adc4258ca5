"""Every planar verification case, turned into space, has the same result as in the plane."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from functools import cache
from unittest import mock

import numpy as np
import pytest
from kernels import systems
from scipy.spatial.transform import Rotation

import stridula as st
from stridula.verification.cases import CASES

from .into_space import IntoSpace

BY_NAME = {case.name: case for case in CASES}
# Ten rotations of cases that take less than a quarter of a second, two of the others.
QUICK = [
    "sdnd100",
    "relay",
    "belt",
    "belt-equal",
    "falling-friction",
    "hoffmann",
    "hoffmann-derivatives",
    "impact",
    "hertz-on-a-wall",
    "hertz-on-a-beam",
    "contact-spring",
    "hertz-impacts",
    "velocity-step",
    "string-supports",
    "order-time",
    "order-sliding",
    "fall-on-a-spring",
    "heated-block",
]
SLOW = [
    "den-hartog",
    "sinou",
    "random-friction",
    "correlated-friction",
    "sliding-stability",
    "bouncing",
    "painleve",
    "lugre",
    "slow-stick-slip",
    "bowed-string",
    "clockwork",
    "lining",
    "friction-damper",
    "cubic-chain",
    "valve-damper",
    "fading-friction",
    "heated-slab",
]
TURNS = [(name, seed) for names, count in ((QUICK, 10), (SLOW, 2)) for name in names for seed in range(count)]
# Where this string sticks, its tangential force passes zero, and its motion across is rounding.
TURNS.append(("bowed-string", 400))
# Cases without a motion: modes of a body, which do not depend on the plane; and cases without bodies in contact.
MODES = [
    "frequencies-beams",
    "frequencies-modal",
    "order-elements",
    "welded-beam",
    "frequencies-plate",
    "in-plane-plate",
    "deflection-plate",
    "mobility-plate",
    "string-frequencies",
]
BAFFLED = [name for name in BY_NAME if name.startswith("radiation-")]
SIGNALS = ["loudness-tone"]
# Shares of the tolerance by which rows may differ beyond round-off: 1e-9 of what is compared.
CLOSE = 1e-4
LOOSE = {
    # It slips at the end of a step, or one later: a step is a twentieth of the tolerance.
    "belt": 0.1,
    # A kick of 1e-7 m on 1 m, whose exponents are taken from differences: round-off of 1 m over them.
    "falling-friction": 0.03,
    # A mass free to move across: where rounding turns the last of its slip, its stop is found in parts of a step.
    "clockwork": 5e-3,
    # Its smallest error is 1.5e-13, partly rounding.
    "order-sliding": 0.2,
    # Rows of free damped motion are their own round-off.
    "order-time": 1e-2,
    # Rows differ from the closed form, and from each other, by round-off alone.
    "hoffmann-derivatives": 1e-2,
    # The masses differ by round-off alone.
    "cubic-chain": 0.1,
    # Its order is taken from small differences of peaks.
    "lugre": 1e-2,
    # Round-off of the gap at rest, over the square of a step, kicks by 4e-8 of the normal force a motion of 1e-4 of it.
    "sliding-stability": 10.0,
}


def ask_in_space(patched: ExitStack, space: IntoSpace) -> None:
    """Make the modules of the cases run their systems turned into space."""
    for name in [name for name in sys.modules if name.startswith("stridula.verification.")]:
        for asked in ("simulate", "sliding_stability", "mode_sensitivity", "mode_probability"):
            if hasattr(sys.modules[name], asked):
                patched.enter_context(mock.patch.object(sys.modules[name], asked, getattr(space, asked)))


def rows_in_space(name: str, rotation: np.ndarray):
    """Return the rows of a case turned into space, and the converter."""
    space = IntoSpace(rotation)
    with ExitStack() as patched:
        ask_in_space(patched, space)
        return BY_NAME[name].run().rows, space


@cache
def rows_in_the_plane(name: str):
    return BY_NAME[name].run().rows


def share(name: str, row) -> float:
    """Return the share of its tolerance by which a row may differ from that of the plane."""
    # The formula of sliding stability is matched to round-off, which is its tolerance.
    by_formula = name == "sliding-stability" and "in time" not in row.quantity
    return 1.0 if by_formula else LOOSE.get(name, CLOSE)


def words(rows) -> list[tuple[str, str]]:
    """Return the quantities of rows; some state a growth of zero, whose sign depends on rounding."""
    return [(row.quantity.replace("growth -0 ", "growth 0 "), row.scheme) for row in rows]


@pytest.mark.parametrize(("name", "seed"), TURNS)
def test_a_case_has_the_same_result_in_space_as_in_the_plane(name, seed):
    """Under ten random rotations of the world, under two where a case takes longer; others for each case."""
    number = 100 * list(BY_NAME).index(name) + seed
    rows, space = rows_in_space(name, Rotation.random(random_state=number).as_matrix())
    assert space.runs > 0
    assert space.across < 1e-6
    flat = rows_in_the_plane(name)
    assert words(rows) == words(flat)
    for row, known in zip(rows, flat, strict=True):
        size, loose = max(abs(known.expected), abs(known.obtained)), share(name, row)
        assert abs(row.obtained - known.obtained) <= 1e-9 * size + loose * row.tolerance, (row, known)
        assert abs(row.error) <= max(1.0, loose) * row.tolerance, row


def test_every_case_is_turned_or_named():
    """A new case joins the turned ones, unless it is in space already or nothing moves in it."""
    named = [*QUICK, *SLOW, *MODES, *BAFFLED, *SIGNALS]
    others = set(BY_NAME) - set(named)
    assert len(set(named)) == len(named)
    assert set(named) <= set(BY_NAME)
    modules = {BY_NAME[name].run.__module__.rpartition(".")[2] for name in others}
    assert modules == {
        "partial_slip",
        "space",
        "surfaces",
        "turning",
        "open_air",
        "sounding_spheres",
        "halved_steps",
        "shaken",
        "limit_cycles",
        "derivatives",
    }


@pytest.mark.parametrize("name", [*MODES, *SIGNALS])
def test_cases_that_are_not_turned_have_no_motion(name):
    if name in SIGNALS:
        assert not hasattr(sys.modules[BY_NAME[name].run.__module__], "simulate")
        return
    assert rows_in_space(name, np.eye(3))[1].runs == 0


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("track", [systems.BELT, systems.SHAKEN], ids=["belt", "shaken belt"])
def test_feet_that_cannot_move_across_stick_as_in_the_plane(track, seed):
    """The rows of a block of the plane along the second tangent are round-off, under which forces once grew."""
    flat = systems.pad_on(track, [st.Coulomb(0.4)] * 3)
    space = IntoSpace(Rotation.random(random_state=seed).as_matrix())
    plane, turned = (run(flat, 0.1, step=1e-4, probes=[]) for run in (st.simulate, space.simulate))
    for name in ("normal_force", "tangential_force"):
        size = float(np.abs(plane[name]).max())
        np.testing.assert_allclose(turned[name].values, plane[name].values, atol=1e-8 * size)
    assert 0.1 < float((plane["status"] == 1).mean()) < 1.0


STEEL = st.Material(2.1e11, 7800.0, 0.3)
BODIES = [
    (st.ModalBeam(STEEL, st.Rectangle(0.02, 0.009), 1.1, damping=0.01, cutoff=8e3), 0.3),
    (st.FiniteElementBeam(STEEL, st.Rectangle(0.02, 0.009), 0.3, angle=0.4, damping=0.01, cutoff=8e3), 0.1),
    (st.ModalPlate(STEEL, 0.002, 0.4, 0.3, in_plane=True), 0.1),
    (st.PointMass(0.3), "centre"),
]


@pytest.mark.parametrize(("body", "place"), BODIES, ids=lambda one: type(one).__name__)
def test_modes_are_the_same_in_any_plane(body, place):
    turn = Rotation.random(random_state=3).as_matrix()
    placed = st.ModalBody.placed(body, {"here": place}, turn[:, 0], turn[:, 1])
    np.testing.assert_array_equal(placed.modes().frequency, body.modes().frequency)
    np.testing.assert_array_equal(placed.modes().damping_rate, body.modes().damping_rate)
    back = np.vstack([body.trace(place), np.zeros(body.modes().count)])
    np.testing.assert_allclose(turn.T @ placed.trace("here"), back, atol=1e-14 * np.abs(back).max())


def test_a_system_turned_the_wrong_way_falls_short(monkeypatch):
    """Negative control: gravity and forces are not turned."""
    monkeypatch.setattr(IntoSpace, "_along", lambda self, given: dict(zip("xyz", (*given, 0.0), strict=False)))
    rows, _ = rows_in_space("sdnd100", Rotation.from_euler("z", 10.0, degrees=True).as_matrix())
    assert not all(row.holds for row in rows)
