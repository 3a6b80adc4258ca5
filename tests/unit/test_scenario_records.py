"""The round trip from systems to records and back to scenarios."""

from __future__ import annotations

import dataclasses
import json
import tomllib

import numpy as np
import pytest
import scipy.io
import scipy.sparse
import xarray as xr
from hypothesis import given
from hypothesis import strategies as some
from unit.scenario_texts import CASES, MASS_ON_FLOOR, MASSES, PLATES, chain

import stridula as st
from stridula.records.packed import packed, unpacked
from stridula.records.provenance import scenario_tables, scenario_toml, toml

STEEL = st.Material(young=2.1e11, density=7800.0)
SIMULATION = {"duration": 0.5, "scheme": "central difference", "step": 1e-6, "sample_rate": 5e4}


@pytest.mark.parametrize("name", CASES + MASSES + PLATES)
def test_every_case_survives_provenance(name, tmp_path):
    scenario = st.load_scenario(name)
    assert reloaded(scenario.system, (), tmp_path).system == scenario.system


@pytest.mark.parametrize("name", CASES + MASSES + PLATES)
def test_tables_are_those_of_the_text(name):
    """They need not be written and read again: their values are plain, of the same types."""
    scenario = st.load_scenario(name)
    tables = scenario_tables(scenario.system, scenario.probes or (), SIMULATION)
    text, read = (json.dumps(one, sort_keys=True) for one in (tables, tomllib.loads(toml(tables))))
    assert text == read


def reloaded(system, probes, folder):
    path = folder / "provenance.toml"
    path.write_text(scenario_toml(system, probes, SIMULATION), encoding="utf-8")
    return st.load_scenario(path)


def make(section=None, drives=lambda slider, track: [], **slider_fields):
    section = section or st.Rectangle(0.02, 0.0098)
    slider = st.FiniteElementBeam(STEEL, section, **{"length": 0.5, "angle": 0.3, "elements": 4} | slider_fields)
    track = st.ModalBeam(STEEL, section, length=0.9, bending_modes=7, axial_modes=3, damping=0.01)
    contact = st.PointContact(slider.tip, track, at=0.3, friction=st.Coulomb(0.4), gap=2e-6)
    return st.System(contact, drives(slider, track))


def test_a_string_survives_provenance(tmp_path):
    system = make()
    string = dataclasses.replace(system.track, tension=250.0)
    stretched = st.System(dataclasses.replace(system.contacts[0], track=string))
    probes = (st.SupportForce(string), st.SupportForce(string, "right"))
    again = reloaded(stretched, probes, tmp_path)
    assert again.probes == probes
    assert again.system == stretched
    assert again.system.track.tension == 250.0


HISTORIES = [
    st.Constant(),
    st.Ramp(0.1),
    st.Harmonic(120.0, amplitude=0.5, mean=1.0, phase=0.2),
    st.Sampled(time=(0.0, 0.1, 0.3), value=(0.0, -1.0, 2.0)),
]


@pytest.mark.parametrize("history", HISTORIES, ids=lambda history: type(history).__name__)
@pytest.mark.parametrize("kind", ["force", "imposed velocity"])
def test_every_drive_and_history_survives_provenance(kind, history, tmp_path):
    def drives(slider, track):
        if kind == "imposed velocity":
            return [st.ImposedVelocity(slider.root, 0.01, normal_load=5.0, history=history)]
        return [
            st.Force(slider.root, axial=-1.0, transverse=2.0, history=history),
            st.Force(slider.at(0.123), x=3.0, y=np.float64(-4.0)),
            st.Force(track.at(0.4), y=1.0),
            st.Force(track.centre, y=1.0),
            st.Gravity(1.62),
            st.InitialVelocity(slider, x=0.5),
            st.InitialVelocity(track, y=-0.5),
        ]

    system = make(drives=drives)
    assert reloaded(system, (), tmp_path).system == system


STARTS = [
    st.InitialEquilibrium(),
    st.InitialEquilibrium(status="sliding", velocity=-0.1),
    st.InitialEquilibrium(mode=np.int64(4), amplitude=1e-6, phase=0.3),
    st.InitialEquilibrium(status=["sliding"], velocity=[0.2], mode="most unstable", amplitude=np.float32(0.5)),
]


@pytest.mark.parametrize("start", STARTS)
def test_every_initial_equilibrium_survives_provenance(start, tmp_path):
    system = make(drives=lambda slider, track: [st.Gravity(), start])
    scenario = reloaded(system, (), tmp_path)
    assert scenario.system == system
    (tmp_path / "shown.toml").write_text(st.scenario_text(tmp_path / "provenance.toml"), encoding="utf-8")
    assert st.load_scenario(tmp_path / "shown.toml").system == system


