"""The table of predicted effects in the documentation: each row again, predicted and with the modes found again."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import stridula as st
from stridula.studies.values_by_key import si_tables, value_of
from stridula.verification.systems import mode_coupling

PAGE = Path(__file__).parents[2] / "docs" / "maps.rst"
HOFFMANN = 0.9
SHOWN = r"   \* -(.*)\n     - ``(.+)``\n     - ([+-]\S+)\n     - ([+-]\S+)"


def rows() -> list[tuple[str, str, str, str]]:
    """Return case, key, predicted and true effect of each row of the table."""
    table = PAGE.read_text(encoding="utf-8").split("list-table:: Effect of 10 % more")[1].split("\n\nSigns")[0]
    found, case = [], ""
    for head, *cells in re.findall(SHOWN, table):
        head = head.strip()
        case = head.split("``")[1] if "``" in head else case if not head else "Hoffmann"
        found.append((case, *cells))
    return found


def source_of(case: str):
    return mode_coupling.hoffmann().system(HOFFMANN) if case == "Hoffmann" else case


def grown(system: st.System, near: float) -> float:
    """Return the growth rate of the mode nearest to a frequency that grows or decays least [1/s]."""
    found = st.sliding_stability(system)
    there = np.abs(found.frequency.values - near) < 0.1 * near
    return float(found.growth_rate.values[there].max())


def rounded(number: float, like: str) -> str:
    """Return a number with the decimals of another one, with its sign."""
    decimals = len(like.partition(".")[2])
    return f"{number:+.{decimals}f}"


@pytest.mark.parametrize("row", [one for one in rows() if one[0] != "brake"], ids=lambda row: f"{row[0]} {row[1]}")
def test_the_table_has_what_is_predicted_and_what_is_found_again(row):
    case, key, predicted, true = row
    source = source_of(case)
    effect = st.mode_sensitivity(source, [key]).isel(parameter=0)
    fastest = effect.isel(mode=int(effect.growth_rate.values.argmax()))
    assert rounded(float(fastest.growth_rate_change), predicted) == predicted
    value = value_of(key, si_tables(source, {}))
    after = grown(value.system(1.1 * value.value), float(fastest.frequency))
    # Where growth ends, the mode that was the fastest neither grows nor decays by much.
    assert rounded(after - float(fastest.growth_rate), true) == true


def test_the_table_has_rows_of_every_case():
    assert (
        len(rows())
        == PAGE.read_text(encoding="utf-8").split("Effect of 10 % more")[1].split("Signs")[0].count("* -") - 1
    )
    assert {row[0] for row in rows()} == {"Hoffmann", "weak-pressure", "pin-on-disc", "brake"}
