"""Sections, Lyapunov exponents, basins and orbit diagrams against closed forms, B45 and an integration by SciPy."""

from __future__ import annotations

from math import log, pi

import numpy as np
import pytest
import xarray as xr
from matplotlib.path import Path
from scipy.integrate import solve_ivp

import stridula as st
from stridula.analysis import poincare_section
from stridula.studies.orbit_diagrams import extremes

# A mass on a belt under weakening friction: sliding is stable above the first speed, stick-slip lives on to the second.
SLIDES_FROM, STICKS_TO = 1.151293, 1.836601


def on_belt(speed: float, start: tuple[float, float] | None = None) -> st.System:
    body = st.PointMass(1.0)
    law = st.ExponentialWeakening(static=1.0, kinetic=0.5, velocity=0.5)
    begun = [] if start is None else [st.InitialState(body, (start[0], 0.0), (start[1], 0.0))]
    return st.System(
        st.PointContact(body.centre, st.RigidTrack(velocity=speed), friction=law),
        [st.Force(body.centre, y=-1.0), *begun],
        [st.Spring(body.centre, stiffness=1.0), st.Dashpot(body.centre, coefficient=0.1)],
    )


def at_stop(turned: float, mass: float = 1.0) -> st.System:
    """A driven mass that touches a stop of stiffness 100 at rest: y'' + 0.1 y' + y + 100 min(y, 0) = cos(turned t)."""
    body = st.PointMass(mass)
    track = st.RigidTrack()
    return st.System(
        st.PointContact(body.centre, track, friction=st.Coulomb(0.0), stiffness=st.LinearStiffness(100.0)),
        [st.Force(body.centre, y=1.0, history=st.Harmonic(turned / (2.0 * pi), phase=pi / 2.0))],
        [
            *(st.Spring(body.centre, stiffness=1.0, direction=axis) for axis in "xy"),
            st.Dashpot(body.centre, coefficient=0.1, direction="y"),
            st.Dashpot(body.centre, coefficient=1.0, direction="x"),
        ],
    )


def waves(rate: float = 200.0, turned: float = 3.0) -> xr.Dataset:
    time = np.arange(1, 2001) / rate
    mean = np.cos(turned * (time - 0.5 / rate))
    return xr.Dataset(
        {
            "place": ("time", np.cos(turned * time), {"units": "m"}),
            "both": (("time", "part"), np.stack([time, np.sin(turned * time)], axis=1)),
            "mean": ("time", mean, {"cell_methods": "time: mean"}),
            "status": ("time", np.where(mean > 0.0, 2, 1), {"cell_methods": "time: mode"}),
        },
        {"time": time, "part": ["time", "sine"]},
    )


@pytest.mark.parametrize(("direction", "first", "sign"), [("up", 1.5 * pi, -1.0), ("down", 0.5 * pi, 1.0)])
def test_a_section_has_the_values_at_the_crossings(direction, first, sign):
    found = poincare_section(waves(), "place", direction=direction)
    times = (first + 2.0 * pi * np.arange(found.sizes["crossing"])) / 3.0
    np.testing.assert_allclose(found["time"], times, atol=1e-6)
    np.testing.assert_allclose(found["both"].sel(part="time"), times, atol=1e-6)
    np.testing.assert_allclose(found["both"].sel(part="sine"), sign, atol=1e-4)
    # Means over an interval are values in its middle.
    np.testing.assert_allclose(found["mean"], 0.0, atol=1e-4)
    np.testing.assert_allclose(poincare_section(waves(), "mean", direction=direction)["time"], times, atol=1e-4)
    both = poincare_section(waves(), "place", direction="both", variables=["place"])
    np.testing.assert_allclose(both["time"], (0.5 + np.arange(both.sizes["crossing"])) * pi / 3.0, atol=1e-6)
    assert list(both.data_vars) == ["place"]


def test_a_stroboscopic_section_is_in_phase_and_leaves_out_the_start():
    found = poincare_section(waves(), period=2.0 * pi / 3.0, phase=0.25, start=4.0)
    np.testing.assert_allclose(found["both"].sel(part="sine"), 1.0, atol=1e-4)
    assert float(found["time"][0]) >= 4.0
    assert set(np.diff(found["time"]).round(9)) == {round(2.0 * pi / 3.0, 9)}
    assert set(found["status"].values) <= {1, 2}


