"""Background computations in a separate process of low priority, so that they do not interrupt the sound."""

from __future__ import annotations

import asyncio
import contextlib
import json
import sys
from typing import Any

# Greatest length of an answer [bytes].
LONGEST = 1_000_000
# Priorities of the two processes, both lower than that of the sound.
QUICK, SLOW = 5, 10
# Time for which the process is kept after the last page has closed [s], so that a page that is loaded again does not
# start another one.
REST = 10.0


class Beside:
    """Two processes that compute for all pages: one the present motion, the other linear theory and maps.

    Rows of maps take seconds, the first one longer, and the present motion is reported every second.
    """

    def __init__(self) -> None:
        self._quick, self._slow = InTurn(QUICK), InTurn(SLOW)

    async def ask(self, what: str, **words: Any) -> Any:
        """Return the answer to a question, asked in turn, or None if the last page closes meanwhile.

        Parameters
        ----------
        what : str
            ``regimes``, ``theory`` or ``now``.
        **words
            Arguments of the function of that name in `beside_worker.ANSWERS`.
        """
        return await (self._quick if what == "now" else self._slow).ask(what, **words)

    def close(self) -> None:
        """Forget all questions, as no page is open: kill a process that computes, one that rests a little later."""
        self._quick.close()
        self._slow.close()

    async def end(self) -> None:
        """Kill the processes and wait for their ends."""
        await self._quick.end()
        await self._slow.end()


class InTurn:
    """A process that answers questions in turn, while any page is open or may return.

    Parameters
    ----------
    niceness : int
        Its priority, lower than that of the server by this number.
    """

    def __init__(self, niceness: int) -> None:
        self.niceness = niceness
        self._process: asyncio.subprocess.Process | None = None
        self._turn = asyncio.Lock()
        self._closed = 0
        self._rest: asyncio.TimerHandle | None = None

    async def ask(self, what: str, **words: Any) -> Any:
        """Return the answer to a question as `Beside.ask` does."""
        # A cancelled question ends here; otherwise it would start the process.
        await self._turn.acquire()
        # Once started, it is computed to its end, so that answers keep their order.
        line = json.dumps({"what": what, "words": words})
        return await asyncio.shield(asyncio.ensure_future(self._answer(line, self._closed)))

    def close(self) -> None:
        """Forget all questions, as no page is open: kill a process that computes, one that rests a little later."""
        self._closed += 1
        self._stay()
        if self._turn.locked():
            self._kill()
        else:
            self._rest = asyncio.get_running_loop().call_later(REST, self._kill)

    async def end(self) -> None:
        """Kill the process and wait for its end."""
        self._stay()
        process = self._process
        self._kill()
        if process is not None:
            await process.wait()

    def _stay(self) -> None:
        if self._rest is not None:
            self._rest.cancel()
            self._rest = None

    def _kill(self) -> None:
        if self._process is not None and self._process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()
        self._process = None

    async def _answer(self, line: str, closed: int) -> Any:
        try:
            if closed != self._closed:
                return None
            self._stay()
            process = await self._started()
            if closed != self._closed:
                # The last page closed while the process started.
                self._kill()
                return None
            assert process.stdin is not None
            assert process.stdout is not None
            try:
                process.stdin.write(line.encode() + b"\n")
                await process.stdin.drain()
            except ConnectionError:
                # Before Python 3.11.4, the loop logs the error of a pipe whose end nobody waits for.
                with contextlib.suppress(ConnectionError):
                    await process.stdin.wait_closed()
            found = await process.stdout.readline()
            return json.loads(found) if found else None
        finally:
            self._turn.release()

    async def _started(self) -> asyncio.subprocess.Process:
        if self._process is None or self._process.returncode is not None:
            pipe = asyncio.subprocess.PIPE
            command = (sys.executable, "-m", "stridula.app.beside_worker", str(self.niceness))
            self._process = await asyncio.create_subprocess_exec(*command, stdin=pipe, stdout=pipe, limit=LONGEST)
        return self._process
