"""The session of one page: its messages and their answers."""

from __future__ import annotations

import asyncio
import threading
import time as clock
from collections.abc import Callable, Coroutine
from contextlib import suppress
from dataclasses import asdict
from typing import Any, TypeVar

from starlette.websockets import WebSocket, WebSocketDisconnect

from ..arrays import Array
from ..checks import ArgumentError, choice
from ..long_tasks import GivenUp, until
from ..plot.colours import REGIME_COLOURS
from ..records.by_surface import groups
from ..scenarios.errors import ScenarioError
from ..version import __version__
from . import controls, now
from .beside import Beside
from .bounds import bounds_of
from .challenges import CHALLENGES, Judge
from .fit import walls_of
from .held import held, is_of_one_case
from .instrument import RATE, Instrument
from .last_seconds import KEPT
from .maps import rows
from .messages import Fit, HoldMap, Listen, Map, Message, NoMap, Pull, Repeat, Restart, Save, Scene, Take, message_of
from .parts import THINNED, Stop, packed
from .playable import Playable
from .presets import presets
from .tour import STOPS
from .turned import keys_of

Result = TypeVar("Result")
# Largest lead of a page over real time [s], and its largest speed relative to real time.
AHEAD, FASTEST = 1.0, 1.5
# Other pages have their turn after this number of parts. Parts that take long are cut so that turns come this often
# [s]; the last value is the longest time of parts played at once [s].
PARTS_AT_ONCE, TURN, LONGEST = 4, 0.02, 0.25
# Sound that is computed again is sent at once, in messages with these numbers of parts, so that the first comes early;
# number of samples in a part.
ANEW, PART = (1, 1, 2, 2), 480
# From this speed on, sound that has not been heard yet is computed again after a change; slower systems need the sound
# that they have.
REPLAYED = 2.0
# Linear theory is computed after this time without changes [s].
PAUSE = 0.25
# Shortest motion that is reported [s].
SHORTEST = 0.2
# Weight of earlier measurements in the speed of playing, as a machine may be busy at times; number of samples needed
# for a new measurement.
KNOWN, ENOUGH = 0.6, 48
# Greatest distance of a motion from its mode, relative to the mode.
NEAR = 0.03
# A page that has not sent a first message is disconnected after this time [s].
HURRY = 10.0
# Interval at which a page that waits is looked after [s].
SOON = 0.1
# Largest number of messages that wait while one is answered.
WAITING = 16
# Codes of a socket that closed without a code, and of one whose page sent nothing.
GONE, SILENT = 1006, 4408


