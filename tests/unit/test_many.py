"""Many runs at once give the results of each run alone."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest
import xarray as xr
from kernels.systems import SYSTEMS
from physics.cases import CASES, STEP, pair, slider, track, transverse

import stridula as st
from stridula.analysis import regime_of
from stridula.integration import many
from stridula.integration.preparation import Preparation
from stridula.integration.settings import Settings
from stridula.studies.ensembles import _perturbed

WORDS = {"step": STEP, "sample_rate": 0.1 / STEP}


def squeals(count: int) -> list[st.System]:
    """Systems of one kind: other angles, damping, loads, lengths, coefficients and gaps."""
    system = CASES["squeal"]()
    rod, bar, contact, force = system.slider, system.track, system.contact, system.drives[0]
    found = []
    for n in range(count):
        slider = replace(rod, angle=rod.angle + 0.02 * n, length=rod.length * (1.0 + 0.01 * n), cutoff=None, elements=6)
        track = replace(bar, damping=bar.damping * (1 + n), cutoff=None, bending_modes=9, axial_modes=4)
        touching = st.PointContact(slider.tip, track, contact.at, st.Coulomb(0.3 + 0.2 * n), contact.gap * (n + 1))
        found.append(st.System(touching, [replace(force, point=slider.root, transverse=force.transverse + 0.1 * n)]))
    return found


def assert_like(run: xr.Dataset, alone: xr.Dataset, tolerance: float) -> None:
    """The same record up to round-off, relative to the largest value of the same unit."""
    assert run.attrs["ended"] == alone.attrs["ended"]
    assert run.sizes == alone.sizes
    recorded = [name for name in alone if not str(name).startswith("state_")]
    scales: dict[str, float] = {}
    for name in recorded:
        units, largest = alone[name].attrs["units"], float(np.abs(alone[name].values).max(initial=0.0))
        scales[units] = max(scales.get(units, 0.0), largest)
    for name in recorded:
        atol = tolerance * scales[alone[name].attrs["units"]]
        np.testing.assert_allclose(run[name], alone[name], rtol=0, atol=atol, err_msg=str(name))


def test_runs_side_by_side_are_those_alone():
    """Eight systems of one kind in one vector, ten in one and two alone: the same up to the order of sums."""
    systems = squeals(10)
    together = st.simulate_many(systems, 400 * STEP, workers=1, **WORDS)
    for run, system in zip(together, systems, strict=True):
        assert_like(run, st.simulate(system, 400 * STEP, **WORDS), 1e-8)


def test_groups_are_of_one_kind_and_full_where_they_can():
    preparation = Preparation(0.1, Settings(step=STEP, sample_rate=1e4))
    systems = [*squeals(10), CASES["judder"](), *squeals(3)]
    groups = many._groups({number: preparation.arrays(system) for number, system in enumerate(systems)})
    assert groups == [[0, 1, 2, 3, 4, 5, 6, 7], [8, 9, 11, 12, 13], [10]]


@pytest.mark.parametrize("name", [name for name, (make, _) in SYSTEMS.items() if len(make().contacts) == 1])
def test_every_law_side_by_side(name):
    """Five runs that differ in their gap or start, in a vector of eight."""
    make, step = SYSTEMS[name]
    system = make()
    systems = [_perturbed(system, 1e-3 * n) for n in range(5)]
    words = {"step": step, "sample_rate": 0.2 / step, "probes": []}
    for run, one in zip(st.simulate_many(systems, 300 * step, **words), systems, strict=True):
        assert_like(run, st.simulate(one, 300 * step, **words), 1e-7)


@pytest.mark.parametrize("name", CASES)
def test_every_drive_side_by_side(name):
    systems = [_perturbed(CASES[name](), 1e-3 * n) for n in range(4)]
    for run, one in zip(st.simulate_many(systems, 300 * STEP, **WORDS), systems, strict=True):
        assert_like(run, st.simulate(one, 300 * STEP, **WORDS), 1e-7)


def test_a_run_that_ends_leaves_the_others_alone():
    """Thrown along the track at different speeds: some leave it, one fails, the others continue."""
    system = CASES["stable"]()
    rod = system.slider
    speeds = (0.0, 60.0, 80.0, -40.0, 0.1)
    systems = [st.System(system.contact, [*system.drives, st.InitialVelocity(rod, x=v)]) for v in speeds]
    broken = st.System(system.contact, [st.Force(rod.root, transverse=1e300), st.InitialVelocity(rod, x=0.0)])
    together = st.simulate_many([*systems, broken], 0.02, **WORDS)
    ended = [run.attrs["ended"] for run in together]
    assert ended == ["finished", "off the track", "off the track", "off the track", "finished", "not finite"]
    assert "no longer finite" in together[-1].attrs["message"]
    assert "message" not in together[0].attrs
    for run, one in zip(together[:-1], systems, strict=True):
        assert_like(run, st.simulate(one, 0.02, **WORDS), 1e-6)


def test_order_and_number_of_workers_do_not_matter():
    systems = [*squeals(5), CASES["judder"](), *squeals(9)[5:], SYSTEMS["frozen contact"][0]()]
    first = st.simulate_many(systems, 100 * STEP, workers=1, **WORDS)
    second = st.simulate_many(systems, 100 * STEP, workers=3, **WORDS)
    for one, other in zip(first, second, strict=True):
        xr.testing.assert_identical(one.drop_attrs(), other.drop_attrs())


def test_reduce_keeps_what_it_returns():
    systems = squeals(9)
    forces = st.simulate_many(systems, 100 * STEP, lambda run: float(run.normal_force.mean()), **WORDS)
    assert forces == [float(run.normal_force.mean()) for run in st.simulate_many(systems, 100 * STEP, **WORDS)]


def test_a_step_left_out_is_the_shortest():
    systems = [CASES["stable"](), pair(transverse(0.2), 0.5, rod=slider(cutoff=30e3), bar=track(cutoff=30e3))]
    steps = [st.simulate(system, 1e-4).attrs["step"] for system in systems]
    assert steps[1] < steps[0]
    assert [run.attrs["step"] for run in st.simulate_many(systems, 1e-4)] == [steps[1]] * 2


def test_progress_is_that_of_all_runs():
    seen = []
    st.simulate_many(squeals(9), 0.25, watchers=[seen.append], workers=2, **WORDS)
    assert seen[-1].time == pytest.approx(9 * 0.25)
    assert all(one.duration == pytest.approx(9 * 0.25) for one in seen)
    assert [one.time for one in seen] == sorted(one.time for one in seen)


def test_a_failure_ends_all():
    def fails(run):
        raise KeyError("no such thing")

    with pytest.raises(KeyError, match="no such thing"):
        st.simulate_many(squeals(9), 0.1, fails, **WORDS)


def test_errors_may_take_the_place_of_results():
    """Other objects, overlaps at the start, bodies that cannot be reduced; the other runs are not affected."""
    good = squeals(6)
    overlap = overlapping()
    seen = []

    def third_fails(run):
        seen.append(run)
        if len(seen) == 3:
            raise KeyError("the third")
        return float(run.normal_force.mean())

    words = {**WORDS, "workers": 1, "errors": "return"}
    found = st.simulate_many([good[0], 1, *good[1:3], overlap, *good[3:]], 100 * STEP, third_fails, **words)
    kinds = [type(one).__name__ for one in found]
    assert kinds == ["float", "ArgumentError", "float", "KeyError", "ArgumentError", "float", "float", "float"]
    assert "system must be a System" in str(found[1])
    assert "overlap" in str(found[4])
    alone = st.simulate_many(good, 100 * STEP, lambda run: float(run.normal_force.mean()), **WORDS)
    kept = [one for one in found if isinstance(one, float)]
    assert kept == [one for number, one in enumerate(alone) if number != 2]
    for broken in (1, overlap):
        with pytest.raises(ValueError, match="system must be a System" if broken == 1 else "overlap"):
            st.simulate_many([good[0], broken], 100 * STEP, **WORDS)


def overlapping() -> st.System:
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack())
    return st.System(contact, [st.InitialState(mass, displacement=(0.0, -1e-3))])


def test_memory_that_runs_out_ends_all():
    def fails(run):
        raise MemoryError

    with pytest.raises(MemoryError):
        st.simulate_many(squeals(2), 100 * STEP, fails, errors="return", **WORDS)


def test_records_do_without_their_scenario_where_they_may():
    (with_it,) = st.simulate_many(squeals(1), 100 * STEP, **WORDS)
    (without,) = st.simulate_many(squeals(1), 100 * STEP, provenance=False, **WORDS)
    assert set(with_it.attrs) - set(without.attrs) == {"scenario"}
    xr.testing.assert_equal(with_it, without)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"errors": "ignore"}, "errors must be one of raise, return"),
        ({"systems": "squeal"}, "systems must be a list of systems"),
        ({"systems": [1]}, "system must be a System"),
        ({"reduce": 3}, "reduce must be a function of a record"),
        ({"workers": 0}, "workers must be"),
        ({"duration": -1.0}, "duration must be"),
        ({"device": "gpu"}, "device must be"),
    ],
)
def test_bad_arguments_are_named(change, message):
    with pytest.raises(ValueError, match=message):
        st.simulate_many(**({"systems": squeals(1), "duration": 1e-3} | change))


def test_no_systems_give_no_records():
    assert st.simulate_many([], 1.0) == []


@pytest.mark.skipif(find_spec("numba_cuda") is not None, reason="there may be a GPU")
def test_without_a_gpu_the_error_says_what_is_missing():
    with pytest.raises(RuntimeError, match="numba-cuda, which is not installed"):
        st.simulate_many(squeals(2), 1e-3, device="cuda")


@pytest.mark.parametrize("still_first", [True, False])
def test_what_varies_in_time_beside_what_does_not(still_first):
    """Constant, rising and oscillating forces; belts at rest and in motion: in one vector."""
    mass = st.PointMass(1.0)
    histories = (st.Constant(), st.Ramp(1e-3), st.Harmonic(100.0), st.Constant())
    belts = (0.0, 0.02, 0.03, 0.0)
    systems = [
        st.System(
            st.PointContact(mass.centre, st.RigidTrack(velocity), friction=st.Coulomb(0.3)),
            [st.Gravity(), st.Force(mass.centre, x=4.0, history=history)],
        )
        for history, velocity in zip(histories, belts, strict=True)
    ][:: 1 if still_first else -1]
    words = {"step": 1e-4, "sample_rate": 2e3, "probes": [st.Velocity(mass.centre, "x")]}
    for run, one in zip(st.simulate_many(systems, 0.02, **words), systems, strict=True):
        assert_like(run, st.simulate(one, 0.02, **words), 1e-9)


def test_probes_of_a_run_that_ended_long_before_the_others():
    """Its last samples are completed from its own last value, not from the continued march of the others."""
    system = CASES["stable"]()
    speeds = (0.0, 60.0, 0.2, 0.1, 0.3)
    systems = [st.System(system.contact, [*system.drives, st.InitialVelocity(system.slider, x=v)]) for v in speeds]
    words = {"step": STEP, "sample_rate": 0.1 / STEP, "probes": [st.Velocity(system.slider.root, "x")]}
    run = st.simulate_many(systems, 0.25, **words)[1]
    assert run.attrs["ended"] == "off the track"
    assert_like(run, st.simulate(systems[1], 0.25, **words), 1e-6)


def test_an_interrupt_between_chunks_ends_all():
    def stop(progress):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        st.simulate_many(squeals(4), 1.0, watchers=[stop], **WORDS)


def test_an_error_names_the_system():
    systems = squeals(3)
    with pytest.raises(ValueError, match=r"systems\[1\]: probe must be on a body of this system"):
        st.simulate_many(systems, 1e-3, probes=[st.Displacement(systems[0].slider.tip, "x")])
    with pytest.raises(ValueError, match=r"systems\[2\]: system must be a System"):
        st.simulate_many([*systems[:2], 5], 1e-3)


def test_a_common_step_is_not_an_error_of_one_system():
    mass = st.PointMass(1.0)
    free = st.System(st.PointContact(mass.centre, st.RigidTrack()), [st.Gravity()])
    first, second = st.simulate_many([free, CASES["stable"]()], 1e-6, sample_rate=2e7)
    assert first.attrs["step"] == second.attrs["step"] == pytest.approx(5e-8)


def test_progress_of_runs_that_end_early_is_complete():
    system = CASES["stable"]()
    thrown = st.System(system.contact, [*system.drives, st.InitialVelocity(system.slider, x=80.0)])
    seen = []
    st.simulate_many([thrown] * 4, 0.5, watchers=[seen.append], **WORDS)
    assert seen[-1].time == pytest.approx(seen[-1].duration) == pytest.approx(2.0)


PLAIN = """
import sys
import numpy as np
import stridula as st
from unit.test_many import squeals
words = {"step": 5e-6, "sample_rate": 1e5}
alone = [float(st.simulate(one, 6e-5, **words).kinetic_and_elastic[-1]) for one in squeals(2)]
many = st.simulate_many(squeals(5), 6e-5, lambda run: float(run.kinetic_and_elastic[-1]), **words)
print(*alone, *many[:2])
"""


def test_plain_python_gives_the_same():
    """With NUMBA_DISABLE_JIT every function is the plain one: one mode of one run at a time."""
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", PLAIN], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    expected = [float(st.simulate(one, 6e-5, step=STEP, sample_rate=1e5).kinetic_and_elastic[-1]) for one in squeals(2)]
    np.testing.assert_allclose([float(word) for word in done.stdout.split()], expected * 2, rtol=1e-9)


@pytest.mark.parametrize("name", ["squeal", "several contacts", "law with a state"])
def test_plain_records_hold_the_arrays_of_labelled_ones(name):
    systems = {
        "squeal": lambda: squeals(5),
        "several contacts": lambda: [SYSTEMS["pad on a belt, bristles and age"][0]()],
        "law with a state": lambda: [SYSTEMS["slider, bristles"][0]()],
    }[name]()
    labelled, plain = (st.simulate_many(systems, 100 * STEP, labelled=each, **WORDS) for each in (True, False))
    for run, one in zip(labelled, plain, strict=True):
        assert isinstance(one, st.PlainRecord)
        assert set(one.attrs) == set(run.attrs) - {"scenario"}
        recorded = [word for word in run.variables if run[word].dims[:1] == ("time",) and "acceleration" not in word]
        assert set(one) == set(recorded)
        for word in recorded:
            np.testing.assert_array_equal(one[word], run[word].values)
            assert one[word].dtype == run[word].dtype
        some = one.labelled("normal_force", "status_share", "damping_loss")
        for word in some.data_vars:
            assert some[word].dims == run[word].dims
        assert some.sizes["time"] == run.sizes["time"]
    with pytest.raises(KeyError, match="did you mean 'normal_force'"):
        one["normal_forc"]


def test_a_regime_is_that_of_a_labelled_record():
    systems = [*squeals(5), SYSTEMS["groove"][0]()]
    words = {**WORDS, "errors": "return"}
    found = [st.simulate_many(systems, 0.05, regime_of, labelled=each, **words) for each in (True, False)]
    assert repr(found[0]) == repr(found[1])
    assert found[0][0]["regime"]
    assert found[0][5]["regime"]


def test_a_plain_record_of_a_run_that_diverged_says_why():
    system = squeals(1)[0]
    huge = replace(system, drives=[replace(system.drives[0], transverse=1e300)])
    labelled, plain = (st.simulate_many([huge], 100 * STEP, labelled=each, **WORDS)[0] for each in (True, False))
    assert "no longer finite" in plain.attrs["message"]
    assert plain.attrs["message"] == labelled.attrs["message"]
    assert plain.time.size == labelled.sizes["time"]


def test_plain_records_may_hold_some_variables_only():
    names = ("normal_force", "status_share", "impact_loss")
    words = {"labelled": False, **WORDS}
    (whole,), (some,) = (st.simulate_many(squeals(1), 100 * STEP, variables=each, **words) for each in (None, names))
    assert set(some) == {"time", *names}
    for name in some:
        np.testing.assert_array_equal(some[name], whole[name])
    for wrong in ({"variables": ["normal_forc"]}, {"variables": "gap"}, {"variables": names, "labelled": True}):
        with pytest.raises(ValueError, match="variables must be") as error:
            st.simulate_many(squeals(1), 100 * STEP, **(words | wrong))
        assert "\n" not in str(error.value)
