"""Temperature of contacts: heat of friction in layers, or a given history; the law of friction follows it."""

from ..contact.lanewise import lanewise
from ..contact.pieces import piece_at
from ..lanes.compiled import called, strict_pasted
from ..lanes.operations import Number, Runs, add, held, hold
from ..layout import columns as at
from ..layout.contact_values import HeatedLaw
from ..layout.heated_laws import AT, FIRST_TEMPERATURE, PERIOD, TIMES, WIDTH
from ..layout.laws import STATIC
from ..layout.parts import Parts


@strict_pasted
def share_between(low: Number, high: Number, value: Number) -> Number:
    """Return the share of the way between two numbers at which a value lies, 0 or 1 beyond them."""
    return min(max((value - low) / (high - low), 0.0), 1.0)


@lanewise(0.0)
def temperature_at(first: Number, time: Number, law: HeatedLaw) -> Number:
    """Return the temperature of a contact: of its first layer, or that of its history at a time, or its place."""
    given, row = law.given, law.row
    count = int(given[row, TIMES])
    if count == 0:
        return first
    times = FIRST_TEMPERATURE + int(given[row, AT]) * (1 + int(given[row, WIDTH]))
    if given[row, PERIOD] > 0.0:
        time = given[row, times] + (time - given[row, times]) % given[row, PERIOD]
    place = times + piece_at(given, row, times, count - 1, time)
    share = share_between(given[row, place], given[row, place + 1], time)
    begin, end = given[row, place + count], given[row, place + count + 1]
    return begin + share * (end - begin)


@lanewise(0.0)
def act_at(temperature: Number, law: HeatedLaw) -> Number:
    """Let the law at a temperature act; return the ratio at rest.

    Between two temperatures at which it is given its parameters lie on straight lines; before the first and beyond the
    last they are constant.
    """
    given, acting, row = law.given, law.acting, law.row
    count, width = int(given[row, AT]), int(given[row, WIDTH])
    if count == 0:
        return acting[row, STATIC]
    below = piece_at(given, row, FIRST_TEMPERATURE, count - 1, temperature)
    place = FIRST_TEMPERATURE + below
    share = share_between(given[row, place], given[row, place + 1], temperature)
    first = FIRST_TEMPERATURE + count + below * width
    after = first + width
    for k in range(width):
        # Numbers that do not depend on the temperature, such as those of pieces, stay exact.
        acting[row, k] = given[row, first + k] + share * (given[row, after + k] - given[row, first + k])
    return acting[row, STATIC]


@called
def set_laws(parts: Parts, runs: Runs) -> None:
    """Let the laws of all contacts act at their temperatures, those at the instant of their next forces."""
    carried, contacts = parts.state.carried, parts.contacts
    for i in range(parts.sizes.contacts):
        law = HeatedLaw(parts.heating.laws, contacts.laws, i * runs.columns + runs.first)
        ratio = act_at(held(carried, i * at.CARRIED + at.TEMPERATURE, runs), law)
        hold(contacts.constants, i * at.CONTACT_CONSTANTS + at.AT_REST, runs, ratio)


@called
def heat_contacts(parts: Parts, runs: Runs) -> None:
    """Heat all contacts by what they lost to friction in a step, and set their laws for the next."""
    carried, energies, layers = parts.state.carried, parts.state.energies, parts.sizes.layers
    numbers, now = parts.heating.numbers, parts.heating.now
    for i in range(parts.sizes.contacts):
        own, base = i * at.OF_HEATING, i * at.CARRIED + at.TEMPERATURE
        heat = held(parts.contacts.now, i * at.IN_STEP + at.LOST, runs) * held(numbers, own + at.HEAT_SHARE, runs)
        for j in range(layers):
            warmed = held(numbers, own + at.WITHOUT_LOSS + j, runs)
            warmed += held(numbers, own + at.PER_LOSS + j, runs) * heat
            for k in range(layers):
                row = own + at.PER_LAYER + j * at.LAYERS + k
                warmed += held(numbers, row, runs) * held(carried, base + k, runs)
            hold(now, j, runs, warmed)
        add(energies, at.HEAT, runs, heat)
        for j in range(layers):
            rise = held(now, j, runs) - held(carried, base + j, runs)
            add(energies, at.STORED_HEAT, runs, held(numbers, own + at.CAPACITY + j, runs) * rise)
            hold(carried, base + j, runs, held(now, j, runs))
        if layers > 1:
            before = held(carried, base + 1, runs)
            moved = held(carried, i * at.CARRIED + at.MATERIAL, runs) - before
            moved *= held(numbers, own + at.BY_PLACE, runs)
            hold(carried, base + 1, runs, before + moved)
            seen = before + moved + held(numbers, own + at.AHEAD, runs) * moved
            law = HeatedLaw(parts.heating.laws, parts.contacts.laws, i * runs.columns + runs.first)
            hold(carried, base, runs, temperature_at(held(carried, base, runs), seen, law))
    set_laws(parts, runs)
