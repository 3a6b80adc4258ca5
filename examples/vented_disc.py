"""
A vented disc
=============

Does it matter where the vanes of a vented disc are? The disc is a mesh from which the channels between its vanes are
cut. It has no axial symmetry: the modes that a pad drives depend on the angle at which the disc stands under it. Two
modes merge and grow at some angles only, eight times in a turn, where a solid disc squeals at each or at none.
:doc:`brake_dimensions` has solid discs.

The vibration of the disc is described in a frame at rest, in which the vanes stand as well. Linear theory then holds
for one angle, as if the disc slid under the pad without its vanes moving on; waves that are carried round are left out.
"""

import matplotlib.pyplot as plt
import numpy as np

import stridula as st

IRON, LINING = st.Material(1.1e11, 7100.0, 0.28), st.Material(4e9, 2500.0, 0.25)
BORE, RIM, THICK, VANES, AROUND = 0.06, 0.13, 0.021, 8, 48
SPEED, FRICTION, LOAD, CUTOFF = 20.0, 0.5, 2e3, 6e3


def channel(place: np.ndarray) -> np.ndarray:
    """Whether places are between two vanes, in the middle of the thickness."""
    share = np.arctan2(place[:, 2], place[:, 0]) / (2.0 * np.pi) * VANES % 1.0
    return (np.abs(place[:, 1] - 0.5 * THICK) < THICK / 6.0) & (share > 0.5)


solid = st.SolidMesh.sector((BORE, RIM), (0.0, 2.0 * np.pi), THICK, (3, AROUND, 3))
vented = solid.cut(channel, "channels")


def disc(mesh: st.SolidMesh) -> st.SolidBody:
    """A disc held at its bore, with the residual shapes of its upper face."""
    return st.SolidBody(
        mesh, IRON, fixed=["inner"], cutoff=CUTOFF, damping=5e-4, contact_faces={"top": (2, AROUND)}, name="disc"
    )


def braked(track: st.SolidBody, angle: float) -> st.System:
    """A pad pressed on a disc, at an angle [rad] about its axis."""
    block = st.SolidMesh.block((0.05, 0.012, 0.06), (2, 1, 3)).moved((0.072, THICK, -0.03))
    pad = st.SolidBody(
        block.moved(rotation=(0.0, angle, 0.0)),
        LINING,
        fixed={"top": "xz"},
        cutoff=CUTOFF,
        damping=0.01,
        contact_faces={"bottom": (3, 4)},
        name="pad",
    )
    turning = ((0.0, 1.0, 0.0), (0.0, 0.0, 0.0), SPEED)
    face = st.SurfaceContact(pad, "bottom", track, "top", st.Coulomb(FRICTION), stiffness=3e11, turning=turning)
    return st.System(face, [st.Force(pad.at("top"), y=-LOAD)])


angles = np.linspace(0.0, 4.0 * np.pi / VANES, 25)
worst, found = {}, {}
for name, track in {"solid": disc(solid), "vented": disc(vented)}.items():
    theory = [st.sliding_stability(braked(track, angle)) for angle in angles]
    heard = [(one.frequency.values > 100.0) & (one.frequency.values < CUTOFF) for one in theory]
    growths = [one.growth_rate.values[at] for one, at in zip(theory, heard, strict=True)]
    pitches = [one.frequency.values[at] for one, at in zip(theory, heard, strict=True)]
    worst[name] = np.array([each.max() for each in growths])
    found[name] = np.array([(a, f) for a, each in zip(np.degrees(angles), pitches, strict=True) for f in each]).T
    loudest = int(worst[name].argmax())
    pitch = pitches[loudest][growths[loudest].argmax()]
    shares = np.mean(worst[name] > 0.0)
    print(f"{name}: at most {worst[name].max():.0f} /s, at {pitch:.0f} Hz; grows at {100 * shares:.0f} % of the angles")

figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.8), layout="constrained")
for name, growth in worst.items():
    left.plot(np.degrees(angles), growth, label=name)
left.axhline(0.0, color="k", linewidth=0.5)
left.set(xlabel="angle of the disc under the pad [deg]", ylabel="largest growth [1/s]")
left.legend(fontsize="small")
right.plot(*found["vented"], "o", markersize=3, color="C1")
right.set(xlabel="angle of the disc under the pad [deg]", ylabel="frequency [Hz]", ylim=(pitch - 60.0, pitch + 60.0))
right.set_title("the pair of modes that merges, vented", fontsize="small")
figure.savefig("vented-disc.png", dpi=110)
