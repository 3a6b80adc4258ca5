"""Sound of a track part by part against that of the whole record."""

import itertools

import numpy as np
import pytest

import stridula as st
from stridula.acoustics.streamed import StreamedSound

RATE = 48e3


@pytest.mark.parametrize(("case", "listener"), [("squeal", (0.2, 0.1, 1.0)), ("squeal", (0.3, 0.0, 0.02))])
def test_it_is_the_sound_of_the_record(case, listener):
    scenario = st.load_scenario(case)
    run = scenario.simulate(duration=0.05, sample_rate=RATE)
    whole = st.radiate(run, scenario.system.track, listener).values[:, 0]
    sound = StreamedSound(scenario.system.track, listener, 1.0 / RATE, run.attrs["steps_per_sample"])
    place = run.contact_position.values
    middle = (np.concatenate([place[:1], place[:-1]]) + place) / 2.0
    force = run.normal_force.values
    cuts = np.cumsum([0, 480, 1, 7, 952, 480, 10, len(force)]).clip(max=len(force))
    parts = [sound.feed(force[low:high], middle[low:high]) for low, high in itertools.pairwise(cuts)]
    heard = np.concatenate(parts)[sound.delay :]
    # Before arrival, the sound of the record is silent and the streamed one has the pre-ringing of the low-pass; at the
    # end of the record the filters of the two depend on different samples beyond.
    first = int(np.flatnonzero(whole)[0])
    inner = slice(first, len(heard) - 100)
    assert np.abs(heard[inner] - whole[inner]).max() < 1e-9 * np.abs(whole).max()
    assert np.abs(heard[:first]).max() < 1e-4 * np.abs(whole).max()
    assert (sound.delay > 0) == (listener[2] < 0.1)


def test_a_listener_in_the_surface_is_refused():
    track = st.load_scenario("squeal").system.track
    with pytest.raises(ValueError, match="listener must be in front of the baffle"):
        StreamedSound(track, (0.2, 0.0, 0.0), 1.0 / RATE, 4)
