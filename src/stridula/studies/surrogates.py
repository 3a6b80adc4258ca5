"""Polynomial chaos and kriging of modes in a band of frequency, with their error at fresh points."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.special
import xarray as xr

from ..analysis.stability import highest_cutoff
from ..arrays import Array
from ..checks import ArgumentError, by_key, choice, count, finite, one_or_each, within
from ..extras import require
from ..linear.growth import Growth
from ..records.variables import described
from ..system import System
from ..version import __version__
from .computed import Plan, Watcher, check_options, computed
from .distributions import is_range
from .growth_probability import checked_edges
from .points import plain_python
from .probabilities import BOUNDS, wilson_interval
from .random_points import RandomPoints
from .sobol import shares_for_indices, sobol_indices
from .sources import SystemOf, varying
from .swept import usual_failure
from .task import Outcome
from .theory_task import TheoryTask

CHAOS, KRIGING = "chaos", "kriging"
POINTS_OF_A_PART = 16
# Fewest points to fit and to check.
FEWEST = 10
# More modes in a band are determined badly by their polynomial.
MOST_MODES = 6
# Points at which a surrogate is evaluated, and samples of each set for its Sobol indices.
EVALUATED, SAMPLES = 2**16, 2**12
RESAMPLES = 199
# Largest total degree of the polynomials, and number of terms from which those are selected.
DEGREE, TERMS = 8, 600
# Spread of a coefficient, relative to the width of the band, below which it counts as constant.
CONSTANT = 1e-9
QUANTILES = (0.05, 0.5, 0.95)
OUTPUTS = ("growth_rate", "grows")


def mode_surrogate(
    scenario: str | Path | xr.Dataset | SystemOf,
    uncertain: Mapping[str, Any],
    band: Sequence[float | str],
    *,
    kind: str = CHAOS,
    samples: int = 200,
    checks: int = 100,
    tolerance: float = 0.1,
    correlations: Mapping[tuple[str, str], float] | None = None,
    seed: int = 0,
    overrides: Mapping[str, Any] | None = None,
    velocity: float | Sequence[float] | None = None,
    confidence: float = 0.95,
    out: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    watchers: Sequence[Watcher] = (),
    progress: bool = False,
) -> xr.Dataset:
    """Fit the modes in a band by polynomial chaos or kriging.

    Exponents have kinks and merge, but the coefficients of the polynomial of which they are the roots are smooth in the
    parameters, as long as no mode enters or leaves the band. These are fitted at random points, and their roots
    evaluated at many others: linear theory at 300 points takes the place of that at 65 536. Fresh points, which are
    not fitted, measure the error.

    Parameters
    ----------
    scenario : str, Path, xarray.Dataset or callable
        A scenario, or a function of the parameters by name that makes a system, as for `sweep`.
    uncertain : mapping
        Distribution of each parameter by key, as for `RandomPoints`.
    band : sequence of float or str
        Lowest and highest frequency of the modes [Hz], with the same number of modes between, at most 6, at all points.
        Modes that decay faster than at half the width of the band [rad/s] are left out.
    kind : {"chaos", "kriging"}, optional
        Polynomial chaos, whose terms are selected by least angle regression and their corrected error of leaving one
        point out (Blatman & Sudret 2011, J. Comput. Phys. 230), or kriging with a linear trend and Matérn's covariance.
    samples, checks : int, optional
        Numbers of points that are fitted and that are only checked.
    tolerance : float, optional
        Largest error of the growth rate at the checked points, root mean square relative to its standard deviation
        [1]: a worse fit is refused.
    correlations, seed, overrides, velocity, confidence : optional
        As for `mode_probability`.
    out, workers, client, watchers, progress : optional
        As for `sweep`.

    Returns
    -------
    xarray.Dataset
        ``probability`` that a mode in the band grows, and ``probability_interval`` over ``bound``: the surrogate's
        share, widened by Wilson's intervals of what it missed and of its false alarms at the checked points, whose
        numbers are ``missed`` and ``false_alarms``. ``growth_rate`` [1/s] over ``share``, quantiles of that of the mode
        that grows fastest or decays least; ``growth_rate_error`` [1/s] and ``frequency_error`` [Hz], root mean squares
        at the checked points, and ``error``, the first relative to the standard deviation of the growth rate there.
        Sobol indices ``first_order`` and ``total_order`` over ``output`` (``growth_rate``; ``grows``, whether it does)
        and ``parameter``, with bootstrap intervals, as in `sensitivity`; NaN with correlations, for which they are not
        defined, and for what does not vary. ``modes``, their number.

    Raises
    ------
    ScenarioError
        If the scenario cannot be used, or a key is not known, means several places or takes values of another kind.
    ValueError
        If an argument is out of its range, a point fails or does not slide, the number of modes in the band varies, or
        the error exceeds `tolerance`.
    MissingPackage
        If OpenTURNS is not installed.
    """
    require("openturns")
    check_options(workers, client, watchers, progress)
    choice("kind", kind, (CHAOS, KRIGING))
    fitted, fresh = (count(word, n, low=FEWEST) for word, n in (("samples", samples), ("checks", checks)))
    within("tolerance", tolerance, 0.0, 1.0)
    within("confidence", confidence, 0.0, 1.0, ends=False)
    ends = checked_edges("band", band)
    if len(ends) != 2:
        raise ArgumentError("band", "be a lowest and a highest frequency", band)
    points = RandomPoints(uncertain, fitted + fresh, correlations, seed)
    speed = None if velocity is None else one_or_each("velocity", plain_python(velocity), finite)
    layout = points.layout()
    fixed = {key: plain_python(value) for key, value in by_key("overrides", overrides).items()}
    found = varying(scenario, fixed, {"duration": 1.0}, layout, highest_rate=math.inf)
    asked = {"points": layout.asked, "overrides": fixed, "band": ends, "kind": kind, "samples": fitted}
    asked |= {"velocity": speed, "tolerance": tolerance, "confidence": confidence}
    attributes = found.attributes | {
        "stridula_version": __version__,
        "surrogate": json.dumps(asked, ensure_ascii=False, default=str),
    }
    fit = _Fit(points, (ends[0], ends[1]), kind, fitted, tolerance, confidence)

    def labelled(outcomes: Sequence[Outcome]) -> xr.Dataset:
        return fit.dataset(outcomes, attributes)

    task = _Task(found.source, speed, (ends[0], ends[1]))
    plan = Plan("surrogate", task, found.values, POINTS_OF_A_PART, attributes, labelled)
    return computed(plan, out, workers, client, watchers, progress)


@dataclass(frozen=True)
class _Task(TheoryTask):
    """The exponents in a band [Hz] at each point."""

    band: tuple[float, float]

    def kept(self, system: System, known: Growth) -> tuple[str, dict[str, Any]]:
        """Return the exponents in the band, and the growth that is round-off.

        Raises
        ------
        ArgumentError
            If the contacts do not slide.
        """
        if known.exponents is None:
            raise ArgumentError("uncertain", "let the contacts slide at every point", got=known.equilibrium.kind)
        low, high = (2.0 * np.pi * end for end in self.band)
        # Motions that creep pass through every band of frequency, far below the others.
        slow = known.exponents[known.exponents.real >= -0.5 * (high - low)]
        inside = slow[(slow.imag >= low) & (slow.imag <= high)]
        inside = inside[np.lexsort((inside.real, inside.imag))]
        return known.equilibrium.kind, {
            "modes": [[float(one.real), float(one.imag)] for one in inside],
            "beyond": self.band[0] > highest_cutoff(system),
            "round_off": known.round_off,
        }


@dataclass(frozen=True)
class _Fit:
    """A surrogate of the modes in a band.

    Attributes
    ----------
    points : RandomPoints
        Points, of which the first ones are fitted and the others checked.
    band : tuple of float
        Lowest and highest frequency [Hz].
    kind : str
        ``chaos`` or ``kriging``.
    fitted : int
        Number of points that are fitted.
    tolerance, confidence : float
        Largest relative error, level of intervals [1].
    """

    points: RandomPoints
    band: tuple[float, float]
    kind: str
    fitted: int
    tolerance: float
    confidence: float

    def dataset(self, outcomes: Sequence[Outcome], attributes: dict[str, Any]) -> xr.Dataset:
        """Return the surrogate's results.

        Raises
        ------
        ArgumentError
            If it cannot be fitted, or its error is too large.
        """
        exponents = self._exponents(outcomes)
        slack = max(one["values"]["round_off"] for one in outcomes)
        inner = self.points.independent_scores()
        coordinates, coefficients = self._coordinates(inner), _coefficients(self._scaled(exponents))
        model = _model(self.kind, coordinates[: self.fitted], self._uniform, coefficients[: self.fitted])

        def fastest(scores: Array) -> Array:
            roots = self._unscaled(_roots(model(self._coordinates(scores))))
            return np.asarray(np.take_along_axis(roots, roots.real.argmax(axis=1)[:, None], axis=1)[:, 0])

        known = exponents[self.fitted :]
        known = np.take_along_axis(known, known.real.argmax(axis=1)[:, None], axis=1)[:, 0]
        missed_by = fastest(inner[self.fitted :]) - known
        growth_error = float(np.sqrt(np.mean(missed_by.real**2)))
        spread = float(known.real.std())
        error = growth_error / spread if spread > slack else math.inf if growth_error > slack else 0.0
        if not error <= self.tolerance:
            words = f"leave an error of the growth rate of at most {self.tolerance:g} of its deviation"
            got = f"{error:.3g} at fresh points: take more samples, a narrower band, or mode_probability"
            raise ArgumentError("samples", words, got=got)
        true, seen = known.real > slack, fastest(inner[self.fitted :]).real > slack
        missed, false = int(np.sum(true & ~seen)), int(np.sum(seen & ~true))
        drawn = np.random.default_rng([self.points.seed, 1]).standard_normal((EVALUATED, inner.shape[1]))
        growth = fastest(drawn).real
        share, interval = self._probability(growth > slack, missed, false, known.size)
        per_second = described("1/s", "growth rate of the mode that grows fastest")
        data: dict[str, Any] = {
            "probability": ((), share, described("1", "probability that a mode in the band grows")),
            "probability_interval": ("bound", interval, described("1", "interval of the probability")),
            "missed": ((), missed, described("1", "checked points whose growth was missed")),
            "false_alarms": ((), false, described("1", "checked points without the growth predicted")),
            "growth_rate": ("share", np.quantile(growth, QUANTILES), per_second),
            "growth_rate_error": ((), growth_error, described("1/s", "root mean square error at checked points")),
            "frequency_error": (
                (),
                float(np.sqrt(np.mean(missed_by.imag**2)) / (2.0 * np.pi)),
                described("Hz", "root mean square error at checked points"),
            ),
            "error": ((), error, described("1", "error of the growth rate relative to its deviation")),
            "modes": ((), exponents.shape[1], described("1", "number of modes in the band")),
        }
        data |= self._indices(fastest, slack)
        own = {
            "bound": list(BOUNDS),
            "share": list(QUANTILES),
            "output": list(OUTPUTS),
            "parameter": list(self.points.distributions),
        }
        counts = {"samples": self.fitted, "checks": known.size, "kind": self.kind, "confidence": self.confidence}
        beyond = any(one["values"]["beyond"] for one in outcomes)
        notes = "the band lies above the cutoff of every body" if beyond else ""
        return xr.Dataset(data, own, attributes | counts | {"notes": notes})

    def _exponents(self, outcomes: Sequence[Outcome]) -> Array:
        """Return the exponents in the band at all points, shape (points, modes)."""
        messages = [one["message"] for one in outcomes if one["message"]]
        if messages:
            raise ArgumentError("uncertain", "leave no point that fails", got=usual_failure(messages))
        sizes = sorted({len(one["values"]["modes"]) for one in outcomes})
        if len(sizes) > 1 or not 0 < sizes[0] <= MOST_MODES:
            words = f"hold the same number of modes, 1 to {MOST_MODES}, at every point"
            got = f"{sizes[0]} to {sizes[-1]}" if len(sizes) > 1 else f"{sizes[0]}"
            raise ArgumentError("band", words, self.band, got=f"{got} from {self.band[0]:g} to {self.band[1]:g} Hz")
        parts = np.array([one["values"]["modes"] for one in outcomes], dtype=float)
        return np.asarray(parts[..., 0] + 1.0j * parts[..., 1])

    @property
    def _uniform(self) -> list[bool]:
        """Whether each coordinate is uniform from -1 to 1, as ranges are, or normal, as scores are."""
        return [is_range(one) and not self.points.correlations for one in self.points.distributions.values()]

    def _coordinates(self, scores: Array) -> Array:
        return np.where(self._uniform, 2.0 * scipy.special.ndtr(scores) - 1.0, scores)

    def _scaled(self, exponents: Array) -> Array:
        return (exponents - 2.0j * np.pi * self._middle) / self._width

    def _unscaled(self, roots: Array) -> Array:
        return self._width * roots + 2.0j * np.pi * self._middle

    @property
    def _middle(self) -> float:
        return 0.5 * (self.band[0] + self.band[1])

    @property
    def _width(self) -> float:
        return np.pi * (self.band[1] - self.band[0])

    def _probability(self, grows: Array, missed: int, false: int, checks: int) -> tuple[float, list[float]]:
        """Return the share of growth, and its ends, which what was missed raises and false alarms lower."""
        share = float(np.mean(grows))
        sampled = wilson_interval(int(grows.sum()), grows.size, self.confidence)
        more, less = (wilson_interval(one, checks, self.confidence) for one in (missed, false))
        low, high = sampled[0] + more[0] - less[1], sampled[1] + more[1] - less[0]
        return share, [max(low, 0.0), min(high, 1.0)]

    def _indices(self, fastest: Callable[[Array], Array], slack: float) -> dict[str, Any]:
        """Return the Sobol indices of the growth rate, and of whether it is positive."""
        keys = len(self.points.distributions)
        growth = np.full((keys + 2) * SAMPLES, np.nan)
        if not self.points.correlations:
            growth = fastest(scipy.special.ndtri(shares_for_indices(keys, SAMPLES, self.points.seed))).real
        grows = np.where(np.isfinite(growth), (growth > slack).astype(float), np.nan)
        outputs = dict(zip(OUTPUTS, (growth, grows), strict=True))
        found = sobol_indices(outputs, keys, SAMPLES, self.points.seed, self.confidence, RESAMPLES)
        return {name: one for name, one in found.items() if name != "used"}


def _coefficients(exponents: Array) -> Array:
    """Return the coefficients of polynomials with these roots, real and imaginary parts, shape (points, 2 modes)."""
    found = np.ones((len(exponents), 1), dtype=complex)
    for column in exponents.T:
        found = np.pad(found, ((0, 0), (0, 1))) - np.pad(found, ((0, 0), (1, 0))) * column[:, None]
    return np.hstack([found[:, 1:].real, found[:, 1:].imag])


def _roots(coefficients: Array) -> Array:
    """Return the roots of polynomials, shape (points, modes)."""
    real, imaginary = np.split(coefficients, 2, axis=1)
    size = real.shape[1]
    companion = np.zeros((len(real), size, size), dtype=complex)
    companion[:, np.arange(1, size), np.arange(size - 1)] = 1.0
    companion[:, 0] = -(real + 1.0j * imaginary)
    return np.linalg.eigvals(companion)


def _model(kind: str, places: Array, uniform: Sequence[bool], values: Array) -> Callable[[Array], Array]:
    """Return a function of places, shape (points, keys), that is fitted to values, shape (points, outputs)."""
    mean = values.mean(axis=0)
    varied = np.ptp(values, axis=0) > CONSTANT
    deviation = np.where(varied, values.std(axis=0), 1.0)
    make = _chaos if kind == CHAOS else _kriging
    parts = [make(places, uniform, (column - m) / d) for column, m, d in _columns(values, mean, deviation, varied)]

    def evaluated(there: Array) -> Array:
        found = np.tile(mean, (len(there), 1))
        for column, part in zip(np.flatnonzero(varied), parts, strict=True):
            found[:, column] += deviation[column] * part(there)
        return found

    return evaluated


def _columns(values: Array, mean: Array, deviation: Array, varied: Array) -> Any:
    return [(values[:, k], mean[k], deviation[k]) for k in np.flatnonzero(varied)]


def _chaos(places: Array, uniform: Sequence[bool], values: Array) -> Callable[[Array], Array]:
    import openturns as ot

    one = {True: (ot.Uniform(-1.0, 1.0), ot.LegendreFactory()), False: (ot.Normal(), ot.HermiteFactory())}
    distributions, families = zip(*(one[word] for word in uniform), strict=True)
    terms = ot.LinearEnumerateFunction(len(uniform))
    basis = ot.OrthogonalProductPolynomialFactory(list(families), terms)
    degree = max(d for d in range(1, DEGREE + 1) if d == 1 or terms.getBasisSizeFromTotalDegree(d) <= TERMS)
    selection = ot.LeastSquaresMetaModelSelectionFactory(ot.LARS(), ot.CorrectedLeaveOneOut())
    algorithm = ot.FunctionalChaosAlgorithm(
        ot.Sample(places.tolist()),
        ot.Sample(values[:, None].tolist()),
        ot.JointDistribution(list(distributions)),
        ot.FixedStrategy(basis, terms.getBasisSizeFromTotalDegree(degree)),
        ot.LeastSquaresStrategy(selection),
    )
    algorithm.run()
    return _evaluation(algorithm.getResult().getMetaModel())


def _kriging(places: Array, uniform: Sequence[bool], values: Array) -> Callable[[Array], Array]:
    import openturns as ot

    size = len(uniform)
    fitter = ot.GaussianProcessFitter(
        ot.Sample(places.tolist()),
        ot.Sample(values[:, None].tolist()),
        ot.MaternModel([1.0] * size, [1.0], 2.5),
        ot.LinearBasisFactory(size).build(),
    )
    fitter.run()
    regression = ot.GaussianProcessRegression(fitter.getResult())
    regression.run()
    return _evaluation(regression.getResult().getMetaModel())


def _evaluation(model: Any) -> Callable[[Array], Array]:
    import openturns as ot

    return lambda there: np.asarray(model(ot.Sample(there)))[:, 0]
