"""The result of a run as text: the summary printed by `stridula run` and shown in notebooks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..cards import Stroke, drawing
from ..cards import card as draw_card
from ..checks import ArgumentError, counted, instance
from ..records.by_point import by_point
from ..records.by_surface import groups
from ..records.checked import record
from ..records.variables import ENERGY, STATUS_WORDS
from ..system import System
from .bowed import bowed_motion
from .coarse_steps import coarse
from .phases import bursts
from .regimes import LIMITS, regime_of, tones_beside
from .several_contacts import loads, mean_shares
from .spectra import dominant_frequency

# Endings of runs that are shown in a line of the card.
ENDINGS = {
    "off the track": "the tip ran off the end of its track",
    "not finite": "failed: the state is no longer finite",
    "contact unsolved": "failed: the contact forces did not converge",
    "energy created": "failed: energy was created without a source",
    "spring too stiff": "failed: the step is too long for the stiffness that a nonlinear spring has reached",
    "interrupted": "interrupted",
}
# Regimes that are cycles of one frequency.
SQUEAL = "squeal"
CYCLES = (SQUEAL, "stick-slip")
# How to get the sound level, which takes too long to compute for a card.
ASK_FOR_LEVEL = 'not computed: st.equivalent_level(st.radiate(run, system), "A") gives LAeq at 1 m'
# Relative changes of a force below this are rounding errors.
STEADY = 1e-9


# Number of columns, width and height of the picture of a force, which is scaled to the drawing.
COLUMNS, LONG, HIGH = 240, 240.0, 60.0


@dataclass(frozen=True)
class RecordCard:
    """The result of a run as text: a table in print, and in notebooks a table with a picture of the normal force.

    Attributes
    ----------
    title : str
        Title of the run, empty if none.
    facts : mapping
        Results as text by name: first whether it squeals, its pitch and its level.
    force : ndarray, shape (columns, 2)
        Smallest and largest total normal force in successive intervals of time [N]; empty without samples.
    """

    title: str
    facts: Mapping[str, str]
    force: Array = field(repr=False, compare=False)

    def __str__(self) -> str:
        width = max(map(len, self.facts))
        return "\n".join(f"{name:<{width}}  {words}" for name, words in self.facts.items())

    def _repr_html_(self) -> str:
        """Return the table with a picture of the normal force."""
        return draw_card(self.title or "Record", self.facts, drawing(_strokes(self.force), "normal force over time"))


def card(run: xr.Dataset, system: System | None = None) -> RecordCard:
    """Return the result of a run as text, as printed by `stridula run`.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate`.
    system : System, optional
        The system of the run; needed for the motion of a bowed string.

    Returns
    -------
    RecordCard
        The regime, its pitch, and the level or the way to compute it; then the forces, the shares of the time in each
        status, the balance of energy, and the computation. In notebooks the last line of a cell shows it as a table.

    Raises
    ------
    ValueError
        If `run` is not a record of `simulate`, or lacks variables or attributes that a card needs, or `system` is no
        System.
    """
    given = record("run", run, "normal_force")
    for name in ("ended", "sample_interval", "modes", "step", "scheme", "wall_time"):
        if name not in given.attrs:
            raise ArgumentError("run", f"be a record with the attribute {name}", run, got="one without")
    if system is not None:
        instance("system", system, System)
    return RecordCard(str(given.attrs.get("title", "")), facts_of(given, system), _force_over_time(given))


def facts_of(record: xr.Dataset, system: System | None = None, level: str = ASK_FOR_LEVEL) -> dict[str, str]:
    """Return the result of a run in words: how it ended if not as asked, whether and how it squeals, then its numbers.

    Parameters
    ----------
    record : xarray.Dataset
        The record.
    system : System, optional
        Its system, to tell which motion a bowed string is in.
    level : str, optional
        How loud it is, in words, or how that is found; no line says it where empty.
    """
    lines = _ending(record)
    few = ""
    if record.sizes["time"] > 1:
        found = regime_of(by_point(record))
        lines |= _heard(record, found) | ({"sound level": level} if level else {}) | _strings(record, system)
        few = coarse(found, float(record.attrs["step"]))
    if record.sizes["time"]:
        lines |= _contact(record) | _energy(record)
    if few:
        lines["coarse step"] = f"{few}; check_step or --check-step tells how far half the step moves the results"
    return lines | _notes(record) | _computation(record)


def _heard(record: xr.Dataset, found: Mapping[str, float | str]) -> dict[str, str]:
    """Return the regime of a run and its pitch."""
    regime, interval = str(found["regime"]), record.attrs["sample_interval"]
    answer = "yes" if regime == SQUEAL else f"no, {regime}"
    pitch = _pitch(regime, float(found["frequency"]), interval)
    return {"squeals": f"{answer} (confidence {float(found['confidence']):.2f})"} | ({"pitch": pitch} if pitch else {})


def _force_over_time(record: xr.Dataset) -> Array:
    force = record["normal_force"].transpose("time", ...).values
    total = force.sum(axis=tuple(range(1, force.ndim)))
    parts = [part for part in np.array_split(total, COLUMNS) if part.size]
    return np.array([[part.min(), part.max()] for part in parts]).reshape(-1, 2)


def _strokes(force: Array) -> list[Stroke]:
    """Return a force over time as strokes, from zero to its largest value; nothing for a constant force."""
    largest = float(np.abs(force).max(initial=0.0))
    if len(force) < 2 or not np.ptp(force):
        return []
    x = np.linspace(0.0, LONG, len(force))
    y = HIGH * force / largest
    bars = [np.array([[one, low], [one, high]]) for one, (low, high) in zip(x, y, strict=True)]
    return [Stroke([np.array([[0.0, 0.0], [LONG, 0.0]])], 1.0, 0.4), Stroke(bars, 1.2)]


def _ending(record: xr.Dataset) -> dict[str, str]:
    """Return the ending and its time of a run that did not finish."""
    ended = record.attrs["ended"]
    if ended not in ENDINGS:
        return {}
    end = float(record["time"][-1]) if record.sizes["time"] else 0.0
    return {"ended": f"{ENDINGS[ended]} at t = {end:.6g} s"}


def _notes(record: xr.Dataset) -> dict[str, str]:
    """Return where the model of the system ends, nothing if it is within its limits."""
    notes = str(record.attrs.get("notes", ""))
    return {"notes": notes} if notes else {}


def _computation(record: xr.Dataset) -> dict[str, str]:
    """Return the simulated time, computing time, step and scheme."""
    simulated = record.sizes["time"] * record.attrs["sample_interval"]
    wall_time, compile_time = record.attrs["wall_time"], record.attrs.get("compile_time", 0.0)
    seconds = f"{compile_time:.0f}" if compile_time >= 10.0 else f"{compile_time:.2g}"
    compiled = f", after {seconds} s of compiling" if compile_time else ""
    modes = counted(int(record.attrs["modes"]), "mode")
    return {
        "simulated": f"{simulated:.6g} s{_since(record)}",
        "computed in": f"{wall_time:.3g} s, {simulated / max(wall_time, 1e-9):.2f} x real time{compiled}",
        "step": f"{record.attrs['step']:.4g} s, {record.attrs['scheme']}, {modes}",
    }


def _since(record: xr.Dataset) -> str:
    """Return the time span of a record that continues another one."""
    interval = record.attrs["sample_interval"]
    if not record.sizes["time"] or record["time"][0] < 1.5 * interval:
        return ""
    first, last = float(record["time"][0]) - interval, float(record["time"][-1])
    return f", from t = {first:.6g} s to {last:.6g} s"


def _strings(record: xr.Dataset, system: System | None) -> dict[str, str]:
    """Return the motion of the string touched by all contacts of a run, if there is one."""
    first = system.contacts[0] if system else None
    stretched = [body for body in (first.tip.body, first.track_body) if getattr(body, "tension", 0.0)] if first else []
    if system is None or len(stretched) != 1 or record.sizes["time"] < 2:
        return {}
    string: Any = stretched[0]
    if not all(string in (contact.tip.body, contact.track_body) for contact in system.contacts):
        return {}
    fundamental = float(string.modes().frequency[0])
    found = bowed_motion(record, fundamental)
    rate, frequency = float(found["slips_per_period"]), float(found["frequency"])
    words = f"{found['motion'].item()}{'' if math.isnan(frequency) else f' at {frequency:.4g} Hz'}"
    slips = "" if math.isnan(rate) else f", {rate:.3g} slips in a period of {fundamental:.4g} Hz"
    return {"bowed string": f"{words}{slips}, slips for {100.0 * float(found['slip_share']):.1f} % of the time"}


def _contact(record: xr.Dataset) -> dict[str, str]:
    """Return the results of the contact; if there are several, of all together and of each contact or surface."""
    points = by_point(record)
    if "contact" in points.dims:
        lines = {}
        for name, part in _parts(record, points):
            alone = _one_contact(part) if "contact" not in part.dims else _surface(part)
            lines[name] = "; ".join(words for words in alone.values() if words[:4] != "none")
        unsolved = int(record["unsolved_steps"].sum())
        words = f"{counted(unsolved, 'step')} with contact forces out of tolerance"
        return lines | ({"unsolved": words} if unsolved else {})
    return {name: words for name, words in _one_contact(record).items() if name != "regime"}


def _parts(record: xr.Dataset, points: xr.Dataset) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield the name and the record of each contact, with the points of a surface as one."""
    names = [str(name) for name in points["contact"].values]
    surfaces = [str(name) for name in points["surface"].values] if "surface" in points.coords else []
    for members in groups(names, surfaces):
        if len(members) > 1:
            yield surfaces[members[0]], points.isel(contact=members)
        else:
            yield names[members[0]], record.sel(contact=names[members[0]])


def _surface(record: xr.Dataset) -> dict[str, str]:
    """Return the results of all points of a surface together."""
    carried = loads(record["normal_force"].values, LIMITS.rare)
    return {
        "points": counted(carried.size, "point"),
        "regime": _regime(record),
        "normal force": _force(record["normal_force"].values.sum(axis=1)),
        "status": _status(mean_shares(record["status_share"].values, carried)),
        **_warmth(record),
    }


def _status(shares: Array) -> str:
    """Return the shares of the time in each status."""
    return ", ".join(f"{word} {100 * max(share, 0.0):.1f} %" for word, share in zip(STATUS_WORDS, shares, strict=True))


def _one_contact(record: xr.Dataset) -> dict[str, str]:
    shares = record["status_share"].mean("time").values
    force, place = record["normal_force"].values, record["contact_position"].values
    jammed = int(record["jammed_steps"].sum())
    lines = {
        "regime": _regime(record),
        "normal force": _force(force),
        **_tones(record),
        "status": _status(shares),
        "tip": f"from {_place(place[0])} to {_place(place[-1])} along the track",
        **_warmth(record),
    }
    return lines | ({"jammed": f"{counted(jammed, 'step')} in which sliding would have jammed"} if jammed else {})


def _warmth(record: xr.Dataset) -> dict[str, str]:
    """Return the temperature of a contact, or the range of those of a surface, at the beginning and at the end."""
    if "temperature" not in record or record["temperature"].isnull().all():
        return {}
    values = record["temperature"].values.reshape(record.sizes["time"], -1)
    ends = (dict.fromkeys(f"{one:.4g}" for one in (np.nanmin(values[k]), np.nanmax(values[k]))) for k in (0, -1))
    first, last = (" to ".join(one) for one in ends)
    return {"temperature": f"{first} degC at the beginning, {last} degC at the end"}


def _place(place: Array) -> str:
    """Return an abscissa, or in space a pair of abscissas [m]."""
    return f"{place:.4g} m" if np.ndim(place) == 0 else f"({', '.join(f'{one:.4g}' for one in place)}) m"


def _force(force: Array) -> str:
    """Return mean, fluctuation and peak of a force [N]."""
    if _is_steady(force, force):
        return f"{force.mean():.4g} N, constant"
    return f"mean {force.mean():.4g} N, fluctuation {force.std():.4g} N rms, peak {force.max():.4g} N"


def _is_steady(heard: Array, force: Array) -> bool:
    """Return whether a part of a force varies by no more than rounding."""
    return bool(np.ptp(heard) <= STEADY * np.abs(force).max())


def _tones(record: xr.Dataset) -> dict[str, str]:
    """Return the tones beside the pitch, or without a pitch the dominant frequency of the normal force."""
    if record.sizes["time"] < 2:
        return {}
    pitch = float(regime_of(record)["frequency"])
    if math.isnan(pitch):
        return {"dominant frequency": _frequency(record)}
    others = [f"{one:.4g} Hz" for one in tones_beside(record, pitch)]
    where = " in the bursts" if len(bursts(record)) else ""
    return {"other tones": f"{', '.join(others)}{where}"} if others else {}


def _frequency(record: xr.Dataset) -> str:
    """Return the dominant frequency of the normal force."""
    force = record["normal_force"].values
    # The load is applied in the first sample.
    if _is_steady(force[1:], force):
        return "none, the normal force is constant"
    frequency = dominant_frequency(record["normal_force"])
    return "none" if math.isnan(frequency) else f"{frequency:.4g} Hz of the normal force"


def _regime(record: xr.Dataset) -> str:
    """Return the regime with its tone; needs at least 2 samples."""
    if record.sizes["time"] < 2:
        return "none"
    found = regime_of(record)
    tone = _tone(str(found["regime"]), float(found["frequency"]), record.attrs["sample_interval"])
    return f"{found['regime']}{tone} (confidence {found['confidence']:.2f})"


def _tone(regime: str, frequency: float, interval: float) -> str:
    """Return the words that follow a regime: its tone; nothing where there is none."""
    pitch = _pitch(regime, frequency, interval)
    return f"{' at ' if regime in CYCLES else ', '}{pitch}" if pitch else ""


def _pitch(regime: str, frequency: float, interval: float) -> str:
    """Return at which frequency [Hz] a regime is heard, in words; nothing where no tone is."""
    if math.isnan(frequency):
        return ""
    # Samples hide a cycle that is faster than half their rate.
    hertz = f"{frequency:{'.4g' if frequency < 1e4 else '.0f'}} Hz{' or more' if frequency * interval >= 0.5 else ''}"
    return hertz if regime in CYCLES else f"loudest at {hertz}"


def _energy(record: xr.Dataset) -> dict[str, str]:
    largest = {variable.name: float(np.abs(record[variable.name]).max()) for variable in ENERGY}
    residual = largest.pop("ledger_residual")
    term = max(largest, key=largest.__getitem__)
    share = residual / largest[term] if largest[term] else 0.0
    return {"energy ledger": f"residual {share:.1e} of the largest term, {term}"}
