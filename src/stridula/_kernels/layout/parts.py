"""Arguments of a march, grouped in tuples."""

from typing import NamedTuple

import numpy as np


class Sizes(NamedTuple):
    """Numbers of blocks, contacts and loads, and kinds of contacts present.

    Attributes
    ----------
    blocks, coupled : int
        Number of blocks of modes, and of those of coupled modes, which are the first.
    per_block : int
        Numbers of a run in a block.
    contacts, faces : int
        Number of contacts, and of blocks of their forces.
    rows : int
        Number of rows of all contacts: of the normal and the tangents of each.
    loads : int
        Number of unit loads.
    springs, kinks : int
        Number of nonlinear springs, and of the kinks of each.
    paths, coupled_paths : bool
        Whether any contact is on a path, and on a path with coupled modes.
    space : bool
        Whether any contact has two tangents.
    circles : bool
        Whether any contact moves round a body, along a circle.
    layers : int
        Largest number of heated layers of a contact, 0 without temperatures.
    """

    blocks: int
    coupled: int
    per_block: int
    contacts: int
    faces: int
    rows: int
    loads: int
    paths: bool
    coupled_paths: bool
    space: bool
    circles: bool = False
    springs: int = 0
    kinks: int = 0
    layers: int = 0


class Timing(NamedTuple):
    """Steps in a sample, time step [s], and tolerance and largest number of sweeps of the contact solver."""

    steps_per_sample: int
    step: float
    tolerance: float
    sweeps: int


class Modes(NamedTuple):
    """Rows of all modes, ``(blocks, rows, lanes)``, matrices of coupled modes, their reach, work of each load at its
    last change."""

    rows: np.ndarray
    matrices: np.ndarray
    reach: np.ndarray
    given: np.ndarray


class Paths(NamedTuple):
    """Modes that each contact depends on, and waves of the paths that it moves along.

    Attributes
    ----------
    waves : ndarray, shape (blocks, rows, lanes)
        Sines and cosines at each contact.
    sets : ndarray of int
        Waves of each contact.
    wave_of, across_of : ndarray of int, shape (blocks of modes,)
        Wave of a block, counted from the first of a contact, and multiple of the angle across.
    spans, first_span : ndarray of int
        Spans of blocks; those of contact i from ``first_span[i]`` to ``first_span[i + 1]``, constant ones first.
    path_of : ndarray of int, shape (contacts,)
        First block of the path of a contact, -1 for none.
    body_of : ndarray of int, shape (contacts,)
        Body that a contact moves round, -1 for none.
    at_start : ndarray, shape (blocks, rows, lanes)
        The rows of each contact at its initial place, if any moves round a body.
    """

    waves: np.ndarray
    sets: np.ndarray
    wave_of: np.ndarray
    across_of: np.ndarray
    spans: np.ndarray
    first_span: np.ndarray
    path_of: np.ndarray
    body_of: np.ndarray
    at_start: np.ndarray


class Contacts(NamedTuple):
    """Laws of friction, constants, compliances and states of the contacts in a step.

    Attributes
    ----------
    codes, laws : ndarray, shapes (contacts,), (contacts runs, parameters)
        Law of each contact and its parameters in each run.
    rows : ndarray of int, shape (contacts + 1,)
        First row of each contact, that of its normal, and the end of the last.
    constants, fixed : ndarray, a column a run
        Constants of each contact; compliance of the only one on constant rows.
    faces, scratch : ndarray, shape (rows, blocks, lanes)
        Displacements and compliances of all contacts; a linear system.
    places : ndarray, shape (rows, lanes)
        Row of displacements for each equation of the system; of runs side by side, in the first lane.
    dense : ndarray, shape (runs, rows, numbers)
        Space to solve for the forces of all contacts of a run together.
    now, sums : ndarray, a column a run
        State of each contact in a step; sums over a sample.
    profiles : ndarray, shape (contacts runs, numbers)
        Profile of the track of each contact in each run, see `profiles`; no numbers without any.
    """

    codes: np.ndarray
    laws: np.ndarray
    rows: np.ndarray
    constants: np.ndarray
    fixed: np.ndarray
    faces: np.ndarray
    scratch: np.ndarray
    places: np.ndarray
    dense: np.ndarray
    now: np.ndarray
    sums: np.ndarray
    profiles: np.ndarray


class Carried(NamedTuple):
    """Numbers carried from step to step, a column a run: of contacts, of contacts of ended runs, energies."""

    carried: np.ndarray
    at_end: np.ndarray
    energies: np.ndarray


class Imposed(NamedTuple):
    """Imposed loads and motions, a row a step, or one row.

    Attributes
    ----------
    signals, motion : ndarray
        Amplitudes of loads and other signals; motions of contacts, from a step before to one after.
    angles : ndarray
        Angles by which bodies turn in each step [rad], from the step before on.
    """

    signals: np.ndarray
    motion: np.ndarray
    angles: np.ndarray


class Turning(NamedTuple):
    """Turning bodies: see `turning`.

    Attributes
    ----------
    rows : ndarray, shape (blocks, rows, lanes)
        Turns of the pairs in each block.
    spans : ndarray of int, shape (bodies, 2)
        Blocks of each body.
    turned, contacts : ndarray, a column a run
        Angles of each body in the step of the turns and in the last; effect of turning on each contact.
    """

    rows: np.ndarray
    spans: np.ndarray
    turned: np.ndarray
    contacts: np.ndarray


class Springs(NamedTuple):
    """Numbers of the nonlinear springs, and their state in a step, a column a run."""

    numbers: np.ndarray
    now: np.ndarray


class Heating(NamedTuple):
    """Temperatures of contacts, see `heating`.

    Attributes
    ----------
    numbers, now : ndarray, a column a run
        Numbers of each contact, and temperatures of its layers after a step.
    laws : ndarray, shape (contacts runs, numbers)
        Laws of friction at some temperatures, and histories of temperature, see `heated_laws`.
    """

    numbers: np.ndarray
    now: np.ndarray
    laws: np.ndarray


class Probes(NamedTuple):
    """Kinds and blocks of probes, shares of signals and contact forces; values at the last step, and additions of
    turning to the last change and to the next."""

    kinds: np.ndarray
    spans: np.ndarray
    direct: np.ndarray
    shares: np.ndarray
    last: np.ndarray
    passing: np.ndarray


class Records(NamedTuple):
    """Energies and contacts, a row a sample; probes, a row a step; result of each run."""

    energies: np.ndarray
    contacts: np.ndarray
    raw: np.ndarray
    stops: np.ndarray


class Parts(NamedTuple):
    """All arguments of a march."""

    sizes: Sizes
    timing: Timing
    modes: Modes
    paths: Paths
    contacts: Contacts
    turning: Turning
    springs: Springs
    heating: Heating
    state: Carried
    imposed: Imposed
    probes: Probes
    records: Records
