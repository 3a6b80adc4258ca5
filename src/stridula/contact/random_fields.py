"""Numbers that vary at random over places, such as coefficients of friction over a face."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, count, finite, non_negative, positive

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
