"""Modes as the text of a universal file."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...arrays import Array


def universal_text(
    nodes: Sequence[int], places: Array | None, shapes: Array, modes: tuple[Array, Array, Array, bool]
) -> str:
    """Return modes as datasets 164, 2411 and 55.

    Parameters
    ----------
    nodes : sequence of int
        Numbers of the points.
    places : ndarray, shape (points, 3), or None
        World places [m].
    shapes : ndarray, shape (points, 3, modes)
        Complex shapes.
    modes : tuple
        Frequencies [Hz], damping ratios, modal masses [kg] (0 for unknown ones), and whether shapes have unit modal A.
    """
    lines = ["    -1", "   164", f"{1:10d}{'SI: metre (newton)':<20}{2:10d}"]
    lines += [f"{1.0:25.17E}{1.0:25.17E}{1.0:25.17E}".replace("E", "D"), f"{273.15:25.17E}".replace("E", "D"), "    -1"]
    if places is not None:
        lines += ["    -1", "  2411"]
        for node, place in zip(nodes, places, strict=True):
            lines += [f"{node:10d}{1:10d}{1:10d}{11:10d}", "".join(f"{x:25.16E}" for x in place).replace("E", "D")]
        lines.append("    -1")
    is_complex = bool(modes[3] or np.any(shapes.imag))
    for number, (frequency, damping, mass) in enumerate(zip(*modes[:3], strict=True)):
        lines += ["    -1", "    55", *["NONE".ljust(80)] * 5]
        kind = 3 if modes[3] else 2
        lines.append(f"{1:10d}{kind:10d}{2:10d}{8:10d}{5 if is_complex else 2:10d}{3:10d}")
        angular = 2.0 * np.pi * frequency
        pole = -damping * angular, angular * np.sqrt(1.0 - damping**2)
        header = (*pole, 1.0, 0.0, 0.0, 0.0) if modes[3] else (frequency, mass, damping, 0.0)
        lines += [f"{2:10d}{len(header):10d}{1:10d}{number + 1:10d}", _numbers(header)]
        for node, moved in zip(nodes, shapes[:, :, number], strict=True):
            values = np.stack([moved.real, moved.imag], axis=1).ravel() if is_complex else moved.real
            lines += [f"{node:10d}", _numbers(values)]
        lines.append("    -1")
    return "\n".join(lines) + "\n"


def _numbers(values: Sequence[float] | Array) -> str:
    return "".join(f"{value:13.5E}" for value in values)
