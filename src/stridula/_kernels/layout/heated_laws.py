"""Laws of friction at some temperatures, and histories of temperature, a row for each contact."""

# Numbers of temperatures at which the law is given, of the parameters of the law, and of the times of a history of the
# temperature, each 0 without; then these temperatures, the parameters at each, the times and the temperatures at these.
AT, WIDTH, TIMES, FIRST_TEMPERATURE = range(4)
