"""Numbers that vary at random over places, such as coefficients of friction over a face."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, count, finite, non_negative, positive
from ..declared import CountFrom0, Number, check_declared
from .friction_law import FrictionLaw

# Share of the variance added to each place alone, without which the covariance of near places has no root.
ALONE = 1e-10


def random_field(
    places: Array, correlation_length: float, deviation: float, *, mean: float = 1.0, seed: int = 0
) -> Array:
    """Return normally distributed numbers at places, which are the more alike the nearer the places are.

    The correlation of two places is ``exp(-(distance / correlation_length)²)``.

    Parameters
    ----------
    places : array_like, shape (places, coordinates)
        Places [m], such as those of the points of a `SurfaceContact`.
    correlation_length : float
        Distance at which the correlation has fallen to 1 / e [m].
    deviation : float
        Standard deviation at each place.
    mean : float, optional
        Mean at each place.
    seed : int, optional
        Seed.

    Returns
    -------
    ndarray, shape (places,)
        A number for each place.

    Examples
    --------
    >>> face = st.SurfaceContact(pad, "bottom", disc)
    >>> factors = st.random_field(face.places, correlation_length=0.02, deviation=0.1, seed=1)
    >>> varied = replace(face, friction=[st.Coulomb(0.4 * factor) for factor in factors])
    """
    given = np.asarray(places, dtype=float)
    if given.ndim != 2 or not np.isfinite(given).all():
        raise ArgumentError("places", "be a table of places, a row for each", places, got=f"shape {given.shape}")
    positive("correlation_length", correlation_length)
    apart = np.linalg.norm(given[:, None] - given[None], axis=2)
    covariance = np.exp(-((apart / correlation_length) ** 2)) + ALONE * np.eye(len(given))
    numbers = np.random.default_rng(count("seed", seed, low=0)).standard_normal(len(given))
    varied = np.linalg.cholesky(covariance) @ numbers
    return np.asarray(finite("mean", mean) + non_negative("deviation", deviation) * varied)


@dataclass(frozen=True)
class FrictionField:
    """A random field over a face by which the coefficients of its friction vary.

    The law of each point has the coefficients of that of the face, times ``1 + deviation f``: f is normally distributed
    with a deviation of 1, and its correlation at two points is ``exp(-(distance / correlation_length)²)``.

    Parameters
    ----------
    deviation : float
        Standard deviation of the coefficients, relative to their mean [1].
    correlation_length : float
        Distance at which the correlation has fallen to 1 / e [m].
    seed : int, optional
        Seed: equal seeds give equal fields.

    Examples
    --------
    >>> field = st.FrictionField(deviation=0.1, correlation_length=0.02, seed=1)
    >>> st.SurfaceContact(pad, "bottom", disc, friction=st.Coulomb(0.4), friction_field=field)
    """

    deviation: Annotated[float, Number(least=0.0)]
    correlation_length: Annotated[float, Number("m", above=0.0)]
    seed: CountFrom0 = 0

    def __post_init__(self) -> None:
        check_declared(self)

    def laws(self, given: Sequence[FrictionLaw], places: Array) -> tuple[FrictionLaw, ...]:
        """Return the law of each place from that without the field.

        Parameters
        ----------
        given : sequence of FrictionLaw
            A law for each place.
        places : ndarray, shape (places, 3)
            Places [m].

        Raises
        ------
        ValueError
            If a coefficient would not be above zero, or a law has no coefficients that can vary.
        """
        factors = random_field(places, self.correlation_length, self.deviation, seed=self.seed)
        if factors.min() <= 0.0:
            words = "leave friction above zero at all points: take a smaller one, or another seed"
            got = f"{self.deviation:g}, with which a coefficient is {factors.min():.3g} times its mean"
            raise ArgumentError("friction_field.deviation", words, got=got)
        return tuple(scaled(law, factor) for law, factor in zip(given, factors.tolist(), strict=True))


def scaled(law: FrictionLaw, factor: float) -> FrictionLaw:
    """Return a law with its coefficients times a factor.

    Raises
    ------
    ValueError
        If it has none in which its friction is linear.
    """
    changed: Any = law
    if hasattr(law, "laws"):
        return replace(changed, laws=tuple(scaled(one, factor) for _, one in law.at_values))
    if not law.linear_in:
        kinds = "a Coulomb, StaticKinetic, Stribeck, ExponentialWeakening or TabulatedFriction"
        raise ArgumentError("friction", f"be {kinds} with a friction_field", law, got=type(law).__name__)
    own = {name: getattr(law, name) for name in law.linear_in}
    return replace(changed, **{name: times(one, factor) for name, one in own.items() if one is not None})


def times(numbers: Any, factor: float) -> Any:
    """Return a number, or numbers in lists, times a factor."""
    return factor * numbers if np.ndim(numbers) == 0 else (factor * np.asarray(numbers)).tolist()
