"""Equilibrium and modes of sliding in words: columns of a table, and the lines below it."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..checks import counted

# Modes shown where none grows.
FEWEST = 5
KINDS = {
    "sliding": "slides steadily",
    "held": "held by friction",
    "lifted off": "lifted off",
    "jammed": "jammed: it neither slides on nor opens",
}
EQUILIBRIA = {
    "several": "Several equilibria exist; this is the one nearest to that without friction.",
    "none": "Nothing stays at rest: the bodies move apart, or friction cannot hold them.",
    "none found": "No equilibrium that satisfies every inequality was found.",
}


def shown_modes(modes: xr.Dataset) -> list[int]:
    """Return the numbers of the modes that grow, or of the few nearest to growth, the fastest first.

    Parameters
    ----------
    modes : xarray.Dataset
        Result of `sliding_stability`.
    """
    grows = int(modes["unstable"].sum())
    order: list[int] = np.argsort(-modes["growth_rate"].values)[: max(grows, FEWEST)].tolist()
    return order


def mode_columns(modes: xr.Dataset) -> dict[str, list[str]]:
    """Return the columns of a table of the modes of `shown_modes`, by their headings.

    Parameters
    ----------
    modes : xarray.Dataset
        Result of `sliding_stability`.
    """
    shown = modes.isel(mode=shown_modes(modes))
    heads = {"frequency [Hz]": "frequency", "growth rate [1/s]": "growth_rate", "damping ratio": "damping_ratio"}
    columns = {head: [f"{number:.5g}" for number in shown[name].values] for head, name in heads.items()}
    shares = shown["energy_share"].transpose("body", "mode").values
    for body, share in zip(modes["body"].values, shares, strict=True):
        columns[f"energy in {body}"] = [f"{100.0 * one:.0f} %" for one in share]
    return columns


def closing_lines(modes: xr.Dataset, given: bool) -> list[str]:
    """Return a line for each contact, and the verdict on the equilibrium.

    Parameters
    ----------
    modes : xarray.Dataset
        Result of `sliding_stability`.
    given : bool
        Whether statuses of the contacts were given.
    """
    return [*contact_lines(modes), *verdict_lines(modes, given)]


def contact_lines(modes: xr.Dataset) -> list[str]:
    """Return a line for each contact: its status, forces and slip."""
    several = "contact" in modes.dims
    lines = []
    for name in [str(word) for word in modes["contact"].values] if several else ["contact"]:
        one = modes.sel(contact=name) if several else modes
        forces = [f"{_size(one[word]):.4g} N {word.partition('_')[0]}" for word in ("normal_force", "tangential_force")]
        lines.append(f"{name}: {one['status'].item()}, {', '.join(forces)}{_motion(one)}")
    return lines


def verdict_lines(modes: xr.Dataset, given: bool) -> list[str]:
    """Return the verdict on the equilibrium and the number of modes that grow, in a few lines."""
    grows, kind = int(modes["unstable"].sum()), KINDS[modes.attrs["equilibrium"]]
    if modes.attrs["equilibrium"] == "jammed" and not modes.sizes["mode"]:
        return [f"No equilibrium to linearise about; {kind}."]
    about = " about the contacts as given" if given else ""
    growing = f"{counted(grows, 'mode')} {'grows' if grows == 1 else 'grow'}" if grows else "no mode grows"
    lines = [f"Equilibrium: {kind}; {growing} (of {modes.sizes['mode']}){about}."]
    if count := int((modes["unstable"] & modes["beyond_cutoff"]).sum()):
        lies = "lies" if count == 1 else "lie"
        lines.append(
            f"{counted(count, 'growing mode')} {lies} above the cutoff of every body, without the modes left out."
        )
    if modes.attrs["equilibria"] in EQUILIBRIA:
        lines.append(EQUILIBRIA[modes.attrs["equilibria"]])
    return [*lines, *([f"Violated: {modes.attrs['violated']}."] if modes.attrs["violated"] else [])]


def _size(component: xr.DataArray) -> float:
    """Return a number, or in space the magnitude of its components along both tangents."""
    return float(component) if component.ndim == 0 else float(np.hypot(*component.values))


def _motion(one: xr.Dataset) -> str:
    slip, acceleration = _size(one["slip_velocity"]), _size(one["slip_acceleration"])
    if np.isfinite(slip) and slip:
        return f", slip {slip:.4g} m/s"
    return f", slip accelerates by {acceleration:.4g} m/s²" if acceleration else ""
