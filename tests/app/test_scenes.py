"""Refused scenes: messages as in `load_scenario`, and playing continues unchanged."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.scenarios import ScenarioError

SLIDES = 'base = "stable-sliding"\n'


@pytest.fixture
def plays(talk):
    """Play, and check that it continues after any request."""
    assert talk.scene("stable-sliding")["type"] == "scene"
    before = talk.play(4800)
    yield talk
    after = talk.play(480)
    assert set(after.revision) == {1}
    assert set(after.stroke) == {1}
    assert after.clock[0] == pytest.approx(0.11)
    assert np.abs(after.places[0] - before.places[-1]) < 1e-3


def problems_of(name, overrides=None):
    with pytest.raises(ScenarioError) as refused:
        st.load_scenario(name, overrides)
    return list(refused.value.problems)


@pytest.mark.parametrize(
    "overrides",
    [
        {"slider.length": -0.1},
        {"slider.length": 0.0, "slider.angle": 9.0},
        {"contact.at": 5.0},
        {"damping": -1.0},
        {"contact.friction.law": "glue"},
        {"contact.friction.law": "static-kinetic"},
        {"contact.friction.static": 0.5},
        {"drives.0.velocity": 1.0},
        {"slider.length": "long"},
        {"slider.length": "1 N"},
        {"track.length": 1e-9},
    ],
    ids=str,
)
def test_values_are_refused_as_in_scenarios(plays, overrides):
    answer = plays.scene("stable-sliding", overrides)
    assert answer["type"] == "refused"
    assert answer["problems"] == problems_of("stable-sliding", overrides)


TEXTS = {
    "a negative length": SLIDES + "[slider]\nlength = -0.5\n",
    "an unknown key": SLIDES + "[slider]\nlenght = 0.5\n",
    "several problems": SLIDES + "[slider]\nlength = -0.5\nangle = 'steep'\n[track]\nlength = 0\n",
    "no TOML": "this is [no TOML\n",
    "another unit": SLIDES + "[slider]\nlength = '3 kg'\n",
    "an infinite length": SLIDES + "[slider]\nlength = 1e999\n",
    "a length without end": SLIDES + f"[slider]\nlength = 1{400 * '0'}\n",
    "nothing but a title": "title = 'x'\n",
    "a base there is not": "base = 'sqeal'\n",
    "nothing": "",
    "deep": f"a = {500 * '['}{500 * ']'}\n",
}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_texts_are_refused_as_files_are(plays, text, tmp_path):
    file = tmp_path / "scenario.toml"
    file.write_text(text, encoding="utf-8")
    answer = plays.scene(text=text)
    assert answer["type"] == "refused"
    # A text has no name, and cannot build on a file.
    said = [problem.replace("a scenario file or one of", "one of") for problem in problems_of(file)]
    assert [problem.replace(" in a text", "") for problem in answer["problems"]] == [
        problem.replace(f"'{file}': `", "the scenario: `").replace(f"'{file}'", "'the scenario'") for problem in said
    ]


STRANGE = {
    "a list as base": "base = ['squeal']\n",
    "a table as base": "[base]\nx = 1\n",
    "a number as base": "base = 7\n",
    "a list as slider": SLIDES + "slider = [1]\n",
    "a list as bodies": "bodies = [1]\n",
    "a date": SLIDES + "[slider]\nlength = 2026-01-01\n",
    "a number without end of elements": SLIDES + f"[slider]\nelements = 1{400 * '0'}\n",
    "elements that are no number": SLIDES + "[slider]\nelements = nan\n",
    "a text of elements": SLIDES + "[slider]\nelements = '1e9'\n",
    "characters of control": "\x00",
}


@pytest.mark.parametrize("text", STRANGE.values(), ids=STRANGE)
def test_strange_texts_are_refused_in_lines(plays, text):
    answer = plays.scene(text=text)
    assert answer["type"] == "refused"
    assert answer["problems"]
    for line in answer["problems"]:
        assert "\n" not in line
        assert 10 < len(line) < 1000


REDUCED = """
[bodies.slider]
kind = "reduced"
file = "{path}"
[bodies.track]
kind = "modal beam"
"""


@pytest.mark.parametrize("path", ["/etc/hostname", "/nowhere"])
def test_a_link_reads_no_file(talk, path):
    """Neither the content nor the existence of the file is revealed."""
    keys = {"bodies.glass.profile.shape": "mesh", "bodies.glass.profile.file": path}
    answer = talk.scene("glass", keys)
    assert set(answer["refused"]) == set(keys)
    assert not any(word in line for line in told(answer) for word in ("no such file", "deduce", "cannot read"))


def test_too_many_steps_are_refused(talk):
    answer = talk.scene(text="base = 'squeal'\n[simulation]\nstep = '0.0001 us'\n")
    assert told(answer) == ["simulation.step must be at least 1e-07 s to be played, got 1e-10"]
    answer = talk.scene("belt", {"simulation.step": 1e-10})
    assert any("simulation.step must be at least 1e-07 s" in line for line in told(answer))


def told(answer):
    """Return the problems of a scene, one line each."""
    return [line for lines in answer["refused"].values() for line in lines]


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("base = '{path}'\n", "base"),
        ("base = '../../etc/passwd'\n", "base"),
        (REDUCED, "bodies"),
        (REDUCED.replace("file", "mass"), "bodies"),
        (REDUCED.replace("file", "damping"), "bodies"),
    ],
    ids=["base", "above", "file", "mass", "damping"],
)
def test_a_text_reads_no_file(plays, text, named, tmp_path):
    file = tmp_path / "secret.toml"
    file.write_text('base = "squeal"\ntitle = "what nobody may read"\n', encoding="utf-8")
    answer = plays.scene(text=text.replace("{path}", str(file)))
    assert answer["type"] == "refused"
    (problem,) = answer["problems"]
    assert problem.startswith(named)
    assert "in a text" in problem
    assert "nobody" not in problem


def test_only_keys_of_the_page_are_set(plays):
    for key in ("slider.elements", "simulation.duration", "title", "no.such.key", "base"):
        answer = plays.scene("stable-sliding", {key: 1})
        assert answer["problems"] == [f"key must be a key of the page, got {key!r}"]


@pytest.mark.parametrize("case", ["glas", "../squeal", "/etc/passwd", ""])
def test_only_cases_of_the_page_are_offered(plays, case):
    (problem,) = plays.scene(case)["problems"]
    assert problem.startswith("case must be one of squeal, ")


TOO_MUCH = {
    "elements": (SLIDES + "[slider]\nelements = 101\n", "slider.elements must be at most 100"),
    "many elements": (SLIDES + "[slider]\nelements = 1000000\n", "slider.elements must be at most 100"),
    "a thin plate": ('base = "squeal-on-plate"\ncutoff = 60000.0\n', "bodies must have at most 1500 modes to be"),
    "a long track": (SLIDES + "[track]\nlength = 5000\n", "cutoff must leave at most 50000 modes"),
}


@pytest.mark.parametrize(("text", "begins"), TOO_MUCH.values(), ids=TOO_MUCH)
def test_systems_too_slow_to_play_are_refused(plays, text, begins):
    (problem,) = plays.scene(text=text)["problems"]
    assert problem.startswith(begins)


def test_a_refused_value_stays_as_it_was_and_the_others_are_played(talk):
    talk.scene("stable-sliding", {"damping": 0.03})
    short = talk.scene("stable-sliding", {"damping": 0.03, "track.length": 0.2})
    assert short["type"] == "refused"
    assert short["refused"] == {"track.length": short["problems"]}
    assert short["kept"] == {"case": "stable-sliding", "text": None, "overrides": {"damping": 0.03}}
    # A further change before the answer arrives.
    more = {"damping": 0.02, "track.length": 0.2, "slider.angle": 9.0, "slider.length": 0.4}
    answer = talk.scene("stable-sliding", more)
    assert (answer["type"], set(answer["refused"])) == ("scene", {"track.length", "slider.angle"})
    assert answer["kept"]["overrides"] == {"damping": 0.02, "slider.length": 0.4}
    assert (answer["values"]["damping"], answer["values"]["slider.length"]) == (0.02, 0.4)
    assert answer["goes_on"]


def test_a_kind_is_played_though_a_value_beside_it_is_refused(talk):
    talk.scene("squeal")
    kind = {"contact.friction.law": "static-kinetic", "contact.friction.static": 0.6, "contact.friction.kinetic": 0.4}
    answer = talk.scene("squeal", kind | {"slider.length": -1.0})
    assert (answer["type"], set(answer["refused"])) == ("scene", {"slider.length"})
    assert answer["kept"]["overrides"] == kind
    assert answer["values"]["contact.friction.law"] == "static-kinetic"


@pytest.mark.parametrize(
    ("case", "overrides", "refused", "kept"),
    [
        ("judder", {"friction": 1.2}, "friction", {}),
        ("judder", {"friction": 1.2, "damping": 0.02}, "friction", {"damping": 0.02}),
        ("judder", {"contact.friction.coefficient": "1,2"}, "contact.friction.coefficient", {}),
        ("nonsense", {"damping": 0.02}, "", {}),
    ],
    ids=str,
)
def test_a_link_plays_its_valid_part(talk, case, overrides, refused, kept):
    answer = talk.scene(case, overrides)
    assert (answer["type"], set(answer["refused"])) == ("scene", {refused})
    assert answer["kept"] == {"case": "judder" if refused else "squeal", "text": None, "overrides": kept}
    assert len(talk.play(480).sound) == 480


def test_a_text_nested_too_deep_is_refused_in_one_line(plays):
    (problem,) = plays.scene(text="[" + "a." * 20_000 + "a]\n")["problems"]
    assert "\n" not in problem


def test_the_played_scenario_runs_unchanged_elsewhere(talk, tmp_path):
    overrides = {"contact.friction.coefficient": 0.7, "slider.angle": 0.6, "section.height": 0.009}
    answer = talk.scene("squeal", overrides)
    file = tmp_path / "played.toml"
    file.write_text(answer["toml"], encoding="utf-8")
    assert st.load_scenario(file).system == st.load_scenario("squeal", overrides).system
    assert st.load_scenario(file).title == answer["title"] == "Squeal"
    # Its text plays like the case.
    again = talk.scene(text=answer["toml"])
    assert (again["values"], again["toml"]) == (answer["values"], answer["toml"])
    assert not again["goes_on"]
