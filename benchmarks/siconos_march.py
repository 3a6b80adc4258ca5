"""March frozen modal systems in contact with Siconos; needs a Python with Siconos and NumPy only.

Moreau-Jean only: in Siconos 4.4.0 Moreau-Jean-Bilbao has neither friction nor external forces.

``python3 siconos_march.py case.npz answer.npz`` reads one case with several starts. Arrays of the case:

angular_frequency, damping (modes,)
    Mass-normalised modes [rad/s, 1].
rows (2, modes)
    Gap and tangential displacement of the tip against the track, from the modes.
load (modes,)
    Constant modal forces.
gap (runs,)
    Initial gap; runs start at rest [m].
friction, speed
    Coefficient [1]; velocity of the frame that carries the tip [m/s].
step, steps, stride
    Step [s], steps of a run, steps of a sample.

Arrays of the answer, normal force compressive, tangential force on the track along +x, as in Stridula:

normal_impulse, tangential_impulse, path (runs, samples)
    Impulses of each sample [N s]; tangential displacement of the tip against the track at its end [m].
shares (runs, 3)
    Shares of steps separated, sticking, sliding.
wall_time (runs,)
    Wall time of the march alone [s].
"""

from __future__ import annotations

import sys
import time

import numpy as np
import siconos.kernel as sk
import siconos.numerics as sn

THETA = 0.5
TOLERANCE = 1e-12
SEPARATED, STICKING, SLIDING = range(3)
# Pivoting leaves round-off of 1e-9 on sliding contacts; sticking ones lie further inside the cone.
INSIDE = 1.0 - 1e-6
# Row of the carriage, a free mode of mass 1: so small that friction cannot slow it. Its square is added to W.
CARRIAGE = 1e-6


def march(case: dict[str, np.ndarray], run: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Return impulses and path of the samples (3, samples), shares of the states (3,), wall time [s]."""
    simulation, contact = build(case, run)
    steps, stride, friction = int(case["steps"]), int(case["stride"]), float(case["friction"])
    samples = np.zeros((3, steps // stride))
    counts = [0, 0, 0]
    began = time.perf_counter()
    for sample in range(steps // stride):
        normal_sum = tangential_sum = 0.0
        for _ in range(stride):
            simulation.computeOneStep()
            normal, tangential = contact.lambda_(1)
            normal_sum += normal
            tangential_sum -= tangential
            counts[state(normal, tangential, friction)] += 1
            simulation.nextStep()
        samples[:, sample] = normal_sum, tangential_sum, contact.y(0)[1]
    return samples, np.array(counts) / steps, time.perf_counter() - began


def state(normal: float, tangential: float, friction: float) -> int:
    """Return the state that follows from the impulses of a step."""
    if normal <= 0.0:
        return SEPARATED
    return STICKING if abs(tangential) < INSIDE * friction * normal else SLIDING


def build(case: dict[str, np.ndarray], run: int) -> tuple[sk.TimeStepping, sk.Interaction]:
    """Return the simulation of one start, and its contact."""
    modes = body(case)
    rows = np.hstack([case["rows"], [[0.0], [CARRIAGE]]])
    law = sk.NewtonImpactFrictionNSL(0.0, 0.0, float(case["friction"]), 2)
    contact = sk.Interaction(law, sk.LagrangianLinearTIR(rows, np.array([case["gap"][run], 0.0])))
    step, steps = float(case["step"]), int(case["steps"])
    model = sk.NonSmoothDynamicalSystem(0.0, (steps + 2) * step)
    model.insertDynamicalSystem(modes)
    model.link(contact, modes)
    # In 4.4.0 the enumerating and the gradient solver leave some of these contacts unsolved; NSGS agrees with Lemke.
    solver = sk.FrictionContact(2, sn.SICONOS_FRICTION_2D_LEMKE)
    solver.numericsSolverOptions().dparam[sn.SICONOS_DPARAM_TOL] = TOLERANCE
    simulation = sk.TimeStepping(model, sk.TimeDiscretisation(0.0, step), sk.MoreauJeanOSI(THETA), solver)
    simulation.setNewtonOptions(sk.SICONOS_TS_LINEAR)
    return simulation, contact


def body(case: dict[str, np.ndarray]) -> sk.LagrangianLinearTIDS:
    """Return the modes, and the carriage as the last one."""
    angular = np.append(case["angular_frequency"], 0.0)
    damping = np.append(case["damping"], 0.0)
    velocity = np.append(np.zeros(angular.size - 1), case["speed"] / CARRIAGE)
    stiffness, viscous = np.diag(angular**2), np.diag(2.0 * damping * angular)
    modes = sk.LagrangianLinearTIDS(np.zeros(angular.size), velocity, np.eye(angular.size), stiffness, viscous)
    modes.setFExtPtr(np.append(case["load"], 0.0))
    return modes


def main(case_file: str, answer_file: str) -> None:
    """March all starts of a case."""
    with np.load(case_file) as stored:
        case = dict(stored)
    answers = [march(case, run) for run in range(len(case["gap"]))]
    samples = np.array([answer[0] for answer in answers])
    np.savez(
        answer_file,
        normal_impulse=samples[:, 0],
        tangential_impulse=samples[:, 1],
        path=samples[:, 2],
        shares=np.array([answer[1] for answer in answers]),
        wall_time=np.array([answer[2] for answer in answers]),
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
