"""Speed and memory of the squeal case with 60 + 40 + 20 modes at 0.8 µs, over their bars.

Memory is measured first: a process also counts the memory that its parent held.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator

import stridula as st
from ratios import REPEATS, Ratio, over, peak_memory, seconds, show, sized
from stridula.scenarios import load_scenario

TITLE = "squeal with 122 modes at 0.8 us"
LONGEST_WALL_TIME = 0.6
LARGEST_MEMORY = 400e6
DURATION = sized(1.0, 0.01)
# Below the explicit scheme's limit with all modes of the slider.
STEP = 8e-7


def squeal() -> st.System:
    """Return the shipped squeal case with 62 slider modes (20 elements, all kept), 40 bending and 20 axial modes."""
    shipped = load_scenario("squeal").system
    slider, track = shipped.slider, shipped.track
    rod = st.FiniteElementBeam(
        slider.material, slider.section, slider.length, slider.angle, elements=20, damping=slider.damping
    )
    beam = st.ModalBeam(track.material, track.section, track.length, damping=track.damping)
    contact = st.PointContact(rod.tip, beam, shipped.contact.at, shipped.contact.friction, shipped.contact.gap)
    force = shipped.drives[0]
    return st.System(contact, [st.Force(rod.root, transverse=force.transverse)])


def rows() -> Iterator[Ratio | str]:
    """Yield memory, then speed under both schemes."""
    if not hasattr(os, "wait4"):
        yield "memory: skipped, this system does not report the memory of a process"
    else:
        yield Ratio(
            f"peak memory of a fresh process, {2.0 * DURATION:g} s, over 400 MB",
            [peak() for _ in range(REPEATS)],
            most=1.0,
        )
    system = squeal()
    for scheme in (st.ExactModal(), st.CentralDifference()):
        (times,) = seconds(lambda scheme=scheme: st.simulate(system, DURATION, scheme=scheme, step=STEP))
        bar = [LONGEST_WALL_TIME] * REPEATS
        yield Ratio(f"{DURATION:g} s, {scheme.name}: 0.6 s over wall time", over(bar, times), least=1.0)


def peak() -> float:
    """Return the peak memory of a fresh process that runs twice as long, over its bar."""
    return peak_memory(__file__) / LARGEST_MEMORY


if __name__ == "__main__":
    if "child" in sys.argv:
        st.simulate(squeal(), 2.0 * DURATION, step=STEP)
    else:
        show(TITLE, rows())