def test_a_section_of_a_run_is_the_lowest_point_of_the_known_cycle():
    system = on_belt(1.0)
    probes = [kind(system.slider.centre, "x") for kind in (st.Displacement, st.Velocity)]
    run = st.simulate(system, 100.0, sample_rate=200.0, probes=probes)
    found = poincare_section(run, run["velocity"][:, 0], start=50.0)
    np.testing.assert_allclose(found["displacement"], -0.577428, atol=1e-4)
    np.testing.assert_allclose(np.diff(found["time"]), 6.431383, atol=1e-3)


@pytest.mark.parametrize("seed", range(4))
def test_a_linear_oscillator_has_its_decay_rate_as_exponent(seed):
    random = np.random.default_rng(seed)
    mass, stiffness = random.uniform(0.5, 3.0), random.uniform(0.5, 50.0)
    damping = random.uniform(0.01, 0.3) * np.sqrt(stiffness * mass)
    body = st.PointMass(mass)
    system = st.System(
        st.PointContact(body.centre, st.RigidTrack(velocity=50.0), friction=st.Coulomb(0.3)),
        [st.Force(body.centre, y=-1.0), st.InitialVelocity(body, x=1.0)],
        [st.Spring(body.centre, stiffness=stiffness), st.Dashpot(body.centre, coefficient=damping)],
    )
    found = st.lyapunov_exponent(system, settle=20, periods=100)
    assert abs(float(found["exponent"]) + damping / (2.0 * mass)) < float(found["error"])
    assert found.attrs["verdict"].startswith("stable")


def test_the_exponent_of_a_stable_cycle_is_zero_and_of_sliding_its_decay_rate():
    found = st.lyapunov_exponent(on_belt(1.0))
    assert abs(float(found["exponent"])) < float(found["error"])
    assert found.attrs["verdict"].startswith("neighbours neither depart nor meet")
    found = st.lyapunov_exponent(on_belt(1.5, (0.5, 0.1)))
    expected = -0.5 * (0.1 - np.exp(-3.0))
    assert abs(float(found["exponent"]) - expected) < float(found["error"])


def test_the_exponent_of_a_driven_cycle_is_that_of_its_multipliers():
    system = at_stop(2.0)
    found = st.lyapunov_exponent(system, periods=100)
    cycle = st.limit_cycle(system)
    real, imaginary = cycle["multiplier"][0].values
    expected = log(np.hypot(real, imaginary)) / float(cycle["period"])
    assert expected < -0.04
    assert abs(float(found["exponent"]) - expected) < float(found["error"])


def _reference(turned: float, periods: int) -> tuple[float, float]:
    """Return exponent and error of `at_stop` by events between its two linear parts and two neighbours."""
    period, near = 2.0 * pi / turned, 1e-7

    def rate(time, state, closed):
        return [state[1], np.cos(turned * time) - 0.1 * state[1] - state[0] * (101.0 if closed else 1.0)]

    def touches(time, state, closed):
        return state[0]

    touches.terminal = True

    def after(state):
        time, closed = 0.0, state[0] < 0.0
        while time < period:
            touches.direction = 1.0 if closed else -1.0
            part = solve_ivp(
                rate, (time, period), state, "DOP853", events=touches, args=(closed,), rtol=1e-9, atol=1e-12
            )
            time, state = part.t[-1], part.y[:, -1]
            if part.status == 1:
                state[0], closed = 0.0, not closed
        return state

    state, direction, grown = np.array([0.3, -0.2]), np.array([1.0, 0.0]), []
    for number in range(60 + periods):
        ends = after(state), after(state + near * direction)
        change = (ends[1] - ends[0]) / near
        size = np.linalg.norm(change)
        state, direction = ends[0], change / size
        if number >= 60:
            grown.append(np.log(size) / period)
    blocks = [np.mean(one) for one in np.array_split(grown, 20)]
    return float(np.mean(grown)), float(np.std(blocks, ddof=1) / np.sqrt(20))


def test_the_exponent_of_chaos_agrees_with_an_integration_of_the_same_equations():
    found = st.lyapunov_exponent(at_stop(1.0))
    exponent, error = _reference(1.0, 300)
    assert found.attrs["verdict"].startswith("chaos")
    assert abs(float(found["exponent"]) - exponent) < 3.0 * np.hypot(error, float(found["error"]))
    # 1000 periods: 0.0590 +- 0.0019.
    assert abs(float(found["exponent"]) - 0.0590) < 3.0 * np.hypot(0.0019, float(found["error"]))


