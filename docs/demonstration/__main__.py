"""Compute settings of the demonstration anew and write them: of all cases, or of those named."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from typing import Any

from stridula.plot.colours import REGIME_COLOURS

from .instruments import INSTRUMENTS, Instrument
from .recording import record
from .writing import DATA, of_instrument, text_of

WORDS = {
    "squeal": "Squeals at {}",
    "stick-slip": "Sticks and slips at {}",
    "judder": "Judders at {}",
    "stable sliding": "Slides steadily",
    "sticking": "Sticks",
    "Helmholtz": "Helmholtz motion at {}",
    "double slip": "Double slip at {}",
    "multiple slip": "Multiple slip at {}",
    "anomalous low": "Anomalous low note at {}",
    "raucous": "Raucous, near {}",
    "sliding": "Slides steadily",
}
COLOURS = REGIME_COLOURS | {
    "Helmholtz": "#0072b2",
    "double slip": "#56b4e9",
    "multiple slip": "#b9d7ec",
    "anomalous low": "#cc79a7",
    "raucous": "#d55e00",
    "sliding": REGIME_COLOURS["stable sliding"],
}


def computed(instrument: Instrument) -> dict[str, Any]:
    """Return the numbers of a case, with a line on standard output for each setting."""
    settings = []
    for x in instrument.x.values:
        for y in instrument.y.values:
            settings.append(record(instrument, x, y))
            one = settings[-1]
            print(f"{instrument.name} {x:g} {y:g}: {one.regime}, {one.pitch:.4g} Hz, share {one.share:.3f}", flush=True)
    first = instrument.scenario(instrument.x.values[0], instrument.y.values[0]).system
    return of_instrument(instrument, instrument.drawn(first), settings)


def main(names: Sequence[str]) -> None:
    """Write the file with new numbers of the cases named, or of all."""
    old = json.loads(DATA.read_text(encoding="utf-8"))["instruments"] if names and DATA.exists() else []
    known = {one["name"]: one for one in old}
    for name in names or INSTRUMENTS:
        known[name] = computed(INSTRUMENTS[name])
    cases = [known[name] for name in INSTRUMENTS if name in known]
    used = {one["regime"] for case in cases for one in case["settings"]}
    words, colours = ({name: table[name] for name in sorted(used)} for table in (WORDS, COLOURS))
    DATA.write_text(text_of({"words": words, "colours": colours, "instruments": cases}), encoding="utf-8")
    print(f"{DATA.name}: {DATA.stat().st_size / 1e3:.0f} kB")


main(sys.argv[1:])
