"""Colours of figures, distinguishable with colour blindness."""

LINE = "#1f4e79"
# The other colours of Okabe & Ito, for several lines in one panel.
LINES = (LINE, "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
# Okabe & Ito's colours.
STATUS_COLOURS = {"separated": "#56b4e9", "sticking": "#d55e00", "sliding": "#f0e442"}
# Regimes without vibration are pale, in the tint of their status; the others have colours of no status.
REGIME_COLOURS = {
    "stable sliding": "#faf3b0",
    "sticking": "#f2c9a6",
    "stick-slip": "#009e73",
    "squeal": "#cc79a7",
    "judder": "#5b52b8",
    "off the track": "#d3eaf8",
}
FAILED_COLOUR = "#000000"
