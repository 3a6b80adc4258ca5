"""Limits and lists in messages: printed limits are valid, and lists of many names are short."""

from __future__ import annotations

import pickle
import re

import numpy as np
import pytest
import xarray as xr
from hypothesis import assume, given, settings
from hypothesis import strategies as some

import stridula as st
from stridula import analysis
from stridula._kernels.contact.slipping import STOPPED
from stridula._kernels.layout import columns as at
from stridula.acoustics.pressures import check_length, check_rate
from stridula.acoustics.resampling import LOWEST, ratio_of
from stridula.checks import at_least, at_most, listed, within
from stridula.integration.stops import CAUSE, Diverged, contact_words
from stridula.integration.timing import choose_timing
from stridula.lowering import assemble

NUMBER = r"(-?[0-9][0-9.]*(?:e[-+]?[0-9]+)?)"
numbers = some.floats(-1e12, 1e12, allow_subnormal=False)
positive = some.floats(1e-9, 1e9)


def refused(check, pattern):
    """Return the numbers that the message of a check holds where a pattern has groups."""
    with pytest.raises(ValueError) as caught:
        check()
    found = re.search(pattern, str(caught.value))
    assert found, str(caught.value)
    return tuple(float(text) for text in found.groups())


@given(numbers, some.integers(1, 12))
def test_a_limit_is_rounded_to_its_own_side_and_no_farther(limit, digits):
    low, high = float(at_most(limit, digits)), float(at_least(limit, digits))
    assert low <= limit <= high
    assert high - low <= 10.0 ** (1 - digits) * abs(limit) * (1.0 + 1e-9) or digits > 10
    assert float(at_most(high, 12)) == high or digits > 11


def test_a_refused_argument_has_its_name_value_and_allowed_values():
    with pytest.raises(st.ArgumentError, match=r"^young must be above 0, got -1\.0$") as caught:
        st.Material(-1.0, 1.0)
    error = caught.value
    assert isinstance(error, ValueError)
    assert (error.argument, error.allowed, error.value) == ("young", "be above 0", -1.0)


def test_a_refused_argument_takes_another_name_and_place():
    error = st.ArgumentError("full_scale", "be above 0", -1.0).renamed("--full-scale")
    assert str(error) == "--full-scale must be above 0, got -1.0"
    assert str(error.inside("sounds[2]").inside("all")) == "all: sounds[2]: --full-scale must be above 0, got -1.0"
    assert str(st.ArgumentError("mass", "be given")) == "mass must be given"
    assert str(st.ArgumentError("mass", "be finite", None)) == "mass must be finite, got None"
    assert str(st.ArgumentError("mass", "be symmetric", [1.0], got="rows")) == "mass must be symmetric, got rows"


@pytest.mark.parametrize("value", [-1.0, "text", None, lambda: None])
def test_a_refused_argument_goes_to_another_process(value):
    error = st.ArgumentError("mass", "be above 0", value).inside("systems[1]")
    copy = pickle.loads(pickle.dumps(error))
    assert (type(copy), str(copy), copy.argument, copy.where) == (type(error), str(error), "mass", "systems[1]")
    assert copy.value == (error.got if callable(value) else value)


def test_short_numbers_stay_as_they_are():
    for text in ("0.1", "48000", "1e-05", "0", "-2.5", "1e+12", "0.3"):
        assert at_most(float(text)) == at_least(float(text)) == text
    assert (at_most(1.2299e-5, 3), at_least(1.2299e-5, 3)) == ("1.22e-05", "1.23e-05")
    assert (at_most(-1.2299, 3), at_least(-1.2299, 3)) == ("-1.23", "-1.22")
    assert (at_most(0.1 + 0.2), at_least(0.1 + 0.2)) == ("0.3", "0.300001")


@given(numbers, positive, some.booleans())
def test_a_printed_range_may_be_used(low, width, ends):
    high = low + width
    assume(low < high)
    words = rf"from {NUMBER} to {NUMBER}," if ends else rf"strictly between {NUMBER} and {NUMBER},"
    for wrong in (low - width, high + width, np.nextafter(low, -np.inf), np.nextafter(high, np.inf)):
        least, most = refused(lambda wrong=wrong: within("value", wrong, low, high, ends=ends), words)
        assert not (least <= wrong <= most)
        assert least < most
        inside = [least, most] if ends else [np.nextafter(least, most), np.nextafter(most, least)]
        for number in inside if np.nextafter(low, high) < high else []:
            assert within("value", number, low, high, ends=ends) == number


