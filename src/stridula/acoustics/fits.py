"""Fits of a body in open air at many frequencies: computed once, on all processors, and cached for other processes."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from importlib.resources import files
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from ..arrays import Array
from ..bodies.body_surfaces import BodySurface
from ..cache import keep, key, recall
from ..long_tasks import check_wanted, task_told, tell_done
from .equivalent_sources import Fit, Radiator
from .ring_sources import RingSources
from .sheets import Sheet, SheetDipoles
from .surface_pressures import SurfacePressures

# By the form of the surface.
RADIATORS: dict[str, Callable[[Any], Radiator]] = {
    "rings": RingSources,
    "points": SurfacePressures,
    "sheet": SheetDipoles,
}
# Files whose code fits depend on.
SOURCES = (
    "equivalent_sources.py",
    "ring_sources.py",
    "surface_pressures.py",
    "flat_patches.py",
    "sheets.py",
    "fits.py",
)
# Time taken by fits above which they are cached [s], and largest size of cached fits [bytes].
WORTH, LARGEST = 1.0, 125_000_000
# Time after which fits are cached before all are done [s].
SOON = 30.0


class Fits:
    """Fits of a body at wavenumbers.

    Parameters
    ----------
    surface : PointSurface, RingSurface or Sheet
        The surface of the body.
    """

    def __init__(self, surface: BodySurface | Sheet) -> None:
        self.radiator = RADIATORS[surface.form](surface)
        self.name = key([_code(), surface.form.encode(), *surface.content])
        self.known: dict[float, Fit] | None = None
        self.took = 0.0

    def at(self, wavenumbers: Sequence[float]) -> list[Fit]:
        """Return the fits at wavenumbers [rad/m]; new ones are computed on all processors.

        Those done are kept from time to time, and when the computation is interrupted.
        """
        if self.known is None:
            self.known = _fits(recall(self.name))
        new = [one for one in wavenumbers if one not in self.known]
        if new:
            with task_told(f"sound of a body at {len(new)} frequencies"):
                self._compute(new)
        return [self.known[one] for one in wavenumbers]

    def _compute(self, new: Sequence[float]) -> None:
        assert self.known is not None
        began, kept = time.perf_counter(), self.took
        pool = ThreadPoolExecutor(os.cpu_count())
        try:
            # Matrices are too small for threads of linear algebra to help.
            with threadpool_limits(1):
                for number, (one, fit) in enumerate(zip(new, self._made(new, pool), strict=True), 1):
                    self.known[one] = fit
                    tell_done(number, len(new))
                    check_wanted()
                    self.took = kept + time.perf_counter() - began
                    if self.took > SOON:
                        self.keep()
                        began, kept = time.perf_counter(), 0.0
        except BaseException:
            self.keep()
            raise
        finally:
            pool.shutdown(cancel_futures=True)
        self.took = kept + time.perf_counter() - began

    def _made(self, wavenumbers: Sequence[float], pool: ThreadPoolExecutor) -> Iterator[Fit]:
        # The first one computes what all fits share.
        yield self.radiator.fit(wavenumbers[0])
        yield from pool.map(self.radiator.fit, wavenumbers[1:])

    def keep(self) -> None:
        """Cache the fits for other processes, if they took long enough and are not too large."""
        if self.known and self.took > WORTH:
            arrays = _arrays(self.known)
            if sum(one.nbytes for one in arrays.values()) <= LARGEST:
                keep(self.name, arrays)
            self.took = 0.0


@lru_cache(maxsize=8)
def fits_of(surface: BodySurface | Sheet) -> Fits:
    """Return the fits of a body by its surface; those of the latest bodies are kept."""
    return Fits(surface)


@lru_cache(maxsize=1)
def _code() -> bytes:
    """Return the code that fits depend on, which may differ in another version of the package."""
    return b"".join((files(__package__) / name).read_bytes() for name in SOURCES)


def _arrays(known: dict[float, Fit]) -> dict[str, Array]:
    """Return fits as arrays."""
    strengths = zip(*(fit.strengths for fit in known.values()), strict=True)
    named = {f"strengths {number}": np.array(several) for number, several in enumerate(strengths)}
    return {"wavenumbers": np.array(list(known)), "errors": np.array([fit.errors for fit in known.values()]), **named}


def _fits(arrays: dict[str, Array] | None) -> dict[float, Fit]:
    """Return fits from arrays."""
    if arrays is None:
        return {}
    strengths = zip(*(arrays[f"strengths {number}"] for number in range(len(arrays) - 2)), strict=True)
    made = (Fit(tuple(some), errors) for some, errors in zip(strengths, arrays["errors"], strict=True))
    return dict(zip(arrays["wavenumbers"].tolist(), made, strict=True))
