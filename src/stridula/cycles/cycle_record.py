"""The record of a limit cycle: one period as of `simulate`, with its frequency, amplitudes, harmonics and stability."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..integration.marches import March
from ..integration.preparation import Preparation
from ..integration.run import Midway
from ..integration.settings import Settings
from ..integration.together import march_together
from ..records import ModalMotion, Probe
from ..records.probes import displacements_of_tip, usual_probes
from ..records.variables import PROBES, described
from ..system import System
from .floquet import Multipliers
from .returning import Return

# Most harmonics that are listed.
HARMONICS = 20
# Terms of the energy balance of a period, with their sign in the sum that is zero.
BALANCE = {
    "drive_work": 1.0,
    "convection_work": 1.0,
    "friction_loss": -1.0,
    "impact_loss": -1.0,
    "damping_loss": -1.0,
}


def cycle_record(
    system: System, cycle: Return, multipliers: Multipliers, settings: Settings, title: str, newton_steps: int = 0
) -> xr.Dataset:
    """Return the record of a limit cycle; its content as in `limit_cycle`."""
    record = _period(system, cycle, settings, title)
    steps = record.sizes["time"]
    own: dict[str, Any] = {
        "period": ((), cycle.orbit.period, described("s", "period of the cycle")),
        "frequency": ((), 1.0 / cycle.orbit.period, described("Hz", "frequency of the cycle")),
        "residual": ((), cycle.residual, described("1", "distance of the motion from itself a period later")),
        "multiplier": (
            ("multiplier_number", "part"),
            np.stack([multipliers.values.real, multipliers.values.imag], axis=-1),
            described("1", "Floquet multipliers, the largest first"),
        ),
        "trivial": (
            "multiplier_number",
            np.arange(multipliers.values.size) == (-1 if multipliers.trivial is None else multipliers.trivial),
            described("1", "whether a multiplier is that of the motion along the cycle, which is 1"),
        ),
        "accuracy": ((), multipliers.accuracy, described("1", "distance of the trivial multiplier from 1")),
        "stable": ((), multipliers.is_stable, described("1", "whether no neighbouring motion departs")),
        "second_frequency": (
            (),
            multipliers.second_frequency,
            described("Hz", "frequency by which the leading pair of multipliers turns"),
        ),
        "periods_marched": ((), cycle.of_period.counter.marched, described("1", "periods marched in the search")),
        "newton_steps": ((), newton_steps, described("1", "steps of Newton's method")),
    }
    coordinates: dict[str, Any] = {"part": ["real", "imaginary"]}
    most = min(HARMONICS, (steps - 1) // 2)
    for name, variable in PROBES.items():
        if name in record and name != ModalMotion.quantity:
            values, probes = record[name].values, record[name].dims[1]
            own[f"{name}_amplitude"] = (
                probes,
                0.5 * np.ptp(values, axis=0),
                described(variable.units, f"half the range of the {variable.long_name}"),
            )
            own[f"{name}_harmonic"] = (
                ("harmonic", probes),
                harmonics(values, most),
                described(variable.units, f"amplitude of each harmonic of the {variable.long_name}"),
            )
            coordinates["harmonic"] = np.arange(1, most + 1)
    terms = {name: sign * float(record[name][-1]) for name, sign in BALANCE.items()}
    own["period_energy"] = (
        "energy_term",
        [*terms.values(), sum(terms.values())],
        described("J", "energy gained in a period by each term of the balance, and their sum"),
    )
    coordinates["energy_term"] = [*terms, "sum"]
    record = record.assign(own).assign_coords(coordinates)
    record.attrs["verdict"] = multipliers.verdict
    return record


def harmonics(values: Array, most: int) -> Array:
    """Return the amplitudes of the first harmonics of one period, samples along the first axis."""
    return np.asarray(2.0 * np.abs(np.fft.rfft(values, axis=0)[1 : most + 1]) / len(values))


def probes_of(system: System, settings: Settings) -> tuple[Probe, ...]:
    """Return the probes asked for; else the usual ones, with the displacements of the first tip."""
    if settings.probes is not None:
        return tuple(settings.probes)
    return (*usual_probes(system), *displacements_of_tip(system))


def _period(system: System, cycle: Return, settings: Settings, title: str) -> xr.Dataset:
    """Return a period as a record with a sample at every step."""
    orbit, of_period, step = cycle.orbit, cycle.of_period, cycle.step
    asked = replace(settings, step=step, sample_rate=1.0 / step, probes=probes_of(system, settings))
    preparation = Preparation(orbit.period, asked)
    state = cycle.vectors.state(orbit.vector, step, orbit.status)
    midway = Midway(state, of_period.first_step)
    run = preparation.run(preparation.arrays(system), title=title, midway=midway)
    march_together([run], March([run.blocks], [run.state], step, 1, settings.solve))
    return run.record()
