"""Mistakes that gave a result without a sign: each is refused in one line, or named in a warning."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

import stridula as st
from stridula import plot
from stridula.contact import FrictionLaw

STEEL = st.Material(2.1e11, 7800.0)
WEAKENING = {"static": 0.5, "kinetic": 0.3, "velocity": 0.1}
LAWS = {
    st.Coulomb: {"coefficient": 0.3},
    st.StaticKinetic: {"static": 0.5, "kinetic": 0.3},
    st.Stribeck: WEAKENING,
    st.ExponentialWeakening: WEAKENING,
    st.LinearWeakening: {"static": 0.5, "slope": 1.0, "kinetic": 0.3},
    st.LuGre: WEAKENING | {"stiffness": 1e5},
    st.RateAndState: {"reference": 0.6, "a": 0.01, "b": 0.015, "slip_distance": 1e-5, "velocity": 1e-3},
}


def refused(call, pattern):
    with pytest.raises(ValueError, match=pattern) as caught:
        call()
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400


def block(friction):
    """Return a mass on a belt, held by a spring."""
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack(1.0), friction=friction)
    return st.System(contact, [st.Force(mass.centre, y=-10.0)], [st.Spring(mass.centre, stiffness=1e4, direction="x")])


# Laws of friction from outside.


def halved(kind, method, share):
    """Return a subclass of a law with a method scaled from a slip speed on."""

    def scaled(self, velocity):
        return np.asarray(kind.coefficient_at(self, velocity)) * np.where(np.abs(velocity) > 1e-3, share, 1.0)

    return type("Own", (kind,), {method: scaled})


@pytest.mark.parametrize("kind", list(LAWS), ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("call", [lambda system: st.simulate(system, 1e-3), st.sliding_stability])
def test_a_law_whose_overridden_coefficient_is_not_marched_is_refused(kind, call):
    words = LAWS[kind]
    call(block(kind(**words)))
    refused(
        lambda: call(block(halved(kind, "coefficient_at", 0.9)(**words))),
        "^contact 1: friction must have the coefficient_at .* as the march computes .* of Own$",
    )
    # Repeating the formula changes nothing.
    call(block(halved(kind, "coefficient_at", 1.0)(**words)))


class OneSided(st.Coulomb):
    """Friction with another coefficient in the other sense."""

    def coefficient_at(self, velocity):
        return np.where(np.asarray(velocity) < 0.0, 0.1, self.coefficient)


class Doubled(st.Stribeck):
    """Twice as much friction, with the slope of half of it."""

    def parameters(self):
        return super().parameters() | {"static": 2.0 * self.static, "kinetic": 2.0 * self.kinetic}

    def coefficient_at(self, velocity):
        return 2.0 * super().coefficient_at(velocity)


class Bristly(st.LuGre):
    """Bristles with the slope of Stribeck's curve alone across the slip."""

    def linearised_across(self, velocity):
        return self.linearised_at(velocity)


@dataclass(frozen=True)
class Halving(FrictionLaw):
    """Friction that falls to its half, marched as Stribeck's with exponent 1."""

    coefficient: float
    velocity: float
    law: ClassVar[str] = "halving"
    kernel_code: ClassVar[str] = "STRIBECK"

    def parameters(self):
        ends = {"static": self.coefficient, "kinetic": self.coefficient / 2}
        return {**ends, "velocity": self.velocity, "exponent": 1.0, "viscous": 0.0}

    def coefficient_at(self, velocity):
        return self.coefficient / 2 * (1 + np.exp(-np.abs(velocity) / self.velocity))


class Held(st.StaticKinetic):
    """A contact that is held longer than it is in the march."""

    holding = 0.9


class Unknown(st.Coulomb):
    """A law with the name of another constant of the march."""

    law: ClassVar[str] = "gap"


class Renamed(st.Coulomb):
    """A law with another name for its parameter than the march has."""

    def parameters(self):
        return {"mu": self.coefficient}


