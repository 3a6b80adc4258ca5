"""Probabilities of growth in words: columns of a table, and the lines below it."""

from __future__ import annotations

import xarray as xr

from ..checks import counted


def probability_columns(found: xr.Dataset) -> dict[str, list[str]]:
    """Return the columns of a table of the bands of frequency, by their headings.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `mode_probability`.
    """
    level = f"{100.0 * found.attrs['confidence']:g} % interval"
    heads = ("growing modes [Hz]", "from", "to", "probability", level, "median growth [1/s]")
    rows = [_row(found.isel(band=number)) for number in range(found.sizes["band"])]
    return {head: [row[number] for row in rows] for number, head in enumerate(heads)}


def _row(one: xr.Dataset) -> list[str]:
    low, high = one["probability_interval"].values
    seen = [float(one["frequency"]), *one["frequency_range"].values.tolist()]
    growth = float(one["band_growth_rate"].median())
    cells = [f"{value:.5g}" if value == value else "" for value in seen]
    return [
        *cells,
        f"{float(one['probability']):.3f}",
        f"{low:.3f} to {high:.3f}",
        f"{growth:.4g}" if growth == growth else "",
    ]


def probability_lines(found: xr.Dataset) -> list[str]:
    """Return the probability that any mode grows, those of the verdicts, and notes."""
    low, high = found["any_probability_interval"].values
    lines = [f"Any mode grows: {float(found['any_probability']):.3f}, {low:.3f} to {high:.3f}."]
    kinds = [(str(one), float(found["kind_probability"].sel(kind=one))) for one in found["kind"].values]
    lines.append("Verdicts: " + ", ".join(f"{word} {share:.3f}" for word, share in kinds if share) + ".")
    if count := int(found["beyond_cutoff"].sum()):
        lines.append(f"{counted(count, 'band')} above the cutoff of every body, without the modes left out.")
    if found.attrs["notes"]:
        lines.append(f"Note: {found.attrs['notes']}.")
    samples, failed = int(found["samples"]), int(found["failed"])
    if failed:
        lines.append(found.attrs["failure"])
    return [*lines, f"{samples} points: {samples - failed} done, {failed} failed"]
