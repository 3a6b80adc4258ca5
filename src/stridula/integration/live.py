"""A march without end of a system that may be changed while it runs."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace

import numpy as np

from .._kernels.layout import columns as at
from ..arrays import Array
from ..checks import positive
from ..lowering.schemes import ExactModal, Scheme
from ..records import Probe
from ..records.state import State
from ..records.variables import ALONG_TANGENTS
from ..system import System
from .marches import Factors
from .run import ALONG_BOTH, CONTACT_COLUMN, ENERGY_COLUMN
from .stops import ENDED
from .under_way import Marched, UnderWay, begun, changed


@dataclass(frozen=True)
class LiveChunk:
    """Record of a part of a live march.

    Attributes
    ----------
    time : ndarray, shape (samples,)
        Time since the start of the stroke at the end of every sample interval [s].
    contacts : dict of ndarray, shape (contacts, samples)
        Variables of the contacts, by their names in records; in space along the first tangent.
    status_shares : ndarray, shape (contacts, samples, 3)
        Share of each interval separated, sticking and sliding.
    energies : dict of ndarray, shape (samples,)
        Energies since the start or the last change, by their names in records.
    probes : ndarray, shape (samples, probes)
        Probes, delayed by `LiveMarch.delay` samples.
    along_tangents : dict of ndarray, shape (contacts, samples, 2)
        Variables of contacts in space along both tangents, by their names in records; empty in the plane.
    """

    time: Array
    contacts: dict[str, Array]
    status_shares: Array
    energies: dict[str, Array]
    probes: Array
    along_tangents: dict[str, Array]

    @property
    def contact(self) -> dict[str, Array]:
        """Variables of the first contact."""
        return {name: values[0] for name, values in self.contacts.items()}

    @property
    def status_share(self) -> Array:
        """Status shares of the first contact."""
        found: Array = self.status_shares[0]
        return found


@dataclass(frozen=True)
class Moment:
    """A moment of a live march, to which it can return.

    Attributes
    ----------
    under_way : UnderWay
        The march.
    state : State
        State of its system.
    factors : Factors, optional
        Factors that its march keeps.
    """

    under_way: UnderWay
    state: State
    factors: Factors | None


class LiveMarch:
    """A march of a system, sample by sample, without a fixed end.

    The system may be changed in between, and its motion continues. Friction, forces and the velocities of rigid tracks
    and of surfaces change at once; changed bodies keep their deflections, contacts their gap and their place on the
    track. A contact that is moved along the track keeps its gap there.

    Parameters
    ----------
    system : System
        The system.
    probes : sequence of probes
        Quantities to record besides those of the contacts: Displacement, Velocity, Acceleration, Reaction,
        SupportForce, ConnectionForce, ModalDisplacement or ModalVelocity.
    scheme : CentralDifference or ExactModal, optional
        Time scheme; the exact modal one if left out.
    sample_rate : float, optional
        Samples per second [Hz].
    """

    def __init__(
        self,
        system: System,
        probes: Sequence[Probe],
        scheme: Scheme | None = None,
        sample_rate: float = 48e3,
        step: float | None = None,
    ) -> None:
        self.interval = 1.0 / positive("sample_rate", sample_rate)
        scheme = ExactModal() if scheme is None else scheme
        self.now = begun(Marched.of(system, tuple(probes), scheme, self.interval, step))

    @property
    def system(self) -> System:
        """The system."""
        return self.now.marched.system

    @property
    def step(self) -> float:
        """Time step [s]."""
        return self.now.marched.step

    @property
    def ratio(self) -> int:
        """Steps per sample."""
        return self.now.marched.ratio

    @property
    def time(self) -> float:
        """Time since the start of the stroke [s]."""
        return self.now.time

    @property
    def delay(self) -> int:
        """Samples by which probes are delayed."""
        return self.now.probed.delay

    @property
    def position(self) -> Array:
        """Present modal displacements, shape (modes,); the range of each body is in `spans`."""
        return self._of_bodies(self.now.state.modal[at.Q])

    @property
    def motion(self) -> tuple[Array, Array]:
        """Present modal displacements and velocities, both as in `position`."""
        modal = self.now.state.modal
        return self._of_bodies(modal[at.Q]), self._of_bodies(modal[at.D] / self.step)

    @property
    def spans(self) -> dict[str, tuple[int, int]]:
        """First mode of each body, and end of its range."""
        return self.now.arrays.spans

    @property
    def passed(self) -> Array:
        """Distance by which the track of each contact has been moved along itself so far, shape (contacts,) [m]."""
        return self.now.imposed[:, at.TRACK_MOTION]

    @property
    def moment(self) -> Moment:
        """The present moment."""
        return Moment(self.now.apart(), self.now.state, self.now.march.factors)

    def return_to(self, moment: Moment) -> None:
        """Return to an earlier moment; the march continues from it to the last bit as it did then."""
        self.now = moment.under_way.apart()
        self.now.march.put([moment.state], moment.factors)

    def at(self, moment: Moment) -> LiveMarch:
        """Return a march of its own that continues from an earlier moment, while this one stays where it is."""
        other = copy(self)
        other.now = replace(moment.under_way.apart(), march=moment.under_way.march.copy())
        other.now.march.put([moment.state], moment.factors)
        return other

    def restart(self) -> None:
        """Return to the start."""
        self.now = begun(self.now.marched)

    def advance(self, samples: int) -> tuple[LiveChunk, str]:
        """Continue the march and return its record, and the reason of its end.

        Parameters
        ----------
        samples : int
            Samples to march.

        Returns
        -------
        chunk : LiveChunk
            Record, with fewer samples if the march ended early.
        ended : str
            ``finished``, ``off the track`` or one of `records.endings.FAILED`; except after the first, the march must
            be started again with `restart` or `begin`.
        """
        now, ratio = self.now, self.ratio
        imposed = now.impositions.on(now.sample * ratio, samples * ratio)
        (chunk,) = now.march.advance([imposed], samples)
        done, ended = now.belief.of(chunk)
        time = (now.sample + np.arange(1, done + 1)) * self.interval
        record, energy = chunk.contacts[:done].transpose(1, 2, 0), chunk.energies[:done].T
        gaps = record[:, at.CONTACT_GAP, -1].copy() if done else now.gaps
        self.now = replace(now, sample=now.sample + done, gaps=gaps)
        contacts = {name: record[:, column].copy() for name, column in CONTACT_COLUMN.items()}
        energies = {name: energy[column].copy() for name, column in ENERGY_COLUMN.items()}
        shares = record[:, at.SEPARATED : at.SLIDING + 1].transpose(0, 2, 1).copy()
        doubled = ALONG_TANGENTS if now.marched.system.has_two_tangents else ()
        tangents = {name: np.stack([record[:, one] for one in ALONG_BOTH[name]], axis=-1) for name in doubled}
        probes = now.probed.next(chunk.raw[: done * ratio], done)
        return LiveChunk(time, contacts, shares, energies, probes, tangents), ENDED[ended]

    def begin(
        self, system: System, probes: Sequence[Probe], scheme: Scheme | None = None, step: float | None = None
    ) -> None:
        """Start again with another system, in any state of the march.

        Parameters
        ----------
        system : System
            New system.
        probes : sequence of probe
            Quantities to record from now on besides those of the contacts.
        scheme : CentralDifference or ExactModal, optional
            Time scheme; unchanged if left out.
        step : float, optional
            Longest time step [s]; the scheme's default if left out.

        Raises
        ------
        ValueError
            As at the start; then nothing is changed.
        """
        self.now = begun(self._next(system, probes, scheme, step))

    def change(
        self, system: System, probes: Sequence[Probe], scheme: Scheme | None = None, step: float | None = None
    ) -> bool:
        """Continue with another system.

        Parameters
        ----------
        system : System
            New system.
        probes : sequence of probe
            Quantities to record from now on besides those of the contacts.
        scheme : CentralDifference or ExactModal, optional
            Time scheme; unchanged if left out.
        step : float, optional
            Longest time step [s]; the scheme's default if left out.

        Returns
        -------
        bool
            Whether the motion continued; otherwise the march starts again, because the motion cannot be transferred to
            the other system, or its tip would not be on the track.

        Raises
        ------
        ValueError
            As at the start; then the march continues unchanged.
        """
        marched = self._next(system, probes, scheme, step)
        continued = changed(self.now, marched)
        self.now = begun(marched) if continued is None else continued
        return continued is not None

    def _next(self, system: System, probes: Sequence[Probe], scheme: Scheme | None, step: float | None) -> Marched:
        """Return the system to march from now on, under the present scheme if none is given."""
        scheme = self.now.marched.scheme if scheme is None else scheme
        return Marched.of(system, tuple(probes), scheme, self.interval, step)

    def _of_bodies(self, modal: Array) -> Array:
        """Return values of the modes of the march as values of the modes of the bodies."""
        blend, found = self.now.arrays.blend, np.array(modal)
        found[: len(blend)] = blend @ found[: len(blend)]
        return found
