"""The page in use: time from slider to ear, pictures per second and drop-outs, with the server on one core.

    python benchmarks/page.py                                   two minutes
    python benchmarks/page.py --minutes 10 --write docs/performance.md
    python benchmarks/page.py --map on off --busy               with a map and without, a busy process beside the server
    python benchmarks/page.py --cores 1                         everything on one core, browser included
    python benchmarks/page.py --short                           some seconds; the server alone without a browser

It needs Debian's chromium and playwright. Chromium plays to a sink at the pace of a sound card. Time from slider to
ear: from the key that moves the friction slider to the moment when the first sample computed with it leaves the queue
of the player, plus the look-ahead of the limiter and the output latency that the browser reports; likewise for another
case, which is prepared first.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

import machine
from ratios import SHORT, arguments, sized, write_between

CHROMIUM = "/usr/bin/chromium"
ARGUMENTS = ("--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update")
CASES = ("weak-pressure", "squeal", "strong-pressure", "judder")
BEGIN, END = "<!-- page: begin -->", "<!-- page: end -->"
TICKS = os.sysconf("SC_CLK_TCK")
# Time in which the code is compiled at most [ms].
COMPILED = 300_000
# Time in which a page that has begun settles [s].
SETTLING = sized(5.0, 1.0)


def served() -> tuple[subprocess.Popen, str]:
    """Start the server on the first core and return it with its address."""
    cores = sorted(os.sched_getaffinity(0))
    command = [sys.executable, "-c", "from stridula.cli import main; main()", "app", "--no-browser", "--port", "0"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    os.sched_setaffinity(server.pid, {cores[0]})
    return server, re.search(r"http://\S+", server.stdout.readline())[0]


def stop(server: subprocess.Popen) -> None:
    """Stop the server."""
    server.terminate()
    server.wait(10)
    server.stdout.close()


def memory(process: int) -> float:
    """Return the resident memory of a process [MB]."""
    return int(Path(f"/proc/{process}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def processor_time(process: int) -> float:
    """Return the processor time of a process [s]."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def idle() -> str:
    """Start the server and return its memory and processor time before any use."""
    server, address = served()
    try:
        with urllib.request.urlopen(address) as page:
            if b"<canvas" not in page.read():
                raise SystemExit(f"the server at {address} must give the page, gave something else")
        return f"server: {memory(server.pid):.0f} MB, {processor_time(server.pid):.1f} s to begin"
    finally:
        stop(server)


@contextmanager
def busy(wanted: bool) -> Iterator[None]:
    """Keep the core of the server busy, if wanted, with a process of the same priority."""
    if not wanted:
        yield
        return
    process = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    os.sched_setaffinity(process.pid, {min(os.sched_getaffinity(0))})
    try:
        yield
    finally:
        process.kill()
        process.wait()


