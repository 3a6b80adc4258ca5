"""Speed and memory of the squeal case with 60 + 40 + 20 modes at 1 µs: ratios to their bars, measured in one run.

Each line prints minimum, median and maximum over the repeats; a ratio above 1 is good for speed, below 1 for memory.
"""

from __future__ import annotations

import resource
import statistics
import subprocess
import sys

import stridula as st
from stridula.scenarios import load_scenario

REPEATS = 5
LONGEST_WALL_TIME = 0.6
LARGEST_MEMORY = 400e6


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


def speed() -> None:
    """Print simulated time over wall time, as a ratio to the bar of one second in 0.6 s."""
    system = squeal()
    for scheme in (st.ExactModal(), st.CentralDifference()):
        st.simulate(system, 0.01, scheme=scheme, step=1e-6)
        ratios = []
        for _ in range(REPEATS):
            run = st.simulate(system, 1.0, scheme=scheme, step=1e-6)
            ratios.append(LONGEST_WALL_TIME / run.attrs["wall_time"])
        print(f"speed over bar, {scheme.name:<18} {spread(ratios)}")


def memory() -> None:
    """Print the peak memory of a fresh process that runs 2 s, as a ratio to the bar of 400 MB."""
    peaks = []
    for _ in range(REPEATS):
        subprocess.run([sys.executable, __file__, "child"], check=True)
        peaks.append(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024 / LARGEST_MEMORY)
    print(f"peak memory over bar, 2 s        {spread(peaks)}")


def spread(values: list[float]) -> str:
    """Return minimum, median and maximum."""
    return f"{min(values):.2f}  {statistics.median(values):.2f}  {max(values):.2f}"


if __name__ == "__main__":
    if sys.argv[1:] == ["child"]:
        st.simulate(squeal(), 2.0, step=1e-6)
    else:
        print("                                 min   median  max")
        # Memory first: a child counts what its parent held when it was made.
        memory()
        speed()
