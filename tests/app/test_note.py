"""The note of a tone, and the mode of linear theory that it may be."""

from __future__ import annotations

import pytest

from .scripting import result_of

NOTES = """import { noteOf } from "./note.js";
result = given.map((frequency) => { const { name, cents } = noteOf(frequency); return [name, cents]; });"""
MODES = """import { modeOf } from "./note.js";
const those = (modes) => modes.map((frequency) => ({ frequency }));
result = given.map(([frequency, modes]) => modeOf(frequency, those(modes))?.frequency ?? null);"""
READING = """import { reading } from "./note.js";
const those = (modes) => modes.map((frequency) => ({ frequency }));
result = given.map(([frequency, modes]) => reading(frequency, those(modes)));"""
NAMES = ["C", "C♯", "D", "D♯", "E", "F", "F♯", "G", "G♯", "A", "A♯", "B"]


def test_known_notes_have_their_names(tmp_path):
    known = {440.0: "A4", 261.6256: "C4", 195.9977: "G3", 27.5: "A0", 4186.009: "C8", 2959.955: "F♯7", 30.86771: "B0"}
    assert result_of(tmp_path, NOTES, list(known)) == [[name, 0] for name in known.values()]


def test_every_key_of_a_piano_is_named_and_cents_say_how_far_off(tmp_path):
    keys = range(21, 109)
    given = [440.0 * 2.0 ** ((key - 69 + cents / 100) / 12) for key in keys for cents in (-37, 0, 12)]
    found = result_of(tmp_path, NOTES, given)
    assert found == [[f"{NAMES[key % 12]}{key // 12 - 1}", cents] for key in keys for cents in (-37, 0, 12)]


def test_a_tone_belongs_to_the_nearest_mode_within_five_percent(tmp_path):
    modes = [320.0, 2900.0, 3000.0]
    given = [
        [323.0, modes],
        [2951.0, modes],
        [2940.0, modes],
        [900.0, modes],
        [304.1, modes],
        [303.0, modes],
        [1.0, []],
    ]
    assert result_of(tmp_path, MODES, given) == [320.0, 3000.0, 2900.0, None, 320.0, None, None]


@pytest.mark.parametrize("none", [0, None, -3.0])
def test_no_tone_means_no_note(tmp_path, none):
    assert result_of(tmp_path, READING, [[none, [100.0]]]) == [{"note": "", "mode": ""}]


def test_note_and_mode_are_written(tmp_path):
    given = [[440.0, []], [2950.0, []], [2980.0, [2930.0]], [322.0, [320.0]]]
    assert [(one["note"], one["mode"]) for one in result_of(tmp_path, READING, given)] == [
        ("A4", ""),
        ("F♯7 −6 cents", ""),
        ("F♯7 +12 cents", "near the growing mode at 2.93 kHz"),
        ("E4 −41 cents", "near the growing mode at 320 Hz"),
    ]
