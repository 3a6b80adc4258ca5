"""A system about its start as matrices: what its equilibrium and its vibration are found from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from ..assembly import Assembly, ContactRows, assemble
from ..bodies import BodyPoint, Track
from ..bodies.modes import Array
from ..contact import PointContact, RigidTrack
from ..histories import History
from ..records.variables import STATUS_WORDS
from ..system import System

SEPARATED, STICKING, SLIDING = STATUS_WORDS
# Relative size below which a motion does not move a row.
UNMOVED = 1e-9
# Relative square of an angular frequency below which a motion strains nothing.
UNSTRAINED = 1e-14


@dataclass(frozen=True)
class ContactLine:
    """One contact at its abscissa, as rows on the modes, each of shape (modes,).

    Attributes
    ----------
    normal, tangent : ndarray
        Displacement of the tip less that of the track, along normal and tangent; also how contact forces act.
    along : ndarray
        Shift of the contact point along a beam or a plate; zero on other tracks, which look the same everywhere.
    normal_slope, tangent_slope : ndarray
        Displacement of the track along normal and tangent, derived along the track [1/m].
    """

    normal: Array
    tangent: Array
    along: Array
    normal_slope: Array
    tangent_slope: Array


class Structure:
    """A system about its start as matrices.

    Parameters
    ----------
    system : System
        The system.
    time : float, optional
        When drives are taken [s]; once they no longer vary if left out.

    Attributes
    ----------
    arrays : Assembly
        The system as flat arrays.
    lines : list of ContactLine
        One for each contact.
    stiffness, damping : ndarray, shape (modes, modes)
        Stiffness [1/s²] and damping matrix [1/s]; the mass matrix is one.
    rigid : ndarray, shape (modes, motions)
        Motions that strain nothing, orthonormal.
    load : ndarray, shape (modes,)
        Modal forces of the drives.
    gaps : ndarray, shape (contacts,)
        Gaps of the undeformed system [m].
    prescribed : ndarray, shape (contacts,)
        Slip velocities that drives and tracks prescribe [m/s].
    """

    def __init__(self, system: System, time: float | None = None) -> None:
        self.system, self.arrays = system, assemble(system)
        now = np.array([settled_time(system) if time is None else time])
        arrays, size = self.arrays, self.arrays.coupled
        self.lines = [_line(one) for one in arrays.contacts]
        self.stiffness = np.diag(arrays.angular_frequency**2)
        self.damping = np.diag(2.0 * arrays.damping * arrays.angular_frequency)
        self.stiffness[:size, :size], self.damping[:size, :size] = arrays.stiffness, arrays.dissipation
        self.rigid = _rigid_motions(arrays)
        factors = np.array([signal(now, 1e-6)[0] for signal in arrays.signals[: len(arrays.loads)]])
        self.load = factors @ arrays.loads
        self.gaps = arrays.motion(now, 1e-6)[0, :, 2] + [contact.gap for contact in system.contacts]
        self.prescribed = np.array([_prescribed_slip(contact, system, now) for contact in system.contacts])

    @property
    def mode_count(self) -> int:
        """Number of modes."""
        return self.arrays.mode_count

    def free_motions(self, rows: Array) -> Array:
        """Return the rigid motions that some rows do not feel, orthonormal, shape (modes, motions)."""
        if not self.rigid.shape[1] or not len(rows):
            return self.rigid
        felt = rows @ self.rigid / np.linalg.norm(rows, axis=1, keepdims=True)
        return np.asarray(self.rigid @ scipy.linalg.null_space(felt, rcond=UNMOVED))


def settled_time(system: System) -> float:
    """Return when drives and tracks no longer vary [s].

    Raises
    ------
    ValueError
        If one always does.
    """
    histories: list[tuple[str, History]] = []
    for number, drive in enumerate(system.drives):
        if hasattr(drive, "history"):
            histories.append((f"drives[{number}]", drive.history))
    for name, contact in zip(system.contact_names, system.contacts, strict=True):
        if isinstance(contact.track, RigidTrack) and contact.track.velocity:
            histories.append((f"the track of {name}", contact.track.history))
    for name, history in histories:
        if history.settled is None:
            raise ValueError(f"time must be given for {name}, which never stops varying, got {history!r}")
    return max((history.settled or 0.0 for _, history in histories), default=0.0)


def _line(one: ContactRows) -> ContactLine:
    nothing = np.zeros(one.fixed.shape[1])
    track = one.contact.track
    if not isinstance(track, Track):
        return ContactLine(one.fixed[0], one.fixed[1], nothing, nothing, nothing)
    modes = slice(one.bending[0], one.axial[1])
    trace, slope = np.zeros((2, 2, nothing.size))
    trace[:, modes], slope[:, modes] = track.trace(one.contact.at), track.trace_slope(one.contact.at)
    # A trace is along x, then along y: tangent and normal.
    return ContactLine(one.fixed[0] - trace[1], one.fixed[1] - trace[0], one.fixed[1], slope[1], slope[0])


def _rigid_motions(arrays: Assembly) -> Array:
    modes, size = np.eye(arrays.mode_count), arrays.coupled
    rigid = [modes[:, size:][:, arrays.angular_frequency[size:] == 0.0]]
    if size:
        squared, shapes = np.linalg.eigh(arrays.stiffness)
        unstrained = squared <= UNSTRAINED * max(float(squared[-1]), 1.0)
        rigid.insert(0, np.pad(shapes[:, unstrained], ((0, arrays.mode_count - size), (0, 0))))
    return np.concatenate(rigid, axis=1)


def _prescribed_slip(contact: PointContact, system: System, now: Array) -> float:
    imposed, tangent = system.imposed_velocity, contact.frame[1]
    root = imposed.velocity * float(imposed.history.factor(now)[0]) if imposed else 0.0
    slip = tangent[0] * root if system.is_held(contact.tip.body) else 0.0
    if isinstance(contact.track, BodyPoint) and system.is_held(contact.track.body):
        slip -= tangent[0] * root
    if isinstance(contact.track, RigidTrack):
        slip -= contact.track.velocity * float(contact.track.history.factor(now)[0])
    return float(slip)
