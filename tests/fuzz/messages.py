"""Random messages of a page to its session: each is answered or refused, and the session continues."""

from __future__ import annotations

import asyncio
import json
import random
import time
from collections.abc import Iterator
from copy import deepcopy
from functools import cache
from typing import Any

from starlette.websockets import WebSocketDisconnect

from stridula.app.challenges import CHALLENGES
from stridula.app.controls import CHOICES, CONTROLS, Control, values
from stridula.app.messages import LARGEST
from stridula.app.playable import PRESETS, playable
from stridula.app.session import Session

# A conversation that takes longer hangs [s].
PATIENCE = 15.0
# Revision of the valid scene after all others.
LAST = 2**50
# Longest line of a refusal, and of all lines of one.
LONGEST, LONGEST_IN_ALL = 2_000, 20_000
KEYS = [one.key for one in (*CONTROLS, *CHOICES)]
STRANGE = (
    None, True, False, 0, -1, 1, 2**31, 2**63, 10**400, -0.0, 1e-300, 1e308, "", " ", "1", "nan", "1 mm", "é\0\ud83d",
    "\n", 5000 * "x", [], [[]], [1, "a"], {}, {"a": 1}, {"type": "pull"}, float("nan"), float("inf"), -float("inf"),
)  # fmt: skip
TEXTS = (
    "", 'base = "squeal"\n', 'base = "stable-sliding"\n[slider]\nlength = 0.45\n', 'base = "belt"\n', 'base = "/x"\n',
    'base = "squeal"\n[slider]\nelements = 101\n', 'base = "squeal"\n[track]\ncutoff = 1e9\n', "[a.b.c]\nx = [1, 2]\n",
    'base = "squeal"\n[contact.friction]\nlaw = "stribeck"\nstatic = 0.6\nkinetic = 0.4\nvelocity = 0.01\n',
    "x = 1979-05-27T07:32:00Z\n", "[" + 300 * "a." + "a]\n",
)  # fmt: skip


def inputs(seed: int, count: int) -> Iterator[list[str | bytes]]:
    """Yield conversations of a few messages each.

    Parameters
    ----------
    seed : int
        Seed; equal seeds yield equal conversations.
    count : int
        Number of conversations.
    """
    for number in range(count):
        dice = random.Random(f"{seed} {number}")
        begins = [_message("scene", revision=0, case=dice.choice(PRESETS))] if dice.random() < 0.8 else []
        yield begins + [_sent(dice) for _ in range(dice.randint(1, 5))]


def check(given: list[str | bytes]) -> str:
    """Send some messages to a session; return whether it refused any, ``accepted`` or ``refused``.

    Parameters
    ----------
    given : list of str or bytes
        The messages.

    Raises
    ------
    AssertionError
        If the session ends, hangs or answers wrongly.
    """
    began = time.monotonic()
    socket = _Socket(given)
    asyncio.run(_played(socket))
    assert time.monotonic() - began < PATIENCE, "the session hung"
    refusals = [one for one in socket.told if isinstance(one, dict) and one["type"] in ("problem", "refused")]
    for refusal in refusals:
        _check_lines(refusal["problems"])
        for lines in refusal.get("refused", {}).values():
            _check_lines(lines)
    return "refused" if refusals else "accepted"


class _Socket:
    """A page that sends given messages, then a valid one, and closes; it keeps all answers."""

    def __init__(self, given: list[str | bytes]) -> None:
        self.told: list[dict[str, Any] | bytes] = []
        self._before: str | bytes = b""
        self._said = iter([*given, _message("scene", revision=LAST), _message("pull", parts=1, samples=48)])

    async def receive_text(self) -> str:
        await asyncio.sleep(0)
        said = next(self._said, None)
        if said is None:
            raise WebSocketDisconnect(1000)
        if self._is_last(said):
            # As a page does, which plays the present scene until then.
            while not any(isinstance(one, dict) and one.get("revision") == LAST for one in self.told):
                await asyncio.sleep(0.01)
        if isinstance(said, bytes):
            # As starlette does for other than text.
            raise KeyError("text")
        return said

    def _is_last(self, said: str | bytes) -> bool:
        """Whether this is the pull after the valid scene."""
        self._before, before = said, self._before
        return before == _message("scene", revision=LAST)

    async def send_json(self, words: dict[str, Any]) -> None:
        # A browser reads neither NaN nor Infinity.
        self.told.append(json.loads(json.dumps(words, allow_nan=False)))

    async def send_bytes(self, content: bytes) -> None:
        self.told.append(content)

    async def close(self, code: int, reason: str) -> None:
        raise AssertionError(f"the session closed its socket: {code} {reason}")


class _Beside:
    """A stand-in that computes neither maps nor linear theory."""

    async def ask(self, what: str, **words: Any) -> Any:
        json.dumps(words)
        return None


