"""Cache on disk for results that take long to compute, shared between processes.

It lies in the cache folder of the operating system: ``stridula`` in ``$XDG_CACHE_HOME`` or ``~/.cache``, in
``~/Library/Caches`` on macOS, in ``%LOCALAPPDATA%`` on Windows. ``STRIDULA_CACHE_DIR`` names another folder, or is
``off``. Files are written whole or not at all, the least recently used ones are deleted when there are too many, and
results that cannot be read or written are computed again.
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
# Largest size of all files together, and size of the digest at the beginning of a file [bytes].
MOST, DIGEST = 500_000_000, 16


def folder() -> Path | None:
    """Return the folder of the cache, whether it exists yet or not; None if the cache is off."""
    chosen = os.environ.get(FOLDER)
    if chosen:
        return None if chosen.lower() == OFF else Path(chosen)
    with suppress(RuntimeError):
        home = Path.home()
        of_system = {"darwin": home / "Library" / "Caches", "win32": os.environ.get("LOCALAPPDATA", home)}
        return Path(of_system.get(sys.platform, os.environ.get("XDG_CACHE_HOME") or home / ".cache")) / "stridula"
    return None


def key(parts: Iterable[bytes]) -> str:
    """Return the name of an entry: a digest of everything that its content depends on."""
    found = hashlib.blake2b(digest_size=DIGEST)
    for part in parts:
        # The length is included, so that the same bytes give another key if they are divided differently.
        found.update(len(part).to_bytes(8, "little") + part)
    return found.hexdigest()


def recall(name: str) -> dict[str, Array] | None:
    """Return the arrays of an entry by name; None if it does not exist or is damaged."""
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
        # Marks it as recently used.
        os.utime(path)
    with np.load(io.BytesIO(content[DIGEST:]), allow_pickle=False) as arrays:
        return dict(arrays)


def keep(name: str, arrays: Mapping[str, Array]) -> None:
    """Store arrays under a name, if possible."""
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
    """Delete the least recently used files until the rest have at most `most` bytes together."""
    files = sorted(((path.stat(), path) for path in place.glob(f"*{ENDING}")), key=lambda one: one[0].st_mtime)
    size = sum(found.st_size for found, _ in files)
    for found, path in files:
        if size <= most:
            break
        path.unlink(missing_ok=True)
        size -= found.st_size
