"""The march on a graphics card: the same source as `march`, one run per thread.

All values are scalars there, so the plain functions of `operations` apply. Runs are adjacent in memory, so that threads
read whole lines of it. Double precision; the compiler for the card decides which products and sums are fused.
"""

from types import FunctionType
from typing import Any

from numba import cuda

from .march import march

_PACKAGE = __name__.rpartition(".")[0]


def on_card(function: Any, known: Any = None) -> Any:
    """Return a function of this package compiled for the card from the same code, with all functions that it calls.

    Numba would accept the functions compiled for the processor, but not the plain functions below them, which it
    replaces by vector operations.
    """
    known = {} if known is None else known
    plain = getattr(function, "py_func", function)
    if plain not in known:
        words = dict(plain.__globals__)
        for name in plain.__code__.co_names:
            if _is_ours(words.get(name)):
                words[name] = on_card(words[name], known)
        twin = FunctionType(plain.__code__, words, plain.__name__, plain.__defaults__, plain.__closure__)
        known[plain] = cuda.jit(device=True)(twin)
    return known[plain]


def _is_ours(thing: Any) -> Any:
    """Return whether a thing is a function of this package, compiled or plain."""
    return isinstance(getattr(thing, "py_func", thing), FunctionType) and thing.__module__.startswith(_PACKAGE)


_march = on_card(march)


def _each(single: Any, several: Any, space: Any) -> Any:
    """Return the kernel for a kind of systems, as in `march`."""

    @cuda.jit
    def march_each(runs: Any, parts: Any) -> None:
        """March `runs` runs, one in each thread."""
        run: int = cuda.grid(1)  # type: ignore[call-arg]
        if run < runs:
            _march(single, several, space, (run, runs), parts)

    return march_each


KINDS = (True, None, None), (None, True, None), (None, True, True)
marches: dict[tuple[bool | None, ...], Any] = {kind: _each(*kind) for kind in KINDS}
