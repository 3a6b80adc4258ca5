"""
Calibration to a measurement
============================

You have measured a quantity and want parameters for which a run gives the same value. :func:`stridula.calibrate`
searches for them. This page also shows how to find the parameters that a measurement does not determine.
"""

# %%
# A rig
# -----
# A block of 0.5 kg on a belt at 5 cm/s, held by a spring and pressed by 10 N. It sticks and slips. A function returns
# the system for the unknown parameters, here the kinetic coefficient of friction and its difference from the static
# one, together with arguments of ``simulate``.

import matplotlib.pyplot as plt
import numpy as np

import stridula as st
from stridula import plot


def rig(kinetic: float, contrast: float) -> tuple[st.System, dict[str, float]]:
    """The block on the belt."""
    block = st.PointMass(0.5, name="block")
    belt = st.RigidTrack(velocity=0.05, name="belt")
    contact = st.PointContact(block.centre, belt, friction=st.StaticKinetic(kinetic + contrast, kinetic))
    spring = st.Spring(block.centre, stiffness=2e3)
    return st.System(contact, [st.Force(block.centre, y=-10.0)], [spring]), {"step": 2e-4, "sample_rate": 1e3}


# %%
# A measurement
# -------------
# So that you can check the search, the measurement is computed here, with coefficients that the search does not know.
# In your case these numbers come from the rig.

KINETIC, CONTRAST = 0.30, 0.15
system, numbers = rig(KINETIC, CONTRAST)
measured = st.simulate(system, duration=2.0, **numbers)
frequency, drag = float(st.regime(measured).frequency), float(-measured.tangential_force.mean())
print(f"{frequency:.2f} slips a second, {drag:.3f} N of drag on average")
plot.timeline(measured.sel(time=slice(0.0, 0.5)), ["contact_position", "tangential_force", "status"])

# %%
# One target
# ----------
# A target is a pair of bounds on a measure: the measurement and its uncertainty. Differential evolution starts from a
# seed; the same seed gives the same search, and the runs of a generation are computed side by side.

ranges = {"kinetic": (0.1, 0.6), "contrast": (0.02, 0.4)}
pitch = {"frequency": (0.998 * frequency, 1.002 * frequency)}


def search(targets: dict[str, tuple[float, float]], seed: int) -> tuple[float, float]:
    """The best coefficients from one seed."""
    best = st.calibrate(
        rig,
        ranges=ranges,
        targets=targets,
        measures={"drag": lambda run: float(-run.tangential_force.mean())},
        population=16,
        generations=15,
        duration=2.0,
        seed=seed,
    )
    print(f"kinetic {float(best.kinetic):.3f}, contrast {float(best.contrast):.3f}, all met: {bool(best.met.all())}")
    return float(best.kinetic), float(best.contrast)


alone = [search(pitch, seed) for seed in range(3)]

# %%
# Each search meets the target with a different kinetic coefficient: the rhythm of stick-slip depends on the contrast
# only. Always look at the spread over seeds before you trust one set of parameters.
#
# A second target
# ---------------
# The mean drag determines the rest. It is not a measure of the package, so it is given as a function of the record
# (``measures`` above).

both = [search(pitch | {"drag": (0.99 * drag, 1.01 * drag)}, seed) for seed in range(3)]

# %%
# The figure shows the parameters that the targets determine: the rhythm alone gives a line, both together a point.

figure, axes = plt.subplots(figsize=(6.0, 4.2), layout="constrained")
axes.plot(*np.transpose(alone), "o", label="rhythm")
axes.plot(*np.transpose(both), "s", label="rhythm and drag")
axes.plot(KINETIC, CONTRAST, "k+", markersize=16, label="truth")
axes.axhline(CONTRAST, color="k", linewidth=0.6, linestyle=":")
axes.set(xlabel="kinetic coefficient", ylabel="contrast, static less kinetic", xlim=ranges["kinetic"], ylim=(0.1, 0.2))
axes.legend()
figure

# %%
# Scenarios are calibrated in the same way, over any of their keys: ``st.calibrate("squeal", ranges={"friction": (0.5,
# 1.5)}, ...)`` or ``stridula calibrate`` on the command line. Runs that squeal are chaotic: give such targets an
# uncertainty, and check the best set with :func:`stridula.ensemble`. :doc:`../maps` describes scales of targets and
# targets of several runs.
