"""Interactive views of systems in space (the only module that uses pyvista)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..cards import VIEW, eye_of
from ..checks import STATUS_WORDS, positive
from ..extras import named_extras
from ..integration.settings import Given
from ..lowering.schemes import Scheme
from ..system import System
from .colours import STATUS_COLOURS
from .mode_films import motion_of_mode, over_largest, shapes_of_mode
from .motion import SAMPLE_RATE, motion_of
from .moved_bodies import MovedBodies, ShownBody, check_surfaces, places_of_contacts, surfaces_of
from .reels import FRAMES_PER_SECOND
from .scenes import VELOCITIES, checked_view
from .space_films import exaggeration_of

# Colour of bodies at rest, and sizes of a contact point and of text [pixels].
PALE, POINT, WORDS = "#b9c4cc", 14, 10
# Shares of ambient light and of light from the eye; their sum is below white.
AMBIENT, DIFFUSE = 0.3, 0.65
# Place of the colour bar, in shares of the window; nearer to the edge, its title is cut off.
BAR = {"vertical": True, "position_x": 0.86, "position_y": 0.25, "width": 0.06, "height": 0.5, "title_font_size": 16}


def view(
    system: System,
    start: float = 0.0,
    duration: float | None = None,
    *,
    slowdown: float = 1000.0,
    exaggeration: float | None = None,
    view: tuple[float, float] = VIEW,
    scheme: Scheme | None = None,
    step: float | None = None,
    sample_rate: float = SAMPLE_RATE,
) -> Any:
    """Show a system in space in an interactive window or notebook.

    Without a duration, the bodies are shown at rest with the contact points. With a duration, a slider and the keys
    Right and Left step through the window of time, with the same motion, colours and scales as the film of `animate`.

    Parameters
    ----------
    system : System
        A system with a `SolidBody` or an `AxisymmetricBody`.
    start : float, optional
        Start of the window of time [s].
    duration : float, optional
        Duration of the window [s]; if left out, bodies are at rest.
    slowdown : float, optional
        Slow-motion factor at 25 frames a second, which sets the number of frames.
    exaggeration : float, optional
        Factor by which the vibration is drawn larger; if left out, the vibration is drawn near 4 % of the extent.
    view : tuple of float, optional
        Initial elevation of the eye above the plane across y, and its azimuth from z towards x [rad].
    scheme : ExactModal or CentralDifference, optional
        Time scheme; if left out, the exact modal one.
    step : float, optional
        Time step [s]; if left out, that of `simulate` at `sample_rate`.
    sample_rate : float, optional
        Sample rate [Hz] of the run shown; no effect with a given `step`.

    Returns
    -------
    pyvista.Plotter
        Call its ``show()``, or ``screenshot("view.png")`` if ``pyvista.OFF_SCREEN = True`` was set before.

    Raises
    ------
    ValueError
        If an argument is out of its range, no body has a surface, or the run ends before the window.
    ImportError
        If the extra ``view`` is not installed.
    """
    check_surfaces(system)
    seen = checked_view(view)
    plotter = _plotter()
    if duration is None:
        for one in surfaces_of(system, np.zeros(3), moving=False):
            plotter.add_mesh(
                _mesh(one, one.surface.place), color=PALE, show_edges=True, edge_opacity=0.15, name=one.name
            )
        _, placed = places_of_contacts(system)
        _show_points(plotter, "contacts", np.array([one.at_rest for one in placed]).reshape(-1, 3), "black")
        return _looked_at(plotter, seen)
    frame = 1.0 / (FRAMES_PER_SECOND * positive("slowdown", slowdown))
    given = Given(scheme=scheme, step=step, sample_rate=sample_rate)
    motion = motion_of(system, (start, duration), frame, given, velocities=True)
    times = exaggeration_of(system, motion.modes, exaggeration)
    moved = MovedBodies(system, motion.modes, times, np.zeros(3))
    time = 1e3 * motion.run["time"].values
    status = motion.run["status"].values.reshape(time.size, -1)[:, moved.numbers]

    def words(number: int) -> str:
        return f"vibration drawn {times:.6g} times\nt = {time[number]:.3f} ms"

    show = _Frames(plotter, moved, "velocity outwards [m/s]", moved.largest_velocity or 1.0, words, status)
    return _with_slider(plotter, seen, show)


def view_mode(system: System, theory: xr.Dataset, number: int, *, view: tuple[float, float] = VIEW) -> Any:
    """Show one period of a mode of linear theory in a window or notebook, as filmed by `animate_mode`.

    Parameters
    ----------
    system : System
        A system with a `SolidBody` or an `AxisymmetricBody`.
    theory : xarray.Dataset
        Result of `sliding_stability` for the system.
    number : int
        Number of the mode, from 0.
    view : tuple of float, optional
        Initial elevation of the eye above the plane across y, and its azimuth from z towards x [rad].

    Returns
    -------
    pyvista.Plotter
        Call its ``show()``; a slider and the keys Right and Left step through the period.

    Raises
    ------
    ValueError
        If an argument is out of its range, the mode does not oscillate, no body has a surface, or the system is not
        that of the theory.
    ImportError
        If the extra ``view`` is not installed.
    """
    check_surfaces(system)
    shapes, seen = shapes_of_mode(system, theory, number), checked_view(view)
    plotter = _plotter()
    frequency, growth = (float(theory[name].values[number]) for name in ("frequency", "growth_rate"))
    motion = motion_of_mode(system, shapes, complex(growth, 2.0 * np.pi * frequency))
    moved = MovedBodies(system, motion, 1.0, np.zeros(3))
    moved.motion = over_largest(moved)

    def words(_: int) -> str:
        return f"{frequency:.6g} Hz, growth {growth:.4g} /s"

    return _with_slider(plotter, seen, _Frames(plotter, moved, "velocity over the largest", 1.0, words))


class _Frames:
    """Contents of a plotter, frame by frame."""

    def __init__(
        self,
        plotter: Any,
        moved: MovedBodies,
        title: str,
        largest: float,
        words: Callable[[int], str],
        status: Array | None = None,
    ) -> None:
        self.plotter, self.moved, self.words, self.status = plotter, moved, words, status
        self.frames, self.frame, self.meshes = moved.motion.frames, 0, []
        for one in moved.bodies:
            mesh = _mesh(one, moved.places(one, 0))
            mesh.cell_data[title] = moved.velocities(one, 0)
            plotter.add_mesh(
                mesh,
                scalars=title,
                cmap=VELOCITIES,
                clim=(-largest, largest),
                name=one.name,
                ambient=AMBIENT,
                diffuse=DIFFUSE,
                scalar_bar_args={"title": title, **BAR},
            )
            self.meshes.append(mesh)
        self.title = title
        self.show(0)

    def show(self, frame: int) -> None:
        """Show a frame."""
        self.frame = frame
        for one, mesh in zip(self.moved.bodies, self.meshes, strict=True):
            mesh.points = self.moved.places(one, frame)
            mesh.cell_data[self.title] = self.moved.velocities(one, frame)
        self.plotter.add_text(self.words(frame), font_size=WORDS, name="words")
        if self.status is not None:
            places = self.moved.contacts(frame)
            for number, word in enumerate(STATUS_WORDS):
                _show_points(self.plotter, word, places[self.status[frame] == number], STATUS_COLOURS[word])


def _with_slider(plotter: Any, seen: tuple[float, float], frames: _Frames) -> Any:
    """Return a plotter with a slider over frames, and keys that step through them."""
    last = frames.frames - 1
    slider = plotter.add_slider_widget(
        lambda value: frames.show(round(value)),
        (0, last),
        value=0,
        title="frame",
        fmt="%.0f",
        pointa=(0.25, 0.06),
        pointb=(0.75, 0.06),
        style="modern",
        interaction_event="always",
    )

    def step(by: int) -> None:
        frames.show((frames.frame + by) % frames.frames)
        slider.GetRepresentation().SetValue(frames.frame)
        plotter.render()

    plotter.add_key_event("Right", lambda: step(1))
    plotter.add_key_event("Left", lambda: step(-1))
    return _looked_at(plotter, seen)


def _looked_at(plotter: Any, seen: tuple[float, float]) -> Any:
    plotter.add_axes()
    plotter.view_vector(eye_of(seen), viewup=(0.0, 1.0, 0.0))
    plotter.camera.focal_point = plotter.center
    plotter.reset_camera()
    return plotter


def _plotter() -> Any:
    with named_extras():
        import pyvista
    return pyvista.Plotter()


def _mesh(one: ShownBody, places: Array) -> Any:
    import pyvista

    polygons = one.surface.polygons
    faces = np.column_stack([np.full(len(polygons), polygons.shape[1]), polygons])
    return pyvista.PolyData(places, faces.ravel())


def _show_points(plotter: Any, name: str, places: Array, colour: str) -> None:
    """Show points as small balls, or remove those of this name if there are none."""
    if len(places):
        plotter.add_points(places, color=colour, point_size=POINT, render_points_as_spheres=True, name=name)
    else:
        plotter.remove_actor(name)
