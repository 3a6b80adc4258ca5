"""Warnings about doubtful values as one line each on standard error."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from ..doubtful import DoubtfulValue
from .exits import GOOD, say


@contextmanager
def doubts_said() -> Iterator[None]:
    """Print each doubtful value once, in one line."""
    with warnings.catch_warnings():
        warnings.simplefilter("always", DoubtfulValue)
        otherwise: Callable[..., None] = warnings.showwarning
        said: set[str] = set()

        def show(message: Warning | str, category: type[Warning], *place: Any, **options: Any) -> None:
            if not issubclass(category, DoubtfulValue):
                otherwise(message, category, *place, **options)
            elif str(message) not in said:
                said.add(str(message))
                say(f"doubtful: {message}", GOOD)

        warnings.showwarning = show
        yield


@contextmanager
def doubts_on_the_card() -> Iterator[None]:
    """Print no doubtful values inside: the caller prints them with the names of their bodies."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DoubtfulValue)
        yield