class Younger(st.RateAndState):
    """A law that starts with contacts half as old as in steady sliding."""

    def state_in_sliding(self, velocity, change=0.0):
        return 0.5 * super().state_in_sliding(velocity, change)


class Stateless(st.RateAndState):
    """A law without its state."""

    state_units: ClassVar[str] = ""


@pytest.mark.parametrize(
    ("law", "message"),
    [
        (OneSided(0.3), r"must have the coefficient_at 0.3 at -.* m/s, .*, got 0.1 of OneSided$"),
        (Doubled(0.5, 0.3, 0.1), r"must have the slope -.* s/m in linearised_at"),
        (Bristly(0.5, 0.3, 0.1, 1e5), r"must have the slope .* s/m in linearised_across"),
        (Held(0.5, 0.3), r"must have the holding ratio 0.5, .*, got 0.9 of Held$"),
        (Unknown(0.3), r"must have a kernel_code out of COULOMB, .*, got 'GAP' of Unknown$"),
        (Renamed(0.3), r"must have the parameters coefficient, .*, got mu of Renamed$"),
        (Younger(**LAWS[st.RateAndState]), r"must have the state_in_sliding\(.*\) of 100 s, .* got 50 of Younger$"),
        (Stateless(**LAWS[st.RateAndState]), r"must have has_state True"),
    ],
)
def test_laws_that_differ_from_their_march_are_refused(law, message):
    refused(lambda: st.simulate(block(law), 1e-3), f"^contact 1: friction {message}")


def test_a_law_from_outside_is_linearised_by_its_own_curve():
    law, same = Halving(0.4, 0.5), st.ExponentialWeakening(0.4, 0.2, 0.5)
    for velocity in (1e-3, 0.05, -0.3):
        assert law.linearised_at(velocity).slope == pytest.approx(same.linearised_at(velocity).slope, rel=1e-8)
    ours, theirs = (st.sliding_stability(block(one)) for one in (law, same))
    np.testing.assert_allclose(ours["growth_rate"], theirs["growth_rate"], rtol=1e-7)
    assert (theirs["growth_rate"] > 0.1).any()


def test_a_law_of_constant_friction_has_no_slope():
    @dataclass(frozen=True)
    class Constant(FrictionLaw):
        coefficient: float
        law: ClassVar[str] = "coulomb"
        depends_on_speed: ClassVar[bool] = False

        def parameters(self):
            return {"coefficient": self.coefficient}

        def coefficient_at(self, velocity):
            return np.full(np.shape(velocity), self.coefficient)

    assert Constant(0.3).linearised_at(0.1).slope == 0.0
    st.simulate(block(Constant(0.3)), 1e-3)


# Rates.


def test_a_rate_of_motion_below_one_interval_is_refused():
    system = block(st.Coulomb(0.3))
    refused(
        lambda: st.simulate(system, 3e-3, motion_rate=1.0), r"^motion_rate must be at least 1 / duration, 333.334 Hz"
    )
    refused(
        lambda: st.simulate_many([system] * 2, 3e-3, motion_rate=1.0),
        r"^systems\[0\]: motion_rate must be at least 1 / duration",
    )
    assert st.simulate(system, 3e-3, motion_rate=1.0 / 3e-3).sizes["time"] == 300


# Angles in degrees.


def test_angles_beyond_a_turn_are_refused():
    mesh = st.SolidMesh.block((0.1, 0.1, 0.1), (1, 1, 1))
    refused(
        lambda: mesh.moved(rotation=(0, 0, 180)),
        "^rotation must be an axis times an angle of at most 2 pi rad, got 180 rad",
    )
    np.testing.assert_allclose(mesh.moved(rotation=(0, 0, 2 * math.pi)).nodes, mesh.nodes, atol=1e-15)
    disc = st.AxisymmetricBody(st.RectangleProfile({"disc": ((0.0, 0.1), (0.0, 0.01))}), STEEL, 5e3)
    for point in (disc.at, disc.circle):
        refused(lambda point=point: point((0.08, 90.0, 0.01)), r"^position\[1\] must be from -2 pi to 2 pi rad, got 90")
    refused(lambda: st.Harmonic(10.0, phase=90.0), "^phase must be from -2 pi to 2 pi rad, got 90")
    refused(lambda: st.InitialEquilibrium(mode=0, amplitude=1e-6, phase=90.0), "^phase must be from -2 pi to 2 pi rad")
    body = st.SolidBody(mesh, STEEL, cutoff=5e3)
    plane = st.SurfaceContact(body, "bottom", st.RigidTrack())
    refused(lambda: plot.system(st.System(plane), view=(30.0, 45.0)), r"^view\[0\] must be from -2 pi to 2 pi rad")