def played(minutes: float, with_map: bool) -> dict[str, list[float]]:
    """Use the page for some minutes, changing the friction every 1.5 s and at times the case; return measurements."""
    from playwright.sync_api import sync_playwright

    server, address = served()
    seen: dict[str, list[float]] = {"fps": [], "dropouts": [], "memory": [], "case": []}
    try:
        with sync_playwright() as play:
            browser = play.chromium.launch(executable_path=CHROMIUM, args=list(ARGUMENTS))
            page = browser.new_page(viewport={"width": 1280, "height": 900})
            page.goto(f"{address}#case={CASES[0]}")
            # Sound is on from here.
            page.click("#begin")
            if not with_map:
                page.click("#map-on")
            page.wait_for_function("() => stridula.stats.samples > 0", timeout=COMPILED)
            time.sleep(SETTLING)
            # Latencies count once the page has settled, drop-outs from the first sample.
            page.evaluate("stridula.stats.latencies.length = 0")
            began, ticks, number = time.monotonic(), processor_time(server.pid), 0
            while time.monotonic() - began < 60.0 * minutes:
                number += 1
                page.focus("#contact-friction-coefficient-slide")
                page.keyboard.press("ArrowLeft" if number % 2 else "ArrowRight")
                time.sleep(1.5)
                stats = page.evaluate("({ ...stridula.stats, latencies: null })")
                seen["fps"].append(stats["fps"])
                seen["dropouts"].append(stats["dropouts"])
                seen["memory"].append(memory(server.pid))
                if number % 60 == 0:
                    before = page.evaluate("stridula.stats.latencies.length")
                    page.select_option("#case", CASES[number // 60 % len(CASES)])
                    time.sleep(1.5)
                    seen["case"] += page.evaluate(f"stridula.stats.latencies.splice({before})")
            page.wait_for_function("() => stridula.stats.latencies.length > 0")
            seen["latency"] = page.evaluate("stridula.stats.latencies")
            seen["share"] = [(processor_time(server.pid) - ticks) / (time.monotonic() - began)]
            seen["output"] = [page.evaluate("1000 * stridula.late()")]
            browser.close()
    finally:
        stop(server)
    return seen


def table(seen: dict[str, list[float]], words: str) -> list[str]:
    """Return the measurements as lines of Markdown."""
    latency, fps = np.array(seen["latency"]), np.array(seen["fps"])
    first, last, case = seen["memory"][0], seen["memory"][-1], np.array(seen["case"])
    cases = []
    if case.size:
        cases = [f"| another case to ear [ms], {case.size} changes | | {np.median(case):.0f} | | {case.max():.0f} |"]
    return [
        f"- {words}, load of the machine at the end {os.getloadavg()[0]:.2f}",
        "",
        "| quantity | bar | median | 95 % | worst |",
        "|---|---|---:|---:|---:|",
        f"| slider to ear [ms], {latency.size} changes, {seen['output'][0]:.0f} ms of it limiter and output | < 150 | "
        f"{np.median(latency):.0f} | {np.percentile(latency, 95):.0f} | {latency.max():.0f} |",
        *cases,
        f"| pictures per second | >= 30 | {np.median(fps):.0f} | {np.percentile(fps, 5):.0f} | {fps.min():.0f} |",
        f"| drop-outs in total | 0 | | | {seen['dropouts'][-1]:.0f} |",
        f"| processor time of the server, over that of one core | | {seen['share'][0]:.2f} | | |",
        f"| memory of the server [MB], at the start and at the end | | {first:.0f} | | {last:.0f} |",
    ]


def circumstances(minutes: float, with_map: bool, is_busy: bool) -> str:
    """Return a description of the measurement."""
    words = f"{minutes:g} minutes, {'with maps computed meanwhile' if with_map else 'without maps'}"
    words += ", a busy process on the core of the server" * is_busy
    cores = len(os.sched_getaffinity(0))
    return words + (f", everything on {cores} core{'s' * (cores > 1)}" if cores < (os.cpu_count() or cores) else "")


def main() -> None:
    """Measure and print, and write if asked."""
    parser = arguments(__doc__)
    parser.add_argument("--minutes", type=float, default=sized(2.0, 0.05))
    parser.add_argument("--map", nargs="+", choices=("on", "off"), default=["on"], help="both are measured in turns")
    parser.add_argument("--busy", action="store_true", help="with a busy process on the core of the server")
    parser.add_argument("--cores", type=int, help="cores for server and browser together; all if left out")
    parser.add_argument("--write", type=Path)
    asked = parser.parse_args()
    if asked.cores:
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: asked.cores])
    if not Path(CHROMIUM).exists():
        if not SHORT:
            raise SystemExit(f"{CHROMIUM} must be installed to measure the page")
        print(idle())
        print(f"skipped: {CHROMIUM} is not installed, so the page is not measured")
        return
    lines = [f"- {line}" for line in machine.description()]
    print("\n".join(lines), flush=True)
    for map in asked.map:
        with busy(asked.busy):
            more = table(played(asked.minutes, map == "on"), circumstances(asked.minutes, map == "on", asked.busy))
        print("\n".join(["", *more]), flush=True)
        lines += more if len(asked.map) == 1 else ["", *more]
    if asked.write:
        write_between(BEGIN, END, asked.write, lines)


if __name__ == "__main__":
    main()
