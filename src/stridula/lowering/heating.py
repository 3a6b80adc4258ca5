"""Temperatures of contacts as arrays for the march."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .._kernels.layout import columns as at
from .._kernels.layout.heated_laws import FIRST_TEMPERATURE
from ..arrays import Array
from ..checks import ArgumentError
from ..contact import PointContact
from ..contact.heating import OverStep
from .contact_rows import ContactRows
from .own_laws import law_of_march, of_one_width


@dataclass(frozen=True)
class HeatBlocks:
    """Temperatures of the contacts as arrays for the march.

    Attributes
    ----------
    layers : int
        Largest number of layers of a contact, 0 without temperatures.
    numbers : ndarray, shape (contacts, numbers)
        Numbers of the heating of each.
    laws : ndarray, shape (contacts, numbers)
        Laws of friction at their temperatures, and histories of temperature.
    """

    layers: int
    numbers: Array
    laws: Array


def heat_blocks(contacts: Sequence[ContactRows], step: float) -> HeatBlocks:
    """Return the temperatures of the contacts as arrays for the march."""
    layers = max((one.contact.acts_at.layers for one in contacts if one.contact.acts_at is not None), default=0)
    numbers = np.zeros((len(contacts), at.OF_HEATING if layers else 0))
    laws = [_laws_of_march(one.contact) for one in contacts] if layers else [np.zeros(0)] * len(contacts)
    for own, one in zip(numbers, contacts, strict=True):
        if one.contact.acts_at is not None:
            own[:] = _numbers_of_march(one.contact.acts_at.over(step))
            own[at.BY_PLACE] = one.contact.acts_at.by_place
            # All laws but Coulomb's take the mean of their ratios half a step before and after the forces.
            own[at.AHEAD] = 0.0 if law_of_march(one.contact.law)[0] == at.COULOMB else 0.5
    return HeatBlocks(layers, numbers, np.array(of_one_width(laws)))


def temperatures_at_start(contacts: Sequence[ContactRows]) -> Array:
    """Return the temperatures of the layers of each contact at the start [degC], shape (contacts, most layers)."""
    found = np.zeros((len(contacts), at.LAYERS))
    for own, one in zip(found, contacts, strict=True):
        if one.contact.acts_at is not None:
            own[: one.contact.acts_at.layers] = one.contact.acts_at.start
    return found


def _numbers_of_march(over: OverStep) -> Array:
    """Return the numbers of the heating of a contact."""
    count, found = over.capacity.size, np.zeros(at.OF_HEATING)
    found[at.HEAT_SHARE] = over.share
    found[at.PER_LAYER : at.PER_LOSS].reshape(at.LAYERS, at.LAYERS)[:count, :count] = over.matrix
    for first, values in ((at.PER_LOSS, over.per_heat), (at.WITHOUT_LOSS, over.constant), (at.CAPACITY, over.capacity)):
        found[first : first + count] = values
    return found


def _laws_of_march(contact: PointContact) -> Array:
    """Return the laws of a contact at their temperatures and its history in a row, see `heated_laws`."""
    given = contact.laws_at_values
    rows = [law_of_march(law)[1] for _, law in given]
    if len({row.size for row in rows}) > 1:
        words = "have laws with the same pieces at all temperatures: give them as TabulatedFriction"
        raise ArgumentError("friction", words, contact.friction)
    times = ((), ()) if contact.acts_at is None else contact.acts_at.history
    period = 0.0 if contact.acts_at is None else contact.acts_at.period
    counts = [len(given), rows[0].size if rows else 0, len(times[0]), period]
    assert len(counts) == FIRST_TEMPERATURE
    return np.concatenate([counts, [temperature for temperature, _ in given], *rows, *times])
