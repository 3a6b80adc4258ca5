"""Two equal rollers pressed on each other and pulled past each other across the line of contact, in plane strain.

Hertz's pressure and the traction of Cattaneo and Mindlin (Johnson 1985, 4.2 and 7.2) are known in closed form. The
contact is divided into strips with the influence of Flamant's solution; nothing of the package computes it.
"""

from __future__ import annotations

from functools import lru_cache
from math import pi, sqrt
from typing import NamedTuple

import numpy as np
import pytest

import stridula as st

# Steel, per metre of length.
RADIUS, YOUNG, POISSON, FRICTION = 8e-3, 200e9, 0.3, 0.2
PRESSED, PULLED = 10e6, 0.93622e6
TOGETHER, RELATIVE = YOUNG / (2.0 * (1.0 - POISSON**2)), RADIUS / 2.0
WIDTH = sqrt(4.0 * PRESSED * RELATIVE / (pi * TOGETHER))
STUCK = WIDTH * sqrt(1.0 - PULLED / (FRICTION * PRESSED))
PEAK = 2.0 * PRESSED / (pi * WIDTH)
# Distance below the surface where the bodies are at rest: the approach alone depends on it.
DEPTH = 10.0 * WIDTH
STEP, RISE, REST = 1e-6, 60, 120
COARSE, FINE = 20, 80


class Found(NamedTuple):
    """State at the end of a run: middles of the strips and their width [m], forces on them [N/m], the record."""

    middle: np.ndarray
    side: float
    normal: np.ndarray
    tangential: np.ndarray
    run: object


def influence(middle, side):
    """Return displacements of both surfaces towards each other at middles of strips, for unit forces on strips.

    Those along the surface are the same: tangential displacements by pressure cancel between equal bodies.
    """
    apart = middle[:, None] - middle

    def integral(end):
        return end * (np.log(np.abs(end) / DEPTH) - 1.0)

    return -2.0 / (pi * TOGETHER * side) * (integral(apart + side / 2.0) - integral(apart - side / 2.0))


def half_space(flexibility, rate):
    """Return both half-spaces as a body whose modes all have the same frequency [rad/s] and are strongly damped."""
    stiffness = np.kron(np.linalg.inv(flexibility), np.eye(2))
    points = {str(number): (2 * number, 2 * number + 1) for number in range(len(flexibility))}
    return st.ReducedBody(stiffness / rate**2, stiffness, points, damping=0.9, name="half-space")


@lru_cache
def pressed_and_pulled(strips, friction=FRICTION):
    """Press, then pull under the same pressure, and wait until nothing moves; `strips` over the width of contact."""
    side = 2.0 * WIDTH / strips
    middle = side * np.arange(-(strips // 2) - 2, strips // 2 + 3)
    flexibility, rate = influence(middle, side), 0.5 / STEP
    plane = half_space(flexibility, rate)
    mass = 1.0 / (float(flexibility.mean()) * rate**2)
    roller = st.ModalBody(np.zeros(2), {"axis": np.eye(2) / sqrt(mass)}, 2.0 * rate, name="roller")
    contacts = [
        st.PointContact(
            roller.at("axis"), plane.at(str(number)), friction=st.Coulomb(friction), gap=gap, name=str(number)
        )
        for number, gap in enumerate((middle**2 / (2.0 * RELATIVE)).tolist())
    ]
    times = (STEP * np.cumsum([0, RISE, REST, RISE, REST])).tolist()
    drives = [
        st.Force(roller.at("axis"), y=-PRESSED, history=st.Sampled(times[:2], (0.0, 1.0))),
        st.Force(roller.at("axis"), x=PULLED, history=st.Sampled(times[2:4], (0.0, 1.0))),
    ]
    run = st.simulate(st.System(contacts, drives), times[-1], sample_rate=1.0 / STEP, probes=[])
    return Found(middle, side, run.normal_force.values[-1], run.tangential_force.values[-1], run)


def ellipse(middle, side, half):
    """Return means of ``sqrt(1 - x² / half²)`` over strips."""

    def integral(end):
        share = np.clip(end / half, -1.0, 1.0)
        return half / 2.0 * (share * np.sqrt(1.0 - share**2) + np.arcsin(share))

    return (integral(middle + side / 2.0) - integral(middle - side / 2.0)) / side


def half_width(middle, force):
    """Return half the width of an ellipse of forces, from their second moment."""
    return 2.0 * sqrt(float(force @ middle**2 / force.sum()))


def errors(found):
    """Return the relative errors of both half widths, and the root mean square errors of both tractions over peaks."""
    middle, side, normal, tangential, _ = found
    whole, inner = (ellipse(middle, side, half) for half in (WIDTH, STUCK))
    traction = whole - STUCK / WIDTH * inner
    return {
        "width": abs(half_width(middle, normal) / WIDTH - 1.0),
        "stuck": abs(half_width(middle, FRICTION * normal - tangential) / STUCK - 1.0),
        "pressure": np.sqrt(np.mean((normal / side / PEAK - whole) ** 2)),
        "traction": np.sqrt(np.mean((tangential / side / (FRICTION * PEAK) - traction) ** 2)),
    }


def test_the_closed_form_has_its_known_numbers():
    assert pytest.approx(0.680778e-3, rel=1e-6) == WIDTH
    assert pytest.approx(0.496497e-3, rel=1e-6) == STUCK


@pytest.mark.parametrize("strips", [COARSE, FINE])
def test_rollers_stick_in_the_middle_and_slip_beside_it(strips):
    """Strips that contain an end of contact or stick may belong to either side; means over all are of second order."""
    found = pressed_and_pulled(strips)
    run, normal, tangential, side = found.run, found.normal, found.tangential, found.side
    assert int(run.unsolved_steps.sum()) == 0
    assert np.abs(run.ledger_residual).max() < 1e-10 * run.drive_work.max()
    assert normal.sum() == pytest.approx(PRESSED, rel=1e-6)
    assert tangential.sum() == pytest.approx(PULLED, rel=1e-6)
    normals, tangentials = run.normal_force.values, run.tangential_force.values
    assert normals.min() >= 0.0
    assert np.max(np.abs(tangentials) - FRICTION * normals) <= 1e-9 * FRICTION * normals.max()
    holds = tangential < FRICTION * normal * (1.0 - 1e-6)
    assert (normal > 0.0).sum() * side / 2.0 == pytest.approx(WIDTH, abs=side)
    assert holds.sum() * side / 2.0 == pytest.approx(STUCK, abs=side)
    error = errors(found)
    assert error["width"] < (side / WIDTH) ** 2
    assert error["stuck"] < (side / STUCK) ** 2
    assert error["pressure"] < side / WIDTH
    assert error["traction"] < side / WIDTH


def test_rollers_converge_with_the_number_of_strips():
    """Half widths, of second order, fall at least with the strips; tractions, of first order, at least by half that.

    The factor of each depends on where the ends of contact and stick lie within their strips.
    """
    coarse, fine = errors(pressed_and_pulled(COARSE)), errors(pressed_and_pulled(FINE))
    share = COARSE / FINE
    for name in ("width", "stuck"):
        assert fine[name] < share * coarse[name]
    for name in ("pressure", "traction"):
        assert fine[name] < 2.0 * share * coarse[name]


def test_another_coefficient_of_friction_is_noticed():
    found = pressed_and_pulled(FINE, 0.9 * FRICTION)
    stuck = half_width(found.middle, 0.9 * FRICTION * found.normal - found.tangential)
    assert abs(stuck / STUCK - 1.0) > 10.0 * (found.side / STUCK) ** 2
