"""Time and memory of the modes of meshed bodies of ten, thirty and a hundred thousand degrees of freedom.

A fresh process for each: it meshes a disc and computes its modes up to 6 kHz and the residual shapes of four points.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator

import stridula as st
from ratios import FORM, Ratio, show, sized

TITLE = "modes of meshed bodies: a ring of iron that yields at four points"
# Elements along radius, angle and axis; units of time [s] and memory [bytes].
DIVISIONS = sized(((6, 48, 2), (10, 80, 3), (16, 120, 4)), ((1, 8, 1),))
SECOND, BYTES = 1.0, 1e9


def rows() -> Iterator[Ratio | str]:
    """Yield time and memory of each mesh, measured once: they are long compared with disturbances."""
    for divisions in DIVISIONS:
        (taken, free, modes), peak = in_fresh_process(__file__, *divisions)
        words = f"{int(free)} degrees of freedom, {int(modes)} modes and residual shapes"
        yield Ratio(f"{words}: time over 1 s", [taken / SECOND])
        if peak is None:
            yield f"{words}: memory skipped, this system does not report the memory of a process"
        else:
            yield Ratio(f"{words}: peak memory over 1 GB", [peak / BYTES])


def in_fresh_process(script: str, *words: object) -> tuple[list[float], float | None]:
    """Return the numbers that a script prints as a "child" with words, and the peak memory of its process [bytes]."""
    command = [sys.executable, script, "child", *map(str, words), *FORM]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    with process.stdout:
        printed = process.stdout.read()
    if hasattr(os, "wait4"):
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        peak = usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    else:
        process.wait()
        peak = None
    if process.returncode:
        raise RuntimeError(f"{' '.join(command[1:])} ended with exit code {process.returncode}")
    return [float(one) for one in printed.split()], peak


def find_modes(divisions: tuple[int, int, int]) -> None:
    """Print the time for the modes of a ring [s], its degrees of freedom and its number of modes."""
    began = time.perf_counter()
    mesh = st.SolidMesh.sector((0.06, 0.13), (0.0, 6.283185307179586), 0.02, divisions)
    places = {f"foot {k}": int(mesh.nodes_of("top")[k * len(mesh.nodes_of("top")) // 4]) for k in range(4)}
    iron = st.Material(1.1e11, 7100.0, 0.28)
    body = st.SolidBody(mesh, iron, points=places, fixed=["inner"], cutoff=6e3)
    modes = body.modes().count
    print(time.perf_counter() - began, 3 * (len(mesh.nodes) - len(mesh.nodes_of("inner"))), modes)


if __name__ == "__main__":
    if "child" in sys.argv:
        first = sys.argv.index("child") + 1
        find_modes(tuple(map(int, sys.argv[first : first + 3])))
    else:
        show(TITLE, rows())