def test_an_initial_equilibrium_is_changed_by_key(tmp_path):
    path = tmp_path / "start.toml"
    path.write_text(
        MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\nmode = 0\namplitude = "2 um"\n', encoding="utf-8"
    )
    changes = {
        "mode": "most unstable",
        "amplitude": "3 mm",
        "drives.0.velocity": "-5 cm/s",
        "drives.0.status": "sliding",
    }
    (start,) = st.load_scenario(path, changes).system.drives
    assert start == st.InitialEquilibrium("sliding", -0.05, "most unstable", 0.003)
    assert st.load_scenario(path).system.initial_equilibrium == st.InitialEquilibrium(mode=0, amplitude=2e-6)


@pytest.mark.parametrize("section", [st.Rectangle(0.02, 0.01), st.Circle(0.012), st.Section(2e-4, 3e-9)])
def test_every_section_survives_provenance(section, tmp_path):
    system = make(section=section, cutoff=20e3, root_support="free", mass="lumped", damping=np.float32(0.25))
    assert reloaded(system, (), tmp_path).system == system


def test_every_probe_and_the_simulation_survive_provenance(tmp_path):
    system = make()
    probes = (
        st.Acceleration(system.track.centre, "y"),
        st.Velocity(system.slider.tip, "axial"),
        st.Displacement(system.slider.at(0.2), "transverse"),
        st.Displacement(system.track.at(0.2), "x"),
        st.Reaction(system.slider, "x"),
    )
    scenario = reloaded(system, probes, tmp_path)
    assert scenario.probes == probes
    assert (scenario.duration, scenario.step, scenario.sample_rate) == (0.5, 1e-6, 5e4)
    assert scenario.scheme == st.CentralDifference()


def test_a_record_runs_again_from_its_file(tmp_path):
    scenario = st.load_scenario("squeal", {"duration": "2 ms"})
    record = scenario.simulate()
    st.save(record, tmp_path / "run.nc")
    again = st.load_scenario(tmp_path / "run.nc")
    assert again.title == scenario.title
    repeated = again.simulate()
    np.testing.assert_array_equal(repeated["normal_force"], record["normal_force"])


def test_a_shared_key_changes_both_bodies_of_a_record(tmp_path):
    path = tmp_path / "provenance.toml"
    path.write_text(scenario_toml(make(), (), SIMULATION))
    system = st.load_scenario(path, {"material.young": 7e10, "damping": 0.03}).system
    assert system.slider.material == system.track.material == st.Material(7e10, 7800.0)
    assert system.slider.damping == system.track.damping == 0.03


def test_a_record_is_a_scenario():
    run = st.load_scenario("squeal", {"duration": "1 ms"}).simulate()
    again = st.load_scenario(run)
    assert (again.system, again.duration) == (st.load_scenario("squeal").system, 0.001)
    xr.testing.assert_identical(again.simulate().drop_attrs(deep=False), run.drop_attrs(deep=False))
    assert again.title == run.attrs["title"]
    assert st.load_scenario(run, {"duration": "2 ms"}).duration == 0.002
    assert st.scenario_text(run).startswith("title")


@pytest.mark.parametrize("given", [3, None, b"squeal", ["squeal"], {"title": "x"}, xr.Dataset()])
def test_bad_sources_of_scenarios_are_refused(given):
    with pytest.raises(st.ScenarioError, match=r"^scenario must be a ") as caught:
        st.load_scenario(given)
    assert "\n" not in str(caught.value)


