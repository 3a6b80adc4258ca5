"""Records as plain arrays: labelling takes longer than a short run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import brief, counted, listed, suggestion
from .variables import ALONG_TANGENTS

# Dimensions of variables over time besides time and contact, by their number.
AFTER_TIME = ((), ("contact_status",))


@dataclass(frozen=True, repr=False)
class PlainRecord:
    """A record of `simulate` as plain arrays: ``run["normal_force"]`` is an array over time.

    Probes and the final state are left out.

    Parameters
    ----------
    time : ndarray, shape (samples,)
        Time at the end of each sample interval [s].
    variables : mapping
        Arrays by the names of the variables of records, over time, and over contacts if there are several.
    contacts : sequence of str
        Names of the contacts.
    attrs : dict
        Attributes of the record.
    surfaces : sequence of str, optional
        Name of the surface of each contact, empty for none; an empty sequence without surfaces.
    """

    time: Array
    variables: Mapping[str, Array]
    contacts: Sequence[str]
    attrs: dict[str, Any]
    surfaces: Sequence[str] = ()

    def __repr__(self) -> str:
        return f"PlainRecord({counted(len(self.time), 'sample')}, contacts {listed(self.contacts)}, {listed(self)})"

    def __getitem__(self, name: str) -> Array:
        """Return a variable."""
        if name == "time":
            return self.time
        if name not in self.variables:
            known = list(self)
            raise KeyError(f"name must be one of {listed(known)}, got {brief(name)}{suggestion(name, known)}")
        return self.variables[name]

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the variables."""
        yield from ("time", *self.variables)

    def __contains__(self, name: object) -> bool:
        """Return whether there is a variable of this name."""
        return name == "time" or name in self.variables

    def by_contact(self, name: str) -> Array:
        """Return a variable of the contacts over time and contacts, also for a single contact."""
        values = self[name]
        return values if len(self.contacts) > 1 else values[:, None]

    def labelled(self, *names: str) -> xr.Dataset:
        """Return some variables as a Dataset with named dimensions, for functions of a record."""
        several = len(self.contacts) > 1
        data = {}
        for name in names:
            values = self[name]
            over = ("time", "contact") if several and values.ndim > 1 else ("time",)
            after = ("tangent",) if name in ALONG_TANGENTS else AFTER_TIME[values.ndim - len(over)]
            data[name] = ((*over, *after)[: values.ndim], values)
        coordinates: dict[str, Any] = {"time": ("time", self.time)}
        if several:
            coordinates["contact"] = ("contact", list(self.contacts))
            if self.surfaces:
                coordinates["surface"] = ("contact", list(self.surfaces))
        return xr.Dataset(data, coordinates, self.attrs)


def plain_of(run: xr.Dataset) -> PlainRecord:
    """Return the plain arrays of a record.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate`.
    """
    held = run.variables
    over_time = {str(name): one.values for name, one in held.items() if name != "time" and one.dims[:1] == ("time",)}
    numbered = [f"contact {number}" for number in range(1, run.sizes.get("contact", 1) + 1)]
    contacts = [str(name) for name in np.atleast_1d(held["contact"].values)] if "contact" in held else numbered
    time = held["time"].values if "time" in held else np.empty(0)
    surfaces = [str(name) for name in np.atleast_1d(held["surface"].values)] if "surface" in held else []
    return PlainRecord(time, over_time, contacts, dict(run.attrs), surfaces)