def _inside_unstable_cycle(speed: float, places: np.ndarray, velocities: np.ndarray) -> np.ndarray:
    system = on_belt(speed)
    probes = [kind(system.slider.centre, "x") for kind in (st.Displacement, st.Velocity)]
    start = st.InitialEquilibrium(mode="most unstable", amplitude=1.0)
    cycle = st.limit_cycle(system, start, step=0.02, probes=probes)
    assert not bool(cycle["stable"])
    curve = Path(np.column_stack([cycle["displacement"][:, 0], cycle["velocity"][:, 0]]))
    across, along = np.meshgrid(places, velocities, indexing="ij")
    return curve.contains_points(np.column_stack([across.ravel(), along.ravel()])).reshape(across.shape)


def test_the_basin_of_sliding_is_bounded_by_the_unstable_cycle():
    ranges = {"displacement.x": (-1.5, 2.5), "velocity.x": st.Range(-2.0, 1.4)}
    found = st.basin(on_belt(1.5), ranges, 400.0, points=(16, 12))
    inside = _inside_unstable_cycle(1.5, found["displacement.x"].values, found["velocity.x"].values)
    assert found["attractor_regime"].values.tolist() == ["stable sliding", "stick-slip"]
    assert bool(found["settled"].all())
    np.testing.assert_array_equal(found["attractor"].values == 0, inside)
    np.testing.assert_array_equal(found["regime"].values == "stable sliding", inside)
    assert float(found["share"][0]) == inside.mean()
    ranges = {"place": (-1.5, 2.5), "speed": (-2.0, 1.4)}
    made = st.basin(lambda place, speed: on_belt(1.5, (place, speed)), ranges, 400.0, points=(16, 12))
    np.testing.assert_array_equal(made["attractor"], found["attractor"])
    axes = st.plot.basin(found).axes[0]
    assert axes.get_xlabel() == "displacement.x [m]"


def test_runs_that_are_too_short_have_not_settled():
    found = st.basin(on_belt(1.5), {"displacement.x": (-1.0, 2.0), "velocity.x": (-1.0, 1.2)}, 30.0, points=4)
    assert (found["attractor"].values[~found["settled"].values] == -1).all()
    assert not bool(found["settled"].all())


def test_orbits_jump_up_and_down_at_the_ends_of_bistability():
    speeds = np.array([1.0, 1.1, 1.2, 1.4, 1.6, 1.7, 1.9, 2.0])
    found = st.orbit_diagram(on_belt, "speed", speeds, 1500.0, transient=0.75)
    assert found["orbit"].attrs["long_name"] == "maxima of the displacement of slider centre x"
    up, down = (found["regime"].sel(sweep=sweep).values for sweep in ("up", "down"))
    assert (up == np.where(speeds < STICKS_TO, "stick-slip", "stable sliding")).all()
    assert (down == np.where(speeds < SLIDES_FROM, "stick-slip", "stable sliding")).all()
    np.testing.assert_allclose(found["orbit"].sel(speed=1.0).mean("extreme"), 1.788131, atol=1e-4)
    slid = found["orbit"].sel(speed=1.6, sweep="down").mean("extreme")
    assert float(slid) == pytest.approx(0.5 + 0.5 * np.exp(-3.2), abs=1e-4)
    assert len(st.plot.orbit_diagram(found).axes[0].lines) == 2


def test_small_steps_of_the_speed_keep_stick_slip_to_its_grazing():
    speeds = [*np.linspace(1.0, 1.6, 7), *np.linspace(1.61, 1.795, 20), *np.linspace(1.8, 1.86, 25)]
    found = st.orbit_diagram(on_belt, "speed", speeds, 150.0, sweeps=["up"])
    last = float(found["speed"].values[found["regime"].values[:, 0] == "stick-slip"].max())
    assert STICKS_TO - 0.02 < last < STICKS_TO