LAWS = [
    st.Coulomb(0.3),
    st.StaticKinetic(0.4, 0.25),
    st.Stribeck(0.5, 0.3, 0.01, exponent=1.5, viscous=0.2),
    st.ExponentialWeakening(0.5, 0.3, 0.01),
    st.LinearWeakening(0.5, 2.0, kinetic=0.1),
    st.LuGre(0.5, 0.3, 1e-3, stiffness=1e5, damping=3.0, viscous=0.4),
    st.RateAndState(0.6, 0.01, 0.015, 1e-5, 1e-6, evolution="slip", initial_state=3.0),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
def test_every_law_survives_provenance(law, tmp_path):
    system = make()
    pair = st.System(dataclasses.replace(system.contact, friction=law, name="tip on track"))
    assert reloaded(pair, (), tmp_path).system == pair
    mass = st.PointMass(0.3)
    alone = st.System(st.PointContact(mass.centre, st.RigidTrack(velocity=0.2), friction=law))
    assert reloaded(alone, (), tmp_path).system == alone


def alternating(size: int) -> np.ndarray:
    return np.kron(np.ones(size), np.eye(2))


REDUCED = {
    "ratio": chain(2, damping=0.01),
    "ratios": chain(2, damping=[0.01, 0.02, 0.03, 0.04], name="pad"),
    "shares": chain(2, damping=st.Rayleigh(2.0, 1e-6), name='a "b".c'),
    "matrix": chain(2, damping=np.eye(4) * 0.7, translation=alternating(2), cutoff=300.0),
    "large": chain(20, damping=np.diag(np.linspace(0.1, 1.0, 40)), translation=alternating(20), name="slider"),
}


@pytest.mark.parametrize("body", REDUCED.values(), ids=REDUCED)
def test_every_reduced_body_survives_provenance(body, tmp_path):
    size = body.mass.shape[0]
    start = st.InitialState(body, displacement=np.linspace(0.0, 1e-6, size), velocity=np.full(size, 1 / 3))
    system = st.System(
        [
            st.PointContact(body.at("tip"), st.RigidTrack(), gap=1e-6, friction=st.Coulomb(0.3)),
            st.PointContact(body.at("20 mm"), st.RigidTrack(velocity=-0.1, name="belt"), inclination=0.5),
        ],
        [st.Force(body.at("x only"), x=1.0), start],
    )
    probes = (st.Velocity(body.at("20 mm"), "x"),)
    again = reloaded(system, probes, tmp_path)
    assert again.system == system
    assert again.probes == probes
    assert again.system.slider.damping is not None


def general() -> tuple[st.System, tuple[object, ...]]:
    """Return a system with all features that a pair of beams lacks, and its probes."""
    section = st.Circle(0.01)
    rod = st.FiniteElementBeam(STEEL, section, 0.3, angle=0.3, elements=3, cutoff=8e3, root_support="free")
    plate = st.ModalBeam(STEEL, section, 0.8, bending_modes=5, axial_modes=2, name="plate")
    block, other, far = st.PointMass(0.2, name="track"), st.PointMass(0.2), chain(1)
    belt = st.RigidTrack(
        velocity=0.1,
        normal_velocity=0.01,
        history=st.Ramp(0.1),
        normal_history=st.Harmonic(50.0),
        name="belt",
        normal_acceleration=0.3,
    )
    contacts = [
        st.PointContact(rod.tip, plate, at=0.3, gap=1e-6, friction=st.Coulomb(0.4), name="rod on plate"),
        st.PointContact(block.centre, belt, at=-2.0, inclination=np.float64(0.1), friction=LAWS[5]),
        st.PointContact(other.centre, st.BodyPoint(plate, 0.4), gap=2e-6, inclination=np.pi, friction=LAWS[6]),
        st.PointContact(rod.at(0.1), block.centre, gap=1.0),
    ]
    drives = [
        st.ImposedVelocity(rod.root, 0.01, normal_load=20.0),
        st.InitialVelocity(block, x=0.05),
        st.InitialState(other, velocity=(0.0, 0.01)),
        st.Force(far.at("tip"), y=3.0, history=st.Sampled((0.0, 0.1, 0.1), (1.0, 2.0, 0.0))),
    ]
    connections = [
        st.Spring(block.centre, rod.at(0.2), stiffness=5e3, direction="y"),
        st.Spring(other.centre, stiffness=2e3),
        st.Dashpot(other.centre, plate.at(0.1), coefficient=3.0, direction="y"),
        st.Dashpot(far.at("tip"), coefficient=4.0),
    ]
    probes = (
        st.Acceleration(plate.centre),
        st.Displacement(rod.at(0.1), "transverse"),
        st.Velocity(block.centre, "x"),
        st.Velocity(far.at("tip")),
    )
    return st.System(contacts, drives, connections), probes


def test_a_record_of_many_bodies_runs_again_bit_by_bit(tmp_path):
    system, probes = general()
    options = {"probes": probes, "contact_solve": st.GaussSeidel(tolerance=1e-9, sweeps=500), "sample_rate": 2e4}
    record = st.simulate(system, 2e-3, title="all", **options)
    assert 'name = ""' not in record.attrs["scenario"]
    st.save(record, tmp_path / "run.nc")
    again = st.load_scenario(tmp_path / "run.nc")
    assert again.contact_solve == options["contact_solve"]
    assert again.system.bodies == system.bodies
    assert again.system.contacts == system.contacts
    assert again.probes == probes
    repeated = again.simulate()
    assert repeated.attrs["scenario"] == record.attrs["scenario"]
    xr.testing.assert_equal(repeated.drop_attrs(), record.drop_attrs())


def test_a_record_of_many_bodies_is_shown_as_the_same_scenario_and_continued(tmp_path):
    system, probes = general()
    record = st.simulate(system, 1e-3, probes=probes)
    st.save(record, tmp_path / "run.nc")
    (tmp_path / "shown.toml").write_text(st.scenario_text(tmp_path / "run.nc"), encoding="utf-8")
    shown = st.load_scenario(tmp_path / "shown.toml")
    assert shown == st.load_scenario(tmp_path / "run.nc")
    onwards = shown.simulate(duration=1e-3, start=record)
    assert onwards["time"].values[0] > record["time"].values[-1]
    other = st.load_scenario(tmp_path / "run.nc", {"contacts.1.friction.law": "coulomb", "contacts.1.friction": 0.3})
    with pytest.raises(ValueError, match="same contacts"):
        other.simulate(start=record)


def test_matrices_written_out_are_the_same_as_their_file(tmp_path):
    body = chain(3, damping=0.01, name="pad")
    body.save(tmp_path / "pad.npz")
    rest = '[[contacts]]\ntip = {body = "pad", point = "tip"}\ntrack = {kind = "rigid"}\n[simulation]\nduration = 1.0\n'
    (tmp_path / "file.toml").write_text(f'[bodies.pad]\nkind = "reduced"\nfile = "pad.npz"\n{rest}')
    # Rows in full, as written by hand.
    rows = {name: getattr(body, name).tolist() for name in ("mass", "stiffness")}
    points = "\n".join(f'"{name}" = {value.tolist()}' for name, value in body.points.items())
    (tmp_path / "rows.toml").write_text(
        f'[bodies.pad]\nkind = "reduced"\ndamping = "1 %"\nmass = {rows["mass"]}\nstiffness = {rows["stiffness"]}\n'
        f"[bodies.pad.points]\n{points}\n{rest}"
    )
    for name in ("mass", "stiffness"):
        scipy.io.mmwrite(tmp_path / f"{name}.mtx", scipy.sparse.coo_array(getattr(body, name)), precision=17)
    (tmp_path / "files.toml").write_text(
        '[bodies.pad]\nkind = "reduced"\ndamping = 0.01\nmass = "mass.mtx"\nstiffness = "stiffness.mtx"\n'
        f"[bodies.pad.points]\n{points}\n{rest}"
    )
    systems = [st.load_scenario(tmp_path / f"{name}.toml").system for name in ("file", "rows", "files")]
    assert systems[0] == systems[1] == systems[2]
    assert systems[0].slider == body


def test_equal_bodies_are_distinguished_by_their_names_in_the_file(tmp_path):
    (tmp_path / "case.toml").write_text(
        '[bodies]\nslider = {kind = "point mass", mass = 1}\ntrack = {kind = "point mass", mass = 1}\n'
        '[[contacts]]\ntip = {body = "slider"}\ntrack = {kind = "point", body = "track"}\n'
        "[simulation]\nduration = 1.0\n"
    )
    system = st.load_scenario(tmp_path / "case.toml").system
    assert [body.name for body in system.bodies] == ["slider", "track"]
    assert reloaded(system, (), tmp_path).system == system


@given(some.integers(0, 3), some.integers(0, 4), some.integers(0, 2**32 - 1))
def test_packed_arrays_come_back_bit_by_bit(rows, columns, seed):
    array = np.random.default_rng(seed).standard_normal((rows, columns)) * 1e-300
    np.testing.assert_array_equal(unpacked(packed(array)), array)


def test_records_without_poisson_load_as_before(tmp_path):
    record = st.simulate(st.load_scenario("squeal").system, 1e-4)
    old = "\n".join(line for line in record.attrs["scenario"].split("\n") if not line.startswith("poisson"))
    assert old != record.attrs["scenario"]
    (tmp_path / "old.toml").write_text(old, encoding="utf-8")
    assert st.load_scenario(tmp_path / "old.toml").system == st.load_scenario("squeal").system


def test_packed_arrays_are_written_beside_texts_that_look_alike():
    array = packed(np.arange(100.0))
    tables = {"a": {"matrix": array, "rows": [array, 'float64 3 "quoted"']}, "title": "float64 2x2 a\\b"}
    assert tomllib.loads(toml(tables)) == tables
