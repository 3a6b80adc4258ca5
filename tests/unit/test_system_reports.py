"""Reports: the words and numbers of the other verbs, on a page that is safe and complete in itself."""

from __future__ import annotations

import re
from html import unescape
from html.parser import HTMLParser

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula import plot
from stridula.acoustics.squeals import squeal_words
from stridula.analysis.mode_effects import effect_columns
from stridula.analysis.record_card import facts_of
from stridula.analysis.stability_words import mode_columns, verdict_lines
from stridula.reports.designs import Options, design_of
from stridula.reports.sections import Pictures, _below, inputs_section
from stridula.weighting import a_weighting

QUICK = {"run": False, "effects": False, "check": False}
VOID = {"meta", "br", "img", "path", "use", "rect"}
EVIL = '<script>alert(1)</script> & "mu"'


class Page(HTMLParser):
    """Tags, addresses and cells of tables of a page."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.names: list[str] = []
        self.addresses: list[str] = []
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        given = dict(attrs)
        self.names += [given["id"]] if "id" in given else []
        self.addresses += [given[name] for name in ("src", "href", "xlink:href", "action", "data") if name in given]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open.pop() == tag


def rows(html: str) -> dict[str, list[str]]:
    """Return the words of each row of facts by name."""
    found = {}
    for name, cells in re.findall(r'<tr><th scope="row">(.*?)</th>(.*?)</tr>', html, re.DOTALL):
        found[unescape(name)] = [unescape(one) for one in re.findall(r"<td>(.*?)</td>", cells, re.DOTALL)]
    return found


def columns(html: str, head: str) -> dict[str, list[str]]:
    """Return the columns of the table whose first heading is given."""
    tables = re.findall(r"<table class=.columns.>.*?</table>", html, re.DOTALL)
    table = next(one for one in tables if f'<tr><th scope="col">{head}<' in one)
    heads = [unescape(one) for one in re.findall(r'<th scope="col">(.*?)</th>', table)]
    cells = [re.findall(r"<td>(.*?)</td>", row, re.DOTALL) for row in table.split("<tbody>")[1].split("</tr>")]
    return {one: [unescape(row[k]) for row in cells if row] for k, one in enumerate(heads)}


def named(name: str) -> st.System:
    """Return a mass on a belt, on a spring, with a name of its own."""
    mass = st.PointMass(1.0, name)
    spring = st.Spring(mass.centre, stiffness=4e3, direction="x")
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=0.5), friction=st.Coulomb(0.3))
    return st.System(contact, drives=[st.Force(mass.centre, y=-10.0)], connections=[spring])


@pytest.fixture(scope="module")
def glass() -> str:
    return st.report("glass", effects=True, run=False, check=False).html


def test_modes_and_verdict_are_those_of_linear_theory(glass):
    modes = st.sliding_stability(st.load_scenario("glass").system)
    assert columns(glass, "frequency [Hz]") == mode_columns(modes)
    assert verdict_lines(modes, False)[0] in unescape(glass)


def test_what_helps_is_that_of_mode_sensitivity(glass):
    expected = effect_columns(st.mode_sensitivity("glass"))
    assert columns(glass, "parameter") == {head: cells[:30] for head, cells in expected.items()}


def test_the_fastest_mode_over_friction_is_that_of_each_system(glass):
    """All coefficients in proportion, each system built apart."""
    table = columns(glass, "friction / given")
    given = st.load_scenario("glass").system.contacts[0].friction
    for number in (6, 12, 20):
        share = float(table["friction / given"][number])
        static, kinetic = (round(share, 4) * one for one in (given.static, given.kinetic))
        words = {"contacts.0.friction.static": static, "contacts.0.friction.kinetic": kinetic}
        modes = st.sliding_stability(st.load_scenario("glass", words).system)
        fastest = float(modes["growth_rate"].max())
        grows = bool(modes["unstable"].any())
        assert (table["growth rate [1/s]"][number] != "") == grows
        if grows:
            assert float(table["growth rate [1/s]"][number]) == pytest.approx(fastest, rel=5e-3)


def test_a_page_is_complete_in_itself(glass):
    page = Page(glass)
    assert page.open == []
    assert all(one.startswith(("data:", "#")) for one in page.addresses)
    assert not set(page.tags) & {"script", "link", "iframe", "object", "embed"}
    assert len(page.names) == len(set(page.names))
    assert not re.search(r"url\((?!#)", glass)
    assert "@import" not in glass
    assert "@media print" in glass


def test_names_of_users_are_text():
    html = st.report(named(EVIL), **QUICK).html
    assert "<script" not in html
    assert "alert(1)" in html
    assert Page(html).open == []


def test_two_designs_mark_what_differs_and_nothing_else(tmp_path):
    text = st.scenarios.scenario_text("belt")
    other = tmp_path / "other.toml"
    other.write_text(text.replace("static = 0.4", "static = 0.45"))
    html = st.report("belt", other, **QUICK).html
    marked = {name for name, words in rows(html).items() if any("<mark>" in one for one in words)}
    assert marked == {"contacts.0.friction.static"}
    assert rows(html)["contacts.0.friction.static"] == ["<mark>0.4</mark>", "<mark>0.45</mark>"]


def test_a_run_has_the_card_of_the_run_and_its_sound():
    record = st.load_scenario("squeal").simulate(duration=0.2)
    html = st.report(record, effects=False, check=False).html
    found = rows(html)
    facts = facts_of(record, st.load_scenario("squeal").system)
    for name in ("squeals", "pitch", "normal force", "energy ledger", "step"):
        assert found[name] == [facts[name]]
    sound = st.radiate(record, st.load_scenario("squeal").system)
    assert f"{float(st.equivalent_level(sound, 'A').max()):.1f} dB" in found["sound level"][0]
    assert found["squeal by SAE J2521"] == [squeal_words(st.squeal_events(sound))]
    assert "data:audio/wav;base64,UklGR" in html


def test_a_record_of_a_body_with_a_mesh_may_be_reported():
    """Its arrays are inputs by their shape."""
    mesh = st.SolidMesh.block((0.1, 0.02, 0.01), (4, 1, 1))
    bar = st.SolidBody(mesh, st.Material(2e11, 7800.0), fixed=["left"], cutoff=3e4, damping=0.01)
    tip = bar.at((0.1, 0.01, 0.005))
    contact = st.PointContact(tip, st.RigidTrack(velocity=0.1), friction=st.Coulomb(0.3))
    run = st.simulate(st.System(contact, [st.Force(tip, y=-5.0)]), 0.01)
    page = st.report(run, sound=False, effects=False, check=False)
    assert page.titles == ("Record",)
    assert "an array of" in page.html


def test_designs_have_the_titles_that_are_given():
    options = {"run": False, "sound": False, "effects": False, "check": False}
    alone = st.report("belt", titles=["Mine"], **options)
    assert alone.titles == ("Mine",)
    assert "<title>Mine" in alone.html
    pair = st.report("belt", "belt", titles=["Soft", "Hard"], **options)
    assert pair.titles == ("Soft", "Hard")
    for wrong in ("ab", ["Soft"], ["Soft", ""], ["Soft", 2]):
        with pytest.raises(ValueError, match="titles must have a title for each design, 2, got"):
            st.report("belt", "belt", titles=wrong, **options)


def test_sections_that_do_not_apply_say_so():
    html = st.report("belt", duration=0.5, check=False).html
    assert "None: no body of the system radiates sound." in html
    assert "No parameter is uncertain." in html
    smooth = st.PointMass(1.0, "mass")
    contact = st.PointContact(smooth.centre, st.RigidTrack(velocity=0.5))
    html = st.report(st.System(contact, drives=[st.Force(smooth.centre, y=-1.0)]), **QUICK).html
    assert "No contact has a coefficient of friction to vary." in html


def test_growth_has_a_probability_for_uncertain_parameters():
    uncertain = {"friction": (0.8, 1.0)}
    html = st.report("weak-pressure", uncertain=uncertain, samples=20, **QUICK).html
    found = st.mode_probability("weak-pressure", uncertain, samples=20)
    assert f"Any mode grows: {float(found['any_probability']):.3f}" in html


def test_a_remedy_is_that_of_the_smallest_change():
    remedies = {"connections.0.stiffness": (3.0, 5.0)}
    html = st.report("belt", remedies=remedies, **QUICK).html
    assert st.smallest_change("belt", remedies).attrs["verdict"] in unescape(html)
    assert "Searched at the friction given." in html


def test_another_parameter_may_be_varied():
    html = st.report("belt", key="stiffness", values=[3.0, 4.0, 5.0], units="N/m", **QUICK).html
    assert "Modes over stiffness" in html


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"source": "sqeal"}, "did you mean"),
        ({"source": 3}, "source must be"),
        ({"key": "stiffness"}, "values must be given with a key"),
        ({"values": [2.0, 1.0]}, "values must be at least 2 increasing"),
        ({"run": 1}, "run must be"),
        ({"samples": 0}, "samples must be"),
        ({"uncertain": [1]}, "uncertain must be"),
        ({"overrides": {"stifness": 1.0}}, "did you mean"),
        ({"remedies": {"stifness": (1.0, 5.0)}, "run": True}, "did you mean"),
    ],
)
def test_wrong_arguments_are_refused(arguments, words):
    with pytest.raises(ValueError, match=words) as caught:
        st.report(**{"source": "belt", **QUICK, **arguments})
    assert len(str(caught.value).splitlines()) == 1


def test_a_page_is_written_whole_or_not_at_all(tmp_path):
    page = st.report("belt", **QUICK)
    page.save(tmp_path / "belt.html")
    assert (tmp_path / "belt.html").read_text(encoding="utf-8") == page.html
    with pytest.raises(ValueError, match="page of HTML"):
        page.save(tmp_path / "belt.png")
    with pytest.raises(OSError, match="no folder"):
        page.save(tmp_path / "none" / "belt.html")
    assert [one.name for one in tmp_path.iterdir()] == ["belt.html"]


def tone(level: float, frequency: float = 3000.0) -> xr.DataArray:
    """Return a tone with an A-weighted level [dB]."""
    time = np.arange(0.0, 0.5, 1.0 / 48000.0)
    gain = float(np.abs(a_weighting(np.array(frequency))))
    size = np.sqrt(2.0) * 20e-6 * 10.0 ** (level / 20.0) / gain
    words = {"units": "Pa"}
    return xr.DataArray(size * np.sin(2.0 * np.pi * frequency * time), {"time": time}, "time", "pressure", words)


@pytest.mark.parametrize(("level", "word"), [(71.0, "yes: the loudest tone has 71.0 dB(A) at 3000 Hz"), (69.0, "no: ")])
def test_the_verdict_is_by_the_level_of_a_tone(level, word):
    assert squeal_words(st.squeal_events(tone(level))).startswith(word)


def test_the_line_of_the_limit_is_the_level_of_a_tone_in_its_band():
    """A tone just at the limit reaches the line."""
    sound = tone(70.0, 1995.26)
    (axes,) = plot.third_octaves(sound, limit=70.0).axes
    (line,) = [one for one in axes.lines if one.get_linestyle() == "--"]
    there = np.interp(1995.26, *line.get_data())
    assert there == pytest.approx(float(st.third_octave_levels(sound, 100.0).sel(band=2000.0)), abs=0.05)
    assert line.get_xdata()[[0, -1]] == pytest.approx([1250.0, 16000.0])


def test_the_command_writes_the_page_and_prints_its_name(stridula, tmp_path):
    words = ("--no-run", "--no-effects", "--no-check", "--vary", "stiffness=3:5:3", "--set", "mass=2")
    assert stridula("report", "belt", *words, "--out", "belt.html")[:2] == (0, "belt.html\n")
    html = (tmp_path / "belt.html").read_text(encoding="utf-8")
    assert rows(html)["bodies.block.mass"] == ["2 kg"]
    assert "Modes over stiffness" in html


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("belt", "--out", "belt.pdf"), "--out must be a page of HTML"),
        (("belt", "--out", "none/belt.html"), "no folder"),
        (("belt", "belt", "belt", "--out", "a.html"), "NAME-OR-FILE must be one or two"),
        (("bell", "--out", "a.html"), "did you mean 'belt'"),
        (("belt", "--vary", "stiffness=3", "--out", "a.html"), "--vary must"),
        (("belt", "--random", "mass", "--out", "a.html"), "--random must"),
        (("belt", "--change", "stiffness=3", "--out", "a.html"), "--change must"),
    ],
)
def test_the_command_refuses_in_one_line_and_writes_nothing(stridula, tmp_path, words, message):
    code, out, err = stridula("report", *words)
    assert (code, out) == (2, "")
    assert message in err
    assert len(err.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


def test_a_stiffness_of_surfaces_is_one_of_an_area():
    options = Options({}, None, "friction", None, "", False, False, False, False, False, None, None, 1, None, None)
    (facts,) = inputs_section(design_of("brake", options), Pictures()).blocks
    assert facts.facts["surfaces.0.stiffness.stiffness"].endswith(("N/m3", "GPa/m", "N/mm3"))
    assert facts.facts["surfaces.0.stiffness.damping"].endswith("N s/m3")
    assert facts.facts["connections.0.stiffness"].endswith("N/m")


def test_loci_leave_out_modes_that_decay_above_the_cutoff():
    frequency, growth = [[100.0, 5e7], [100.0, 5e7]], [[-1.0, -1.0], [1.0, 2.0]]
    loci = xr.Dataset(
        {name: (("mu", "mode"), one) for name, one in (("frequency", frequency), ("growth_rate", growth))}
    ).assign(unstable=(("mu", "mode"), np.array(growth) > 0.0))
    drawn = _below(1e3, loci)
    for name in ("frequency", "growth_rate"):
        np.testing.assert_array_equal(np.isfinite(drawn[name].values), [[True, False], [True, True]])


def test_friction_may_be_what_changes():
    """It is then no condition of the search."""
    page = st.report(flutter(0.6), remedies={"friction.coefficient": (0.01, 0.9)}, **QUICK)
    assert "no mode grows with friction.coefficient from 0.6 to" in unescape(page.html)
    assert "Searched at the friction given" in page.html


def flutter(friction):
    """A mass on two inclined springs whose modes merge under friction, with damping."""
    mass = st.PointMass(1.0)
    ways = [(np.cos(angle), np.sin(angle), 0.0) for angle in np.radians([150.0, 30.0])]
    springs = [
        st.Spring(mass.centre, stiffness=one * 1e4, direction=way) for one, way in zip((11.0, 20.0), ways, strict=True)
    ]
    dashpots = [st.Dashpot(mass.centre, coefficient=1.0, direction=way) for way in ("x", "y")]
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=-3.0), friction=st.Coulomb(friction), stiffness=11e4)
    return st.System(contact, [st.Force(mass.centre, y=-100.0)], [*springs, *dashpots])
