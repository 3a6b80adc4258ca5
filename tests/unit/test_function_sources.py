"""Studies of systems made by functions: the same as with scenarios, with errors in one line."""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.stats
import xarray as xr

import stridula as st

SHORT = {"duration": "2 ms"}
LEANING = math.radians(45.0)
FORCES = ["mean_force", "shares"]


@functools.lru_cache(maxsize=1)
def shipped() -> st.Scenario:
    return st.load_scenario("squeal")


def squeal(friction, angle=LEANING, load=0.8857):
    """Return the shipped case at another friction, angle [rad] and load [N]."""
    rod = replace(shipped().system.slider, angle=angle)
    contact = replace(shipped().system.contact, tip=rod.tip, friction=st.Coulomb(friction))
    return st.System(contact, [st.Force(rod.root, transverse=load)])


def timed(friction):
    return squeal(friction), {"duration": 1e-3, "sample_rate": 50e3, "step": 5e-6}


def of_scenario(friction):
    return st.load_scenario("squeal", {"friction": friction, "duration": 1e-3, "sample_rate": 10e3})


def samples(run):
    return run.sizes["time"]


def test_a_function_gives_what_the_scenario_gives_bit_for_bit():
    values = {"friction": [0.3, 0.9, 1.5], "angle": ["20 deg", "45 deg"]}
    made, read = (st.sweep(source, values, FORCES, **SHORT) for source in (squeal, "squeal"))
    xr.testing.assert_equal(made, read)
    assert made["angle"].values.tolist() == [20.0, 45.0]
    assert made["angle"].attrs == {"long_name": "angle", "key": "angle", "units": "deg"}
    assert made["friction"].attrs == {"long_name": "friction", "key": "friction"}
    assert made.attrs["title"] == "squeal"
    assert made.attrs["function"].endswith("test_function_sources.squeal")
    assert "scenario" not in made.attrs


def test_points_may_be_a_list_or_a_hypercube():
    listed = st.sweep(squeal, [{"friction": 0.3}, {"friction": 0.9}], "mean_force", **SHORT)
    assert listed["mean_force"].dims == ("point",)
    cube = st.LatinHypercube({"friction": (0.2, 2.0), "angle": ("10 deg", "80 deg")}, count=4)
    found = st.sweep(squeal, cube, "mean_force", **SHORT)
    assert np.isfinite(found["mean_force"]).all()


def test_overrides_are_arguments_that_stay_the_same():
    given = {"overrides": {"load": "2 N", "angle": 0.5}, **SHORT}
    found = st.sweep(squeal, {"friction": [0.3]}, "mean_force", **given)
    other = st.sweep(functools.partial(squeal, load=2.0, angle=0.5), {"friction": [0.3]}, "mean_force", **SHORT)
    assert found["mean_force"].item() == other["mean_force"].item()
    assert other.attrs["title"] == "squeal"


def test_a_function_may_say_how_it_is_simulated():
    look = {"samples": samples}
    assert st.sweep(timed, {"friction": [0.3]}, look)["samples"].item() == 50.0
    assert st.sweep(timed, {"friction": [0.3]}, look, duration="2 ms", sample_rate="10 kHz")["samples"].item() == 20.0
    assert st.sweep(of_scenario, {"friction": [0.3]}, look)["samples"].item() == 10.0
    assert st.sweep(squeal, {"friction": [0.3]}, look, duration=1e-3)["samples"].item() == 20.0
    assert st.sweep(timed, {"friction": [0.3]}, "step")["step"].item() == 5e-6


def test_points_at_which_it_fails_are_kept_with_their_message():
    def fails_above_one(friction):
        if friction > 1.0:
            raise KeyError("too much")
        return squeal(friction) if friction > 0.5 else None

    found = st.sweep(fails_above_one, {"friction": [0.3, 0.9, 1.5, 0.8]}, "mean_force", **SHORT)
    assert found["ended"].values.tolist() == ["not built", "finished", "not built", "finished"]
    assert "fails_above_one must return a System, a Scenario" in found["message"].values[0]
    assert found["message"].values[2] == "fails_above_one: KeyError: 'too much'"


def test_a_file_belongs_to_one_function(tmp_path):
    out = tmp_path / "map.nc"
    first = st.sweep(squeal, {"friction": [0.3]}, FORCES, out=out, **SHORT)
    xr.testing.assert_identical(st.sweep(squeal, {"friction": [0.3]}, FORCES, out=out, **SHORT), first)
    xr.testing.assert_identical(st.load(out), first)
    with pytest.raises(ValueError, match=r"must be a record of a scenario, got .*, of the function .*squeal"):
        st.load_scenario(out)
    for other in (timed, "squeal"):
        with pytest.raises(ValueError, match=r"another (function|scenario)"):
            st.sweep(other, {"friction": [0.3]}, FORCES, out=out, **SHORT)


