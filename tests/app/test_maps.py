"""Maps of regimes around the played scenario."""

from __future__ import annotations

import asyncio
import json
import time
from contextlib import suppress

import numpy as np
import psutil
import pytest

import stridula as st
from stridula.analysis.regimes import REGIMES
from stridula.app.beside import Beside, InTurn
from stridula.app.maps import rows
from stridula.app.messages import Map
from stridula.app.playable import playable

from .conversation import Conversation

FRICTION, ANGLE = "contact.friction.coefficient", "slider.angle"
ACROSS, UP = {"key": FRICTION, "low": 0.2, "high": 1.6}, {"key": ANGLE, "low": 0.5, "high": 0.9}


def rows_of(talk: Conversation, **words) -> dict[int, list[str]]:
    """Return all rows of a map by number."""
    talk.others.clear()
    talk.say("map", revision=talk.revision, **words)
    done = talk.until("map done", "problem")
    assert done["type"] == "map done", done
    rows = [one for one in talk.others if isinstance(one, dict) and one["type"] == "map row"]
    assert {row["revision"] for row in (*rows, done)} == {talk.revision}
    assert len(rows) == len({row["row"] for row in rows})
    return {row["row"]: row["regimes"] for row in rows}


def test_a_map_has_every_row_and_agrees_with_a_sweep(talk):
    talk.scene("squeal")
    rows = rows_of(talk, x=ACROSS, y=UP, points=4)
    assert sorted(rows) == [0, 1, 2, 3]
    assert {len(row) for row in rows.values()} == {4}
    words = {word for row in rows.values() for word in row}
    assert words <= {*REGIMES, ""}
    assert len(words - {""}) > 1
    across = np.linspace(ACROSS["low"], ACROSS["high"], 4)
    # From the lowest to the highest.
    for row, angle in ((0, UP["low"]), (3, UP["high"])):
        points = [{FRICTION: float(value), ANGLE: angle} for value in across]
        swept = st.sweep("squeal", points, "regime", duration=1.0, probes=False, workers=1)
        assert rows[row] == [str(word) for word in swept.regime.values]


def test_playing_continues_beside_a_map_and_a_new_map_replaces_it(talk):
    talk.scene("squeal")
    talk.say("map", revision=talk.revision, x=ACROSS, y=UP, points=12)
    assert len(talk.play(480).sound) == 480
    talk.until("map row")
    rows = rows_of(talk, x={**ACROSS, "low": 0.3}, y=UP, points=2)
    assert sorted(rows) == [0, 1]
    assert {len(row) for row in rows.values()} == {2}


def test_an_unwanted_map_stops(talk):
    talk.scene("squeal")
    talk.say("map", revision=talk.revision, x=ACROSS, y=UP, points=12)
    talk.until("map row")
    talk.say("no map")
    talk.play(480)
    talk.others.clear()
    # Only the later map is sent.
    rows = rows_of(talk, x=ACROSS, y=UP, points=2)
    assert len(rows) == 2


@pytest.mark.parametrize("case", ["belt", "glass", "judder"])
def test_a_map_around_the_case_before_is_not_refused_but_forgotten(talk, case):
    """The page may ask for one before it knows that the next case plays."""
    talk.scene("squeal")
    before = talk.revision
    talk.scene(case)
    talk.others.clear()
    talk.say("map", revision=before, x=ACROSS, y=UP, points=2)
    assert len(talk.play(480).sound) == 480
    assert not [one for one in talk.others if isinstance(one, dict) and one["type"] in ("problem", "map row")]


def test_a_map_survives_changes_of_its_own_axes(talk):
    talk.scene("squeal")
    before = talk.revision
    talk.scene("squeal", {FRICTION: 0.7})
    talk.say("map", revision=before, x=ACROSS, y=UP, points=2)
    assert talk.until("map done", "problem") == {"type": "map done", "revision": before}


def test_a_held_map_keeps_its_rows_and_continues_with_the_next(talk):
    talk.scene("squeal")
    talk.say("map", revision=talk.revision, x=ACROSS, y=UP, points=4)
    talk.say("hold map", on=True)
    first = talk.until("map row")["row"]
    # The time of several rows once the code is compiled.
    began = time.monotonic()
    with suppress(TimeoutError):
        while time.monotonic() - began < 3.0:
            told = json.loads(talk.socket.recv(timeout=3.0))
            assert told["type"] not in ("map row", "map done")
    talk.others.clear()
    talk.say("hold map", on=False)
    talk.until("map done")
    rows = [one["row"] for one in talk.others if isinstance(one, dict) and one["type"] == "map row"]
    assert sorted([first, *rows]) == [0, 1, 2, 3]


