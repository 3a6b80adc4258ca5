"""Numbers of the profiles of tracks, a row for each contact."""

# Number of pieces, 0 without a profile; whether it repeats; then the places between pieces, and the coefficients of
# each piece, those of the powers of the distance from its beginning.
PIECES, PERIODIC, FIRST_PLACE = range(3)
ORDER = 4
