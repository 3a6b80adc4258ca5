"""Settings of the demonstration as numbers for the page."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .drawn import Array, Drawn
from .instruments import Instrument
from .recording import Setting

DATA = Path(__file__).with_name("settings.json")

# Error of the motion of a setting by the shapes kept, relative to its size, and the largest number of shapes.
ERROR, SHAPES = 0.02, 10
# Harmonics of a motion below this part of the largest are left out.
FAINT = 0.01
STEP, UNIT = 1e-4, 1000


def of_instrument(instrument: Instrument, drawn: Drawn, settings: Sequence[Setting]) -> dict[str, Any]:
    """Return what the page needs of a case: axes, body and settings, the values of y running fastest."""
    shapes = shapes_of(settings)
    largest = max(largest_of(one) for one in settings if one.motion)
    exaggeration = float(f"{drawn.reach / largest:.1g}")
    amounts = [rows_of(one) @ shapes.T for one in settings if one.motion]
    grain = max(float(np.abs(one).max()) for one in amounts) / 3e3
    sizes = np.abs(shapes).max(axis=1)
    whole = np.round(UNIT * shapes / sizes[:, None]).astype(int)
    body = {
        "places": np.round(drawn.place / STEP).astype(int).ravel().tolist(),
        "step": STEP,
        "faces": drawn.faces,
        "lines": drawn.lines,
        "extent": drawn.extent,
        "view": instrument.view,
        "shapes": whole.tolist(),
        "grain": grain / UNIT,
        "exaggeration": exaggeration,
        "reach": exaggeration * largest,
    }
    axes = {
        key: {"label": axis.label, "unit": axis.unit, "values": axis.values}
        for key, axis in (("x", instrument.x), ("y", instrument.y))
    }
    listed = [of_setting(one, shapes, grain / sizes) for one in settings]
    about = {"name": instrument.name, "title": instrument.title, "motion": instrument.motion, "start": instrument.start}
    return about | axes | {"body": body, "settings": listed}


def shapes_of(settings: Sequence[Setting]) -> Array:
    """Return the fewest orthonormal shapes, (shapes, coordinates), of which the motion of all settings is made."""
    parts = [part_of(one) for one in settings if one.motion]
    _, _, shapes = np.linalg.svd(np.concatenate(parts), full_matrices=False)
    for count in range(1, SHAPES):
        kept = shapes[:count]
        if max(float(np.linalg.norm(part - part @ kept.T @ kept)) for part in parts) < ERROR:
            break
    return np.asarray(shapes[: count + 1] if count == SHAPES - 1 else kept)


def rows_of(setting: Setting) -> Array:
    """Return the motion of a setting, (harmonics, coordinates)."""
    return np.array([one.ravel() for one in setting.motion.values()])


def largest_of(setting: Setting) -> float:
    """Return the largest displacement of a point along an axis in a setting [m]."""
    turns = np.exp(2j * np.pi * np.outer(np.arange(400) / 400, list(setting.motion)))
    return float(np.abs((turns @ rows_of(setting)).real).max())


def part_of(setting: Setting) -> Array:
    """Return the motion of a setting in rows of unit size together."""
    flat = rows_of(setting)
    rows = np.concatenate([flat.real, flat.imag])
    return np.asarray(rows / np.linalg.norm(rows))


def of_setting(setting: Setting, shapes: Array, grain: Array) -> dict[str, Any]:
    """Return the numbers of a setting; null for those that a silent one has not."""
    lines = [[k, *digits(line)] for k, line in enumerate(setting.lines, 1) if line != 0.0]
    motion = []
    if setting.motion:
        amounts = rows_of(setting) @ shapes.T
        most = float(np.abs(amounts).max())
        for k, row in zip(setting.motion, amounts, strict=True):
            if np.abs(row).max() > FAINT * most:
                parts = np.stack([row.real, row.imag], axis=1) / grain[:, None]
                motion.append([k, *np.round(parts).astype(int).ravel().tolist()])
    return {
        "regime": setting.regime,
        "pitch": rounded(setting.pitch, 4),
        "base": rounded(setting.base, 8),
        "share": rounded(setting.share, 4),
        "level": rounded(setting.level, 4),
        "repeated": setting.repeated,
        "lines": lines,
        "motion": motion,
        "marks": setting.marks,
    }


def rounded(value: float, count: int) -> float | None:
    """Return a number with so many digits, None if there is none."""
    return float(f"{value:.{count}g}") if math.isfinite(value) else None


def digits(value: complex) -> list[float | None]:
    """Return both parts of an amplitude, with four digits."""
    return [rounded(value.real, 4), rounded(value.imag, 4)]


def text_of(data: dict[str, Any]) -> str:
    """Return the file of the demonstration, a line for each case."""
    whole = json.dumps(data | {"instruments": []}, separators=(",", ":"), sort_keys=True)
    cases = ",\n".join(json.dumps(one, separators=(",", ":")) for one in data["instruments"])
    return whole.replace('"instruments":[]', f'"instruments":[\n{cases}\n]') + "\n"
