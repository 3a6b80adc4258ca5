"""Messages about invalid scenarios."""

from __future__ import annotations

import pytest
from unit.scenario_texts import MASS_ON_FLOOR, problems

import stridula as st


def test_a_base_cannot_lead_back_to_itself(tmp_path):
    (tmp_path / "other.toml").write_text('base = "case.toml"')
    assert "must not refer back to the scenario itself" in problems('base = "other.toml"', tmp_path)[0]


def test_unknown_keys_and_bad_values_are_reported_together():
    with pytest.raises(st.ScenarioError) as caught:
        st.load_scenario("squeal", {"foo": 1, "slider.mass": "lump", "friction": "3 m"})
    found = caught.value.problems
    assert len(found) == 3
    for words in ("got 'foo'", "slider.mass must be one of", "contact.friction.coefficient must be"):
        assert any(words in problem for problem in found)


BELT = """
[bodies.m]
kind = "point mass"
mass = 1.0
[[contacts]]
name = "guide"
tip = {body = "m"}
track = {kind = "rigid"}
[[contacts]]
name = "leading"
tip = {body = "m"}
track = {kind = "rigid", velocity = 0.1}
friction = 0.3
[[connections]]
kind = "spring"
first = {body = "m"}
stiffness = 100.0
[simulation]
duration = 0.01
"""


@pytest.mark.parametrize(
    ("key", "nearest"),
    [
        ("leading.velocity", "contacts.1.track.velocity"),
        ("guide.velocty", "contacts.0.track.velocity"),
        ("leading.coefficient", "contacts.1.friction.coefficient"),
        ("leading.xyz", "contacts.1"),
    ],
)
def test_the_name_of_a_contact_leads_to_its_keys(key, nearest, tmp_path):
    (found,) = problems(BELT, tmp_path, {key: 1.0})
    assert found == f"key must be a key of the scenario, got {key!r}; did you mean {nearest!r}?"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"bodies.m.mass": 1e-320}, "bodies.m.mass must be at least 1e-100, got 1e-320"),
        ({"bodies.m.mass": 1e-90, "stiffness": 1e250}, "scenario must hold numbers of ordinary size"),
    ],
)
@pytest.mark.filterwarnings("ignore:.*encountered in:RuntimeWarning")
def test_numbers_out_of_range_are_named(changes, message, tmp_path):
    (tmp_path / "case.toml").write_text(BELT)
    with pytest.raises(st.ScenarioError, match=message) as caught:
        st.load_scenario(tmp_path / "case.toml", changes).simulate()
    assert "infs" not in str(caught.value)


def test_bodies_out_of_range_are_named(tmp_path):
    reduced = 'kind = "reduced"\nmass = [[1e-300]]\nstiffness = [[1e10]]\npoints = {a = {x = 0}}'
    text = BELT.replace('kind = "point mass"\nmass = 1.0', reduced)
    (found,) = problems(text, tmp_path)
    assert found.startswith(
        "bodies.m.stiffness must be of an ordinary size relative to mass, got up to 1e+10 N/m on masses"
    )
    with pytest.raises(st.ScenarioError, match=r"must hold numbers of ordinary size: its modes overflow"):
        st.load_scenario("squeal", {"density": 1e-320})


def test_a_step_above_the_limit_names_its_key():
    with pytest.raises(st.ScenarioError, match=r"^simulation\.step must be below .* limit of .*, got 0.001$"):
        st.load_scenario("squeal", {"step": 1e-3}).simulate()


