"""The stated level of the moment of friction about the middle plane, against couples of normal forces."""

from __future__ import annotations

import re

import numpy as np
import pytest
import xarray as xr

import stridula as st

from .cases import STEEL

RATE, SAMPLES, PLACE = 100e3, 10000, (0.3, 0.1, 0.5)
APART = 1e-4
BEAM = st.ModalBeam(STEEL, st.Rectangle(0.03, 0.01), 0.6, bending_modes=14, damping=0.01)
ROUND = st.ModalBeam(STEEL, st.Circle(0.012), 0.5, bending_modes=10, damping=0.003)
PLATE = st.ModalPlate(STEEL, 0.004, 0.4, 0.3, bending_modes=(9, 7), damping=0.02)
NOTE = r"the moment of friction about the middle plane, (\S+) mm below, is not included: about (-?\d+) dB relative"


def half_depth(track) -> float:
    return 0.5 * (track.thickness if track is PLATE else track.section.depth)


def rubbing(seed: int, begin: float, end: float) -> xr.Dataset:
    """A record of a contact that moves along a track, with noise of several colours and a tone in both forces."""
    random, time = np.random.default_rng(seed), np.arange(1, SAMPLES + 1) / RATE
    forces = []
    for _ in range(2):
        spectrum = np.fft.rfft(random.standard_normal(SAMPLES))
        frequency = np.fft.rfftfreq(SAMPLES, 1.0 / RATE)
        colour = 1.0 / (1.0 + (frequency / random.uniform(500.0, 8e3)) ** 2)
        noise = np.fft.irfft(spectrum * colour, SAMPLES)
        tone = np.sin(2.0 * np.pi * random.uniform(300.0, 4e3) * time)
        forces.append(20.0 + noise / noise.std() + random.uniform(0.0, 2.0) * tone)
    data = {
        "normal_force": forces[0],
        "tangential_force": forces[1],
        "contact_position": np.linspace(begin, end, SAMPLES),
    }
    return xr.Dataset({name: ("time", value) for name, value in data.items()}, {"time": time})


def couples(run: xr.Dataset, arm: float) -> xr.Dataset:
    """The same record with the moment of friction as a pair of normal forces."""
    swing = run.tangential_force - run.tangential_force.mean()
    moved = [
        run.assign(
            contact_position=run.contact_position + side * APART, normal_force=-side * arm * swing / (2.0 * APART)
        )
        for side in (1.0, -1.0)
    ]
    return xr.concat(moved, "contact").assign_coords(contact=["ahead", "behind"]).drop_vars("tangential_force")


def effective(sound) -> float:
    return float(np.sqrt(np.mean(sound.values**2)))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    ("track", "baffled"),
    [(BEAM, True), (BEAM, False), (ROUND, False), (PLATE, True)],
    ids=["beam", "line", "round", "plate"],
)
def test_the_level_is_that_of_couples(track, baffled, seed):
    begin, end = np.random.default_rng(100 + seed).uniform(0.05, 0.25, 2)
    run = rubbing(seed, begin, end)
    heard = st.radiate(run, track, PLACE, baffled=baffled)
    known = effective(st.radiate(couples(run, half_depth(track)), track, PLACE, baffled=baffled))
    arm, level = re.search(NOTE, heard.attrs["notes"]).groups()
    assert float(arm) == pytest.approx(1e3 * half_depth(track))
    assert float(level) == pytest.approx(20.0 * np.log10(known / effective(heard)), abs=3.0)


def test_shipped_cases_state_it_for_their_track():
    scenario = st.load_scenario("squeal-on-plate", {"duration": "0.1 s"})
    run, track = scenario.simulate(), scenario.system.track
    known = effective(st.radiate(couples(run, half_depth_of := 0.5 * track.thickness), track, PLACE))
    for source, words in ((track, {}), (scenario.system, {"bodies": [track]})):
        heard = st.radiate(run, source, PLACE, **words)
        arm, level = re.search(NOTE, heard.attrs["notes"]).groups()
        assert float(arm) == pytest.approx(1e3 * half_depth_of)
        assert float(level) == pytest.approx(20.0 * np.log10(known / effective(heard)), abs=3.0)


def test_it_is_left_out_where_it_is_faint():
    run = rubbing(0, 0.1, 0.2)
    for faint in (run.assign(tangential_force=1e-3 * run.tangential_force), run.drop_vars("tangential_force")):
        assert "moment of friction" not in st.radiate(faint, BEAM, PLACE).attrs["notes"]