def test_a_period_of_drives_goes_on_in_phase():
    found = st.orbit_diagram(at_stop, "turned", [2.0, 2.2, 2.875, 2.9], 400.0, take="strobe", units="rad/s")
    for turned, periods in ((2.0, 1), (2.2, 1), (2.875, 2), (2.9, 2)):
        one = found["orbit"].sel(turned=turned)
        cycle = st.limit_cycle(at_stop(turned), probes=[st.Displacement(at_stop(turned).slider.centre, "y")])
        assert float(cycle["frequency"]) * periods == pytest.approx(turned / (2.0 * pi))
        for sweep in ("up", "down"):
            values = one.sel(sweep=sweep).dropna("extreme").values[-20:]
            assert len(np.unique(values.round(3))) == periods


def test_other_parameters_are_passed_anew():
    def heavier(mass: float) -> st.System:
        return at_stop(2.0, mass)

    found = st.orbit_diagram(heavier, "mass", [1.0, 1.1], 200.0, sweeps=["anew"], take="both")
    assert np.isfinite(found["orbit"].values).any()
    with pytest.raises(st.ArgumentError, match=r"key must change drives.* alone .*'mass'.*anew"):
        st.orbit_diagram(heavier, "mass", [1.0, 1.1], 20.0)


def test_extremes_are_those_of_a_parabola():
    time = np.linspace(0.0, 20.0, 401)
    np.testing.assert_allclose(extremes(np.cos(time), "maxima"), 1.0, atol=1e-5)
    assert len(extremes(np.cos(time))) == 6
    assert extremes(np.full(9, 2.0)).tolist() == [2.0]


BELT = on_belt(1.0)
BAD = [
    (lambda: poincare_section(waves()), "signal or period must be given"),
    (lambda: poincare_section(waves(), "place", period=1.0), "signal or period must be given, one of them, got both"),
    (lambda: poincare_section(waves(), "plac"), "signal must be one of place"),
    (lambda: poincare_section(waves(), waves()["both"]), "signal must have the one dimension time"),
    (lambda: poincare_section(waves(), "place", direction="left"), "direction must be one of up, down, both"),
    (lambda: poincare_section(waves(), "place", start=1e3), "start must be from 0 to"),
    (lambda: poincare_section(waves(), "place", variables=["x"]), "variables must be among place"),
    (lambda: st.lyapunov_exponent("weak-pressure"), "system must be a System"),
    (lambda: st.lyapunov_exponent(BELT, periods=10), "periods must be at least 40"),
    (lambda: st.lyapunov_exponent(BELT, st.InitialEquilibrium()), "start must have a mode"),
    (lambda: st.basin(BELT, {"displacement.x": (0, 1)}, 1.0), "ranges must have two coordinates"),
    (lambda: st.basin(BELT, {"displacement.x": (0, 1), "speed": (0, 1)}, 1.0), "ranges must be of displacement.x"),
    (lambda: st.basin(BELT, {"displacement.x": (0, 1), "velocity.x": (0, 1)}), "duration must be given"),
    (
        lambda: st.basin(BELT, {"displacement.x": (0, 1), "velocity.x": (0, 1)}, 1.0, points=1),
        "points must be at least",
    ),
    (lambda: st.basin(on_belt, {"a": (0, 1), "b": (0, 1)}, 1.0), "on_belt must take the parameters a, b"),
    (lambda: st.orbit_diagram(on_belt, "speed", [2.0, 1.0], 1.0), "values must be at least 2 increasing"),
    (lambda: st.orbit_diagram(on_belt, "orbit", [1.0, 2.0], 1.0), "key must not have the name"),
    (lambda: st.orbit_diagram(on_belt, "speed", [1.0, 2.0], 1.0, sweeps="up"), "sweeps must be a list of up, down"),
    (lambda: st.orbit_diagram(on_belt, "speed", [1.0, 2.0], 1.0, take="strobe"), "take must be of extremes"),
    (lambda: st.orbit_diagram(on_belt, "speed", [1.0, 2.0], 1.0, probes=()), "probes must be left out"),
    (lambda: st.plot.basin(waves()), "found must be the result of basin"),
    (lambda: st.plot.orbit_diagram(waves()), "found must be the result of orbit_diagram"),
]


@pytest.mark.parametrize(("call", "words"), BAD, ids=[words for _, words in BAD])
def test_bad_arguments_are_refused_in_one_line(call, words):
    with pytest.raises(ValueError, match="^" + words.replace("(", r"\(")) as caught:
        call()
    assert "\n" not in str(caught.value)
