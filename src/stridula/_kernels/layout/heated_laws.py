"""Laws of friction at some temperatures or places, and histories of temperature, a row for each contact."""

# Numbers of temperatures at which the law is given, of the parameters of the law, and of the times of a history of the
# temperature, each 0 without, and the period of this history, 0 without; then these temperatures, the parameters at
# each, the times and the temperatures at these. A law along the track has places instead of temperatures and times.
AT, WIDTH, TIMES, PERIOD, FIRST_TEMPERATURE = range(5)
