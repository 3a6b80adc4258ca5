"""Orbit diagrams: extremes of the motion over a parameter that rises and falls, each run from the end of the last."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from ..analysis.regimes import regime_of
from ..arrays import Array
from ..checks import ArgumentError, brief, choice, count, instance, listed, positive, within
from ..cycles.drive_periods import drive_period, settled_at
from ..integration import Diverged, simulate
from ..integration.bars import bar
from ..integration.default_step import default_step
from ..integration.settings import Settings, settings_of
from ..lowering import Assembly, assemble
from ..records import Displacement, Probe
from ..records.variables import PROBES, described
from ..system import System
from .loci import Source, SystemOf, origin_of, rising, systems_over
from .measures import message_of
from .task import one_thread_each

UP, DOWN, ANEW = "up", "down", "anew"
SWEEPS = (UP, DOWN, ANEW)
MAXIMA, MINIMA, BOTH, STROBE = "maxima", "minima", "both", "strobe"
TAKES = (MAXIMA, MINIMA, BOTH, STROBE)
# Recorded samples of a run at most, unless a rate is given, and largest rate [Hz].
SAMPLES, HIGHEST_RATE = 20_000, 20e3
# Periods of the drives among which a run begins where their phase is nearest to that at the end of the last one.
NEAREST = 50
# Attribute and part of messages of the restart.
START = "start"
RESULTS = ("orbit", "regime", "frequency", "message", "sweep", "extreme")