def test_the_present_motion_does_not_wait_for_a_map(monkeypatch):
    asked = []

    async def stuck(self, what: str, **words) -> str:
        """Answer once nothing else is asked: a row of a map takes seconds, the first one longer."""
        asked.append(what)
        async with self._turn:
            await asyncio.sleep(3600.0 if what == "regimes" else 0.0)
        return what

    monkeypatch.setattr(InTurn, "ask", stuck)

    async def answers() -> tuple[str, bool]:
        beside = Beside()
        row = asyncio.create_task(beside.ask("regimes"))
        theory = asyncio.create_task(beside.ask("theory"))
        await asyncio.sleep(0)
        found = await asyncio.wait_for(beside.ask("now"), 10.0)
        done = theory.done()
        row.cancel()
        theory.cancel()
        return found, done

    # Linear theory waits for the row.
    assert asyncio.run(answers()) == ("now", False)
    assert asked == ["regimes", "theory", "now"]


@pytest.mark.parametrize("turns", range(4))
def test_a_map_cancelled_at_its_start_starts_no_process(turns):
    played = playable("squeal", None, {})
    wanted = Map.model_validate({"type": "map", "revision": 1, "x": ACROSS, "y": UP, "points": 2})

    async def given_up() -> None:
        beside = Beside()

        async def asked() -> None:
            async for _ in rows(beside, played, wanted):
                pass

        task = asyncio.create_task(asked())
        for _ in range(turns):
            await asyncio.sleep(0)
        task.cancel()
        beside.close()
        for _ in range(20):
            await asyncio.sleep(0.01)

    before = psutil.Process().children()
    asyncio.run(given_up())
    assert psutil.Process().children() == before


def test_a_page_that_is_loaded_again_finds_the_process_and_it_ends_after_a_rest(monkeypatch):
    tables = playable("squeal", None, {}).tables

    async def loaded_again() -> None:
        beside = Beside()
        before = set(psutil.Process().children())
        first = await beside.ask("theory", tables=tables)
        (process,) = set(psutil.Process().children()) - before
        monkeypatch.setattr("stridula.app.beside.REST", 0.3)
        # Two pages that ask nothing, then one that does.
        beside.close()
        beside.close()
        assert await beside.ask("theory", tables=tables) == first
        await asyncio.sleep(1.0)
        assert process.is_running()
        assert set(psutil.Process().children()) - before == {process}
        beside.close()
        await asyncio.sleep(1.0)
        assert not process.is_running()
        # Another one at once, and at the end of the server none.
        assert await beside.ask("theory", tables=tables) == first
        beside.close()
        await beside.end()
        assert set(psutil.Process().children()) <= before

    asyncio.run(loaded_again())


def test_a_map_without_valid_systems_is_empty(talk):
    talk.scene("squeal")
    rows = rows_of(talk, x={"key": "slider.length", "low": -1.0, "high": -0.5}, y=UP, points=2)
    assert rows == {0: ["", ""], 1: ["", ""]}


@pytest.mark.parametrize(
    ("x", "named"),
    [
        ({"key": "no.such.key", "low": 0.0, "high": 1.0}, "x must be a key of a number on the page"),
        ({"key": "contact.friction.law", "low": 0.0, "high": 1.0}, "x must be a key of a number on the page"),
        ({"key": "contact.friction.static", "low": 0.0, "high": 1.0}, "x must be a key of a number on the page"),
        ({"key": FRICTION, "low": 1.0, "high": 1.0}, "x must be a key of a number on the page, with low below high"),
        ({"key": FRICTION, "low": 1.0, "high": 0.0}, "x must be a key of a number on the page, with low below high"),
        ({"key": FRICTION, "low": 0.0}, "map.x.high"),
        ({"key": FRICTION, "low": 0.0, "high": 1e300}, "map.x.high"),
    ],
)
def test_bad_sides_of_a_map_are_refused(talk, x, named):
    talk.scene("squeal")
    talk.say("map", revision=talk.revision, x=x, y=UP, points=4)
    (problem,) = talk.until("problem", "map row", "map done")["problems"]
    assert problem.startswith(named)
    assert len(talk.play(480).sound) == 480


@pytest.mark.parametrize("points", [1, 25, 10_000_000])
def test_the_size_of_a_map_is_limited(talk, points):
    talk.scene("squeal")
    talk.say("map", revision=talk.revision, x=ACROSS, y=UP, points=points)
    (problem,) = talk.until("problem", "map row", "map done")["problems"]
    assert problem.startswith("map.points must be")


def test_equal_sides_of_a_map_are_refused(talk):
    talk.scene("squeal")
    talk.say("map", revision=talk.revision, x=ACROSS, y=ACROSS, points=2)
    assert talk.until("problem", "map done")["type"] == "problem"
