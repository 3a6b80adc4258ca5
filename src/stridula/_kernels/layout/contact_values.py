"""Values that belong to a contact within a step, by name."""

from typing import NamedTuple

from ..lanes.operations import Array, Number


class Tangents(NamedTuple):
    """One number for each of the tangents a and b of a contact in space."""

    a: Number
    b: Number


class Matrix(NamedTuple):
    """Numbers for pairs of these tangents, row by row."""

    aa: Number
    ab: Number
    ba: Number
    bb: Number


class Compliance(NamedTuple):
    """Relative displacement of a contact for unit forces [m/N], the first letter that of the displacement."""

    nn: Number
    nt: Number
    tn: Number
    tt: Number


class ComplianceInSpace(NamedTuple):
    """The same along the normal and two tangents a and b."""

    nn: Number
    na: Number
    nb: Number
    an: Number
    aa: Number
    ab: Number
    bn: Number
    ba: Number
    bb: Number


class Law(NamedTuple):
    """The law of friction of a contact.

    Attributes
    ----------
    code : int
        Code of the law, see `columns`.
    table : array
        Parameters of the laws of all contacts, with the columns of `laws`.
    row : int
        Row of this contact, that of the first of several runs.
    at_rest : number
        Ratio of forces up to which it may rest.
    normal : number
        Normal force at which its ratio is evaluated [N].
    """

    code: int
    table: Array
    row: int
    at_rest: Number
    normal: Number


class Piece(NamedTuple):
    """A piece of a curve of friction: the slip speeds at its ends, and the column of its first coefficient."""

    begin: Number
    end: Number
    first: int


class Profile(NamedTuple):
    """The profile of the track of a contact: the table of those of all contacts, and its row; see `profiles`."""

    table: Array
    row: int


class HeatedLaw(NamedTuple):
    """The law of a contact at some temperatures, and its temperature over time: tables of those of all contacts, the
    table of the laws that act, and its row; see `heated_laws`."""

    given: Array
    acting: Array
    row: int


class Free(NamedTuple):
    """Motion of a contact in a step without its own forces, and what these change.

    Attributes
    ----------
    gap : number
        Gap at the end of the step [m].
    slip : number
        Motion of the tip along the track in the step [m].
    strayed : number
        Distance of a stick from its anchor [m].
    w : Compliance
        Displacement for unit forces.
    let_go : number
        Above 0.5 where the contact is no longer held, and above 0 where no reversal within the step is sought.
    """

    gap: Number
    slip: Number
    strayed: Number
    w: Compliance
    let_go: Number


class Tried(NamedTuple):
    """Abscissa, gap and slip of the only contact in a step without its forces [m], and its compliance."""

    place: Number
    gap: Number
    slip: Number
    w: Compliance


class Done(NamedTuple):
    """Work of the only contact in a step, loss to damping [J], and force along its path by the slope of that."""

    work: Number
    lost: Number
    slope: Number


class FreeInSpace(NamedTuple):
    """The same along both tangents, and `guess`, the tangential forces from which their direction is sought."""

    gap: Number
    slips: Tangents
    strays: Tangents
    w: ComplianceInSpace
    let_go: Number
    guess: Tangents


class Before(NamedTuple):
    """What a contact carries from the steps before.

    Attributes
    ----------
    status : number
        Status of the last step.
    slip, earlier_slip : number
        Slip of the last step, and of the one before [m].
    state : number
        Internal state of the law.
    normal, tangential : number
        Forces of the last step [N].
    past : number
        Part of the ratio of forces that lies before the step, see `slipping`.
    """

    status: Number
    slip: Number
    earlier_slip: Number
    state: Number
    normal: Number
    tangential: Number
    past: Number


class BeforeInSpace(NamedTuple):
    """The same along both tangents."""

    status: Number
    slip: Tangents
    earlier_slip: Tangents
    state: Tangents
    normal: Number
    tangential: Tangents
    past: Tangents


class Yielding(NamedTuple):
    """How a contact yields along its normal; a rigid one has no stiffness.

    Attributes
    ----------
    stiffness, exponent : number
        Force for an indentation of one, and the power of the indentation.
    damping, rate : number
        Dashpot [N s/m], and damping rate over the force [s/m].
    reach : number
        Size of its sawtooth under unit forces [m/N], see `pressing`.
    """

    stiffness: Number
    exponent: Number
    damping: Number
    rate: Number
    reach: Number


class Indentations(NamedTuple):
    """Indentations of a contact at the last three steps [m], the latest first."""

    now: Number
    before: Number
    earlier: Number


class Drive(NamedTuple):
    """What drives a slip over a step: its value at the beginning, and its change."""

    begin: Number
    grows: Number


class DriveInSpace(NamedTuple):
    """The same along both tangents."""

    begin: Tangents
    grows: Tangents


class Way(NamedTuple):
    """The slip of a contact on its way through a step, see `slipping`.

    Attributes
    ----------
    past : number
        Past part of the ratio of forces for the next step.
    state : number
        Internal state of the law.
    stuck : number
        Share of the step in which it sticks.
    """

    past: Number
    state: Number
    stuck: Number


class Touch(NamedTuple):
    """Forces of a contact in a step [N], its status, whether it jams, and the way of its slip.

    Only the solution of a single contact has its way.
    """

    normal: Number
    tangential: Number
    status: Number
    jammed: Number
    way: Way


class TouchInSpace(NamedTuple):
    """The same with the forces along both tangents."""

    normal: Number
    tangential: Tangents
    status: Number
    jammed: Number


class Moved(NamedTuple):
    """Gap of a contact at the end of a step and slip in it, under all forces [m]."""

    gap: Number
    slip: Number
