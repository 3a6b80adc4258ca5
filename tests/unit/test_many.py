"""Many runs at once give what each gives alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from physics.cases import CASES, STEP
from stridula.integration import many
from stridula.integration.simulate import Asked

WORDS = {"step": STEP, "sample_rate": 0.1 / STEP}


def squeals(count: int) -> list[st.System]:
    """Systems of one kind: other angles, damping, loads, lengths, coefficients and gaps."""
    system = CASES["squeal"]()
    rod, bar, contact, force = system.slider, system.track, system.contact, system.drives[0]
    found = []
    for n in range(count):
        slider = replace(rod, angle=rod.angle + 0.02 * n, length=rod.length * (1.0 + 0.01 * n), cutoff=None, elements=6)
        track = replace(bar, damping=bar.damping * (1 + n), cutoff=None, bending_modes=9, axial_modes=4)
        touching = st.PointContact(slider.tip, track, contact.at, st.Coulomb(0.3 + 0.2 * n), contact.gap * (n + 1))
        found.append(st.System(touching, [replace(force, point=slider.root, transverse=force.transverse + 0.1 * n)]))
    return found


def assert_like(run: xr.Dataset, alone: xr.Dataset, tolerance: float) -> None:
    """The same record but for round-off, relative to the largest value of each variable."""
    assert run.attrs["ended"] == alone.attrs["ended"]
    assert run.sizes == alone.sizes
    for name in alone:
        scale = float(np.abs(alone[name].values).max(initial=0.0))
        np.testing.assert_allclose(run[name], alone[name], rtol=0, atol=tolerance * scale, err_msg=name)
