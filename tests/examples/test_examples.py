"""Every example runs, and at least one number of its output is checked; the README shows the shortest one."""

from __future__ import annotations

import re
import runpy
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stridula as st
from stridula import analysis

from .growing import unstable_frequencies
from .pages import EXAMPLES, ROOT, blocks, output_shown


def check_ten_lines(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """The limit cycle grows out of an unstable mode of sliding, and the contact carries the load.

    Six modes of sliding are unstable, of which the one at 2.80 kHz grows fast and lies low. Its limit cycle opens the
    contact for part of each period, which lowers its frequency by a few percent; the modes next to it are 50 % away
    and more, so 5 % leaves no doubt which one it is. Two periods of the mode differ, and the pitch is that of their
    pair: half of its frequency.

    The root is free along y, so the mean normal force differs from 50 N by the slider's change of momentum over 1 s.
    While the tip sticks the force swings by 42 N about its mean at some 18 Hz, and the momentum by 42 N / (2 pi 18 Hz)
    = 0.4 N s: 0.8 % of 50 N s.
    """
    squeal, force = (
        float(number) for number in re.search(r"squeals at (\S+) Hz .* force of (\S+) N", printed).groups()
    )
    modes = unstable_frequencies(names["system"], sense=1.0)
    assert 2.0 * squeal == pytest.approx(modes[np.abs(modes - 2800.0) < 500.0].item(), rel=0.05)
    assert force == pytest.approx(50.0, rel=0.008)
    assert (folder / "squeal.png").read_bytes().startswith(b"\x89PNG")
    # Negative control: with little friction no mode is unstable, so there would be nothing to match.
    contact = replace(names["contact"], friction=type(names["contact"].friction)(0.3))
    assert unstable_frequencies(replace(names["system"], contact=contact), sense=1.0).size == 0


def check_stick_on_a_plate(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """It squeals, and at 2 m it is quieter in every direction than a metre above."""
    assert printed.startswith("squeal; plate with ")
    assert names["heard"].sizes["listener"] == 2
    near, levels = float(st.equivalent_level(names["heard"], "A").max()), names["levels"]
    assert levels.size == 11
    assert levels.max() < near
    assert (folder / "directivity.png").read_bytes().startswith(b"\x89PNG")


def check_mass_on_a_belt(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """Stick-slip between constant coefficients has a closed form; a law between them gives no smaller swing.

    With ``D = (static - kinetic) N / k`` and ``w = sqrt(k / m)`` the mass swings by ``sqrt(D² + (v / w)²)`` each way
    and sticks for ``2 D / v`` of the period; with 1000 samples a second an instant is known to 1 ms.
    """
    swings = {name: float(swing) for name, swing in re.findall(r"^(.+): swings over (\S+) m", printed, re.MULTILINE)}
    jump, rate, speed = (0.4 - 0.25) * 10.0 / 4.0, 2.0, 0.5
    assert swings["static and kinetic"] == pytest.approx(2.0 * np.hypot(jump, speed / rate), abs=2 * speed * 1e-3)
    assert swings["Coulomb"] == pytest.approx(2.0 * speed / rate, abs=2 * speed * 1e-3)
    assert min(swings["Stribeck"], swings["LuGre"]) > swings["static and kinetic"]
    slip, stick = (2 / rate) * (np.pi - np.arctan(jump * rate / speed)), 2 * jump / speed
    shares = re.search(r"static and kinetic: .* sticks (\d+) %", printed)
    # 20 s hold five and a half periods, which may begin and end anywhere in one.
    assert float(shares[1]) / 100 == pytest.approx(stick / (slip + stick), abs=0.5 / 5.5)
    assert len(list(folder.glob("*.png"))) == len(names["laws"])


def check_cut_off_modes(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """Static flexibility of modes left out restores equilibrium and squeal of the block, and harms a slender beam."""
    forces, frequency, growth = names["truth"]
    for (cutoff, static), (pressed, squeal, grows) in names["found"].items():
        near = np.abs(pressed - forces).max() < 1e-9 * forces.max()
        assert near == static, cutoff
        # The error is the inertia of these modes, (squeal / cutoff)² of their flexibility.
        assert (abs(squeal / frequency - 1.0) < 0.02 and abs(grows / growth - 1.0) < 0.05) == static, cutoff
    lines = re.findall(r"judder, modes beyond (\S+) kHz (.+): off the track (\S+) \+- (\S+)", printed)
    shares = {(float(cutoff), words): (float(share), float(half)) for cutoff, words, share, half in lines}
    settled = shares[60.0, "left out"][0]
    harm = {cutoff: shares[cutoff, "yielding statically"][0] - settled for cutoff in (7.5, 60.0)}
    assert 0.0 < harm[60.0] < 2.0 / 3.0 * harm[7.5]
    assert abs(shares[7.5, "left out"][0] - settled) < 0.5 * harm[7.5] + 0.02
    assert (folder / "cut-off-modes.png").read_bytes().startswith(b"\x89PNG")


def check_brake_shim(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """A stiffness alone does not silence the brake, a loss does; the run of the silent one decays."""
    rate = float(re.search(r"without a shim: (\d+) /s", printed)[1])
    assert rate == pytest.approx(102.0, rel=0.02)
    for modes in names["found"].values():
        growths = [growth for growth, _ in modes]
        assert growths[0] == max(growths) > 0.5
        assert growths[-1] < 0.0
    loud, quiet = (np.abs(names[run].velocity.values[:, 0]) for run in ("loud", "quiet"))
    assert loud[-500:].max() > 2.0 * loud[-1400:-900].max()
    assert quiet[-500:].max() < 0.9 * quiet[:500].max()
    assert (folder / "brake_shim.png").read_bytes().startswith(b"\x89PNG")


def check_brake_judder(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """The torque varies at twice the speed, and the axle shakes after its resonance was passed."""
    torque, time, speed = names["torque"]["15 µm"], names["time"], names["speed"]
    steady = names["torque"]["0 µm"]
    assert np.ptp(steady) < 0.02 * steady.mean()
    assert np.ptp(torque) > 0.2 * steady.mean()
    # The pad touches highest where the flat disc would be.
    assert torque.max() < 1.01 * steady.mean()
    rises = np.flatnonzero((torque[:-1] < np.median(torque)) & (torque[1:] >= np.median(torque)))
    turned = np.trapezoid(speed[rises[0] : rises[-1]], time[rises[0] : rises[-1]])
    assert turned / np.pi == pytest.approx(rises.size - 1, abs=0.1)
    own = 0.5 * np.sqrt(names["AXLE"] / names["AXLE_MASS"])
    assert 0.8 * own < names["worst"] < own
    assert "thick places a second" in printed


def check_vented_disc(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """A solid disc is the same at every angle; a vented one repeats with its vanes, and grows between some only."""
    solid, vented = names["worst"]["solid"], names["worst"]["vented"]
    assert np.ptp(solid) < 0.1 * solid.mean()
    assert solid.min() > 0.0
    assert 0.1 < np.mean(vented > 0.0) < 0.5
    turn = vented.size // 2
    np.testing.assert_allclose(vented[[0, -1]], vented[turn], rtol=0.05)
    lost = names["solid"].volume.sum() - names["vented"].volume.sum()
    ring = np.pi * (names["RIM"] ** 2 - names["BORE"] ** 2) * names["THICK"]
    assert lost == pytest.approx(ring / 6.0, rel=0.02)
    assert "solid: at most" in printed


def check_wheel_ring(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """A heavier ring leaves less growth; runs grow and decay as linear theory says."""
    growths = [float(growth) for growth in re.findall(r"kg: (\S+) /s", printed)]
    assert growths[0] == pytest.approx(42.1, rel=0.02)
    assert growths == sorted(growths, reverse=True)
    assert growths[-1] < 0.0 < growths[-2]
    for name, growth, span in (("without a ring", growths[0], slice(20, 40)), ("40 mm", growths[-1], slice(50, 100))):
        seen = np.polyfit(3e-3 * np.arange(100)[span], np.log(names["peaks"][name][span]), 1)[0]
        assert seen == pytest.approx(growth, rel=0.1), name
    assert (folder / "wheel-ring.png").read_bytes().startswith(b"\x89PNG")


def check_brake_pad(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """More friction lets modes of disc and pad grow; the ledger closes, and forces are about those of theory."""
    growing = re.findall(r"^friction (\S+): .*growing modes \[Hz\]: (.+)$", printed, re.MULTILINE)
    assert [friction for friction, _ in growing] == ["0.2", "0.4", "0.6"]
    assert growing[0][1] == "none"
    assert growing[2][1] != "none"
    run, system = names["run"], names["system"]
    assert len(system.contacts) == 15
    largest = max(float(np.abs(run[term]).max()) for term in ("drive_work", "contact_work", "kinetic_and_elastic"))
    assert float(np.abs(run.ledger_residual).max()) < 1e-11 * largest
    assert 0.0 < float(run.friction_loss[-1]) < 1.01 * float(run.drive_work[-1])
    # Less than 600 N: springs carry some. On average the momentum of the pad does not change.
    pressed = float(names["theory"].normal_force.sum())
    assert 500.0 < pressed < 600.0
    assert float(run.normal_force.sum("contact").mean()) == pytest.approx(pressed, rel=0.05)
    again = names["st"].load_scenario(run).simulate()
    np.testing.assert_array_equal(again.normal_force, run.normal_force)
    assert (folder / "brake-pad.png").read_bytes().startswith(b"\x89PNG")


def check_brake(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """More friction lets modes grow, the fastest one dominates the run, and both pads carry their load."""
    growing = re.findall(r"^friction (\S+): sliding, growing below 7 kHz: (.+)$", printed, re.MULTILINE)
    assert [friction for friction, _ in growing] == ["0.3", "0.5"]
    assert growing[0][1] == "none"
    assert growing[1][1] != "none"
    run, found = names["run"], names["found"]
    # The squeal is chaotic: rounding in the modes decides whether a step in some ten thousand misses the tolerance.
    assert int(run.unsolved_steps.sum()) <= 2
    largest = max(float(np.abs(run[term]).max()) for term in ("drive_work", "contact_work", "kinetic_and_elastic"))
    assert float(np.abs(run.ledger_residual).max()) < 1e-11 * largest
    early, late = (float(np.abs(run.velocity[part]).max()) for part in (slice(None, 50), slice(-500, None)))
    assert late > 100.0 * early
    for one, side in zip(found, (1.0, -1.0), strict=True):
        # Squeal lifts the pads by 30 to 60 um on average; springs of 2 MN/m pull them back by some 100 N.
        assert side * float(one.force.sel(axis="y").mean()) == pytest.approx(2000.0, rel=0.1)
        assert float(one.closed_area.max()) <= float(one.area.sum()) * (1.0 + 1e-12)
    assert (folder / "brake.png").read_bytes().startswith(b"\x89PNG")


def check_brake_dimensions(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """With its usual dimensions it is the shipped brake, with fewer points; a thicker disc has higher modes."""
    shipped = st.sliding_stability(st.load_scenario("brake").system)
    slowest = float(shipped.frequency[shipped.unstable].min())
    thicknesses, angles = names["found"].values()
    usual = dict(thicknesses)[20.0]
    assert [hertz for hertz, _ in usual] == pytest.approx([slowest], rel=2e-3)
    lowest = [modes[0][0] for _, modes in thicknesses]
    assert (np.diff(lowest) > 100.0).all()
    assert len(angles) == 6
    assert printed.count(" Hz by ") == sum(len(modes) for _, modes in (*thicknesses, *angles))
    for name in ("brake-dimensions.png", "brake_dimensions.png"):
        assert (folder / name).read_bytes().startswith(b"\x89PNG")


def check_brake_loop(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """A small mass silences the brake, no smaller one does, and in time it decays as fast as by linear theory.

    A start within linear theory differs from it by what travel and the step do to a frequency of 2.8 kHz, some 1e-6 of
    its 18 000 rad/s, and by friction that follows the slip: 0.2 % of the growth and 0.1 /s.
    """
    least, most = names["least"], names["LARGEST"]
    assert 0.02 < least < 0.06
    assert bool(names["found"].found)
    assert float(names["found"].growth_rate.max()) <= -1.0
    lighter = names["with_mass"](least - 0.01 * most)
    assert float(st.sliding_stability(lighter).growth_rate.max()) > -1.0
    assert all(rate > 100.0 for rate in names["growth"]["middle"])
    rates = names["rates"]
    assert len(rates) == 4
    for (mass, _), (by_theory, in_time) in rates.items():
        assert (in_time > 0.0) == (mass == 0.0)
        assert in_time == pytest.approx(by_theory, rel=2e-3, abs=0.1)
    assert [float(one) for one in re.findall(r"in time (\S+) /s", printed)] == pytest.approx(
        [one for _, one in rates.values()], abs=0.01
    )
    page = (folder / "brake-loop.html").read_text(encoding="utf-8")
    assert page == names["page"].html
    assert page.count("growth in time") >= 1
    assert names["page"].titles == ("Brake as it is", f"Brake with {1e3 * least:.0f} g on its upper pad")
    for name in ("growth", "time"):
        assert (folder / f"brake-loop-{name}.png").read_bytes().startswith(b"\x89PNG")


def check_pin_on_disc(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """One mode grows, in one sense of turning, near the published 2215 Hz; in time it grows as in theory.

    The frequency is compared with its limit for high cutoffs, 2273 Hz, 2.6 % above the published one.
    """
    found = names["found"]
    assert {friction: len(modes) for friction, modes in found.items()} == {0.05: 0, 0.1: 1, 0.152: 1, 0.2: 1, 0.3: 1}
    frequency, growth = found[0.152][0]
    assert frequency == pytest.approx(2273.0, rel=2e-3)
    assert growth == pytest.approx(431.0, rel=0.02)
    assert not names["backwards"]
    # A prototype with other elements, a Craig-Bampton pin and null spaces gives 2268.7 Hz.
    assert frequency == pytest.approx(2268.7, rel=5e-3)
    run = names["run"]
    motion = run.velocity.values[:, 0]
    early = [np.abs(motion[(run.time.values > t) & (run.time.values < t + 1e-3)]).max() for t in (0.010, 0.016)]
    assert np.log(early[1] / early[0]) / 0.006 == pytest.approx(names["growth"], rel=0.05)
    # It grows until the edge moves as fast as the disc slides under it.
    assert 1.0 < np.abs(names["late"]).max() < 10.0
    assert abs(names["cycle"] / frequency - 1.0) < 0.05
    assert float(run.status_share.mean("time").sel(contact_status="separated").max()) > 0.3
    assert (folder / "pin-on-disc.png").read_bytes().startswith(b"\x89PNG")


def check_wine_glass(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """It sings just below the mode of two waves, which stands in space and beats at a point of the glass."""
    mode = float(re.search(r"2 waves: (\d+) Hz", printed)[1])
    assert 0.995 * mode < names["tone"] < mode + 0.5
    assert 0.1 < -float(names["onset"].value) < 0.12
    seen, still = (names["sizes"][word][names["rubbed"]] for word in ("glass", "space"))
    assert seen.min() < 0.05 * seen.max()
    assert still.min() > 0.95 * still.max()
    assert (folder / "glass.png").read_bytes().startswith(b"\x89PNG")


def check_railway_wheel(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """Each axial pair grows once standing, twice rolling; a wave against the turning squeals below its mode."""
    rows = re.findall(r"^\d nodal diameters: (\d+) Hz; standing (.+); rolling (.+)$", printed, re.MULTILINE)
    assert [(one.count("Hz"), two.count("Hz")) for _, one, two in rows] == [(1, 2)] * 4
    assert 0.96 * float(rows[0][0]) < names["tone"] < float(rows[0][0])
    assert names["back"] > 3.0 * names["ahead"]
    assert (folder / "wheel.png").read_bytes().startswith(b"\x89PNG")


def check_violin(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """Slips as in theory; Schelleng's maximal force to within a step of the forces, and one half more."""
    assert printed.startswith("Helmholtz motion at 195.1 Hz")
    assert names["slip"] == pytest.approx(-0.2 * 0.88 / 0.12, rel=0.03)
    step = float(names["SHARES"][1] / names["SHARES"][0])
    assert all(1.0 / step < highest < 1.5 for highest in names["highest"])
    assert names["right"] >= 0.95 * len(names["helmholtz"])
    assert names["right"] >= 0.75 * len(names["between"])
    # The wedge closes towards the bridge.
    columns = zip(names["PLACES"], names["highest"], names["lowest"], strict=True)
    width = [high * names["most"](place) / (low * names["least"](place)) for place, high, low in columns]
    assert width[0] < 0.5 * width[-1]
    back = st.read_wav(folder / "violin.wav")
    assert analysis.dominant_frequency(back[24_000:, 0]) == pytest.approx(195.1, abs=1.0)
    assert (folder / "violin.png").read_bytes().startswith(b"\x89PNG")


def check_lining(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """It squeals in the stop where the friction of its temperature exceeds that at which two modes couple.

    Stiffness of sliding and damping, to which friction that falls with the speed adds, as one matrix of first order.
    """
    unit, angles = names["UNIT"], np.radians([150.0, 30.0])
    ways = np.stack([np.cos(angles), np.sin(angles)])
    grounded = ways @ np.diag([11.0, 20.0]) @ ways.T

    def grows(temperature: float) -> bool:
        law, speed = names["lining"].at(temperature), names["SPEED"]
        mu, slope = float(law.coefficient_at(speed)), law.linearised_at(speed).slope
        stiffness = unit * (grounded + 11.0 * np.array([[0.0, -mu], [0.0, 1.0]]))
        normal = -11.0 * unit * np.linalg.solve(stiffness, [0.0, -names["LOAD"]])[1]
        damping = 30.0 * np.eye(2) + np.diag([slope * normal, 0.0])
        state = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -damping]])
        return bool(np.linalg.eigvals(state).real.max() > 0.0)

    np.testing.assert_array_equal(names["growth"] > 0.0, [grows(one) for one in names["temperatures"]])
    first, last = (float(one) for one in re.search(r"from (\S+) to (\S+) degC", printed).groups())
    for begin, end, celsius, regime in re.findall(r"(\S+) to (\S+) s, (\S+) degC: (.+)", printed):
        assert (regime == "squeal") == (first < float(celsius) < last), (begin, end)
    assert printed.count("squeal") == 1
    assert (folder / "stop.png").read_bytes().startswith(b"\x89PNG")


# One check for every example: it takes the example's names, what it printed and the folder it ran in.
CHECKS: dict[str, Callable[[Mapping[str, Any], str, Path], None]] = {
    "brake.py": check_brake,
    "brake_dimensions.py": check_brake_dimensions,
    "brake_loop.py": check_brake_loop,
    "brake_pad.py": check_brake_pad,
    "brake_shim.py": check_brake_shim,
    "cut_off_modes.py": check_cut_off_modes,
    "lining.py": check_lining,
    "mass_on_a_belt.py": check_mass_on_a_belt,
    "pin_on_disc.py": check_pin_on_disc,
    "railway_wheel.py": check_railway_wheel,
    "stick_on_a_plate.py": check_stick_on_a_plate,
    "ten_lines.py": check_ten_lines,
    "violin.py": check_violin,
    "brake_judder.py": check_brake_judder,
    "vented_disc.py": check_vented_disc,
    "wheel_ring.py": check_wheel_ring,
    "wine_glass.py": check_wine_glass,
}


def test_every_example_has_a_check():
    assert [path.name for path in EXAMPLES] == sorted(CHECKS)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_example(path, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names = runpy.run_path(str(path), run_name="__main__")
    printed = capsys.readouterr().out
    CHECKS[path.name](names, printed, tmp_path)
    assert all(printed.strip() == text.strip() for text in output_shown(path))


def test_output_that_pages_show_is_found():
    (text,) = output_shown(ROOT / "examples" / "brake.py")
    assert text.startswith("friction 0.3: sliding")


def test_the_readme_shows_the_ten_lines():
    _, _, ten_lines = (ROOT / "examples" / "ten_lines.py").read_text(encoding="utf-8").rpartition('"""\n\n')
    assert ("python", ten_lines) in blocks(ROOT / "README.md", "python")
