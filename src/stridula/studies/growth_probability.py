"""Probability that modes of sliding grow, for uncertain parameters, by linear theory at random points."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..analysis.stability import highest_cutoff
from ..arrays import Array
from ..checks import ArgumentError, by_key, count, finite, one_or_each, positive, rising, within
from ..linear.growth import Growth
from ..records.variables import described
from ..scenarios.quantities import quantity
from ..system import System
from ..version import __version__
from .computed import Plan, Watcher, check_options, computed
from .frequency_bands import bands_of, edges_between
from .points import POINT, plain_python
from .probabilities import BOUNDS, shares_of, wilson_interval
from .random_points import RandomPoints
from .sources import SystemOf, varying
from .swept import coordinates, usual_failure
from .task import Outcome
from .theory_task import TheoryTask

STABLE, UNSTABLE = "stable", "unstable"
VERDICTS = (STABLE, UNSTABLE, "held", "lifted off", "jammed")
# Number of points computed together.
POINTS_OF_A_PART = 32
OWN = (
    *("point", "band", "bound", "verdict", "message", "growth_rate", "frequency", "unstable_modes", "kind"),
    *("probability", "probability_interval", "frequency_range", "edge", "beyond_cutoff", "band_growth_rate"),
    *("any_probability", "any_probability_interval", "kind_probability", "kind_probability_interval"),
    *("samples", "failed"),
)


def mode_probability(
    scenario: str | Path | xr.Dataset | SystemOf,
    uncertain: Mapping[str, Any],
    *,
    samples: int = 1000,
    correlations: Mapping[tuple[str, str], float] | None = None,
    seed: int = 0,
    overrides: Mapping[str, Any] | None = None,
    gap: float = 0.05,
    edges: Sequence[float | str] | None = None,
    highest: float | str | None = None,
    velocity: float | Sequence[float] | None = None,
    confidence: float = 0.95,
    out: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    watchers: Sequence[Watcher] = (),
    progress: bool = False,
) -> xr.Dataset:
    """Return the probability that modes of sliding grow, for uncertain parameters.

    Linear theory, as in `sliding_stability`, is evaluated at random points, without any run. Modes of different points
    count as the same if their frequencies are in one band. Numbers of modes would not do: two modes that merge exchange
    them, depending on the path of parameters around the merge. By default the bands are separated in all gaps
    between the frequencies of growing modes that are wider than `gap`.

    Parameters
    ----------
    scenario : str, Path, xarray.Dataset or callable
        A scenario, or a function of the parameters by name that makes a system, as for `sweep`.
    uncertain : mapping
        Distribution of each parameter by key, as for `RandomPoints`.
    samples : int, optional
        Number of points.
    correlations : mapping, optional
        Correlations by pair of keys, as for `RandomPoints`.
    seed : int, optional
        Seed of the points: equal seeds give equal results.
    overrides : mapping, optional
        Values of other keys, the same at every point.
    gap : float, optional
        Width of the gaps that separate bands, relative to the frequency above [1], strictly between 0 and 1.
    edges : sequence of float or str, optional
        Frequencies [Hz] that separate bands, rising, in place of such gaps.
    highest : float or str, optional
        Modes above this frequency [Hz] are not counted.
    velocity : float or sequence of float, optional
        Slip velocity where nothing prescribes it [m/s], as for `sliding_stability`.
    confidence : float, optional
        Level of the intervals [1], strictly between 0 and 1.
    out, workers, client, watchers, progress : optional
        As for `sweep`.

    Returns
    -------
    xarray.Dataset
        Over ``band``: ``probability`` that a mode in the band grows, with ``probability_interval`` over ``bound``;
        ``edge``, both ends of the band [Hz]; of the growing modes the median ``frequency`` [Hz] and
        ``frequency_range``, NaN if none grows; ``beyond_cutoff``, whether this range begins above the cutoff of every
        body, so that modes left out would take part. ``any_probability``: that any mode grows. Over ``kind`` the
        ``kind_probability`` of each verdict of linear theory. All have Wilson's intervals; points that failed widen
        them, as if at none or at all of them the mode grew. ``samples`` and ``failed``: numbers of points;
        ``attrs["failure"]`` is the most frequent message. Over ``point``: the parameters, ``verdict`` (stable,
        unstable, held, lifted off, jammed), ``growth_rate`` [1/s] of the mode that grows fastest or decays least, NaN
        where nothing slides, ``unstable_modes``, ``message``; with ``band`` the ``band_growth_rate`` [1/s], NaN where
        no mode in the band grows. ``attrs["notes"]`` counts the points with several equilibria, of which one is used,
        those without one that satisfies every inequality, and those of which only the lowest modes are known.

    Raises
    ------
    ScenarioError
        If the scenario cannot be used, or a key is not known, means several places or takes values of another kind.
    ValueError
        If an argument is out of its range, all points fail, or as in `sweep`.
    OSError
        If the file or a part cannot be written; finished parts are kept.
    RuntimeError
        If a part fails on other machines; finished parts are kept.
    """
    check_options(workers, client, watchers, progress)
    points = RandomPoints(uncertain, count("samples", samples), correlations, seed)
    within("gap", gap, 0.0, 1.0, ends=False)
    within("confidence", confidence, 0.0, 1.0, ends=False)
    given = None if edges is None else checked_edges("edges", edges)
    task: dict[str, Any] = {
        "highest": math.inf if highest is None else _frequency("highest", highest),
        "velocity": None if velocity is None else one_or_each("velocity", plain_python(velocity), finite),
    }
    layout = points.layout()
    clash = next((key for key in layout.keys if key in OWN), None)
    if clash is not None:
        raise ArgumentError("key", "not have the name of a result", clash, got=f"{clash!r}: write its full key")
    fixed = {key: plain_python(value) for key, value in by_key("overrides", overrides).items()}
    # Required by functions without a duration; nothing runs.
    found = varying(scenario, fixed, {"duration": 1.0}, layout, highest_rate=math.inf)
    asked = task | {"points": layout.asked, "overrides": fixed, "gap": gap, "edges": given, "confidence": confidence}
    attributes = found.attributes | {
        "stridula_version": __version__,
        "probability": json.dumps(asked, ensure_ascii=False, default=str),
    }

    def labelled(outcomes: Sequence[Outcome]) -> xr.Dataset:
        known = coordinates(layout, found.keys, found.values)
        return _counted(outcomes, known, attributes | {"confidence": confidence}, given, gap)

    plan = Plan("probability", _Task(found.source, **task), found.values, POINTS_OF_A_PART, attributes, labelled)
    return computed(plan, out, workers, client, watchers, progress)


@dataclass(frozen=True)
class _Task(TheoryTask):
    """The growing modes up to a frequency [Hz] at each point."""

    highest: float

    def kept(self, system: System, known: Growth) -> tuple[str, dict[str, Any]]:
        """Return the verdict of a point, its growing modes, and what is known of its equilibrium."""
        counted = np.empty(0, dtype=complex) if known.exponents is None else known.exponents
        most = 2.0 * np.pi * self.highest
        counted, growing = (one[one.imag <= most] for one in (counted, known.growing))
        limit = highest_cutoff(system)
        verdict = UNSTABLE if growing.size else STABLE
        return known.equilibrium.kind if known.exponents is None else verdict, {
            "growth_rate": float(counted.real.max()) if counted.size else None,
            "modes": [[float(one.imag / (2.0 * np.pi)), float(one.real)] for one in growing],
            "several": known.equilibrium.found == "several",
            "violated": known.equilibrium.found == "none found",
            "complete": known.complete,
            "limit": limit if math.isfinite(limit) else None,
        }


def _counted(
    outcomes: Sequence[Outcome], known: dict[str, Any], attributes: dict[str, Any], given: Any, gap: float
) -> xr.Dataset:
    """Return the outcomes of all points as probabilities."""
    good = [one for one in outcomes if not one["message"]]
    messages = [one["message"] for one in outcomes if one["message"]]
    if not good:
        raise ArgumentError("uncertain", "leave a point at which linear theory holds", got=usual_failure(messages))
    confidence, failed = attributes["confidence"], len(messages)
    modes = [np.array(one["values"].get("modes", []), dtype=float).reshape(-1, 2) for one in outcomes]
    frequencies = np.concatenate(modes)[:, 0]
    edges = edges_between(frequencies, gap) if given is None else np.array(given)
    rates = _rates(modes, edges)
    number = bands_of(frequencies, edges)
    inside = [frequencies[number == band] for band in range(len(edges) + 1)]
    ranges = np.array([[one.min(), one.max()] if one.size else [np.nan] * 2 for one in inside])
    seen = np.isfinite(rates).sum(axis=0).tolist()
    limit = max((one["values"]["limit"] for one in good if one["values"]["limit"] is not None), default=np.inf)
    verdicts = [one["ended"] if not one["message"] else "" for one in outcomes]
    kinds, kind_bounds = shares_of(VERDICTS, np.array([one for one in verdicts if one]), confidence, failed)
    unstable = sum(one == UNSTABLE for one in verdicts)
    nothing = float("nan")
    grown = [one["values"].get("growth_rate") for one in outcomes]
    numbers = [
        float(len(one)) if word not in ("", "jammed") else nothing for one, word in zip(modes, verdicts, strict=True)
    ]

    def interval(one: int) -> list[float]:
        return wilson_interval(one, len(good), confidence, failed)

    level = described("1", "Wilson's interval, widened by points that failed")
    data: dict[str, Any] = {
        "probability": ("band", [one / len(good) for one in seen], described("1", "probability that a mode grows")),
        "probability_interval": (("band", "bound"), [interval(one) for one in seen], level),
        "frequency": (
            "band",
            [np.median(one) if one.size else nothing for one in inside],
            described("Hz", "median frequency of the growing modes"),
        ),
        "frequency_range": (("band", "bound"), ranges, described("Hz", "frequencies of the growing modes")),
        "edge": (("band", "bound"), _ends(edges), described("Hz", "ends of the band")),
        "beyond_cutoff": ("band", ranges[:, 0] > limit, described("1", "whether above the cutoff of every body")),
        "any_probability": ((), unstable / len(good), described("1", "probability that any mode grows")),
        "any_probability_interval": ("bound", interval(unstable), level),
        "kind_probability": ("kind", kinds, described("1", "probability of the verdict")),
        "kind_probability_interval": (("kind", "bound"), kind_bounds, level),
        "samples": ((), len(outcomes), described("1", "number of points")),
        "failed": ((), failed, described("1", "number of points that failed")),
        "verdict": (POINT, np.array(verdicts, dtype=object), {"long_name": "verdict of linear theory"}),
        "growth_rate": (
            POINT,
            [nothing if one is None else one for one in grown],
            described("1/s", "largest growth rate"),
        ),
        "unstable_modes": (POINT, numbers, described("1", "number of modes that grow")),
        "message": (POINT, np.array([one["message"] for one in outcomes], dtype=object), {"long_name": "failure"}),
        "band_growth_rate": ((POINT, "band"), rates, described("1/s", "largest growth rate in the band")),
    }
    own = {"band": np.arange(len(edges) + 1), "bound": list(BOUNDS), "kind": list(VERDICTS)}
    words = attributes | {"notes": "; ".join(_notes(good))}
    return xr.Dataset(data, known | own, words | ({"failure": usual_failure(messages)} if messages else {}))


def _rates(modes: Sequence[Array], edges: Array) -> Array:
    """Return the largest growth rate of each point in each band [1/s], NaN where no mode grows."""
    found = np.full((len(modes), len(edges) + 1), np.nan)
    for row, one in zip(found, modes, strict=True):
        np.fmax.at(row, bands_of(one[:, 0], edges), one[:, 1])
    return found


def _ends(edges: Array) -> Array:
    whole = np.concatenate([[0.0], edges, [np.inf]])
    return np.stack([whole[:-1], whole[1:]], axis=1)


def _notes(good: Sequence[Outcome]) -> list[str]:
    """Return what is known only in part, in words."""
    several = sum(one["values"]["several"] for one in good)
    violated = sum(one["values"]["violated"] for one in good)
    partial = sum(not one["values"]["complete"] for one in good)
    found = []
    if several:
        found.append(f"{several} of {len(good)} points have several equilibria, of which one is used")
    if violated:
        found.append(f"at {violated} of {len(good)} points no equilibrium satisfies every inequality")
    if partial:
        found.append(f"at {partial} of {len(good)} points only the lowest modes are known")
    return found


def checked_edges(name: str, given: Any) -> list[float]:
    """Return rising frequencies [Hz] from numbers or texts."""
    if isinstance(given, str) or not hasattr(given, "__len__") or not len(given):
        raise ArgumentError(name, "be rising frequencies", given)
    found = [_frequency(f"{name}[{number}]", one) for number, one in enumerate(given)]
    rising(name, found)
    return found


def _frequency(name: str, given: Any) -> float:
    """Return a frequency above 0 [Hz], from a number or a text."""
    try:
        return positive(name, quantity(plain_python(given), "Hz"))
    except ArgumentError as error:
        raise error.renamed(name) from None
