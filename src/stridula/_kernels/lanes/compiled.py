"""How functions of the march are compiled: decorators that keep their types.

All have strict arithmetic: a step is the same to the last bit wherever it is completed, and a function inlined in the
march does not inherit a permission to reorder sums. Nothing is counted by reference: arrays come from Python and stay.
"""

import inspect
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
from numba.extending import overload

F = TypeVar("F", bound=Callable[..., Any])
# Its stubs lack some options.
_njit: Any = numba.njit

# Said of each function, as numba passes it on to all that a function calls: by chance, to those that it compiles first.
STRICT: dict[str, Any] = {
    "cache": True,
    "fastmath": False,
    "error_model": "numpy",
    "forceinline": False,
    "no_cfunc_wrapper": True,
}
# A wrapper for callers in Python takes a sixth of the compilation.
WITHOUT_WRAPPER: dict[str, Any] = {**STRICT, "_nrt": False, "no_cpython_wrapper": True}
INLINED: dict[str, Any] = {**WITHOUT_WRAPPER, "forceinline": True}


def strict(function: F) -> F:
    """Compile a function of the numbers of a single run, which may also be called from Python."""
    return cast("F", _njit(**STRICT)(function))


def strict_pasted(function: F) -> F:
    """Do `strict` for a function whose code is pasted into its callers."""
    return cast("F", _njit(inline="always", **STRICT)(function))


def entry(function: F) -> F:
    """Compile a function that is called from Python and lets other threads run."""
    return cast("F", _njit(**STRICT, _nrt=False, nogil=True)(function))


def inlined(function: F) -> F:
    """Compile a function as a part of its callers: called from Python, it crashes."""
    return cast("F", _njit(**INLINED)(function))


def pasted(function: F) -> F:
    """Paste the code of a function that mainly calls others into its callers: called from Python, it crashes.

    Compiled apart, all that it calls would be optimised again.
    """
    return cast("F", _njit(**WITHOUT_WRAPPER, inline="always")(function))


def called(function: F) -> F:
    """Compile a function apart, so that its callers do not pay for it: called from Python, it crashes."""
    return cast("F", _njit(**WITHOUT_WRAPPER)(function))


def overloaded(target: Callable[..., Any], returns_arrays: bool = False) -> Callable[[F], F]:
    """Do `numba.extending.overload`, which would compare the annotations of both functions.

    Only where references are counted does numba let a function return a part of an array.
    """
    options: Any = {"forceinline": True} | ({"_nrt": True} if returns_arrays else {})

    def declare(choose: F) -> F:
        def chosen(*kinds: Any) -> Any:
            found = choose(*kinds)
            if found is not None:
                found.__annotations__ = {}
            return found

        names = [one.replace(annotation=one.empty) for one in inspect.signature(choose).parameters.values()]
        chosen.__signature__ = inspect.Signature(names)  # type: ignore[attr-defined]
        overload(target, jit_options=options)(chosen)
        return choose

    return declare