# Files of another format.


@pytest.mark.parametrize("ending", [".mp3", ".flac", ".nc", ".CSV", ".png"])
def test_a_sound_is_not_written_under_the_ending_of_another_format(tmp_path, ending):
    run = st.load_scenario("squeal").simulate(duration=2e-3)
    pressure = st.radiate(run, st.load_scenario("squeal").system)
    refused(lambda: st.write_wav(tmp_path / f"a{ending}", pressure), "^path must be a WAV file, .wav, got ")
    assert not list(tmp_path.iterdir())
    for name in ("a.wav", "a.WAV", "a.take 2", "a"):
        st.write_wav(tmp_path / name, pressure)


@pytest.mark.parametrize("ending", [".csv", ".mat", ".wav", ".png", ".toml", ".npz", ".XLSX"])
def test_a_record_is_not_written_under_the_ending_of_another_format(tmp_path, ending):
    run = st.simulate(block(st.Coulomb(0.3)), 1e-3)
    path = tmp_path / f"a{ending}"
    refused(lambda: st.save(run, path), "^path must be a NetCDF file, .nc, got '.*'; export writes tables")
    refused(lambda: st.sweep("squeal", [{"at": 0.3}], "regime", out=path), "^out must be a NetCDF file, .nc, got ")
    refused(lambda: st.squeal_survey("squeal", [{"at": 0.3}], out=path), "^out must be a NetCDF file, .nc, got ")
    assert not list(tmp_path.iterdir())
    for name in ("a.nc", "a.h5", "a.2024", "a"):
        st.save(run, tmp_path / name)
        assert st.load(tmp_path / name).sizes == run.sizes


# Faces without flexibility of their own.


def surfaces(stiffness=None, **options):
    """Return a block of few modes on a plane and on a disc."""
    body = st.SolidBody.block((0.1, 0.04, 0.1), (3, 1, 3), STEEL, cutoff=3e4, **options)
    contacts = [
        st.SurfaceContact(
            body, "bottom", st.RigidTrack(), friction=st.Coulomb(0.3), stiffness=stiffness, name="lining"
        ),
    ]
    return st.System(contacts, [st.Force(body.at("top"), y=-100.0)])


def test_faces_without_flexibility_are_refused_with_both_remedies_in_a_short_line():
    with pytest.raises(ValueError, match="hold the same motion twice") as caught:
        st.sliding_stability(surfaces(), velocity=1.0)
    words = str(caught.value)
    assert words.endswith(
        "got lining; give the SurfaceContact a stiffness, or name its face in contact_faces of the body"
    )
    assert len(words) < 200
    st.sliding_stability(surfaces(1e11), velocity=1.0)


# Values without the prefix of their unit.

