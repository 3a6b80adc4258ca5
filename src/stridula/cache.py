"""What takes long to find, kept on disk from one process to the next; never in the way of what it is kept for.

In the folder that systems have for what programs can find again: ``stridula`` in ``$XDG_CACHE_HOME`` or ``~/.cache``,
in ``~/Library/Caches`` on macOS, in ``%LOCALAPPDATA%`` on Windows. ``STRIDULA_CACHE_DIR`` names another folder, or is
``off``. Files are written whole or not at all, those not asked for longest go when there are too many, and what cannot
be read or written is found again.
"""

from __future__ import annotations

import hashlib
import io
import os
import sys
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path

import numpy as np

from .arrays import Array
from .disk import read, write

FOLDER, OFF = "STRIDULA_CACHE_DIR", "off"
ENDING = ".kept"
# Bytes of all files, at most, and of the digest that a file begins with.
MOST, DIGEST = 500_000_000, 16


def folder() -> Path | None:
    """Return the folder where things are kept, whether there is one yet or not; None if nothing is."""
    chosen = os.environ.get(FOLDER)
    if chosen:
        return None if chosen.lower() == OFF else Path(chosen)
    with suppress(RuntimeError):
        home = Path.home()
        of_system = {"darwin": home / "Library" / "Caches", "win32": os.environ.get("LOCALAPPDATA", home)}
        return Path(of_system.get(sys.platform, os.environ.get("XDG_CACHE_HOME") or home / ".cache")) / "stridula"
    return None


def key(parts: Iterable[bytes]) -> str:
    """Return the name under which something is kept, by all that decides about it."""
    found = hashlib.blake2b(digest_size=DIGEST)
    for part in parts:
        # With its length: parts that are cut at another place are others.
        found.update(len(part).to_bytes(8, "little") + part)
    return found.hexdigest()


def recall(name: str) -> dict[str, Array] | None:
    """Return arrays by their names as they were kept; None if they are not there, or not whole."""
    place = folder()
    if place is None:
        return None
    path = place / f"{name}{ENDING}"
    try:
        content = read(path)
    except (OSError, ValueError):
        return None
    if _digest(content[DIGEST:]) != content[:DIGEST]:
        return None
    with suppress(OSError):
        # It has been asked for.
        os.utime(path)
    with np.load(io.BytesIO(content[DIGEST:]), allow_pickle=False) as arrays:
        return dict(arrays)


def keep(name: str, arrays: Mapping[str, Array]) -> None:
    """Keep arrays under a name, if that can be done."""
    place = folder()
    if place is None:
        return
    packed = io.BytesIO()
    np.savez(packed, allow_pickle=False, **arrays)
    content = packed.getvalue()
    if len(content) > MOST:
        return
    with suppress(OSError, ValueError):
        place.mkdir(mode=0o700, parents=True, exist_ok=True)
        _make_room(place, MOST - len(content))
        write(place / f"{name}{ENDING}", _digest(content) + content)


def _digest(content: bytes) -> bytes:
    return hashlib.blake2b(content, digest_size=DIGEST).digest()


def _make_room(place: Path, most: int) -> None:
    """Delete what has not been asked for longest, until files have `most` bytes together."""
    files = sorted(((path.stat(), path) for path in place.glob(f"*{ENDING}")), key=lambda one: one[0].st_mtime)
    size = sum(found.st_size for found, _ in files)
    for found, path in files:
        if size <= most:
            break
        path.unlink(missing_ok=True)
        size -= found.st_size
