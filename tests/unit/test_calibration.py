"""Calibration: known parameters are recovered, equal seeds give equal searches, bad targets are reported."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stridula as st
from stridula.analysis import advance
from stridula.studies.calibration import WORST

SHORT = {"duration": "50 ms"}


def valley(points):
    """Return two measures of two parameters, least at length 3 mm and stiffness 200."""
    return [
        {"far": abs(float(point["length"].split()[0]) - 3.0), "stiff": abs(math.log10(point["stiffness"] / 200.0))}
        for point in points
    ]


RANGES = {"length": ("1 mm", "10 mm"), "stiffness": st.Range(1.0, 1e4, logarithmic=True)}
NEAR = {"far": st.Target(high=1e-3, scale=1.0), "stiff": st.Target(high=1e-3, scale=1.0)}


def test_known_parameters_are_found_with_their_unit_and_over_decades():
    found = st.calibrate(valley, RANGES, NEAR, population=12, generations=100)
    assert float(found["length"]) == pytest.approx(3.0, abs=1e-3)
    assert found["length"].attrs["units"] == "mm"
    assert float(found["stiffness"]) == pytest.approx(200.0, rel=3e-3)
    assert found["met"].values.all()
    assert float(found["miss"]) == 0.0
    assert found["target"].values.tolist() == ["far", "stiff"]


def test_the_history_never_gets_worse_and_ends_once_all_targets_are_met():
    seen = []
    found = st.calibrate(valley, RANGES, NEAR, population=12, generations=100, watchers=[seen.append])
    misses = found["best_miss"].values
    assert (np.diff(misses) <= 0.0).all()
    assert misses[-1] == 0.0
    assert (misses[:-1] > 0.0).all()
    assert len(seen) == misses.size < 101
    assert [one.generation for one in seen] == list(range(misses.size))
    assert seen[-1].best == {"length": f"{float(found['length'])!r} mm", "stiffness": float(found["stiffness"])}
    best = found["best_parameters"].isel(generation=-1)
    assert best.sel(parameter="stiffness") == found["stiffness"]


def test_targets_met_at_once_take_one_generation():
    sizes = []

    def evaluate(points):
        sizes.append(len(points))
        return [{"x": 1.0, "y": np.float64(2.0)} for _ in points]

    found = st.calibrate(evaluate, {"a": (0.0, 1.0)}, {"x": (0.0, 2.0)}, population=7)
    assert sizes == [7]
    assert float(found["y"]) == 2.0, "other measures are kept"


def test_narrow_bounds_are_found_from_afar():
    found = st.calibrate(valley, RANGES, {"far": (0.0, 1e-6), "stiff": (0.0, 1e-6)}, population=12, generations=150)
    assert found["met"].values.all()


def test_equal_seeds_search_alike_and_others_do_not():
    one, same, other = (
        st.calibrate(valley, RANGES, NEAR, population=8, generations=3, seed=seed) for seed in (1, 1, 2)
    )
    assert one.identical(same)
    assert not np.array_equal(one["best_parameters"], other["best_parameters"])


def test_a_search_starts_at_the_given_set():
    def first_set(spread):
        seen = []
        found = st.calibrate(
            lambda points: seen.append(points) or valley(points),
            RANGES,
            NEAR,
            population=8,
            generations=1,
            start={"length": "4 mm", "stiffness": 100.0},
            spread=spread,
        )
        assert float(found["best_miss"][0]) <= math.hypot(1.0, math.log10(2.0))
        return seen[0]

    sets = first_set(0.02)
    assert float(sets[0]["length"].split()[0]) == pytest.approx(4.0)
    assert sets[0]["stiffness"] == pytest.approx(100.0)
    lengths = [float(one["length"].split()[0]) for one in sets]
    assert 0.0 < np.std(lengths) < 3.0 * 0.02 * 9.0
    assert len({one["stiffness"] for one in first_set(0.0)}) == 1


def test_friction_is_found_from_how_far_a_tip_travels():
    made = {"friction": 0.35}
    run = st.load_scenario("stable-sliding", {**made, **SHORT, "sample_rate": 20e3}).simulate(probes=())
    travel = advance(run)
    aim = st.Target(0.9995 * travel, 1.0005 * travel, travel)
    found = st.calibrate(
        "stable-sliding", {"friction": (0.1, 0.6)}, {"travel": aim}, population=8, generations=20, **SHORT
    )
    assert found["met"].values.all()
    assert float(found["friction"]) == pytest.approx(0.35, rel=0.02)
    assert found["travel"].attrs["units"] == "m"
    assert float(found["sample_interval"]) == 5e-5


def test_a_measure_may_be_a_word_or_a_user_function():
    found = st.calibrate(
        "squeal",
        {"friction": (0.2, 1.8)},
        {"equilibrium": "held", "peak": (0.0, 1e6)},
        measures={"peak": lambda run: float(run["normal_force"].max())},
        population=6,
        generations=5,
        duration="5 ms",
    )
    assert found["equilibrium"].item() == "held"
    # The slider leans by 45 degrees.
    assert float(found["friction"]) > 1.0
    assert found["met"].values.tolist() == [True, True]


def test_runs_that_fail_count_as_the_worst_and_the_others_continue():
    found = st.calibrate(
        "squeal", {"angle": ("60 deg", "120 deg")}, {"travel": (5.0, 6.0)}, population=6, generations=2, duration="2 ms"
    )
    assert float(found["angle"]) < 90.0
    assert np.isfinite(float(found["travel"]))
    # 5 m in units of half a metre, compressed.
    assert float(found["miss"]) == pytest.approx(7.5, abs=0.01)
    assert not found["met"].values.any()


def test_the_reason_is_reported_if_nothing_can_be_run():
    with pytest.raises(ValueError, match=r"got 6 that cannot: slider\.angle must be strictly between"):
        st.calibrate("squeal", {"angle": ("95 deg", "100 deg")}, {"travel": (0.0, 1.0)}, population=6, duration="2 ms")


def test_a_target_gives_the_miss_of_a_measure():
    between = st.Target(2.0, 4.0)
    assert [between.miss(value) for value in (1.0, 2.0, 3.0, 4.0, 6.0)] == [1.0, 0.0, 0.0, 0.0, 2.0]
    assert st.Target(high=5.0).miss(6.0) == pytest.approx(2.0)
    assert st.Target(low=1.0, high=1.0, scale=0.5).miss(2.0) == 2.0
    assert {between.miss(value) for value in (math.nan, math.inf, "squeal")} == {WORST}
    far = [between.miss(value) for value in (9.0, 9.01, 20.0, 1e6, 2e6)]
    assert far[:2] == pytest.approx([5.0, 5.01], abs=1e-4)
    assert (np.diff(far) > 0.0).all()
    assert far[-1] < WORST


def call(ranges=None, targets=None, source=valley, **options):
    return lambda: st.calibrate(source, ranges or RANGES, targets or NEAR, **options)


@pytest.mark.parametrize(
    ("calibrate", "message"),
    [
        (call(population=4), "population must be at least 5, got 4"),
        (call(population=10_001), "population must be at most 10000, got 10001"),
        (call(generations=0), "generations must be at least 1, got 0"),
        (call(seed=-1), "seed must be at least 0"),
        (call(spread=-0.1), "spread must be 0 or above"),
        (call(ranges={"a": (1.0, 0.0)}), "ranges['a']: high must be above low (1.0), got 0.0"),
        (call(ranges={"a": (0.0, math.inf)}), "ranges['a']: high must be finite"),
        (call(ranges={"a": ("1 mm", "2 cm")}), "high must be in the unit of low"),
        (call(ranges={"a": 1.0}), "ranges['a'] must be a Range or its two ends"),
        (call(ranges=[1.0]), "ranges must be ranges by key"),
        (call(targets={"far": 1.0}), "targets['far'] must be a Target, its two bounds or a word"),
        (
            call(targets={"far": (2.0, 1.0)}),
            "targets['far']: low and high must be bounds in order, at least one of them finite",
        ),
        (call(targets={"far": (1.0, 1.0)}), "targets['far']: scale must be given for a target at one value"),
        (call(targets={"far": (None, 1.0)}), "targets['far']: low must be a number, got None"),
        (
            call(targets={"miss": (0.0, 1.0)}),
            "targets must not have the name of a result of the calibration, got 'miss'",
        ),
        (call(start={"length": "4 mm"}), "start must have the keys of ranges, length, stiffness, got length"),
        (call(start={"length": "4 mm", "stiffness": 1e5}), "start must lie in the ranges, got stiffness = 100000.0"),
        (call(start={"length": "4 mm", "stiffness": -1.0}), "start must lie in the ranges, got stiffness = -1.0"),
        (call(start={"length": 4.0, "stiffness": 1.0}), "start must be in the unit of its range (mm), got 4.0"),
        (call(source=lambda points: [{"far": 1.0}] * len(points)), "source must return 'stiff' for each point"),
        (call(source=lambda points: []), "source must return the measures of each of 32 points, got []"),
        (call(source=lambda points: [{"far": None, "stiff": 1.0}] * len(points)), "got a NoneType"),
        (call(source=lambda points: [{"far": 1.0, "stiff": 1.0, "length": 1.0}] * len(points)), "got 'length'"),
        (call(source="nope"), "targets must be among "),
        (call(source="squeal", targets={"trvel": (0.0, 1.0)}), "did you mean 'travel'?"),
        (call(source="squeal", targets={"travel": "squeal"}), "target of travel must be bounds, got 'squeal'"),
        (call(source="squeal", targets={"regime": "sqeal"}), "did you mean 'squeal'?"),
        (call(source="squeal", targets={"regime": (0.0, 1.0)}), "target of regime must be one of stable sliding, "),
        (call({"frition": (0.0, 1.0)}, {"travel": (0.0, 1.0)}, "squeal"), "did you mean 'friction'?"),
        (call({"friction": (0.0, 1.0)}, {"travel": (0.0, 1.0)}, "squeal", out="a.csv"), "out must be a NetCDF file"),
        (call({"friction": (0.0, 1.0)}, {"travel": (0.0, 1.0)}, "nope"), "scenario must be a file or one of"),
    ],
)
def test_bad_arguments_are_one_line(calibrate, message):
    with pytest.raises(ValueError) as error:
        calibrate()
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_errors_of_an_evaluation_are_raised():
    with pytest.raises(ZeroDivisionError):
        st.calibrate(lambda points: 1 / 0, RANGES, NEAR)

    def wrong(points):
        raise TypeError("mine")

    with pytest.raises(TypeError, match="mine"):
        st.calibrate(wrong, RANGES, NEAR)


def test_an_interrupted_search_resumes_and_finds_the_same(tmp_path):
    words = {"population": 8, "generations": 6, "seed": 3}
    whole = st.calibrate(valley, RANGES, NEAR, **words)
    kept = words | {"out": tmp_path / "found.nc"}

    def stop(progress):
        if progress.generation == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        st.calibrate(valley, RANGES, NEAR, watchers=[stop], **kept)
    sizes, reached = [], []

    def counted(points):
        sizes.append(len(points))
        return valley(points)

    counted.__module__, counted.__qualname__ = valley.__module__, valley.__qualname__
    again = st.calibrate(counted, RANGES, NEAR, watchers=[reached.append], **kept)
    assert len(sizes) == len(reached) - 3
    assert [one.resumed for one in reached[2:]] == [3] * len(reached[2:])
    for name in whole.variables:
        np.testing.assert_array_equal(again[name].values, whole[name].values)
    # A finished one is read from its file.
    sizes.clear()
    read = st.calibrate(counted, RANGES, NEAR, **kept)
    assert not sizes
    assert float(read["miss"]) == float(whole["miss"])
    assert not (tmp_path / "found.nc.parts").exists()
    with pytest.raises(ValueError, match=r"^out must be .* that of this calibration, .*, of other points or options$"):
        st.calibrate(valley, RANGES, NEAR, **kept | {"seed": 4})


def test_a_search_over_a_scenario_resumes(tmp_path):
    words = {"population": 5, "generations": 1, "duration": "2 ms", "out": tmp_path / "found.nc"}

    def stop(progress):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        st.calibrate("squeal", {"friction": (0.5, 1.0)}, {"travel": (1.0, 2.0)}, watchers=[stop], **words)
    reached = []
    found = st.calibrate("squeal", {"friction": (0.5, 1.0)}, {"travel": (1.0, 2.0)}, watchers=[reached.append], **words)
    assert [one.resumed for one in reached] == [1, 1]
    assert found["met"].values.tolist() == [False]
