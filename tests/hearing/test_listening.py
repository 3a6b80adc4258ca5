"""Sound in notebooks: the player holds the sound itself."""

from __future__ import annotations

import base64
import io
import re
from html.parser import HTMLParser

import numpy as np
import pytest
import soundfile

import stridula as st

from .sounds import heard, tone


class Players(HTMLParser):
    """Attributes of the players in a page."""

    def __init__(self, page):
        super().__init__()
        self.found = []
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        if tag == "audio":
            self.found.append(dict(attrs))


def played(sound):
    """Return the samples that the player of a sound holds, over full scale, their rate and their form."""
    (player,) = Players(sound._repr_html_()).found
    assert "controls" in player
    kind, content = player["src"].split(",", 1)
    assert kind == "data:audio/wav;base64"
    with soundfile.SoundFile(io.BytesIO(base64.b64decode(content, validate=True))) as file:
        return file.read(always_2d=True), file.samplerate, file.subtype


@pytest.mark.parametrize(("subtype", "step"), [("PCM_16", 2.0**-15), ("PCM_24", 2.0**-23)])
def test_a_player_holds_both_ears_in_their_order(subtype, step):
    given = heard(np.random.default_rng(0).uniform(-1.9, 1.9, (400, 2)))
    sound = st.listen(given, full_scale=2.0, subtype=subtype)
    samples, rate, form = played(sound)
    assert (rate, form) == (48000, subtype)
    assert np.abs(samples - given.values / 2.0).max() <= 0.5 * step * 1.0000001


def test_a_sound_is_brought_to_the_rate_and_the_peak_of_players():
    sound = st.listen(tone(level=40.0, rate=100e3, duration=0.1))
    samples, rate, _ = played(sound)
    assert (rate, samples.shape) == (48000, (4800, 1))
    assert np.abs(samples).max() == pytest.approx(10.0 ** (-1.0 / 20.0), abs=1e-4)


def test_a_player_plays_what_the_file_of_the_same_sound_holds(tmp_path):
    given = tone(level=70.0, rate=100e3, duration=0.05)
    st.write_wav(tmp_path / "a.wav", given)
    assert st.listen(given, subtype="PCM_24").wav == (tmp_path / "a.wav").read_bytes()


def test_the_summary_is_printed_and_shown_below_the_player():
    sound = st.listen(tone(level=100.0), full_scale=10.0)
    assert re.fullmatch(r"sound: 1 channel, 48 kHz, 1 s, peak as written .* full scale 10 Pa, calibrated", str(sound))
    assert str(sound) in sound._repr_html_()
    assert "wav=" not in repr(sound)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"full_scale": 1.0}, "full_scale must be at least 2.00007 Pa"),
        ({"full_scale": -1.0}, "full_scale must be"),
        ({"subtype": "FLOAT"}, "subtype must be one of PCM_16, PCM_24, got"),
        ({"sample_rate": 8000}, "sample_rate must be one of"),
    ],
)
def test_unplayable_sounds_are_refused(words, message):
    with pytest.raises(ValueError, match=message):
        st.listen(heard([0.0, 2.0, -1.0]), **words)


def test_other_objects_are_refused():
    with pytest.raises(ValueError, match="pressure must be a DataArray"):
        st.listen(np.zeros(5))
