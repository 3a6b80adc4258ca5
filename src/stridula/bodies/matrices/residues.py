"""Shapes of modes from residues: products of shapes at responses and at excitations."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, listed
from ...doubtful import warn_of

# Ratio of the second singular value of a residue to the first above which the product of two shapes is doubtful.
LARGEST_SECOND = 0.2
DIRECTIONS = {f"{sign}{axis}": (k, value) for k, axis in enumerate("XYZ") for sign, value in (("+", 1.0), ("-", -1.0))}


def place_of_label(word: str, label: Any) -> tuple[str, int, float]:
    """Return the point, the direction from 0 and the sense of a label such as ``"7 +Z"``."""
    point, _, way = label.rpartition(" ") if isinstance(label, str) else ("", "", "")
    if not point or way not in DIRECTIONS:
        raise ArgumentError(word, 'be points with directions, such as "7 +Z"', label)
    return point, *DIRECTIONS[way]


def shapes_of_residues(
    poles: Any, residues: Any, responses: tuple[str, ...], excitations: tuple[str, ...]
) -> tuple[Array, Array]:
    """Return poles [rad/s] and shapes of unit modal A at the responses, shape (responses, modes).

    The nearest product of two shapes is that of the largest singular value. Its scale is the mean over the points that
    are both, in least squares.

    Raises
    ------
    ValueError
        If no label is both, or an argument does not fit.
    """
    try:
        found, values = np.asarray(poles, dtype=complex), np.asarray(residues, dtype=complex)
    except (TypeError, ValueError):
        raise ArgumentError("residues", "be numbers, as the poles", residues) from None
    if found.ndim != 1 or not found.size or not (np.isfinite(found).all() and (found.imag > 0.0).all()):
        raise ArgumentError("poles", "be a list of finite numbers above the real axis", poles)
    if (found.real > 0.0).any():
        raise ArgumentError("poles", "have a real part of 0 or below", got=f"{found.real.max():.4g} rad/s")
    shape = len(responses), len(excitations), found.size
    if values.shape != shape or not np.isfinite(values).all():
        raise ArgumentError("residues", f"be finite, of the shape {shape}", residues, got=values.shape)
    measured = {place_of_label("responses", label): row for row, label in enumerate(responses)}
    driven = [place_of_label("excitations", label) for label in excitations]
    if len(measured) < len(responses):
        raise ArgumentError("responses", "be different", responses)
    rows, senses = [], []
    for point, direction, sense in driven:
        for other in (sense, -sense):
            if (point, direction, other) in measured:
                rows.append(measured[point, direction, other])
                senses.append(sense * other)
                break
        else:
            rows.append(-1)
            senses.append(0.0)
    kept = np.array(rows) >= 0
    if not kept.any():
        words = f"have one of the excitations, {listed(excitations)}: without it the scale is unknown"
        raise ArgumentError("responses", words, got=listed(responses))
    shapes = np.empty((len(responses), found.size), dtype=complex)
    for mode in range(found.size):
        left, size, right = np.linalg.svd(values[:, :, mode], full_matrices=False)
        if size.size > 1 and size[1] > LARGEST_SECOND * size[0]:
            at, share = abs(found[mode]) / (2.0 * np.pi), size[1] / size[0]
            words = f"the residue at {at:.5g} Hz is not one product (singular values 1 to {share:.2g})"
            warn_of([f"{words}: a second mode of the same frequency, or noise, is left out"])
        along = left[:, 0]
        both = along[np.array(rows)[kept]] * np.array(senses)[kept]
        product = size[0] * right[0][kept]
        weight = float(np.sum(np.abs(both) ** 2))
        if not weight:
            raise ArgumentError("residues", "move an excitation in every mode", got=f"none in mode {mode} (from 0)")
        shapes[:, mode] = along * np.sqrt(np.sum(product * both.conj()) / weight)
    return found, shapes


def split(responses: tuple[str, ...], shapes: Array) -> tuple[list[str], Array]:
    """Return the points of responses and their displacements along world x, y and z, shape (points, 3, modes)."""
    labels = [place_of_label("responses", label) for label in responses]
    points = list(dict.fromkeys(point for point, _, _ in labels))
    moved = np.zeros((len(points), 3, shapes.shape[1]), dtype=complex)
    for row, (point, direction, sense) in zip(shapes, labels, strict=True):
        moved[points.index(point), direction] = sense * row
    return points, moved
