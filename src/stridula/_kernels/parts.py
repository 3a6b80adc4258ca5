"""What a march takes, part by part."""

from typing import NamedTuple

import numpy as np


class Sizes(NamedTuple):
    """How much there is of what.

    Attributes
    ----------
    blocks, coupled : int
        Blocks of modes, those of coupled modes, which come first.
    per_block : int
        Numbers of a run in a block.
    contacts, faces : int
        Contacts, blocks of their forces.
    loads : int
        Unit loads.
    paths, coupled_paths : bool
        Whether a contact is on a path, and on one whose modes are coupled.
    space : bool
        Whether a contact has two tangents.
    circles : bool
        Whether a contact moves round a body, along a circle.
    """

    blocks: int
    coupled: int
    per_block: int
    contacts: int
    faces: int
    loads: int
    paths: bool
    coupled_paths: bool
    space: bool
    circles: bool = False


class Timing(NamedTuple):
    """Steps of a sample, their length [s], and how contacts are solved: tolerance and most sweeps."""

    steps_per_sample: int
    step: float
    tolerance: float
    sweeps: int


class Modes(NamedTuple):
    """Rows of all modes, ``(blocks, rows, lanes)``, matrices of coupled ones, their reach, work of each load when last
    changed."""

    rows: np.ndarray
    matrices: np.ndarray
    reach: np.ndarray
    given: np.ndarray


class Paths(NamedTuple):
    """The modes that each contact sees, and the waves of those that it moves along.

    Attributes
    ----------
    waves : ndarray, shape (blocks, rows, lanes)
        Sines and cosines at each contact.
    sets, pairs : ndarray of int
        Which waves each contact has, and which of them are sums and differences.
    wave_of : ndarray of int, shape (blocks of modes,)
        The wave of a block, from the first of a contact on.
    spans, first_span : ndarray of int
        Spans of blocks; those of contact i from ``first_span[i]`` to ``first_span[i + 1]``, constant ones first.
    path_of : ndarray of int, shape (contacts,)
        The first block of the path of a contact, -1 for none.
    body_of : ndarray of int, shape (contacts,)
        The turning body that a contact moves round, -1 for none.
    at_start : ndarray, shape (blocks, rows, lanes)
        The two rows of each contact where it starts, where any moves round a body.
    """

    waves: np.ndarray
    sets: np.ndarray
    pairs: np.ndarray
    wave_of: np.ndarray
    spans: np.ndarray
    first_span: np.ndarray
    path_of: np.ndarray
    body_of: np.ndarray
    at_start: np.ndarray


class Contacts(NamedTuple):
    """Laws of friction, constants, compliances and what the contacts are in a step.

    Attributes
    ----------
    codes, laws : ndarray, shapes (contacts,), (contacts runs, parameters)
        Law of each contact and its parameters in each run.
    constants, fixed : ndarray, a column a run
        Constants of each contact; compliance of the only one on constant rows.
    faces, scratch : ndarray, shape (rows, blocks, lanes)
        Displacements and compliances of all contacts; a linear system.
    places : ndarray, shape (2 contacts, lanes)
        Row of the displacements that each equation of the system is of; of runs side by side, in the first lane.
    now, sums : ndarray, a column a run
        What each contact is in a step; sums over a sample.
    """

    codes: np.ndarray
    laws: np.ndarray
    constants: np.ndarray
    fixed: np.ndarray
    faces: np.ndarray
    scratch: np.ndarray
    places: np.ndarray
    now: np.ndarray
    sums: np.ndarray


class Carried(NamedTuple):
    """What is carried from step to step, a column a run: of contacts, at the end of runs that have ended, energies."""

    carried: np.ndarray
    at_end: np.ndarray
    energies: np.ndarray


class Imposed(NamedTuple):
    """What is imposed, a row a step, or one row.

    Attributes
    ----------
    signals, motion : ndarray
        Amplitudes of the loads and what else is imposed; motions of contacts, from a step before to one after.
    angles : ndarray
        Angles by which bodies turn in each step [rad], from the step before on.
    """

    signals: np.ndarray
    motion: np.ndarray
    angles: np.ndarray


class Turning(NamedTuple):
    """Bodies that turn: see `turning`.

    Attributes
    ----------
    rows : ndarray, shape (blocks, rows, lanes)
        Turns of the pairs in each block.
    spans : ndarray of int, shape (bodies, 2)
        Blocks of each body.
    turned, contacts : ndarray, a column a run
        Angles of each body in the step that the turns are of and in the last; what turning does to each contact.
    """

    rows: np.ndarray
    spans: np.ndarray
    turned: np.ndarray
    contacts: np.ndarray


class Probes(NamedTuple):
    """Kinds of probes, blocks they see, shares of signals and contact forces; values at the last step, and what turning
    adds to the last change and to the next."""

    kinds: np.ndarray
    spans: np.ndarray
    direct: np.ndarray
    shares: np.ndarray
    last: np.ndarray
    passing: np.ndarray


class Records(NamedTuple):
    """A row a sample for energies and contacts, a row a step for the probes; what became of each run."""

    energies: np.ndarray
    contacts: np.ndarray
    raw: np.ndarray
    stops: np.ndarray


class Parts(NamedTuple):
    """All that a march takes."""

    sizes: Sizes
    timing: Timing
    modes: Modes
    paths: Paths
    contacts: Contacts
    turning: Turning
    state: Carried
    imposed: Imposed
    probes: Probes
    records: Records
