"""Agreement of measured with computed mode shapes: the modal assurance criterion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import MeasuredModes
from ..checks import ArgumentError, choice, instance, positive
from ..records.variables import described

# Distance within which a node is that of a measured point, relative to the size of the measured body.
TOLERANCE = 0.02


def mac(
    measured: MeasuredModes,
    computed: Any,
    *,
    points: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
) -> xr.DataArray:
    """Return the modal assurance criterion between measured modes and those of a body.

    With measured shapes psi and computed shapes phi at the same points and directions (Allemang 2003)::

        MAC = |psi^H phi|**2 / ((psi^H psi) (phi^H phi))

    Directions in which a point is at rest in all measured modes are left out as not measured. Computed shapes are those
    at the nearest node of a mesh, or at the nearest point with a known place.

    Parameters
    ----------
    measured : MeasuredModes
        Modes of a test.
    computed : SolidBody, ModalBody, MeasuredModes or another body
        The body, or modes with the same names of points, such as `measured` itself.
    points : mapping, optional
        Positions on the body by the names of measured points, which are then used alone; needed for beams, plates and
        bodies of revolution.
    tolerance : float, optional
        Largest distance of a node from a measured point [m]; a fiftieth of the diagonal of the measured points if left
        out.

    Returns
    -------
    xarray.DataArray, shape (measured, computed)
        The criterion, from 0 to 1. Coordinates ``measured_frequency`` and ``computed_frequency`` [Hz],
        ``measured_damping`` and ``computed_damping`` [1]; the attribute ``distance`` is the largest distance of a node
        from its measured point [m].

    Raises
    ------
    ValueError
        If a point has no node within the tolerance, or the body no modes of finite frequency.

    Examples
    --------
    >>> import stridula as st
    >>> body = st.SolidBody.block((0.3, 0.05, 0.01), (4, 2, 1), st.Material(7e10, 2700.0, 0.33), cutoff=3e3)
    >>> places = [(0.0, 0.0, 0.01), (0.15, 0.0, 0.01), (0.3, 0.05, 0.01)]
    >>> shapes = [body.trace(place)[:, 6:9] for place in places]
    >>> test = st.MeasuredModes(body.modes().frequency[6:9], 0.002, shapes, "abc", places=places)
    >>> table = st.mac(test, body)
    """
    instance("measured", measured, MeasuredModes)
    names, traces, motion, distance = _computed(measured, computed, points, tolerance)
    rows = [measured.points.index(name) for name in names]
    shapes = np.asarray(measured.shapes)[rows]
    seen = shapes.any(axis=2)
    psi, phi = shapes[seen], traces[seen]
    if not psi.any(axis=0).all():
        number = int(np.argmin(psi.any(axis=0)))
        raise ArgumentError("points", "move in every measured mode", got=f"none in mode {number + 1}")
    product = np.abs(psi.conj().T @ phi) ** 2
    sizes = np.outer(np.sum(np.abs(psi) ** 2, axis=0), np.sum(np.abs(phi) ** 2, axis=0))
    frequency, damping = motion
    return xr.DataArray(
        product / np.where(sizes > 0.0, sizes, 1.0),
        {
            "measured": np.arange(1, psi.shape[1] + 1),
            "computed": np.arange(1, phi.shape[1] + 1),
            "measured_frequency": ("measured", measured.frequency, described("Hz", "frequency of the measured mode")),
            "measured_damping": ("measured", measured.damping, described("1", "damping ratio of the measured mode")),
            "computed_frequency": ("computed", frequency, described("Hz", "frequency of the computed mode")),
            "computed_damping": ("computed", damping, described("1", "damping ratio of the computed mode")),
        },
        ("measured", "computed"),
        "mac",
        described("1", "modal assurance criterion") | {"distance": distance, "rows": int(seen.sum())},
    )


def _computed(
    measured: MeasuredModes, computed: Any, points: Mapping[str, Any] | None, tolerance: float | None
) -> tuple[list[str], Array, tuple[Array, Array], float]:
    """Return names of points, computed shapes there, their frequencies with damping, and the largest distance [m]."""
    if points is not None:
        instance("points", points, Mapping)
    if isinstance(computed, type) or not hasattr(computed, "check_position"):
        instance("computed", computed, MeasuredModes)
        at = dict(zip(measured.points, measured.points, strict=True)) if points is None else points
        rows = [
            computed.points.index(choice(f"points[{name!r}]", place, computed.points)) for name, place in at.items()
        ]
        return _checked(measured, at), computed.shapes[rows], (computed.frequency, computed.damping), 0.0
    positions, distance = _positions(measured, computed, tolerance) if points is None else (points, 0.0)
    names = _checked(measured, positions)
    modes = computed.modes()
    kept = ~modes.massless
    if not kept.any():
        raise ArgumentError("computed", "have modes of finite frequency", computed, got="none")
    traces = np.zeros((len(positions), 3, int(kept.sum())))
    for row, position in enumerate(positions.values()):
        trace = computed.trace(position)
        traces[row, : len(trace)] = trace[:, kept]
    return names, traces, (modes.frequency[kept], modes.damping[kept]), distance


def _checked(measured: MeasuredModes, points: Mapping[str, Any]) -> list[str]:
    if not points:
        raise ArgumentError("points", "name at least one measured point", points, got="none")
    return [choice("points", name, measured.points) for name in points]


def _positions(measured: MeasuredModes, body: Any, tolerance: float | None) -> tuple[dict[str, Any], float]:
    """Return the position of the nearest node or point of a body at each measured point, and the largest distance."""
    if measured.places is None:
        raise ArgumentError("points", "be given for measured points without places", got="none")
    given, places = _nodes(body)
    extent = float(np.linalg.norm(np.ptp(measured.places, axis=0)))
    if tolerance is None and not extent > 0.0:
        raise ArgumentError("tolerance", "be given for a single point", got="none")
    allowed = TOLERANCE * extent if tolerance is None else positive("tolerance", tolerance)
    found, largest = {}, 0.0
    for name, place in zip(measured.points, measured.places, strict=True):
        far = np.linalg.norm(places - place, axis=1)
        nearest = int(np.argmin(far))
        if far[nearest] > allowed:
            where = ", ".join(f"{value:.4g}" for value in place)
            got = f"{far[nearest]:.3g} m for {name!r} at ({where}) m"
            raise ArgumentError("measured", f"have its points within {allowed:.3g} m of nodes", got=got)
        found[name], largest = given[nearest], max(largest, float(far[nearest]))
    return found, largest


def _nodes(body: Any) -> tuple[list[Any], Array]:
    """Return positions on a body with their places: the nodes of its mesh, or its points."""
    if hasattr(body, "mesh"):
        return list(map(tuple, body.mesh.nodes.tolist())), body.mesh.nodes
    known = {name: body.at(name).place for name in body.point_names}
    known = {name: place for name, place in known.items() if place is not None}
    if not known:
        raise ArgumentError("points", "be given for a body whose points have no places", got="none")
    return list(known), np.array(list(known.values()))
