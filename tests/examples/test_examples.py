"""Every example runs, and one number of its output is what it must be; the README shows the shortest one."""

from __future__ import annotations

import re
import runpy
import textwrap
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.linalg

import stridula as st

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))


def unstable_frequencies(system: Any, sense: float) -> np.ndarray:
    """Return the frequencies [Hz] of the modes that grow when small motion is added to steady sliding.

    No time march: with the rows ``N q = 0`` (contact stays closed) and forces along ``N - sense mu T``, the free motion
    lies in the null space Z of N and is tested with the null space Y of ``N - sense mu T``; eigenvalues of
    ``Y' (s² + s C + K) Z``, unsymmetric.
    """
    slider, track, contact = system.slider, system.track, system.contact
    parts = slider.modes(held_x=True), track.modes()
    angular = np.concatenate([part.angular_frequency for part in parts])
    damping = np.concatenate([part.damping for part in parts])
    tip, below = slider.trace(0.0, held_x=True), track.trace(contact.at)
    tangent, normal = np.concatenate([tip, -below], axis=1)
    z = scipy.linalg.null_space(normal[None])
    y = scipy.linalg.null_space((normal - sense * contact.friction.coefficient * tangent)[None])
    mass, loss, stiffness = (y.T @ (d[:, None] * z) for d in (angular**0, 2 * damping * angular, angular**2))
    zero, one = np.zeros_like(mass), np.eye(len(mass))
    matrix = np.block([[zero, one], [-scipy.linalg.solve(mass, stiffness), -scipy.linalg.solve(mass, loss)]])
    roots = scipy.linalg.eigvals(matrix)
    return roots[(roots.real > 1.0) & (roots.imag > 0.0)].imag / (2.0 * np.pi)


def check_ten_lines(names: Mapping[str, Any], printed: str, folder: Path) -> None:
    """The limit cycle grows out of an unstable mode of sliding, and the contact carries the load.

    Six modes of sliding are unstable, of which the one at 2.80 kHz grows fast and lies low. Its limit cycle opens the
    contact for part of each period, which lowers its frequency by a few percent; the modes next to it are 50 % away
    and more, so 5 % leaves no doubt which one it is.

    The root is free along y, so the mean normal force differs from 50 N by the slider's change of momentum over 1 s.
    While the tip sticks the force swings by 42 N about its mean at some 18 Hz, and the momentum by 42 N / (2 pi 18 Hz)
    = 0.4 N s: 0.8 % of 50 N s.
    """
    squeal, force = (
        float(number) for number in re.search(r"squeals at (\S+) Hz .* force of (\S+) N", printed).groups()
    )
    modes = unstable_frequencies(names["system"], sense=1.0)
    assert squeal == pytest.approx(modes[np.abs(modes - 2800.0) < 500.0].item(), rel=0.05)
    assert force == pytest.approx(50.0, rel=0.008)
    assert (folder / "squeal.png").read_bytes().startswith(b"\x89PNG")
    # Negative control: with little friction no mode is unstable, so there would be nothing to match.
    contact = replace(names["contact"], friction=type(names["contact"].friction)(0.3))
    assert unstable_frequencies(replace(names["system"], contact=contact), sense=1.0).size == 0


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


# One check for every example: it takes the example's names, what it printed and the folder it ran in.
CHECKS: dict[str, Callable[[Mapping[str, Any], str, Path], None]] = {
    "mass_on_a_belt.py": check_mass_on_a_belt,
    "ten_lines.py": check_ten_lines,
}


def test_every_example_has_a_check():
    assert [path.name for path in EXAMPLES] == sorted(CHECKS)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_example(path, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names = runpy.run_path(str(path), run_name="__main__")
    CHECKS[path.name](names, capsys.readouterr().out, tmp_path)


def test_what_the_start_page_shows_of_other_systems_runs(tmp_path, monkeypatch):
    """A mass on a belt, a body from a file against a wall, an ensemble, a sweep: the code of the page, as it stands."""
    page = (ROOT / "docs" / "start.rst").read_text(encoding="utf-8")
    section = page.partition("Other bodies, other tracks\n")[2].partition("\nRead a record\n")[0]
    blocks = [textwrap.dedent(b) for b in re.findall(r"code-block:: python\n\n((?: {3}.*\n|\n)+)", section)]
    assert len(blocks) == 5
    monkeypatch.chdir(tmp_path)
    stiffness = np.kron([[1e6, -1e6], [-1e6, 1.1e6]], np.eye(2))
    st.ReducedBody(0.1 * np.eye(4), stiffness, {"tip": (0, 1), "back": (2, 3)}).save("pad.npz")
    names: dict[str, Any] = {}
    for block in blocks:
        exec(block, names)
    run = names["run"]
    # The wall and the spring of 0.1 MN/m together hold the drag: at least the kinetic and at most the static friction.
    reach = 1e5 * 1e-4
    assert 0.3 * 200.0 - reach < float(run.normal_force.sel(contact="stop").sel(time=slice(0.02, None)).mean())
    assert 0.0 < names["found"].sliding_mean <= 1.0
    assert names["swept"].sizes == {"friction": 3, "angle": 3}
    assert len(names["shares"]) == 20
    assert names["shares"][0] > names["shares"][-1]


def test_what_the_stability_page_prints(capsys):
    page = (ROOT / "docs" / "stability.rst").read_text(encoding="utf-8")
    code, printed = (
        textwrap.dedent(re.search(rf"code-block:: {kind}\n\n((?: {{3}}.*\n|\n)+)", page)[1])
        for kind in ("python", "text")
    )
    exec(code, {})
    assert capsys.readouterr().out.strip() == printed.strip()


def test_what_the_page_of_maps_shows_runs(tmp_path, monkeypatch):
    page = (ROOT / "docs" / "maps.rst").read_text(encoding="utf-8")
    blocks = [textwrap.dedent(b) for b in re.findall(r"code-block:: python\n\n((?: {3}.*\n|\n)+)", page)]
    assert len(blocks) == 4
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for block in blocks:
        exec(block, names)
    assert 0.635 < float(names["onset"].value) < 0.636
    assert int(names["counts"].compared) == 12
    assert names["best"].met.values.tolist() == [True, True]
    # The way of 50 ms falls by 3.7 mm a unit of friction, from 3.3 mm at 0.3.
    assert 0.35 < float(names["best"].friction) < 0.45
    assert float(names["shares"].probability.sum()) == pytest.approx(1.0)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["map.png", "root-loci.png"]


def test_what_the_readme_shows_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for block in shown_in_the_readme():
        exec(block, names)
    # The load, by the slope of the track that it bends, adds one.
    grows = unstable_frequencies(names["system"], sense=1.0).size + 1
    assert f"\n{grows} modes grow\n" in capsys.readouterr().out
    assert len(names["forces"]) == 4
    back, heard = st.read_wav("squeal.wav"), names["heard"]
    assert back.sizes["listener"] == 2
    # The file ends at 24 kHz, where little of the sound is left.
    assert float((back**2).mean()) == pytest.approx(float((heard**2).mean()), rel=0.05)


def shown_in_the_readme() -> list[str]:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```$", readme, flags=re.DOTALL | re.MULTILINE)


def test_the_readme_shows_the_ten_lines():
    blocks = shown_in_the_readme()
    assert (ROOT / "examples" / "ten_lines.py").read_text(encoding="utf-8") in blocks
