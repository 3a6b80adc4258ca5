"""A system under a scheme as the blocks that the march reads."""

from __future__ import annotations

import numpy as np

from .._kernels import layout as at
from ..assembly import Assembly
from ..bodies.modes import Array
from ..system import System
from .schemes import Scheme


def coefficient_block(arrays: Assembly, scheme: Scheme, step: float) -> tuple[Array, Array]:
    """Return the coefficient block of the march and the load increments for unit signals."""
    k = scheme.coefficients(arrays.angular_frequency, arrays.damping, step)
    block = np.zeros((at.COEFFICIENT_ROWS, arrays.mode_count))
    block[at.B], block[at.R], block[at.CH] = k.b, k.r, k.c * step
    block[at.HALF_OVER_CH] = 0.5 / block[at.CH]
    block[at.HALF_LOSS] = (1.0 - k.b) / 2.0
    block[[at.TIP_X, at.TIP_Y], : arrays.sizes[0]] = arrays.tip
    return block, arrays.loads * k.load


def constants(system: System, arrays: Assembly, block: Array, step: float) -> Array:
    """Return the constants of the march, the slider's share of the contact's compliance among them."""
    track, contact = system.track, system.contact
    ch = block[at.CH, : arrays.sizes[0]]
    tip_x, tip_y = arrays.tip
    values = np.empty(at.CONSTANTS)
    values[at.STEP] = step
    values[at.START] = contact.at
    values[at.GAP] = contact.gap
    values[at.WAVENUMBER] = np.pi / track.length
    values[at.AMPLITUDE] = track.amplitude
    values[at.LENGTH] = track.length
    values[at.MU] = contact.friction.coefficient
    values[at.W_NN] = np.sum(ch * tip_y * tip_y)
    values[at.W_NT] = np.sum(ch * tip_x * tip_y)
    values[at.W_TT] = np.sum(ch * tip_x * tip_x)
    return values


def probe_blocks(arrays: Assembly, step: float) -> tuple[Array, Array, Array, Array]:
    """Return the probes' rows on q, d[n+1] + d[n] and d[n+1] - d[n], their spans, shares of signals and contact."""
    count = len(arrays.probes)
    rows = np.zeros((count, 3, arrays.mode_count))
    spans = np.zeros((count, 3, 2), dtype=np.int64)
    direct = np.zeros((count, len(arrays.signals)))
    contact = np.zeros((count, 2))
    scale = np.array([1.0, 0.5 / step, 1.0 / step**2])
    for p, probe in enumerate(arrays.probes):
        rows[p] = probe.rows * scale[:, None]
        direct[p], contact[p] = probe.direct, probe.contact
        for kind in range(3):
            used = np.flatnonzero(rows[p, kind])
            if used.size:
                spans[p, kind] = used[0], used[-1] + 1
    return rows, spans, direct, contact


def at_rest(system: System, arrays: Assembly, scheme: Scheme, step: float) -> tuple[Array, Array]:
    """Return the state at the start, whose first increment makes the scheme of second order from the first step on."""
    zero = np.zeros(1)
    factors = np.array([signal(zero, step)[0] for signal in arrays.signals[: arrays.loads.shape[0]]])
    state = np.zeros((2, arrays.mode_count))
    state[at.D] = scheme.first_increment(
        arrays.angular_frequency, arrays.damping, step, state[at.Q], arrays.velocity, factors @ arrays.loads
    )
    carried = np.zeros(at.CARRIED)
    start = system.contact.at
    before = arrays.tip[0] @ state[at.D, : arrays.sizes[0]]
    carried[at.MATERIAL] = carried[at.ABSCISSA] = start
    carried[at.ABSCISSA_BEFORE] = (
        start - before - (arrays.imposed(zero + step, step)[0] - arrays.imposed(zero, step)[0])
    )
    return state, carried