class Session:
    """An open page.

    Parameters
    ----------
    socket : WebSocket
        Its connection.
    beside : Beside
        The processes that compute its headline, linear theory and maps.
    ready : Event, optional
        Set once the code is compiled, for which the page waits.
    """

    def __init__(self, socket: WebSocket, beside: Beside, ready: threading.Event | None = None) -> None:
        self.socket, self.beside, self.ready = socket, beside, ready
        self.instrument: Instrument | None = None
        self.scene: Scene | None = None
        self.source, self.repeats = "pressure", True
        self._tasks: dict[str, asyncio.Task[None]] = {}
        # Messages that wait, and whether the page has gone, which ends the threads.
        self._messages: asyncio.Queue[str | Exception] = asyncio.Queue(WAITING)
        self._gone = threading.Event()
        # Time since which requested samples are counted, number of them, and number of samples sent.
        self._began, self._played, self._given = clock.monotonic(), 0, 0
        # Hash of the last drawing.
        self._drawn: str | None = None
        # Seconds of the system played per second; time taken and number of samples played since that was measured.
        self.speed: float | None = None
        self._taken, self._made = 0.0, 0
        # Held while the scenario changes and while parts are played.
        self._changing = asyncio.Lock()
        # Frequency of the squeal named last [Hz], and its revision.
        self._sings: tuple[float | None, int] = None, -1
        # Judge of a challenge, if the page has taken one.
        self.judge: Judge | None = None
        # Revision since which the keys of a map are those that are played, and whether its next row may begin.
        self._keyed, self._maps = 0, asyncio.Event()

    async def run(self) -> None:
        """Answer the page until it disconnects, then raise WebSocketDisconnect."""
        try:
            self._do("listening", self._listening())
            await self._greet()
            patience: float | None = HURRY
            while True:
                try:
                    heard = await asyncio.wait_for(self._messages.get(), patience)
                    patience = None
                    if isinstance(heard, Exception):
                        raise heard
                    await self._answer(message_of(heard))
                except ValueError as error:
                    await self._tell("problem", problems=_lines(error))
        except TimeoutError:
            await self.socket.close(SILENT, f"a page must send a message within {HURRY:g} s")
        finally:
            self._gone.set()
            for task in self._tasks.values():
                task.cancel()

    async def _greet(self) -> None:
        """Send the greeting once the code is compiled."""
        if self.ready is not None and not self.ready.is_set():
            await self._tell("compiling")
            while not self.ready.is_set():
                if self._gone.is_set():
                    raise WebSocketDisconnect(GONE)
                await asyncio.sleep(SOON)
        await self._tell(
            "hello",
            version=__version__,
            rate=RATE,
            kept=KEPT,
            presets=presets(),
            tour=[asdict(stop) for stop in STOPS],
            challenges=[one.described for one in CHALLENGES.values()],
            regimes=REGIME_COLOURS,
            **controls.turned_of_pair({}).described,
        )

    async def _listening(self) -> None:
        """Receive messages, also while one is answered, so that a page that leaves is noticed at once."""
        heard: str | Exception
        while not self._gone.is_set():
            try:
                heard = await self._heard()
            except ArgumentError as error:
                heard = error
            except WebSocketDisconnect as error:
                self._gone.set()
                heard = error
            await self._messages.put(heard)

    async def _in_thread(self, function: Callable[..., Result], *words: Any) -> Result:
        """Return the result of a function from a thread, whose long work ends when the page has gone."""
        try:
            return await asyncio.to_thread(until, self._gone, function, *words)
        except GivenUp:
            raise WebSocketDisconnect(GONE) from None

    async def _in_time(self, is_quick: bool, function: Callable[..., Result], *words: Any) -> Result:
        """Return the result of a function, from a thread unless it is quick: threads wait for each other."""
        return function(*words) if is_quick else await self._in_thread(function, *words)

    async def _heard(self) -> str:
        try:
            return await self.socket.receive_text()
        except KeyError:
            raise ArgumentError("message", "be text", got="bytes") from None

    async def _tell(self, what: str, **words: Any) -> None:
        await _sent(self.socket.send_json({"type": what, **words}))

    async def _answer(self, message: Message) -> None:
        preparing = self._tasks.get("scene")
        # Only the sound continues while another scenario is prepared.
        if preparing is not None and (preparing.done() or type(message) is not Pull):
            await self._tasks.pop("scene")
        if type(message) is Scene and self.instrument is not None:
            self._do("scene", self._scene_beside(message))
        elif type(message) in ANSWERS:
            await ANSWERS[type(message)](self, message)
        elif self.instrument is None:
            raise ArgumentError("scene", "be given first")
        else:
            await ANSWERS_OF_WHAT_PLAYS[type(message)](self, self.instrument, message)

    async def _listen(self, message: Listen) -> None:
        if self.instrument is not None:
            self.instrument.listen_to(message.source, self._kept(message))
            await self._send_anew(await self._anew())
        self.source = message.source

    async def _repeat(self, message: Repeat) -> None:
        self.repeats = message.on
        if self.instrument is not None:
            self.instrument.repeat(message.on)

    async def _take(self, message: Take) -> None:
        if message.name is None:
            self.judge = None
            return
        choice("name", message.name, tuple(CHALLENGES))
        self.judge = Judge(CHALLENGES[message.name])

    async def _scene(self, scene: Scene) -> None:
        """Play another scene, or its playable part; the present one sounds until it is ready."""
        refused: dict[str, list[str]] = {}
        came = clock.monotonic()
        try:
            found = await self._in_time(self._is_quick(scene), held, scene, self.scene)
            refused, played = found.refused, found.played
            if refused and self.scene is not None and _is_same(found.scene, self.scene):
                raise ScenarioError(found.problems)
            other = await self._prepared(played)
            async with self._changing:
                kept = self._kept(scene, clock.monotonic() - came)
                if other is not None or self.instrument is None or _keys(self.instrument.played) != _keys(played):
                    self._keyed = scene.revision
                goes_on = await self._play(played, scene.revision, other, kept)
                is_anew = await self._anew()
                self.scene = found.scene
                # The page receives the scene before its first part.
                await self._tell_scene(scene.revision, goes_on, refused)
                await self._send_anew(is_anew)
        except MemoryError:
            problems = ["scenario must fit into memory"]
        except ValueError as error:
            problems = _lines(error)
        else:
            self._do("theory", self._theory(played, scene.revision))
            if "now" not in self._tasks or self._tasks["now"].done():
                self._do("now", self._now())
            return
        told = {"problems": problems, "refused": refused or {"": problems}, "kept": _said(self.scene)}
        await self._tell("refused", revision=scene.revision, **told)

    async def _scene_beside(self, scene: Scene) -> None:
        with suppress(WebSocketDisconnect):
            await self._scene(scene)

    async def _prepared(self, played: Playable) -> tuple[Instrument, float | None] | None:
        """Return another case or text as an instrument and its speed, None if it is the same."""
        if self.instrument is not None and self.instrument.is_of(played):
            return None
        return await self._in_thread(_begun, played, self.source)

    def _is_quick(self, scene: Scene) -> bool:
        """Return whether a scene takes less time to read than a part of its sound takes to play."""
        is_fast = self.instrument is not None and self.instrument.played.is_fast
        return is_fast and self.scene is not None and is_of_one_case(scene, self.scene)

    def _kept(self, message: Scene | Listen | Restart, since: float = 0.0) -> int | None:
        """Return the number of samples that a page keeps, a time after its message came; None if it keeps all."""
        if message.kept is None or (self.speed is not None and self.speed < REPLAYED):
            return None
        return message.kept + round(since * RATE)

    async def _anew(self) -> bool:
        """Tell the page from where on the sound is computed anew, if not from where it was; return whether it is."""
        assert self.instrument is not None
        undone, self._given = self._given - self.instrument.given_samples, self.instrument.given_samples
        if not undone:
            return False
        # These samples do not count as requested.
        self._played -= undone
        await self._tell("anew", samples=self._given)
        return True

    async def _send_anew(self, is_anew: bool) -> None:
        """Send the first sound that is computed anew, without a request, since the way of one takes time."""
        if not is_anew:
            return
        assert self.instrument is not None
        for parts in ANEW:
            self._played += parts * PART
            await self._play_parts(self.instrument, Pull(type="pull", parts=parts, samples=PART))

    async def _play(
        self, played: Playable, revision: int, other: tuple[Instrument, float | None] | None, kept: int | None
    ) -> bool:
        """Play a scenario, or another one that is prepared, and return whether the motion continues."""
        if other is None:
            assert self.instrument is not None
            is_quick = self.instrument.played.is_fast and played.system.bodies == self.instrument.played.system.bodies
            goes_on, speed = await self._in_time(is_quick, _changed, self.instrument, played, revision, kept)
        else:
            (begun, speed), goes_on = other, False
            if self.instrument is None:
                self.instrument = begun
                begun.begins_as(revision, self.repeats)
            else:
                self.instrument.begin_as(begun, revision, kept)
        if not goes_on:
            self.speed, self._taken, self._made = speed, 0.0, 0
        return goes_on

    async def _tell_scene(self, revision: int, goes_on: bool, refused: dict[str, list[str]]) -> None:
        assert self.instrument is not None
        told = {"goes_on": goes_on, "refused": refused, "kept": _said(self.scene) if refused else None}
        described = _described(self.instrument, self.speed)
        drawn, self._drawn = self._drawn, described.get("drawn")
        if drawn and drawn == self._drawn:
            # Bodies in space are large, and are not sent again.
            parts = self.instrument.drawing.described
            described = {name: value for name, value in described.items() if name not in parts} | {"drawn": drawn}
        await self._tell("scene", revision=revision, **told, **described)

    async def _now(self) -> None:
        """Report the present motion once a second."""
        before, headline = 0, now.Headline()
        with suppress(WebSocketDisconnect):
            while True:
                await asyncio.sleep(headline.pause)
                async with self._changing:
                    instrument = self.instrument
                    if instrument is None or self._made < ENOUGH:
                        continue
                    if not instrument.played.is_fast:
                        now_played = self._made / RATE / self._taken
                        known = now_played if self.speed is None else self.speed
                        self.speed = KNOWN * known + (1.0 - KNOWN) * now_played
                        await self._tell("speed", speed=self.speed)
                    self._taken, self._made = 0.0, 0
                    if instrument.played_samples - before < now.MOMENT * RATE / 4:
                        continue
                    before, revision = instrument.played_samples, instrument.revision
                    last = instrument.last_seconds
                    variables, pressure = last.moment(headline.seconds(last.steady))
                    clock, played, scene = instrument.played_samples / RATE, instrument.played, self.scene
                seconds = len(variables["damping_loss"]) / RATE if variables else 0.0
                if seconds < SHORTEST or not headline.takes(seconds, revision):
                    continue
                told = await asyncio.to_thread(_all_said, variables)
                system = played.system
                members = groups(system.contact_names, system.surface_names)
                names = [system.contact_names[those[0]] for those in members]
                found = await self.beside.ask("now", interval=1.0 / RATE, contacts=names, variables=told)
                if found is not None:
                    named = headline.after(found, revision)
                    words = now.words(named, now.level_of(pressure[-round(now.MOMENT * RATE) :]))
                    self._sings = named["frequency"] if named["regime"] == "squeal" else None, revision
                    verdict = None
                    if self.judge is not None and scene is not None:
                        verdict = self.judge.after(named, scene, played, clock, revision)
                    await self._tell("now", revision=revision, words=words, verdict=verdict, **named)

    async def _pull(self, instrument: Instrument, pull: Pull) -> None:
        """Play the next parts; a page that requests more than real time must wait."""
        wanted = pull.parts * pull.samples
        allowed = round((clock.monotonic() - self._began) * FASTEST * RATE)
        # Parts that were not requested in time are not sent later.
        self._played = max(self._played, allowed) + wanted
        early = (self._played - allowed) / RATE - AHEAD
        if early > 0.0:
            await asyncio.sleep(early / FASTEST)
        async with self._changing:
            await self._play_parts(instrument, pull)

    async def _play_parts(self, instrument: Instrument, pull: Pull) -> None:
        parts: list[bytes] = []
        start = clock.monotonic()
        for number, samples in enumerate(self._cut(pull)):
            # Computed here, not in a thread: switching threads takes as long as a part.
            began = clock.perf_counter()
            found = list(instrument.play(samples))
            self._taken += clock.perf_counter() - began
            for part in found:
                if isinstance(part, Stop):
                    await self._tell("stroke", why=part.why, goes_on=part.goes_on)
                else:
                    self._made += part.samples
                    parts.append(packed(part))
            if self.speed is not None and clock.monotonic() - start > LONGEST:
                break
            if samples < pull.samples or number % PARTS_AT_ONCE == PARTS_AT_ONCE - 1:
                await asyncio.sleep(0)
        self._given = instrument.given_samples
        await _sent(self.socket.send_bytes(b"".join(parts)))

    def _cut(self, pull: Pull) -> list[int]:
        """Return the samples of each part; slow systems are cut into smaller parts."""
        most = pull.samples
        if self.speed is not None:
            most = max(THINNED, int(TURN * self.speed * RATE) // THINNED * THINNED)
        whole, rest = divmod(pull.samples, min(most, pull.samples))
        return [*[min(most, pull.samples)] * whole, *[rest] * bool(rest)] * pull.parts

    async def _save(self, instrument: Instrument, save: Save) -> None:
        last, played, steps = instrument.last_seconds, instrument.played, instrument.live.ratio
        if save.format == "wav":
            content = await asyncio.to_thread(last.wav)
        else:
            content = await asyncio.to_thread(last.record, played, steps)
        await self._tell("file", format=save.format, size=len(content))
        await _sent(self.socket.send_bytes(content))

    async def _restart(self, instrument: Instrument, message: Restart) -> None:
        instrument.restart(self._kept(message))
        await self._send_anew(await self._anew())

    async def _no_map(self, instrument: Instrument, message: NoMap) -> None:
        self._stop("map")

    async def _hold_map(self, instrument: Instrument, message: HoldMap) -> None:
        if message.on:
            self._maps.clear()
        else:
            self._maps.set()

    async def _map(self, instrument: Instrument, message: Map) -> None:
        # The page asks again once it has another case.
        if message.revision < self._keyed:
            return
        played, known = instrument.played, _keys(instrument.played)
        for side in ("x", "y"):
            axis = getattr(message, side)
            if axis.key not in known or not axis.low < axis.high:
                raise ArgumentError(side, "be a key of a number on the page, with low below high", axis.key)
        if message.x.key == message.y.key:
            raise ArgumentError("y", "be another key than x", message.y.key, got=f"{message.y.key!r} for both")
        self._maps.set()
        self._do("map", self._rows(played, message))

    async def _rows(self, played: Playable, wanted: Map) -> None:
        with suppress(WebSocketDisconnect):
            async for row, found in rows(self.beside, played, wanted):
                await self._tell("map row", revision=wanted.revision, row=row, regimes=found)
                await self._maps.wait()
            await self._tell("map done", revision=wanted.revision)

    async def _theory(self, played: Playable, revision: int) -> None:
        await asyncio.sleep(PAUSE)
        found = await self.beside.ask("theory", tables=played.tables)
        if found is not None:
            with suppress(WebSocketDisconnect):
                await self._tell("theory", revision=revision, **found)

    async def _fit(self, instrument: Instrument, message: Fit) -> None:
        # The page has another setting by now.
        if message.revision != instrument.revision:
            return
        if not walls_of(instrument.played.tables):
            raise ArgumentError("fit", "be of a system with the wall of a glass", got=instrument.played.scenario.title)
        self._do("fit", self._fitted(instrument.played, message))

    async def _fitted(self, played: Playable, message: Fit) -> None:
        found = await self.beside.ask("theory", tables=played.tables)
        sung, revision = self._sings
        modes = found["modes"] if found is not None else []
        # The motion is a little above linear theory, unless it is that of another mode.
        is_known = bool(modes) and sung is not None and revision == message.revision
        above = sung / modes[0]["frequency"] if is_known and sung is not None else 1.0
        above = above if abs(above - 1.0) < NEAR else 1.0
        fitting = await self.beside.ask("fit", tables=played.tables, frequency=message.frequency, above=above)
        if fitting is not None:
            with suppress(WebSocketDisconnect):
                await self._tell("fit", revision=message.revision, **fitting)

    def _do(self, name: str, what: Coroutine[Any, Any, None]) -> None:
        """Start a background task, in place of the previous one with this name."""
        self._stop(name)
        self._tasks[name] = asyncio.create_task(what)

    def _stop(self, name: str) -> None:
        before = self._tasks.pop(name, None)
        if before is not None:
            before.cancel()


# Methods that answer messages, without and with an instrument.
ANSWERS: dict[type, Any] = {
    Scene: Session._scene,
    Listen: Session._listen,
    Repeat: Session._repeat,
    Take: Session._take,
}
ANSWERS_OF_WHAT_PLAYS: dict[type, Any] = {
    Pull: Session._pull,
    Restart: Session._restart,
    Save: Session._save,
    NoMap: Session._no_map,
    HoldMap: Session._hold_map,
    Map: Session._map,
    Fit: Session._fit,
}


async def _sent(sending: Coroutine[Any, Any, None]) -> None:
    """Send; raise WebSocketDisconnect if the page has gone, even if another task noticed it first."""
    try:
        await sending
    except RuntimeError:
        raise WebSocketDisconnect(GONE) from None


def _begun(played: Playable, source: str) -> tuple[Instrument, float | None]:
    """Return a scenario as an instrument, and the seconds it plays per second, None if it is fast enough."""
    instrument = Instrument(played, source)
    speed = None if played.is_fast else instrument.keep_up()
    # Computed here because it may be slow.
    _ = instrument.drawing.described
    return instrument, speed


def _changed(instrument: Instrument, played: Playable, revision: int, kept: int | None) -> tuple[bool, float | None]:
    """Change the scenario of an instrument; return whether the motion continues, and the speed if not (`_begun`)."""
    goes_on = instrument.change(played, revision, kept)
    speed = None if goes_on or played.is_fast else instrument.keep_up()
    _ = instrument.drawing.described
    return goes_on, speed


def _keys(played: Playable) -> set[str]:
    """Return the keys of the numbers that a map can vary."""
    return {control.key for control in played.turned.controls} & set(played.turned.values)


def _all_said(variables: dict[str, Array]) -> dict[str, Any]:
    return {name: now.said(values) for name, values in variables.items()}


def _is_same(one: Scene, other: Scene) -> bool:
    return is_of_one_case(one, other) and one.overrides == other.overrides


def _said(scene: Scene | None) -> dict[str, Any] | None:
    """Return a scene in the form that a page sends."""
    return None if scene is None else scene.model_dump(include={"case", "text", "overrides"})


def _lines(error: ValueError) -> list[str]:
    """Return the problems, one line each."""
    return list(error.problems) if isinstance(error, ScenarioError) else [str(error)]


def _described(instrument: Instrument, speed: float | None) -> dict[str, Any]:
    """Return the description of the played scenario for the page."""
    played, live = instrument.played, instrument.live
    return {
        "title": played.scenario.title,
        "description": played.scenario.description,
        "values": played.turned.values,
        "bounds": bounds_of(played),
        "turned": None if played.before is None else played.turned.described,
        "places": _places(played),
        "toml": played.toml,
        "sources": {name: vars(source) for name, source in played.sources.items()},
        "source": instrument.name,
        **instrument.drawing.described,
        "modes": len(live.position),
        "contact_count": len(played.system.contacts),
        "seconds_kept": instrument.last_seconds.seconds,
        "step": live.step,
        "steps": live.ratio,
        "longer": instrument.longer is not None,
        "speed": speed,
        "fits": bool(walls_of(played.tables)),
    }


def _places(played: Playable) -> dict[str, list[str]]:
    """Return the keys for which each key with a ``*`` stands."""
    several = [key for key in played.turned.values if "*" in key]
    return {key: keys_of(key, played.tables) for key in several}
