"""Fates of the growing modes of a design: what a run that starts with each of them becomes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..scenarios.load import Scenario
from ..studies.fates import CHANGES, JOINS, LIVES, VIBRATES, Options
from ..studies.survey_task import SurveyTask
from .designs import Design

# Options of the runs: those of a survey by default, without kicks.
LONGEST, AMPLITUDE, RESOLUTION = 1.0, 1e-3, 0.1
# Largest distance of an exponent at the start from that of a mode in the table, relative to it.
SAME = 0.02
NOT_FOLLOWED = "not followed"
HEADS = ("becomes", "pitch", "level")


@dataclass(frozen=True)
class _Alone:
    """The scenario of a design as the source of a single point."""

    made: Scenario

    def scenario(self, values: Sequence[Any]) -> Scenario:
        """Return the scenario."""
        return self.made

    def tables(self, values: Sequence[Any], scenario: Scenario) -> dict[str, Any]:
        """Return no tables: nothing is differentiated."""
        return {}


def fate_columns(design: Design, modes: xr.Dataset, numbers: Sequence[int]) -> tuple[dict[str, list[str]], str]:
    """Return the columns of the fates of modes, empty for those that decay, and a message where there are none.

    Parameters
    ----------
    design : Design
        The design.
    modes : xarray.Dataset
        Result of `sliding_stability`.
    numbers : sequence of int
        Numbers of the modes of the rows.
    """
    if design.options.status is not None:
        return {}, "Without fates: runs do not take given statuses."
    fates, message = _fates(design, lambda: None)
    if not fates:
        return {}, f"Without fates: {message or 'no mode grows at the start'}."
    rows = [_row(modes.isel(mode=number), fates) for number in numbers]
    words = f"Fates: {message}." if message else ""
    return dict(zip(HEADS, map(list, zip(*rows, strict=True)), strict=True)), words


def _fates(design: Design, watch: Callable[[], None]) -> tuple[list[dict[str, Any]], str]:
    """Return the fates of the growing modes at the start, and a message."""
    velocity: Any = design.options.velocity
    given = velocity if velocity is None or np.ndim(velocity) == 0 else tuple(velocity)
    options = Options(None, LONGEST, AMPLITUDE, RESOLUTION, math.inf, given, cycles=True, kicks=0)
    (outcome,) = SurveyTask(_Alone(design.scenario), options).outcomes([()], watch=watch)
    return outcome["values"].get("modes", []), str(outcome["message"])


def _row(mode: xr.Dataset, fates: Sequence[Mapping[str, Any]]) -> tuple[str, str, str]:
    """Return what a mode of the table becomes, its pitch and its level."""
    if not bool(mode["unstable"]):
        return "", "", ""
    own = complex(float(mode["growth_rate"]), 2.0 * np.pi * float(mode["frequency"]))
    exponents = np.array([complex(one["growth_rate"], 2.0 * np.pi * one["frequency"]) for one in fates])
    nearest = int(np.abs(exponents - own).argmin())
    if abs(exponents[nearest] - own) > SAME * abs(own):
        return NOT_FOLLOWED, "", ""
    fate = fates[nearest]
    if fate["fate"] not in VIBRATES:
        return str(fate["fate"]), "", ""
    return _becomes(fate, fates), _pitch(fate), _level(fate)


def _becomes(fate: Mapping[str, Any], fates: Sequence[Mapping[str, Any]]) -> str:
    """Return the regime, and the mode that a mode joins, if its strongest tone is not its own."""
    words = {LIVES: "", CHANGES: ", other tone"}
    if fate["fate"] == JOINS:
        other = next((one for one in fates if one["number"] == fate["joined"]), None)
        words[JOINS] = ", joins another mode" if other is None else f", joins the mode at {other['frequency']:.4g} Hz"
    return f"{fate['regime']}{words[fate['fate']]}"


def _pitch(fate: Mapping[str, Any]) -> str:
    """Return the frequency of the limit cycle's strongest tone."""
    return f"{fate['tones'][0]['frequency']:.4g} Hz" if fate["tones"] else ""


def _level(fate: Mapping[str, Any]) -> str:
    """Return the sound level, or the fluctuation of the normal force where there is no sound."""
    level = float(fate["sound_level"])
    return f"{level:.1f} dB(A)" if math.isfinite(level) else f"{fate['normal_force_rms']:.3g} N rms"
