"""What linear theory says of what is played, for the page."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..analysis.stability import sliding_stability
from ..system import System

MOST = 12


def theory(system: System) -> dict[str, Any]:
    """Return the equilibrium of a system, and the modes that grow about it.

    Returns
    -------
    dict
        ``equilibrium`` as in `sliding_stability`, or why there is none; ``modes`` that grow, fastest first, with
        ``frequency`` [Hz] and ``growth_rate`` [1/s].
    """
    try:
        found = sliding_stability(system)
    except ValueError as error:
        return {"equilibrium": str(error), "modes": []}
    growth = found["growth_rate"].values
    growing = [k for k in np.argsort(-growth) if bool(found["unstable"].values[k])][:MOST]
    modes = [{"frequency": float(found["frequency"].values[k]), "growth_rate": float(growth[k])} for k in growing]
    return {"equilibrium": str(found.attrs["equilibrium"]), "modes": modes}
