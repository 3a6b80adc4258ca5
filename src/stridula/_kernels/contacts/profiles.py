"""Height of the surface of a track under a tip, and the work of a normal force that follows it."""

from ..contact.lanewise import lanewise
from ..contact.pieces import piece_at
from ..lanes.compiled import called
from ..lanes.operations import Array, Number, Runs, add, held, hold
from ..layout import columns as at
from ..layout.contact_values import Profile
from ..layout.parts import Carried, Contacts
from ..layout.profiles import FIRST_PLACE, ORDER, PERIODIC, PIECES


@lanewise(0.0)
def height_at(place: Number, profile: Profile) -> Number:
    """Return the height of a surface at a place along its material; beyond the ends that of the end."""
    table, row = profile.table, profile.row
    pieces = int(table[row, PIECES])
    if pieces == 0:
        return 0.0
    first, last = table[row, FIRST_PLACE], table[row, FIRST_PLACE + pieces]
    if table[row, PERIODIC] > 0.0:
        place = first + (place - first) % (last - first)
    place = min(max(place, first), last)
    low = piece_at(table, row, FIRST_PLACE, pieces, place)
    along = place - table[row, FIRST_PLACE + low]
    begin = FIRST_PLACE + pieces + 1 + low * ORDER
    height = table[row, begin + ORDER - 1]
    for k in range(ORDER - 2, -1, -1):
        height = height * along + table[row, begin + k]
    return height


@called
def set_height(i: int, slip: Number, contacts: Contacts, carried: Array, runs: Runs) -> Number:
    """Set and return the height of the track under contact `i` at the end of the step (step 3).

    `slip` is that without contact forces; these are expected to add as much as in the last step.
    """
    base, here = i * at.CARRIED, i * at.IN_STEP
    place = held(carried, base + at.MATERIAL, runs) + slip + held(carried, base + at.PUSHED, runs)
    height = height_at(place, Profile(contacts.profiles, i * runs.columns + runs.first))
    hold(contacts.now, here + at.HEIGHT, runs, height)
    hold(contacts.now, here + at.TRIED_SLIP, runs, slip)
    return height


@called
def follow_profile(i: int, normal: Number, slip: Number, contacts: Contacts, state: Carried, runs: Runs) -> None:
    """Carry what contact `i` has of a profile to the next step; credit the work of the normal force as it advances."""
    base, here, carried = i * at.CARRIED, i * at.IN_STEP, state.carried
    height = held(contacts.now, here + at.HEIGHT, runs)
    rise = 0.5 * (height - held(carried, base + at.EARLIER_HEIGHT, runs))
    add(state.energies, at.CONVECTION_WORK, runs, normal * rise)
    hold(carried, base + at.EARLIER_HEIGHT, runs, held(carried, base + at.LAST_HEIGHT, runs))
    hold(carried, base + at.LAST_HEIGHT, runs, height)
    hold(carried, base + at.PUSHED, runs, slip - held(contacts.now, here + at.TRIED_SLIP, runs))