def no_system(friction):
    return friction


def wrong_words(friction):
    return squeal(friction), {"stp": 1e-6}


def raises(friction):
    raise RuntimeError("no\nsuch thing")


BAD = [
    (no_system, {}, "no_system must return a System, a Scenario, or a System and arguments of simulate by name"),
    (wrong_words, {}, "did you mean 'step'?"),
    (raises, {}, "raises: no such thing"),
    (squeal, {"duration": None}, "duration must be given, as an argument or by squeal, got none"),
    (squeal, {"duration": -1.0}, "duration must be above 0"),
    (squeal, {"duration": "2 mm"}, "duration must be a number in s, ms or us, got '2 mm'"),
    (squeal, {"points": {"frction": [0.3]}}, "squeal must take the parameters frction, got one of (friction, angle="),
    (squeal, {"points": {"angle": [0.3]}}, "missing a required argument: 'friction'"),
    (squeal, {"overrides": {"friction": 0.3}}, "key must be set or varied, got 'friction' as both"),
    (squeal, {"points": {"friction": [0.3], "angle": ["1 deg", "1 N"]}}, "angle must be a number in rad or deg"),
]


@pytest.mark.parametrize(("function", "options", "message"), BAD, ids=[message for *_, message in BAD])
def test_errors_of_functions_are_one_line(function, options, message):
    given = {"points": {"friction": [0.3]}, "measures": "mean_force", **SHORT} | options
    with pytest.raises(ValueError) as error:
        st.sweep(function, **given)
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_a_search_takes_a_function_of_the_parameters():
    ranges, targets = {"friction": (0.2, 1.8)}, {"equilibrium": "held"}
    words = {"population": 6, "generations": 5, "duration": "5 ms"}
    made, read = (st.calibrate(source, ranges, targets, **words) for source in (squeal, "squeal"))
    assert made["equilibrium"].item() == "held"
    assert float(made["friction"]) == float(read["friction"])
    with pytest.raises(ValueError, match=r"of_two must take the parameters frction, got one of \(friction, angle\)"):
        st.calibrate(of_two, {"frction": (0.2, 1.8)}, targets, **words)


def of_two(friction, angle):
    return squeal(friction, angle)


def test_sensitivity_of_a_function():
    uncertain = {"friction": scipy.stats.norm(0.5, 0.05), "angle": ("20 deg", "30 deg")}
    words = {"samples": 8, "resamples": 9, **SHORT}
    made, read = (st.sensitivity(source, uncertain, ["mean_force"], **words) for source in (squeal, "squeal"))
    xr.testing.assert_equal(made, read)
    assert made.attrs["function"].endswith("squeal")


def mean(run):
    return float(run.normal_force.mean())


def test_ensembles_of_a_system_a_scenario_or_a_function():
    words = {"runs": 3, "sample_rate": 1e4, "probes": ()}
    values = {"friction": 0.9}
    plain = st.ensemble(squeal(0.9), 2e-3, {"mean": mean}, **words)
    xr.testing.assert_identical(st.ensemble(squeal, 2e-3, {"mean": mean}, overrides=values, **words), plain)
    xr.testing.assert_identical(st.ensemble("squeal", "2 ms", {"mean": mean}, overrides=values, **words), plain)
    own = st.ensemble(timed, None, {"samples": samples}, overrides=values, runs=2)
    assert own["samples"].values.tolist() == [50.0, 50.0]
    default = st.ensemble(squeal, 1e-3, {"samples": samples}, overrides=values, runs=2)
    assert default["samples"].values.tolist() == [100.0, 100.0]


@pytest.mark.parametrize(
    ("system", "options", "message"),
    [
        (squeal, {"overrides": {"frction": 1.0}}, "squeal must take the parameters frction"),
        (squeal, {}, "missing a required argument: 'friction'"),
        (raises, {"overrides": {"friction": 1.0}}, "raises: no such thing"),
        ("sqeal", {}, "did you mean 'squeal'?"),
        (3, {}, "system must be a System, got 3"),
    ],
)
def test_bad_arguments_are_reported(system, options, message):
    with pytest.raises(ValueError) as error:
        st.ensemble(system, 1e-3, {"mean": mean}, runs=2, **options)
    assert message in str(error.value)
    assert "\n" not in str(error.value)
