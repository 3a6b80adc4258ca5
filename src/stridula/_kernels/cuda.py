"""The march on a graphics card: the very source of `march`, one run per thread.

Everything is a number there: the plain functions of `lanes` are what they say. Runs side by side lie so in memory, and
threads read whole lines of it. Double precision; products and sums are fused as the compiler for the card sees fit.
"""

from types import FunctionType

from numba import cuda

from .march import march

_PACKAGE = __name__.rpartition(".")[0]


def on_card(function, known=None):
    """Return a function of this package compiled for the card, and with it all that it calls, from the same code.

    Numba would take the functions that it compiled for the processor, but not the plain ones under them: it knows
    vectors in their place.
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


def _is_ours(thing):
    """Return whether a thing is a function of this package, compiled or plain."""
    return isinstance(getattr(thing, "py_func", thing), FunctionType) and thing.__module__.startswith(_PACKAGE)


_march = on_card(march)


@cuda.jit
def march_each(runs, parts):
    """March `runs` runs, one in each thread."""
    run = cuda.grid(1)
    if run < runs:
        _march(0.0, run, runs, parts)
