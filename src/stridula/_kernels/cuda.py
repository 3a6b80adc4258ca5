"""The march on a graphics card: the very source of `one_contact`, one run per thread.

Everything is a number there. Functions are not written again: each is compiled for the card with the same code, what it
calls taken from here.
"""

from types import FunctionType

from numba import cuda

from . import lanes
from .one_contact import steps


def fused(a, b, c):
    """Return ``a b + c``, rounded once."""
    return cuda.fma(a, b, c)


# What the card has of its own.
_OWN = {lanes.fused: fused}
_PACKAGE = __name__.rpartition(".")[0]


def on_card(function, known=None):
    """Return a function of this package for the card, and with it all that it calls."""
    known = {} if known is None else known
    plain = getattr(function, "py_func", function)
    if plain not in known:
        source = _OWN.get(plain, plain)
        words = dict(source.__globals__)
        for name in source.__code__.co_names:
            if _is_ours(words.get(name)):
                words[name] = on_card(words[name], known)
        copy = FunctionType(source.__code__, words, source.__name__, source.__defaults__, source.__closure__)
        known[plain] = cuda.jit(device=True)(copy)
    return known[plain]


def _is_ours(thing):
    """Return whether a thing is a function of this package, compiled or plain."""
    return isinstance(getattr(thing, "py_func", thing), FunctionType) and thing.__module__.startswith(_PACKAGE)


_steps = on_card(steps)


@cuda.jit
def march_each(runs, blocks, arguments):
    """March `runs` runs, one in each thread."""
    run = cuda.grid(1)
    if run < runs:
        _steps(0.0, run, runs, blocks, *arguments)