async def _played(socket: _Socket) -> None:
    session = Session(socket, _Beside())
    try:
        await asyncio.wait_for(session.run(), PATIENCE)
    except WebSocketDisconnect:
        pass
    except TimeoutError:
        raise AssertionError("the session hung") from None
    except Exception as error:
        raise AssertionError(f"the session ended: {error!r}") from error
    assert socket.told[0]["type"] == "hello"
    # After any messages, a valid one is played.
    scene = next(one for one in reversed(socket.told) if isinstance(one, dict) and one["type"] != "stroke")
    assert (scene["type"], scene["revision"]) == ("scene", LAST)
    assert isinstance(socket.told[-1], bytes)
    assert len(socket.told[-1]) > 48 * 4


def _check_lines(lines: list[str]) -> None:
    assert lines
    assert sum(map(len, lines)) < LONGEST_IN_ALL
    for line in lines:
        assert 0 < len(line) < LONGEST, f"a line of {len(line)} characters: {line[:80]}"
        assert not set(line) & {"\n", "\r"}, f"more than a line: {line!r}"
        assert "Traceback" not in line


def _message(type: str, **words: Any) -> str:
    return json.dumps({"type": type, **words})


def _sent(dice: random.Random) -> str | bytes:
    """Return a message as it is, with wrong words or wrong letters."""
    words = _right(dice)
    for _ in range(dice.choice((0, 0, 0, 0, 1, 2))):
        _go_wrong(dice, words)
    text = json.dumps(words)
    kind = dice.random()
    if kind < 0.06:
        text = _garbled(dice, text)
    elif kind < 0.07:
        return text.encode()
    elif kind < 0.09:
        text = dice.choice(("", "[]", "null", "7", '"scene"', 20_000 * "[", "{" * 500, '{"type":' * 300))
    elif kind < 0.1:
        text = _message("scene", revision=1, text=dice.choice("[x=é\n") * 59_000)
    assert len(text) < 10 * LARGEST
    return text


def _right(dice: random.Random) -> dict[str, Any]:
    """Return a message that may be played."""
    type = dice.choice(
        (*["scene"] * 3, *["pull"] * 2, "listen", "restart", "repeat", "save", "map", "no map", "hold map", "challenge")
    )
    words: dict[str, Any] = {"type": type}
    if type == "scene":
        case = dice.choice(PRESETS)
        words |= {"revision": dice.randint(0, 1000), "case": case, "overrides": _overrides(dice, case)}
        if dice.random() < 0.3:
            words["text"] = dice.choice(TEXTS)
            if dice.random() < 0.3:
                words["text"] = _garbled(dice, words["text"])
    elif type == "pull":
        words |= {"parts": dice.randint(1, 4), "samples": dice.choice((1, 4, 48, 480))}
    elif type == "listen":
        words["source"] = dice.choice(("pressure", "force", "acceleration"))
    elif type in ("repeat", "hold map"):
        words["on"] = dice.random() < 0.5
    elif type == "challenge":
        words["name"] = dice.choice((*CHALLENGES, None, "nonsense"))
    elif type == "save":
        words["format"] = dice.choice(("wav", "nc"))
    elif type == "map":
        x, y = dice.sample(_held(PRESETS[0]) if dice.random() < 0.8 else CONTROLS, 2)
        words |= {"revision": dice.randint(0, 1000), "x": _side(x), "y": _side(y), "points": dice.randint(2, 24)}
    return words


@cache
def _held(case: str) -> tuple[Control, ...]:
    """Return the controls that a case has."""
    held = values(playable(case, None, {}).tables)
    return tuple(control for control in CONTROLS if control.key in held)


def _overrides(dice: random.Random, case: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    controls = _held(case) if dice.random() < 0.8 else CONTROLS
    for control in dice.sample(controls, dice.choice((0, 1, 1, 2, 5))):
        share = dice.random() if dice.random() < 0.8 else dice.uniform(-2.0, 3.0)
        found[control.key] = (control.low + share * (control.high - control.low)) * control.scale
    if dice.random() < 0.15:
        choice = dice.choice(CHOICES)
        kind = dice.choice(list(choice.kinds))
        found |= {choice.key: kind, **choice.begins[kind]}
    return found


def _side(control: Control) -> dict[str, Any]:
    return {"key": control.key, "low": control.low * control.scale, "high": control.high * control.scale}


def _go_wrong(dice: random.Random, words: dict[str, Any]) -> None:
    """Change, remove or add a word somewhere."""
    inner = [words, *(value for value in words.values() if isinstance(value, dict))]
    table = dice.choice(inner)
    key = dice.choice([*table, "extra", dice.choice(KEYS)])
    if dice.random() < 0.2:
        table.pop(key, None)
    else:
        table[key] = deepcopy(dice.choice(STRANGE))


def _garbled(dice: random.Random, text: str) -> str:
    letters = list(text)
    for _ in range(dice.randint(1, 4)):
        at = dice.randrange(len(letters) + 1)
        change = dice.randrange(3)
        if change == 0:
            letters[at:at] = dice.choice(("\0", "é", "\u2028", "\n", '"', "{", "]", "1e999", "-", "\\", " "))
        elif change == 1:
            del letters[at : at + dice.randint(1, 8)]
        else:
            letters = letters[:at]
    return "".join(letters)
