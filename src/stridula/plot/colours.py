"""Colours of figures, distinguishable with colour blindness."""

LINE = "#1f4e79"
# The other colours of Okabe & Ito, for several lines in one panel.
LINES = (LINE, "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
# Okabe & Ito's colours.
STATUS_COLOURS = {"separated": "#56b4e9", "sticking": "#d55e00", "sliding": "#f0e442"}
# Regimes without vibration are pale.
REGIME_COLOURS = {
    "stable sliding": "#cfe8f5",
    "sticking": "#b9b9b9",
    "stick-slip": "#009e73",
    "squeal": "#d55e00",
    "judder": "#e69f00",
    "off the track": "#f4f4f4",
}
FAILED_COLOUR = "#000000"
