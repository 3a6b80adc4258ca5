"""Parts of a study on other machines, by dask.distributed."""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from contextlib import suppress
from typing import Any

from ..checks import ArgumentError
from ..extras import named_extras
from ..version import __version__
from .measures import message_of
from .task import Outcome, Work, use_one_thread

Points = Sequence[Sequence[Any]]
# Longest time that the client waits for a lost machine [s].
PATIENCE = 30.0


def client_of(address: str) -> Any:
    """Return a client of the scheduler at an address such as ``tcp://host:8786``.

    Raises
    ------
    ValueError
        If no scheduler answers.
    ImportError
        If dask.distributed is not installed.
    """
    with named_extras():
        from distributed import Client
    try:
        # The client is not the default of this process, since one that cannot connect would remain the default.
        return Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise ArgumentError("scheduler", "answer", address, got=f"{address!r}: {message_of(error)}") from None


def on_machines(client: Any, task: Work, parts: Mapping[int, Points]) -> Generator[tuple[int, list[Outcome]]]:
    """Yield the parts with their outcomes as they are finished.

    Parameters
    ----------
    client : distributed.Client
        Client of the machines.
    task : Work
        Work at each point.
    parts : mapping
        Points of each part.

    Raises
    ------
    RuntimeError
        If a part cannot be computed because machines are lost repeatedly or lack something.
    """
    from distributed import as_completed

    futures = {client.submit(_outcomes, task, points, __version__, pure=False): n for n, points in parts.items()}
    try:
        with client.as_current():
            finished = as_completed(futures)
        for future in finished:
            try:
                outcomes = future.result()
            except Exception as error:
                message = f"part {futures[future]} failed on other machines: {message_of(error)}"
                raise RuntimeError(f"{message}; finished parts are kept") from None
            yield futures[future], outcomes
    finally:
        with suppress(Exception):
            client.cancel([future for future in futures if not future.done()])


def _outcomes(task: Work, points: Points, version: str) -> list[Outcome]:
    """Return the outcomes of a part, on another machine."""
    if version != __version__:
        raise RuntimeError(f"stridula must also be {version} there, got {__version__}")
    use_one_thread()
    return task.outcomes(points)