@settings(max_examples=40, deadline=None)
@given(some.floats(10.0, 1e4), some.floats(0.0, 1e-4), some.sampled_from([st.ExactModal(), st.CentralDifference()]))
def test_the_step_that_is_printed_may_be_taken(angular, beyond, scheme):
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack())
    flat = assemble(st.System(contact, (), [st.Spring(mass.centre, stiffness=angular**2)]))
    known = scheme.limit(flat.angular_frequency, flat.damping_rate)

    def timing(step=None, duration=10.0, rate=1e3):
        return choose_timing(flat, scheme, duration, step, rate)

    wrong = known * (1.0 + beyond)
    (limit,) = refused(lambda: timing(wrong), rf"step must be below the .* limit of {NUMBER} s, got ")
    assert 0.99999 * known <= limit <= known <= wrong
    taken = np.nextafter(limit, 0.0)
    assert timing(taken).step == taken
    (least,) = refused(lambda: timing(known * 0.9e-7), rf"step must be at least {NUMBER} s for these modes")
    assert timing(least, duration=1.0, rate=1.0 / least).step == least
    third = known / 3.0
    (rate,) = refused(lambda: timing(third, rate=1e-7 / known), rf"sample_rate must be at least {NUMBER} Hz")
    assert timing(third, duration=1.0 / rate, rate=rate).step == third
    (interval,) = refused(lambda: timing(third, duration=third / 1e3), rf"half a sample interval of {NUMBER} s")
    assert timing(third, duration=interval / 2.0).samples == 1


@settings(max_examples=40, deadline=None)
@given(some.floats(0.01, 5.0), some.floats(1e-3, 0.05))
def test_the_cutoff_that_is_printed_leaves_a_mode(length, height):
    steel, section = st.Material(2.1e11, 7800.0), st.Rectangle(0.02, height)
    first = rf"\(first at {NUMBER} Hz\)"
    (cutoff,) = refused(lambda: st.ModalBeam(steel, section, length, cutoff=1e-6), first)
    assert st.ModalBeam(steel, section, length, cutoff=cutoff).harmonics[0] == 1

    def plate(highest):
        return st.ModalPlate(steel, height, length, 0.7 * length, cutoff=highest)

    (cutoff,) = refused(lambda: plate(1e-6), first)
    assert len(plate(cutoff).numbers) == 1
    stiffness = np.diag([length, 3.0, 3.0])

    def reduced(highest):
        return st.ReducedBody(height * np.eye(3), stiffness, points={"a": (0, 1)}, cutoff=highest).modes()

    (cutoff,) = refused(lambda: reduced(1e-9), first)
    assert reduced(cutoff).count >= 1


@settings(deadline=None)
@given(some.floats(1e-3, 1e3), some.floats(0.0, 0.999))
def test_a_too_short_sound_is_printed_below_the_required_length(shortest, share):
    interval = shortest / 1000.0
    sound = xr.DataArray(np.zeros(max(1, int(1000 * share))), dims="time")
    sound = sound.assign_coords(time=interval * np.arange(sound.size), listener=0)
    sound.attrs["sample_interval"] = interval
    if sound.size > 1:
        least, got = refused(
            lambda: check_length(sound, shortest, "this"), rf"at least {NUMBER} s for this, got {NUMBER} s"
        )
        assert got < shortest <= least
    least, got = refused(
        lambda: check_rate(share * shortest, shortest, "this"), rf"at {NUMBER} Hz or more for this, got {NUMBER} Hz"
    )
    assert got < shortest <= least


@given(some.floats(LOWEST, 1e6))
def test_the_sample_rate_that_is_printed_is_supported(recorded):
    (highest,) = refused(lambda: ratio_of(2.0 * recorded, recorded, 1), rf"at most the record's {NUMBER} Hz")
    assert ratio_of(highest, recorded, 1) > 0
    for measured in (1.0 / (1.0 / 48e3), 1.0 / (0.1 / 4800), 47999.99999999999):
        with pytest.raises(ValueError, match="at most the record's 48000 Hz, got 96000"):
            ratio_of(96e3, measured, 1)


