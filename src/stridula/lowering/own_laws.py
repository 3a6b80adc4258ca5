"""Friction laws defined by users: refused unless their formulas are those that the march computes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from .._kernels.contact import friction as marched
from .._kernels.layout import columns as at
from .._kernels.layout.contact_values import Law
from .._kernels.layout.laws import CODES, LAW_COLUMNS, NEW_STATE, PARAMETERS, STATIC
from ..arrays import Array
from ..checks import ArgumentError
from ..contact import LAWS, FrictionLaw
from ..contact.linearised import Linearised

# Range of slip speeds at which formulas are compared, in decades below and above the speed up to which a curve is
# characteristic, and their number.
DECADES_BELOW, DECADES_ABOVE, SPEEDS = 8, 3, 441
# Slip [m] after which a contact has forgotten its first state.
FAR = 1e9
# Relative difference that may be due to rounding; relative step of a derivative, and its error relative to ratio and
# speed.
EQUAL, STEP, SLOPE_ERROR = 1e-9, 1e-5, 1e-6


def check_law(law: FrictionLaw) -> None:
    """Raise ValueError if a law has formulas other than those that are marched under its code and parameters.

    The coefficient, its derivative in linear theory, the ratio at rest and the properties of the law are compared, at
    slip speeds over eleven decades in both senses. Laws of the package need no check.
    """
    if type(law) in LAWS:
        return
    for words, got in _differences(law):
        words = f"{words}, as the march computes under its kernel_code and parameters"
        raise ArgumentError("friction", words, law, got=f"{got} of {type(law).__name__}")


def _differences(law: FrictionLaw) -> Iterator[tuple[str, str]]:
    """Yield the differences between a law and its march, in words."""
    if law.kernel_code not in CODES:
        yield f"have a kernel_code out of {', '.join(CODES)}", repr(law.kernel_code)
        return
    code, given, needed = CODES[law.kernel_code], law.parameters(), PARAMETERS[law.kernel_code]
    if set(given) != set(needed):
        yield f"have the parameters {', '.join(needed)}", ", ".join(given) or "none"
        return
    march = _in_march(law)
    for name, own, marches in (
        ("set_valued", law.set_valued, bool(marched.set_valued(code))),
        ("has_state", law.has_state, not marched.set_valued(code)),
        ("state_is_vector", law.state_is_vector, code == at.LUGRE),
    ):
        if own != marches:
            yield f"have {name} {marches}, as {law.kernel_code} does", repr(own)
    speeds = law.reach * np.logspace(-DECADES_BELOW, DECADES_ABOVE, SPEEDS)
    ratios = np.array([_ratio(law, march, speed) for speed in speeds.tolist()])
    yield from _curve(law, speeds, ratios)
    if law.set_valued and not np.isclose(law.holding, held := march.at_rest, rtol=EQUAL):
        yield f"have the holding ratio {held:.6g}", f"{law.holding:.6g}"
    yield from _slopes(law, speeds, ratios)
    if law.has_state:
        yield from _states(law, march, speeds)


def law_of_march(law: FrictionLaw) -> tuple[int, Array]:
    """Return the code of a law and its row of parameters."""
    code = CODES[law.kernel_code]
    row = np.concatenate([np.zeros(LAW_COLUMNS), law.pieces if code in (at.CURVE, at.IN_SERIES) else []])
    for name, value in law.parameters().items():
        row[PARAMETERS[law.kernel_code][name]] = value
    row[NEW_STATE] = law.state_at_landing
    return code, row


def of_one_width(rows: Sequence[Array]) -> list[Array]:
    """Return tables of laws, of any width, with zeros behind the shorter rows."""
    width = max(one.shape[-1] for one in rows)
    return [np.concatenate([one, np.zeros((*one.shape[:-1], width - one.shape[-1]))], axis=-1) for one in rows]


def _in_march(law: FrictionLaw) -> Law:
    """Return a law as a contact of the march has it."""
    code, row = law_of_march(law)
    return Law(code, row[None], 0, float(row[STATIC]), 1.0)


def _ratio(law: FrictionLaw, march: Law, speed: float) -> float:
    """Return the ratio of steady sliding in the march."""
    if not law.has_state:
        return float(marched.sliding_ratio(march, speed))
    return float(marched.state_ratio(march, _steady_state(law, march, speed), speed))


def _steady_state(law: FrictionLaw, march: Law, speed: float) -> float:
    """Return the state that the march reaches in sliding, whatever it begins with."""
    return float(marched.next_state(march, law.state_in_sliding(speed), speed, FAR / speed))


def _states(law: FrictionLaw, march: Law, speeds: Array) -> Iterator[tuple[str, str]]:
    """Yield differences of the internal state in steady sliding."""
    for speed in speeds.tolist():
        own, marches = law.state_in_sliding(speed), _steady_state(law, march, speed)
        if not np.isclose(own, marches, rtol=EQUAL, atol=0.0):
            yield f"have the state_in_sliding({speed:.4g}) of {marches:.6g} {law.state_units}", f"{own:.6g}"
            return


def _curve(law: FrictionLaw, speeds: Array, ratios: Array) -> Iterator[tuple[str, str]]:
    """Yield differences of the coefficient of friction in steady sliding."""
    for sense in (1.0, -1.0):
        own = np.broadcast_to(np.asarray(law.coefficient_at(sense * speeds), dtype=float), speeds.shape)
        different = ~np.isclose(own, ratios, rtol=EQUAL, atol=EQUAL * np.abs(ratios).max())
        if different.any():
            first = int(different.argmax())
            place = f"at {sense * speeds[first]:.4g} m/s"
            yield f"have the coefficient_at {ratios[first]:.6g} {place}", f"{own[first]:.6g}"
    if not law.depends_on_speed and np.ptp(ratios) > EQUAL * np.abs(ratios).max():
        yield "have depends_on_speed True", "False"


def _slopes(law: FrictionLaw, speeds: Array, ratios: Array) -> Iterator[tuple[str, str]]:
    """Yield differences of the linearised law along and across steady sliding, with its state in the steady one."""
    for speed, ratio in zip(speeds.tolist(), ratios.tolist(), strict=True):
        before, here, after = np.asarray(law.coefficient_at(speed * (1.0 + STEP * np.arange(-1, 2))), dtype=float)
        one_sided = (here - before) / (STEP * speed), (after - here) / (STEP * speed)
        error = SLOPE_ERROR * abs(ratio) / speed
        along, across = (_steady(one) for one in (law.linearised_at(speed), law.linearised_across(speed)))
        if not min(one_sided) - error <= along <= max(one_sided) + error:
            yield f"have the slope {np.mean(one_sided):.6g} s/m in linearised_at({speed:.4g})", f"{along:.6g} s/m"
            return
        if abs(across - ratio / speed) > error:
            yield f"have the slope {ratio / speed:.6g} s/m in linearised_across({speed:.4g})", f"{across:.6g} s/m"
            return


def _steady(law: Linearised) -> float:
    """Return the change of the ratio with the slip velocity [s/m] once the state has followed."""
    followed = law.by_state * law.state_by_velocity / law.state_by_state if law.state_by_state else 0.0
    return law.slope - followed
