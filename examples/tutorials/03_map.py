"""
A sweep and its map
===================

Run a case at many points of its parameters, keep a few numbers of each run, and draw where it squeals.
"""

# %%
# One key, three values
# ---------------------
# Every number of a scenario has a key; ``stridula show weak-pressure`` prints them. A sweep takes keys with their
# values, and the names of measures. It returns a Dataset with a dimension for each key.

import numpy as np

import stridula as st
from stridula import plot

found = st.sweep("weak-pressure", {"friction": [0.4, 0.9, 1.4]}, ["regime", "peak_force"], duration=0.3)
print(found[["regime", "peak_force"]].to_dataframe()[["regime", "peak_force"]])

# %%
# Two keys: a map
# ---------------
# 13 x 11 runs of 1 s of another case, in which a force pushes the beam across. Similar runs march side by side in the
# vector units of the processor, and on all of its cores.

points = st.Grid({"friction": np.linspace(0.4, 2.0, 13), "angle": [f"{angle} deg" for angle in range(20, 75, 5)]})
found = st.sweep("squeal", points, ["regime"], duration=1.0)
plot.regime_map(found)

# %%
# Colours are the regimes of the runs. The dashed line bounds steady sliding: below it the tip slides, or slides off the
# track. Above it friction can hold the force permanently. Yet in a band above the line the tip does not come to rest:
# it lands, digs in and squeals.
#
# Cuts
# ----
# The result is an ordinary ``xarray.Dataset``: select, average and plot it as you like.

cut = found.sel(angle=45.0)
for friction, word, hertz in zip(cut.friction.values, cut.regime.values, cut.frequency.values, strict=True):
    print(f"friction {friction:.2f}: {word}" + (f" at {hertz:.0f} Hz" if word == "squeal" else ""))

# %%
# Linear theory
# -------------
# No mode grows on this map: linear theory of the held contact does not include motion that begins with a landing.

counts = st.agreement(found)
print(f"{counts.agree.item()} of {counts.compared.item()} runs agree with linear theory")

# %%
# Where does it begin?
# --------------------
# Under an imposed velocity, as in the case ``weak-pressure``, the tip slides nearly everywhere, and linear theory
# applies. :func:`stridula.root_loci` tracks the modes over one key without any run, and
# :func:`stridula.critical_value` finds the onset.

loci = st.root_loci("weak-pressure", "friction", np.linspace(0.0, 1.6, 33), highest=4e3)
onset = st.critical_value("weak-pressure", "friction", 0.5, 1.0)
print(f"the first mode grows from a friction of {onset.value:.3f} on, at {onset.frequency:.0f} Hz")
plot.root_loci(loci, [onset])

# %%
# Your own measure, your own system
# ---------------------------------
# A measure may be a function of a record. In place of a scenario, a sweep accepts a function that returns a system for
# given values.


def louder(friction: float) -> st.System:
    """The same pair, with another law of friction."""
    shipped = st.load_scenario("weak-pressure").system
    law = st.Stribeck(static=friction, kinetic=0.7 * friction, velocity=0.05)
    contact = st.PointContact(shipped.slider.tip, shipped.track, shipped.contact.at, friction=law)
    return st.System(contact, shipped.drives)


found = st.sweep(
    louder,
    {"friction": [0.5, 0.8, 1.1]},
    ["regime", {"largest": lambda run: float(run.normal_force.max())}],
    duration=0.3,
)
print(found[["regime", "largest"]].to_dataframe()[["regime", "largest"]])

# %%
# Long sweeps keep their finished parts on disk (``out="map.nc"``) and resume after a crash; ``stridula sweep`` does the
# same from the command line. :doc:`../maps` and :doc:`../surveys` continue with sensitivity, agreement, and every
# growing mode followed in time.
