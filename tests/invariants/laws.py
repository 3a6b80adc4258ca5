"""Laws that every run must satisfy at each step, checked on a record of every step."""

from __future__ import annotations

import numpy as np
from kernels.general_twin import curve, has_state, held_up_to, ratio_with_state

import stridula as st
from stridula.lowering import assemble

EPS = np.finfo(float).eps
SEPARATED, STICKING, SLIDING = 0, 1, 2
# Several contacts are solved until no force changes by more than 1e-10 of the largest; a sweep later it is below that.
TOLERANCE = 1e-9


def violations(run, system: st.System) -> set[str]:
    """Names of the laws that a record of every step breaks."""
    step, steps = run.attrs["step"], run.sizes["time"]
    shape = (steps, len(system.contacts))
    names = ("status", "normal_force", "tangential_force", "gap", "slip_velocity", "contact_position")
    columns = {name: run[name].values.reshape(shape) for name in names}
    state = run.friction_state.values.reshape(shape) if "friction_state" in run else np.zeros(shape)
    arrays = assemble(system)
    rows = np.abs(np.array([contact.fixed for contact in arrays.contacts])).sum(axis=(0, 1))
    # Displacement by the largest force in a step.
    pushed = step**2 * np.sum(rows**2) * np.abs(columns["normal_force"]).max()
    # A gap and a slip are sums of numbers up to the largest displacement, that of a belt included.
    travel = np.abs(columns["contact_position"]).max() + np.abs(columns["slip_velocity"]).sum(axis=0).max() * step
    imposed = np.abs(arrays.motion(run.time.values, step)).max()
    moved = max(travel, imposed, pushed, np.abs(run.contact_height.values).max(), np.abs(columns["gap"]).max())
    small = 20 * (10 + arrays.mode_count) * EPS * moved + TOLERANCE * pushed * (shape[1] > 1)
    broken = set()
    for i, contact in enumerate(system.contacts):
        own = {name: values[:, i] for name, values in columns.items()}
        broken |= set(of_one(contact.friction, own, state[:, i], step, small))
    residual = np.abs(run.ledger_residual.values).max()
    terms = ("kinetic_and_elastic", "damping_loss", "drive_work", "contact_work")
    largest = max(np.abs(run[name].values).max() for name in terms)
    largest = max(largest, abs(run.attrs["initial_energy"]))
    if residual > 1e-10 * largest:
        broken.add("ledger does not close")
    if np.any(np.diff(run.damping_loss.values) < -1e-12 * largest):
        broken.add("damping gives energy")
    if np.any(run.kinetic_and_elastic.values < -1e-12 * largest):
        broken.add("stored energy below zero")
    if np.any(run.status_share.values.sum(axis=-1) != 1):
        broken.add("share is not a state")
    return broken


def of_one(law, columns, state, step, small):
    """Names of the laws that one contact breaks; `small` is the round-off of a displacement [m]."""
    status, normal, tangential = columns["status"], columns["normal_force"], columns["tangential_force"]
    gap, slip = columns["gap"], columns["slip_velocity"] * step
    closed = status != SEPARATED
    peak = normal.max(initial=0.0)
    if normal.min() < -TOLERANCE * peak:
        yield "normal force below zero"
    if gap.min() < -small:
        yield "gap below zero"
    if np.any(np.abs(gap[closed]) > small):
        yield "force at a distance"
    if np.any(normal[~closed] != 0) or np.any(tangential[~closed] != 0):
        yield "force while separated"
    # The slip velocity in the laws, from the third step on, and its error.
    centred = (9 * slip[2:] + 6 * slip[1:-1] + slip[:-2]) / (16 * step)
    unsure = small / step
    rest = slice(2, None)
    if has_state(law):
        yield from of_state(law, normal[rest], tangential[rest], closed, state, centred, unsure, step)
        return
    stuck, sliding = status == STICKING, status == SLIDING
    # In a step in which the slip reverses, forces are means over both senses.
    turned = sliding & np.concatenate([[False], sliding[:-1] & (slip[1:] * slip[:-1] < 0)])
    if np.any(np.abs(tangential[turned]) > curve(law, 0.0) * normal[turned] * (1 + 1e-12) + TOLERANCE * peak):
        yield "turns outside the cone"
    one_way = ~turned
    sliding = sliding & one_way
    if np.any(np.abs(slip[stuck]) > small):
        yield "slip while sticking"
    if np.any((tangential * slip)[sliding] < -np.abs(tangential[sliding]) * small):
        yield "slides the wrong way"
    if np.any((tangential * slip)[closed & one_way] < -np.abs(tangential[closed & one_way]) * small):
        yield "friction gives energy"
    # Contacts that stick or stop are held by the static coefficient, except those that land.
    was = np.concatenate([[True], closed[:-1]])
    held = np.array([held_up_to(law, before) for before in was])
    # Viscous friction above the static one may bring a contact to rest: the ratio at its velocity is also allowed.
    high = np.array([curve(law, abs(v) + unsure) for v in centred])
    allowed = np.maximum(held, np.concatenate([[np.inf, np.inf], high]))
    if np.any(np.abs(tangential[stuck]) > allowed[stuck] * normal[stuck] * (1 + 1e-12) + TOLERANCE * peak):
        yield "outside the cone"
    low_speed = np.maximum(np.sign(tangential[rest]) * centred - unsure, 0.0)
    high_speed = np.maximum(np.sign(tangential[rest]) * centred + unsure, 0.0)
    ends = np.array([[curve(law, v) for v in speeds] for speeds in (low_speed, high_speed)])
    ratio = np.abs(tangential[rest])
    if np.any((ratio > ends.max(axis=0) * normal[rest] * (1 + 1e-9) + TOLERANCE * peak)[sliding[rest]]):
        yield "slides outside the cone"
    if np.any((ratio < ends.min(axis=0) * normal[rest] * (1 - 1e-9) - TOLERANCE * peak)[sliding[rest]]):
        yield "slides inside the cone"


def of_state(law, normal, tangential, closed, state, centred, unsure, step):
    """Laws with internal state: the ratio at velocity and state; no more energy than the state stores."""
    before, after = state[1:-1], state[2:]
    for n in np.flatnonzero(closed[2:]):
        ends = [ratio_with_state(law, before[n], centred[n] + d, step) for d in (-unsure, unsure)]
        margin = 1e-7 * max(np.abs(ends)) + TOLERANCE * normal.max() / normal[n]
        if not min(ends) - margin <= tangential[n] / normal[n] <= max(ends) + margin:
            yield "off the law"
            break
    held = closed[2:]
    stored = 0.5 * law.stiffness * (after**2 - before**2) if isinstance(law, st.LuGre) else 0.0 * after
    with np.errstate(divide="ignore", invalid="ignore"):
        given = tangential / normal * centred * step
    blur = np.abs(tangential / np.where(normal > 0, normal, 1.0)) * unsure * step
    passive = not isinstance(law, st.LuGre) or law.damping <= passive_damping(law)
    if passive and np.any((given < stored - blur - 1e-9 * np.abs(stored).max(initial=0.0))[held]):
        yield "friction gives energy"


def passive_damping(law) -> float:
    """Largest damping of the bristles for which LuGre's law dissipates energy at any velocity."""
    return 0.0 if law.static > law.kinetic else np.inf
