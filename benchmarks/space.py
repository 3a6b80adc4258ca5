"""Systems in space: shipped rigs and faces in contact against real time, and the cost of a turning disc."""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np

import stridula as st
from ratios import REPEATS, WARM_UP, Ratio, must_agree, seconds, show, sized

TITLE = "systems in space: contacts with two tangents, meshed bodies, discs that turn"
DURATION = sized(0.02, 2e-4)
LININGS = sized(((2, 3, 1), (3, 5, 1)), ((1, 2, 1),))
# The shipped brake, in the short form with 16 points on each pad.
PADS = sized({}, {f"bodies.{side} pad.mesh.divisions": [2, 2, 1] for side in ("upper", "lower")})
IRON, LINING = st.Material(1.1e11, 7100.0, 0.28), st.Material(4e9, 2500.0, 0.25)
STEP = 5e-6


def rows() -> Iterator[Ratio]:
    """Yield speeds of the rigs and of a face on a disc, its steps, and the cost of turning."""
    for name in ("pin-on-disc", "pad-on-disc"):
        system = st.load_scenario(name).system
        contacts = len(system.contacts)
        yield Ratio(f"{name}, {contacts} contacts: simulated time over wall time", speeds(system)[0])
    for divisions in LININGS:
        system = lined(divisions)
        fast, made = speeds(system)
        words = f"a lining of {len(system.contacts)} points on a disc that turns"
        yield Ratio(f"{words}: simulated time over wall time", fast)
        yield Ratio(f"{words}: sweeps or steps of Newton's method per step", made)
    brake = st.load_scenario("brake", PADS).system
    fast, made = speeds(brake)
    words = f"brake, {len(brake.contacts)} points on two faces"
    yield Ratio(f"{words}: simulated time over wall time", fast)
    yield Ratio(f"{words}: sweeps or steps of Newton's method per step", made)
    yield Ratio("a rider on a turning disc, over the same on a disc at rest", turning())


def speeds(system: st.System) -> tuple[list[float], list[float]]:
    """Return simulated time over wall time, and the mean number of sweeps or of steps of Newton's method in a step."""
    found, made = [], []
    for repeat in range(WARM_UP + REPEATS):
        began = time.perf_counter()
        run = st.simulate(system, DURATION, probes=[])
        if repeat >= WARM_UP:
            found.append(DURATION / (time.perf_counter() - began))
            made.append(float(run.contact_sweeps.mean()))
    return found, made


def disc(turning: float) -> st.AxisymmetricBody:
    """Return a disc of cast iron."""
    profile = st.RectangleProfile({"disc": ((0.06, 0.13), (-0.01, 0.0))})
    return st.AxisymmetricBody(profile, IRON, 6e3, "inner", damping=0.001, axis=(0.0, 1.0, 0.0), turning=turning)


def lined(divisions: tuple[int, int, int]) -> st.System:
    """Return a lining pressed on a turning disc."""
    mesh = st.SolidMesh.sector((0.085, 0.125), (-0.4, 0.4), 0.012, divisions, axis="y")
    pad = st.SolidBody(mesh, LINING, cutoff=12e3, damping=0.01, contact_faces=["bottom"], name="pad")
    face = st.SurfaceContact(pad, "bottom", disc(20.0), friction=st.Coulomb(0.3), stiffness=3e12)
    back = pad.face_points("top")
    places = list(zip(back.place.tolist(), back.area.tolist(), strict=True))
    loads = [st.Force(pad.at(place), y=-2000.0 * area / back.area.sum()) for place, area in places]
    springs = [st.Spring(pad.at(place), stiffness=2e7, direction=way) for place, _ in places[::6] for way in "xz"]
    return st.System(face, [*loads, st.InitialEquilibrium()], springs)


def turning() -> list[float]:
    """Return the time with turning pairs over that without; the disc turns so slowly that results agree."""
    slow, place = 1e-9, (0.12, 0.0, 0.0)

    def rider(plate: st.AxisymmetricBody, **words: float) -> st.System:
        mass = st.RigidBody(0.2)
        directions = {"normal": (0.0, 1.0, 0.0), "tangent": (0.0, 0.0, -1.0)}
        contact = st.PointContact(mass.centre, plate.at(place), friction=st.Coulomb(0.3), **directions, **words)
        return st.System(contact, [st.Force(mass.centre, y=-50.0)])

    systems = rider(disc(slow)), rider(disc(0.0), surface_velocity=slow * place[0])

    def run(system: st.System) -> np.ndarray:
        return st.simulate(system, 5.0 * DURATION, step=STEP, sample_rate=1e4, probes=[]).normal_force.values

    def agree(found: np.ndarray, expected: np.ndarray) -> None:
        must_agree("forces on a disc that turns slowly", found, expected, 1e-6)

    turned, still = seconds(*(lambda one=one: run(one) for one in systems), agree=agree)
    return [one / other for one, other in zip(turned, still, strict=True)]


if __name__ == "__main__":
    show(TITLE, rows())
