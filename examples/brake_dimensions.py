"""
A brake by its dimensions
=========================

Which disc and which pads squeal? A brake is built from its dimensions, and two of them are swept: the thickness of the
disc and the length of the pads. :doc:`brake` explains the parts.
"""

from dataclasses import dataclass, replace

import matplotlib.pyplot as plt
import numpy as np

import stridula as st
from stridula import plot

IRON, STEEL, LINING = (
    st.Material(1.1e11, 7100.0, 0.28),
    st.Material(2.1e11, 7800.0, 0.3),
    st.Material(4e9, 2500.0, 0.25),
)


@dataclass(frozen=True)
class Brake:
    """Dimensions [m, rad], force on each pad [N], friction, and speed of the disc [rad/s]."""

    radius: float = 0.13
    bore: float = 0.07
    thickness: float = 0.02
    hat: float = 0.04
    pad_radii: tuple[float, float] = (0.085, 0.125)
    pad_angle: float = np.radians(46.0)
    lining: float = 0.010
    plate: float = 0.006
    load: float = 2000.0
    friction: float = 0.45
    turning: float = 20.0

    @property
    def disc(self) -> st.AxisymmetricBody:
        """The disc with its hat, held at the flange."""
        half, wall = 0.5 * self.thickness, 0.01
        boxes = [
            ("disc", ((self.bore, self.radius), (-half, half))),
            ("hat", ((self.bore - wall, self.bore), (-half, half + self.hat))),
            ("hat", ((0.03, self.bore - wall), (half + self.hat - 0.006, half + self.hat))),
        ]
        middle = [self.pad_radii[0] + share * (self.pad_radii[1] - self.pad_radii[0]) for share in (0.25, 0.75)]
        return st.AxisymmetricBody(
            st.RectangleProfile(boxes),
            IRON,
            cutoff=8e3,
            held="hat.inner",
            damping=0.002,
            residual_at=[(radius, side * half) for radius in middle for side in (-1.0, 1.0)],
            axis=(0.0, 1.0, 0.0),
            turning=self.turning,
            name="disc",
        )

    def pad(self, side: float, name: str) -> st.SolidBody:
        """The pad above (side 1) or below (side -1) the disc: lining first, then the plate."""
        angle, height = 0.5 * self.pad_angle, self.lining + self.plate
        mesh = st.SolidMesh.sector(self.pad_radii, (-angle, angle), height, (2, 4, 2), axis="y")
        level = mesh.nodes[:, 1]
        # Two layers of elements: the nodes between them lie at the face of the plate.
        level = np.interp(level, [0.0, 0.5 * height, height], [0.0, self.lining, height]) + 0.5 * self.thickness
        middle = mesh.nodes[mesh.elements, 1].mean(axis=1)
        parts = {"lining": np.flatnonzero(middle < 0.5 * height), "plate": np.flatnonzero(middle > 0.5 * height)}
        nodes = np.column_stack([mesh.nodes[:, 0], level, mesh.nodes[:, 2]]) * [side, side, 1.0]
        mesh = replace(mesh, nodes=nodes, volumes=parts)
        materials = {"lining": LINING, "plate": STEEL}
        return st.SolidBody(mesh, materials, cutoff=8e3, damping=0.02, contact_faces={"bottom": 24}, name=name)

    @property
    def system(self) -> st.System:
        """The brake, its pads held by springs at both ends."""
        disc, faces, drives, springs = self.disc, [], [], []
        for side, name in ((1.0, "upper"), (-1.0, "lower")):
            pad = self.pad(side, f"{name} pad")
            laws = {"friction": st.Coulomb(self.friction), "stiffness": st.LinearStiffness(3e11, damping=3e6)}
            faces.append(st.SurfaceContact(pad, "bottom", disc, **laws, name=f"{name} lining"))
            drives.append(st.Force(pad.at("top"), y=-side * self.load))
            springs += [
                st.Spring(pad.at(end), stiffness=2e7, direction=way) for end in ("start", "end") for way in ("x", "z")
            ]
            springs.append(st.Spring(pad.at("top"), stiffness=1e6, direction="y"))
        return st.System(faces, drives, springs)


# Modes well below the cutoffs.
HIGHEST = 6e3


def growing(brake: Brake) -> list[tuple[float, float]]:
    """Frequency [Hz] and growth [1/s] of the growing modes, by frequency."""
    theory = st.sliding_stability(brake.system)
    found = zip(theory.frequency.values[theory.unstable], theory.growth_rate.values[theory.unstable], strict=True)
    return sorted((float(hertz), float(rate)) for hertz, rate in found if hertz < HIGHEST)


usual = Brake()
plot.save(plot.system(usual.system), "brake-dimensions.png")

SWEEPS = {
    "thickness of the disc [mm]": [(1e3 * d, replace(usual, thickness=d)) for d in np.linspace(0.016, 0.026, 6)],
    "angle of the pads [deg]": [(a, replace(usual, pad_angle=np.radians(a))) for a in np.linspace(36.0, 56.0, 6)],
}
found = {words: [(value, growing(brake)) for value, brake in points] for words, points in SWEEPS.items()}
for words, points in found.items():
    print(words)
    for value, modes in points:
        print(f"  {value:.0f}:", ", ".join(f"{hertz:.0f} Hz by {rate:.0f} /s" for hertz, rate in modes) or "none grows")

figure, panels = plt.subplots(1, 2, figsize=(10.0, 3.8), sharey=True, layout="constrained")
for panel, (words, points) in zip(panels, found.items(), strict=True):
    for value, modes in points:
        if modes:
            hertz, rates = np.array(modes).T
            dots = panel.scatter(
                np.full(hertz.size, value), hertz / 1e3, c=rates, vmin=0.0, vmax=150.0, cmap="viridis_r"
            )
        else:
            panel.plot(value, 0.0, "x", color="0.5")
    panel.set(xlabel=words, ylim=(0.0, 1e-3 * HIGHEST))
panels[0].set(ylabel="frequency of growing modes [kHz]")
figure.colorbar(dots, ax=panels, label="growth [1/s]")
figure.savefig("brake_dimensions.png", dpi=110)
