"""The rows of a block of modes: what is known of each mode of it."""

# State, share of an increment kept, stiffness of a step, loads of this step.
Q, D, KEPT, STIFFNESS, FORCE = range(5)
# Of a fixed block its rows at the contact, of harmonics their amplitude and that of their derivatives.
NORMAL = AMPLITUDE = 5
TANGENTIAL = SLOPE = 6
# Sines and cosines of the harmonics at the contact, in the last step and in this one in turn, and their numbers.
WAVES, NUMBER = 7, 11
# Unit loads, and the probes after them.
LOADS = 12
