"""Laws that every run must satisfy at each step, checked on a record of every step."""

from __future__ import annotations

import numpy as np
from kernels.twin.laws import curve, has_state, held_up_to, ratio_with_state
from scipy.optimize import minimize_scalar

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
    # The share of a row is that of the step before its force; the slip is that after it.
    slid = run.status_share.values.reshape(*shape, 3)[:, :, SLIDING]
    slid = np.concatenate([slid[1:], np.ones((1, shape[1]))])
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
        own |= {"slid": slid[:, i], "pushed": step**2 * np.sum(rows**2) * own["normal_force"]}
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
    # A sum of three shares is rounded.
    if np.any(np.abs(run.status_share.values.sum(axis=-1) - 1.0) > 4.0 * np.finfo(float).eps):
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
    if not isinstance(law, st.Coulomb):
        yield from of_changing(law, columns, state, slip, small, step)
        if not has_state(law) and slips_while_held(law, columns, slip, small):
            yield "slip while sticking"
        return
    stuck, sliding = status == STICKING, status == SLIDING
    # In a step in which the slip reverses, forces are means over both senses.
    turned = sliding & np.concatenate([[False], sliding[:-1] & (slip[1:] * slip[:-1] < 0)])
    cone = law.coefficient * normal
    off = np.abs(tangential) - cone
    if np.any(off[turned | stuck] > 1e-12 * cone[turned | stuck] + TOLERANCE * peak):
        yield "outside the cone"
    sliding = sliding & ~turned
    if np.any(np.abs(slip[stuck]) > small):
        yield "slip while sticking"
    if np.any((tangential * slip)[sliding] < -np.abs(tangential[sliding]) * small):
        yield "slides the wrong way"
    one_way = closed & ~turned
    if np.any((tangential * slip)[one_way] < -np.abs(tangential[one_way]) * small):
        yield "friction gives energy"
    if np.any(off[sliding] > 1e-9 * cone[sliding] + TOLERANCE * peak):
        yield "slides outside the cone"
    if np.any(off[sliding] < -1e-9 * cone[sliding] - TOLERANCE * peak):
        yield "slides inside the cone"


def of_changing(law, columns, state, slip, small, step):
    """Laws whose friction changes: ratios within those of the velocities that a contact has during its two steps.

    `small` is the round-off of a displacement [m].
    """
    status, normal, tangential = columns["status"], columns["normal_force"], columns["tangential_force"]
    closed = status != SEPARATED
    peak = normal.max(initial=0.0)
    for n in range(3, status.size - 1):
        if not closed[n]:
            continue
        ratio, margin = tangential[n] / normal[n], TOLERANCE * peak / normal[n] + 1e-9
        near = slip[n - 2 : n + 2] / step
        # The mean velocity of a step is known; within one it changes by about as much as from one to the next.
        spread = 2.0 * np.abs(np.diff(near)).max() + small / step
        if not closed[n - 1]:
            # A contact that lands has half of its friction at the velocity that it would have without it.
            spread += abs(ratio) * columns["pushed"][n] / step
        speeds = np.linspace(near[:3].min() - spread, near[:3].max() + spread, 9)
        if isinstance(law, st.RateAndState):
            # Creep changes by decades from one step to the next.
            speeds = np.concatenate([speeds / 3.0, 3.0 * speeds])
        if has_state(law):
            # The drive of a law with a state is taken to go on, which it does not for two steps after an impulse.
            struck = normal[n - 2 : n + 1].max() > 3.0 * normal[n]
            if closed[n - 3 : n + 2].all() and not struck:
                low, high = ratios_with_state(law, state[n - 3 : n + 1], speeds)
                blur = 0.05 * (high - low) + margin
                if not low - blur <= ratio <= high + blur:
                    yield "off the law"
                    return
            continue
        beyond = abs(ratio) - margin
        if beyond > held_up_to(law, True) and beyond > largest(law, speeds):
            yield "outside the cone"
            return
        if (status[n - 2 : n + 2] == SLIDING).all() and speeds.min() * speeds.max() > 0.0:
            if ratio * speeds[0] < 0.0:
                yield "slides the wrong way"
                return
            ratios = [curve(law, abs(v)) for v in speeds]
            blur = 0.05 * (max(ratios) - min(ratios)) + margin
            if not min(ratios) - blur <= abs(ratio) <= max(ratios) + blur:
                yield "off the law"
                return


def largest(law, speeds):
    """Largest ratio within a range of velocities, between those given and where the curve of a table turns, too."""
    low, high = speeds.min(), speeds.max()
    turns = np.array(law.velocity if isinstance(law, st.TabulatedFriction) else (0.0,))
    turns = np.concatenate([-turns, turns])
    speeds = np.sort(np.concatenate([speeds, turns[(turns > low) & (turns < high)]]))
    best = np.argmax([curve(law, abs(v)) for v in speeds])
    about = speeds[max(best - 1, 0)], speeds[min(best + 1, speeds.size - 1)]
    found = minimize_scalar(lambda v: -curve(law, abs(v)), bounds=about, method="bounded", options={"xatol": 1e-12})
    return max(-found.fun, curve(law, abs(speeds[best])))


def slips_while_held(law, columns, slip, small):
    """Whether a contact slips in a step of which it sticks throughout, or while nothing could make it slip.

    After an impulse a contact may stop, slide back and stop again in steps that all count as sticking; under forces
    that hardly change and are well below the limit it may not.
    """
    normal, stuck = columns["normal_force"], columns["status"] == STICKING
    moves = stuck & (np.abs(slip) > small)
    if np.any(moves & (columns["slid"] == 0.0)):
        return True
    low = np.abs(columns["tangential_force"]) < 0.8 * held_up_to(law, True) * normal
    calm = stuck & low
    calm[1:] &= np.abs(np.diff(normal)) < 0.1 * normal[1:]
    earlier = np.lib.stride_tricks.sliding_window_view(calm, 4).all(axis=1)
    return bool(np.any(earlier & moves[3:]))


def ratios_with_state(law, states, speeds):
    """Least and largest ratio under a law with internal state, for the states and velocities about a step."""
    spread = np.ptp(states)
    lowest, highest = states.min() - spread, states.max() + spread
    if isinstance(law, st.RateAndState):
        lowest, highest = states.min() / 3.0, 3.0 * states.max()
    found = [ratio_with_state(law, state, v) for state in np.linspace(lowest, highest, 5) for v in speeds]
    return min(found), max(found)
