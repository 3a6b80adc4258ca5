"""
Sound
=====

From a run to sound pressure, levels, third-octave bands and a WAV file.
"""

# %%
# Sound pressure
# --------------
# A record contains the forces at the contact. From them :func:`stridula.radiate` recomputes the motion of the bodies,
# and from this the sound pressure in pascals at any place. The default listeners are two ears a metre above the track.

import stridula as st
from stridula import plot

scenario = st.load_scenario("strong-pressure")
system = scenario.system
run = scenario.simulate(duration=1.0)
heard = st.radiate(run, system)
print(heard.sizes, heard.attrs["units"])
st.listen(heard)

# %%
# What is in it?
# --------------

plot.spectrogram(heard.isel(listener=0), run)

# %%
# Each burst has a comb of tones. In steps of third octaves, as acoustic reports have them:

plot.third_octaves(heard)

# %%
# Levels
# ------
# The equivalent level over the whole sound, without weighting and A-weighted, and the largest level with the time
# weighting *fast*.

for weighting in "ZA":
    level = st.equivalent_level(heard, weighting)
    print(f"L{weighting}eq {float(level.max()):.1f} dB")
fast = st.sound_level(heard, "A", response="fast")
print(f"LAFmax {float(fast.max()):.1f} dB")

# %%
# Which body is it?
# -----------------
# ``bodies`` selects the bodies that you hear.

for name, body in (("slider", system.slider), ("track", system.track)):
    alone = st.radiate(run, system, bodies=[body])
    print(f"{name}: {float(st.equivalent_level(alone, 'A').max()):.1f} dB")

# %%
# A listener who moves away
# -------------------------

for height in (0.25, 0.5, 1.0, 2.0):
    there = st.radiate(run, system, (0.7, 0.0, height))
    print(f"{height:.2f} m above the track: {float(st.equivalent_level(there, 'A').max()):.1f} dB")

# %%
# A file
# ------
# Without ``full_scale`` a file is normalised: its peak lies 1 dB below full scale. With ``full_scale`` in pascals it
# is calibrated, and files of the same full scale keep their relative loudness. Nothing is ever clipped.

print(st.write_wav("squeal.wav", heard))
print(st.write_wav("calibrated.wav", heard, full_scale=20.0))

# %%
# Loud or quiet?
# --------------
# The same pair under 2 N. Both players have the same full scale, so that you hear the difference in level.

quiet = st.load_scenario("weak-pressure")
softly = st.radiate(quiet.simulate(duration=1.0), quiet.system)
print(f"{float(st.equivalent_level(softly, 'A').max()):.1f} dB")
full_scale = 1.2 * float(abs(heard).max())
st.listen(softly, full_scale=full_scale)

# %%
st.listen(heard, full_scale=full_scale)

# %%
# :doc:`../hearing` describes loudness, sharpness and roughness, and :doc:`../sound` the equations and their accuracy.
