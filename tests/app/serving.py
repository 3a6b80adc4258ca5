"""A server of the page in a separate process."""

from __future__ import annotations

import json
import os
import re
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from http.client import HTTPConnection, HTTPResponse
from pathlib import Path
from typing import Any

from websockets.sync.client import connect

from stridula.app.serve import COMPILING

# Time limit [s]: a loaded machine is slow, a first start and a first map compile.
WAIT, START = 120.0, 300.0
COMMAND = (sys.executable, "-c", "from stridula.cli import main; main()", "app", "--no-browser")


class Server:
    """`stridula app` on a free or given port, with further arguments and environment if given."""

    def __init__(
        self, errors: Path, port: int = 0, arguments: Sequence[str] = (), is_ready: bool = True, **environment: str
    ) -> None:
        self.errors = errors
        with errors.open("ab") as file:
            self.process = subprocess.Popen(
                [*COMMAND, "--port", str(port), *arguments],
                stdout=subprocess.PIPE,
                stderr=file,
                text=True,
                env=os.environ | environment,
            )
        assert self.process.stdout is not None
        ready, _, _ = select.select([self.process.stdout], [], [], START)
        line = self.process.stdout.readline() if ready else ""
        found = re.fullmatch(r"stridula plays at (http://127\.0\.0\.1:(\d+)/) \(Ctrl-C stops it\)\n", line)
        if found is None:
            self.kill()
            raise AssertionError(f"the server said {line!r} and {self.complaints}")
        self.address, self.port = found[1], int(found[2])
        if is_ready:
            self._wait_until_ready()

    def _wait_until_ready(self) -> None:
        """Wait for a greeting: before it, the server may compile."""
        with connect(f"ws://127.0.0.1:{self.port}/socket", origin=self.origin, compression=None) as socket:
            told = ""
            while told != "hello":
                told = json.loads(socket.recv(timeout=START))["type"]

    @property
    def origin(self) -> str:
        """Origin of its pages."""
        return self.address.rstrip("/")

    @property
    def said(self) -> str:
        """Its standard error."""
        return self.errors.read_text(encoding="utf-8")

    @property
    def complaints(self) -> str:
        """The same without the notice of compilation: empty if all is well."""
        return re.sub(rf"{COMPILING}.*\n", "", self.said)

    def get(self, path: str, **headers: str) -> tuple[HTTPResponse, bytes]:
        """Ask for a file of the page."""
        connection = HTTPConnection("127.0.0.1", self.port, timeout=WAIT)
        try:
            connection.request("GET", path, headers=headers)
            answer = connection.getresponse()
            return answer, answer.read()
        finally:
            connection.close()

    def stop(self) -> None:
        """End it in the regular way."""
        self.process.terminate()
        self._wait()

    def kill(self) -> None:
        """End it at once."""
        self.process.kill()
        self._wait()

    def interrupt(self) -> int:
        """Press Ctrl-C and return the exit code."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(WAIT)

    def _wait(self) -> None:
        self.process.wait(WAIT)
        assert self.process.stdout is not None
        self.process.stdout.close()


def app(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Run `stridula app` in a case in which it cannot serve."""
    return subprocess.run(
        [*COMMAND, *arguments], capture_output=True, text=True, timeout=START, env=os.environ, check=False
    )


def eventually(found: Callable[[], Any], what: str, wait: float = WAIT) -> Any:
    """Return a result once it is true."""
    end = time.monotonic() + wait
    while not (value := found()):
        assert time.monotonic() < end, f"{what} did not come about in {wait} s"
        time.sleep(0.05)
    return value