# Lists.


@given(some.lists(some.text("abc ", min_size=1, max_size=30), max_size=60))
def test_long_lists_are_shortened_with_a_count(words):
    text = listed(words)
    if not words:
        assert text == "none"
    elif len(", ".join(words)) <= 160:
        assert text == ", ".join(words)
    else:
        shown, count = re.fullmatch(r"(.*) and (\d+) others?", text).groups()
        assert len(shown) <= 160
        assert shown == ", ".join(words[: len(words) - int(count)])


def test_forty_contacts_do_not_make_a_long_message():
    names = tuple(f"contact {k + 1} of the comb" for k in range(40))
    carried = np.zeros((40, at.CARRIED))
    carried[:, at.ABSCISSA], carried[:, at.LAST_NORMAL] = 0.123456, np.arange(40.0)
    carried[7, at.LAST_NORMAL] = np.nan
    words = contact_words(names, carried)
    assert words.startswith("contact 8 of the comb separated at 0.123456 m with nan N normal")
    assert words.endswith(" and 39 others")
    for ended in CAUSE:
        record = xr.Dataset(attrs={"ended": ended, "step": 1.23456e-5, "sample_interval": 1e-5}, coords={"time": [0.0]})
        assert len(str(Diverged(record, words))) <= 330
    few = contact_words(("left", "right"), carried[:2])
    assert few == (
        "right separated at 0.123456 m with 1 N normal, 0 N tangential, left separated at 0.123456 m with 0 N normal, "
        "0 N tangential"
    )


def test_a_contact_that_stopped_in_the_step_that_was_not_solved_sticks():
    carried = np.zeros((1, at.CARRIED))
    carried[:, at.STATUS] = STOPPED
    assert contact_words(("shoe",), carried).startswith("shoe sticking at 0 m")


def test_lists_of_variables_of_a_record_are_short():
    bodies = [st.PointMass(1.0, name=f"tooth {k + 1} of the comb") for k in range(40)]
    contacts = [st.PointContact(body.centre, st.RigidTrack(), name=body.name) for body in bodies]
    run = st.simulate(st.System(contacts, [st.Gravity()]), 1e-3, step=1e-4, sample_rate=1e4, probes=[])
    stateless = run.drop_vars("state_modal")
    for check, said in (
        (lambda: analysis.bursts(run), "run must be of one contact, got those of 'tooth 1 of the comb', "),
        (
            lambda: st.simulate(st.System(contacts), 1e-3, start=stateless),
            "start must be a record of simulate with ",
        ),
        (lambda: st.compare(run, run.drop_vars([*run.data_vars])), "b must have a variable in common with a, got none"),
    ):
        with pytest.raises(ValueError) as caught:
            check()
        assert str(caught.value).startswith(said)
        assert len(str(caught.value)) <= 300


def test_many_bodies_are_not_all_listed(tmp_path):
    bodies = "".join(f'[bodies.tooth-{k}-of-the-comb]\nkind = "point mass"\nmass = 1\n' for k in range(40))
    text = bodies + '[[contacts]]\ntip = { body = "pad" }\ntrack = { kind = "rigid" }\n[simulation]\nduration = 1\n'
    path = tmp_path / "comb.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(st.ScenarioError) as caught:
        st.load_scenario(path)
    found = next(problem for problem in caught.value.problems if problem.startswith("contacts.0.tip.body"))
    assert re.search(r"must be one of tooth-0-of-the-comb, .* and \d+ others, got 'pad'", found)
    assert len(found) <= 300


def test_an_array_in_place_of_a_word_is_refused_in_one_line():
    """Its comparison with words has no truth value."""
    mesh = st.SolidMesh.block((0.1, 0.02, 0.01), (2, 1, 1))
    with pytest.raises(st.ArgumentError, match=r"be one of left, right, .*, got a ndarray"):
        st.SolidBody(mesh, st.Material(2e11, 7800.0), fixed=[mesh.nodes[:, 0] < 1e-6], cutoff=3e4)
