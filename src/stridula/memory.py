"""Memory of the machine."""

from __future__ import annotations

import os
from pathlib import Path

INFO = Path("/proc/meminfo")
GIB = 1024.0**3


def available_memory() -> float:
    """Return the memory [bytes] that a process may still use without swapping, infinite if it is not known."""
    try:
        for line in INFO.read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return 1024.0 * float(line.split()[1])
    except (OSError, ValueError, IndexError):
        pass
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return float("inf")
