"""Files of modes of programs and of tests, damaged, read as modal bodies."""

from __future__ import annotations

import gzip
import random
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import stridula as st

from .numbers import flipped
from .outcomes import folder, outcome

Given = tuple[str, bytes]
FILES = Path(__file__).parents[1] / "unit"
NAMES = (
    "modes/block.frd",
    "modes/block_binary.frd",
    "modes/beam_modes_m1.op2.gz",
    "modes/mode_solid_shell_bar.op2.gz",
    "modes/hex_201.rst.gz",
    "universal/uff55_translation_rotation.uff",
    "universal/uff55_sample_test_record10.uff",
    "universal/binary8byte.uff",
)
# Bytes at the beginning of a file, where its header is.
HEADER = 6000


def inputs(seed: int, count: int) -> Iterator[Given]:
    """Return the endings and contents of files."""
    for k in range(count):
        dice = random.Random(f"mode_files {seed} {k}")
        name = dice.choice(NAMES)
        content = bytearray(_content(name))
        for _ in range(dice.choice((0, 1, 4))):
            content[dice.randrange(dice.choice((min(HEADER, len(content)), len(content))))] = dice.choice(
                (0, 1, 127, 255)
            )
        changed = bytes(content)
        yield Path(name.removesuffix(".gz")).suffix, flipped(dice, changed) if dice.random() < 0.3 else changed


@cache
def _content(name: str) -> bytes:
    held = (FILES / name).read_bytes()
    return gzip.decompress(held) if name.endswith(".gz") else held


def check(given: Given) -> str:
    """Return the outcome of reading a file of modes."""
    ending, content = given
    with folder():
        path = Path(f"a{ending}")
        path.write_bytes(content)
        return outcome(lambda: st.MeasuredModes.read(path, damping=0.01))