RECTANGLE = st.Rectangle(0.02, 0.01)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: st.Material(210.0, 7800.0), r"Young's modulus of 210 Pa; did you mean GPa\?"),
        (lambda: st.Material(2.1e5, 7800.0), r"Young's modulus of 2.1e\+05 Pa; did you mean MPa\?"),
        (lambda: st.Material(2.1e11, 7.8), r"density of 7.8 kg/m3; did you mean g/cm3\?"),
        (lambda: st.HertzStiffness(0.01, 115.0), r"combined modulus of 115 Pa; did you mean GPa\?"),
        (lambda: st.Rectangle(60.0, 1.0), r"size of 60 m; did you mean mm\?"),
        (lambda: st.Circle(60.0), r"size of 60 m; did you mean mm\?"),
        (lambda: st.ModalBeam(STEEL, RECTANGLE, 60.0), r"size of 60 m; did you mean mm\?"),
        (lambda: st.FiniteElementBeam(STEEL, RECTANGLE, 60.0), r"size of 60 m; did you mean mm\?"),
        (lambda: st.ModalPlate(STEEL, 0.01, 1.0, 60.0), r"size of 60 m; did you mean mm\?"),
        (
            lambda: st.AxisymmetricBody(st.RectangleProfile({"a": ((0.0, 30.0), (0.0, 5.0))}), STEEL, 100.0, orders=0),
            r"size of 60 m; did you mean mm\?",
        ),
        (lambda: st.SolidMesh.block((60.0, 40.0, 10.0), (1, 1, 1)), r"size of 60 m; did you mean mm\?"),
        (lambda: st.RigidBody(1.0, 0.1, {"tip": (0.0, -60.0, 0.0)}), r"size of 60 m; did you mean mm\?"),
    ],
)
def test_values_without_their_prefix_are_named_in_a_warning_at_the_line_that_gives_them(make, words):
    with pytest.warns(st.DoubtfulValue, match=f"^{words}$") as caught:
        make()
    assert {one.filename for one in caught} == {__file__}


def test_ordinary_values_raise_no_warning():
    st.Material(1e6, 10.0)
    st.Material(1.2e12, 2.3e4)
    st.ModalBeam(STEEL, RECTANGLE, 50.0)


# Faces far from their track.


def pressed(above, gap=0.0):
    """Return a block pressed on another one, from a height above it."""
    bed = st.SolidBody(st.SolidMesh.block((0.04, 0.01, 0.04), (1, 1, 1)), STEEL, fixed=["bottom"], name="bed")
    mesh = st.SolidMesh.block((0.02, 0.01, 0.02), (1, 1, 1)).moved((0.01, 0.01 + above, 0.01))
    die = st.SolidBody(mesh, STEEL, fixed={"top": "xz"}, name="die")
    face = st.SurfaceContact(die, "bottom", bed, "top", gap=gap, stiffness=1e12, name="sole")
    spring = st.Spring(die.at("top"), stiffness=1e6, direction="y")
    return lambda: st.System(face, [st.Force(die.at("top"), y=-10.0)], [spring])


@pytest.mark.parametrize(("above", "gap"), [(0.02, 0.0), (0.0, 0.02)])
def test_a_face_far_from_its_track_is_named(above, gap):
    words = r"sole: nothing within 0\.02 m of the face, 0\.01155 m in size; did you mean to move it there\?"
    with pytest.warns(st.DoubtfulValue, match=f"^{words}$") as caught:
        system = pressed(above, gap)()
    assert caught[0].filename == __file__
    found = st.sliding_stability(system)
    assert found.attrs["equilibrium"] == "lifted off"
    assert "sole is open by 0.02 m" in found.attrs["notes"].split("; ")
    again = st.System(system.contact, [*system.drives, st.InitialEquilibrium()], system.connections)
    refused(
        lambda: st.simulate(again, 1e-4),
        "which sole is lifted off: press it down, or status='separated' starts it open; sole is open by 0.02 m$",
    )


def test_a_face_near_its_track_is_not_named(recwarn):
    pressed(1e-4)()
    assert not [one for one in recwarn if "nothing within" in str(one.message)]


@pytest.mark.parametrize(("push", "words"), [(5.0, "no contact pressed at any time"), (-5.0, "")])
def test_a_load_that_pulls_is_noted(push, words):
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack(1.0), friction=st.Coulomb(0.3))
    system = st.System(contact, [st.Force(mass.centre, y=push)])
    assert st.simulate(system, 1e-3).attrs["notes"] == words
    assert st.simulate_many([system], 1e-3, labelled=False)[0].attrs["notes"] == words