def test_every_problem_of_a_file_is_reported(tmp_path):
    found = problems(
        'base = "squeal"\n[slider]\nlenght = 3\nangle = nan\n[material]\nyoung = -1\n[[drives]]\nkind = "forc"\n'
        '[[drives]]\nkind = "force"\naxial = "x {y}"\n[simulation]\nprobes = [{quantity = "speed"}]\n',
        tmp_path,
    )
    assert sorted(found) == [
        "drives.0.kind must be one of force, imposed velocity, gravity, initial velocity, initial state, "
        "initial equilibrium, "
        "got 'forc'; "
        "did you mean 'force'?",
        "drives.1.axial must be a number in N, mN or kN, got 'x {y}'",
        "material.young must be above 0, got -1",
        "simulation.probes.0.quantity must be one of displacement, velocity, acceleration, reaction, support_force, "
        "connection_force, modal_displacement, modal_velocity, modal_motion, "
        "got 'speed'",
        "slider.angle must be finite, got nan",
        "slider.lenght must be one of the known keys material, section, length, angle, elements, damping, "
        "root_support, tip_support, mass, cutoff, name, got lenght = 3; did you mean 'length'?",
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "scenario must not be empty"),
        ("# nothing\n", "scenario must not be empty"),
        ("a = 1\nb = ]\n", "line 2"),
        ("a = [\n", "line 1"),
        ("a = " + "[" * 5000, "must be TOML"),
        ('base = "sqeal"', "did you mean 'squeal'?"),
        ("base = 3", "base must be a scenario file"),
        ("slider = 3", "slider must be a table, got 3"),
        ("drives = 3", "drives must be a list, got 3"),
        ('base = "squeal"\ntitle = 3', "title must be a text, got 3"),
        ('base = "squeal"\nlength = 3', "did you mean 'track.length'?"),
        ('base = "squeal"\n[[drives]]\nx = 1', "drives.0.kind must be given"),
        ('base = "squeal"\n[[drives]]\nkind = "force"\npoint = "centre"', "drives.0.point must be tip or root or"),
        ('base = "squeal"\n[[drives]]\nkind = "force"\npoint = 9', "drives.0.point must be from 0 to "),
        (
            'base = "squeal"\n[[drives]]\nkind = "force"\nhistory = {kind = "sampled", time = [1, 0], value = [1, 1]}',
            "drives.0.history.time must increase",
        ),
        (
            'base = "weak-pressure"\n[slider]\nroot_support = "pinned"',
            "slider.root_support must be guided or free under an imposed velocity",
        ),
        ("[contact]\nat = 1\n", "slider must be given"),
    ],
)
def test_errors_of_a_file_are_explained(text, message, tmp_path):
    assert any(message in problem for problem in problems(text, tmp_path))


@pytest.mark.parametrize(
    "text", ["[" + ".".join("a" * 20_000) + "]\n", "a = " + "[" * 20_000, "a" + ".a" * 60 + " = 1\n"]
)
def test_tables_nested_thousands_deep_are_refused_in_one_line(text, tmp_path):
    (problem,) = problems(text, tmp_path)
    assert problem.startswith("scenario must ")
    assert len(problem) < 300


def test_other_files_are_refused_as_scenarios(tmp_path):
    (tmp_path / "binary.toml").write_bytes(b"\xff\x00\x80")
    (tmp_path / "cut.nc").write_bytes(b"\x89HDF\r\n\x1a\nrest")
    for name, message in [
        ("binary.toml", "text in UTF-8"),
        ("cut.nc", "damaged"),
        ("", "a directory"),
        ("none.toml", "must be a file or one of"),
    ]:
        with pytest.raises(ValueError, match=message):
            st.load_scenario(tmp_path / name)
    with pytest.raises(st.ScenarioError, match="did you mean 'squeal'"):
        st.load_scenario("sqeal")


TWO = """
density = 3
[bodies.a]
kind = "point mass"
mass = "3 m"
[bodies.b]
kind = "reduced"
mass = [[1, 2], [3]]
points = 3
[bodies.c]
kind = "mass"
[[contacts]]
tip = {body = "a", pint = "centre"}
track = {kind = "belt"}
friction = {law = "stribek"}
[[connections]]
kind = "spring"
first = {body = "a"}
[simulation]
duration = 1
contact_solve = {sweeps = 0}
"""


def test_every_problem_of_bodies_and_contacts_is_reported(tmp_path):
    found = "\n".join(problems(TWO, tmp_path))
    for words in (
        "density must be one of the known keys",
        "bodies.a.mass must be a number in kg, g or t, got '3 m'",
        "bodies.b.mass must be a matrix, a list of rows of numbers or a file, got [[1, 2], [3]]",
        "bodies.b.points must be a table of points by name, got 3",
        "bodies.c.kind must be one of finite-element beam, modal beam, modal plate, point mass, reduced, rigid body, "
        "modal body, axisymmetric, solid, got 'mass'",
        "contacts.0.tip.pint must be one of the known keys body, point, got pint = 'centre'; did you mean 'point'?",
        "contacts.0.track.kind must be one of beam, plate, rigid, point, circle, got 'belt'",
        "contacts.0.friction.law must be one of coulomb, static-kinetic, stribeck",
        "did you mean 'stribeck'?",
        "connections.0.stiffness must be given: stiffness [N/m]",
        "simulation.contact_solve.sweeps must be at least 1, got 0",
    ):
        assert words in found


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('base = "squeal"\n' + MASS_ON_FLOOR, "slider must be left out where there are bodies and contacts, got both"),
        ("[[contacts]]\ntip = 3\n", "bodies must be given: bodies by name"),
        ("contacts = []\nbodies = {}\n" + "[simulation]\nduration = 1\n", "contacts must not be empty, got []"),
        ("cutoff = 3\n" + MASS_ON_FLOOR, "cutoff must be set in a body"),
        (
            MASS_ON_FLOOR + '[bodies.b]\nkind = "point mass"\nmass = 1\n',
            "bodies.b must be in a contact, a connection or a layer",
        ),
        (MASS_ON_FLOOR.replace('body = "a"', 'body = "b"'), "contacts.0.tip.body must be one of a, got 'b'"),
        (MASS_ON_FLOOR.replace('"rigid"', '"beam", body = "a"'), "contacts.0.track.body must be a modal beam, got 'a'"),
        (MASS_ON_FLOOR + '[[drives]]\nkind = "imposed velocity"\nvelocity = 1\n', "must be a finite-element beam"),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial state"\nvelocity = [1]\n',
            "drives.0.velocity must be two finite",
        ),
        (MASS_ON_FLOOR + '[[drives]]\nkind = "force"\nbody = "b"\n', "drives.0.body must be one of "),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\nmode = "fast"\n',
            "drives.0.mode must be a whole number from 0 on or most unstable, got 'fast'",
        ),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\nmode = -1\n',
            "drives.0.mode must be a whole number from 0 on or most unstable, got -1",
        ),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\nstatus = ["sliding", "stuck"]\n',
            "drives.0.status must be one of separated, sticking, sliding or a list of them",
        ),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\nvelocity = "fast"\n',
            "drives.0.velocity must be a number in m/s",
        ),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\namplitude = 1e-6\n',
            "drives.0.amplitude must be 0 without a mode, got 1e-06",
        ),
        (MASS_ON_FLOOR + '[[simulation.probes]]\nquantity = "velocity"\nbody = "b"\n', "probes.0.body must be one of "),
    ],
)
def test_errors_of_a_file_of_bodies_are_explained(text, message, tmp_path):
    assert any(message in problem for problem in problems(text, tmp_path))


def test_a_damaged_packed_matrix_is_reported(tmp_path):
    text = MASS_ON_FLOOR.replace("mass = 1", 'stiffness = [[1]]\npoints = {p = {x = 0}}\nmass = "float64 1x1 eJx"')
    found = problems(text.replace("point mass", "reduced"), tmp_path)
    assert found == ("bodies.a.mass must be a complete packed array, as in records, got 'float64 1x1 eJx'",)


@pytest.mark.parametrize(
    ("name", "key", "value", "message"),
    [
        ("squeal", "contact.stiffness", -1, "contact.stiffness must be above 0, got -1"),
        (
            "squeal",
            "contact.stiffness",
            "5 kg",
            "contact.stiffness must be a number in N/m, N/mm, kN/m or kN/mm, got '5 kg'",
        ),
        ("squeal", "contact.stiffness", {"kind": "linear"}, "contact.stiffness.stiffness must be given"),
        ("squeal-on-plate", "in_plane", "no way", "bodies.plate.in_plane must be true or false, got 'no way'"),
        ("pad-on-disc", "bodies.disc.held.0.directions", ["r"], "bodies.disc.held.0.place must be given"),
    ],
)
def test_a_value_of_another_type_is_refused_once_in_words(name, key, value, message):
    with pytest.raises(st.ScenarioError) as caught:
        st.load_scenario(name, {key: value})
    (problem,) = caught.value.problems
    assert problem.startswith(message)
