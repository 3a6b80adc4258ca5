"""Files read and written: whole or not at all, and what fails said in one line."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


def read(path: str | Path, size: int = -1) -> bytes:
    """Return what a file holds, its first `size` bytes if given."""
    with one_line(f"cannot read {str(path)!r}"), open(path, "rb") as file:
        return file.read(size)


def check_writable(path: str | Path) -> None:
    """Raise OSError if no file can be written at `path`; leave everything as it is."""
    target = Path(path).resolve()
    cannot = f"cannot write {str(path)!r}"
    if target.is_dir():
        raise IsADirectoryError(f"{cannot}: it is a directory")
    if not target.parent.is_dir():
        raise FileNotFoundError(f"{cannot}: there is no folder {str(Path(path).parent)!r}")
    if target.exists() and not os.access(target, os.W_OK):
        raise PermissionError(f"{cannot}: permission denied")
    if target.is_file() or not target.exists():
        with one_line(cannot), open(_beside(target), "xb"):
            pass
        _beside(target).unlink()


def write(path: str | os.PathLike[str], content: bytes | memoryview) -> None:
    """Write a file beside its place under a temporary name, then move it there; a device is written directly."""
    target = Path(path).resolve()
    is_device = target.exists() and not target.is_file()
    written = target if is_device else _beside(target)
    try:
        with one_line(f"cannot write {str(path)!r}"):
            with open(written, "wb") as file:
                file.write(content)
                file.flush()
                if not is_device:
                    os.fsync(file.fileno())
            if not is_device:
                os.replace(written, target)
    finally:
        if not is_device:
            written.unlink(missing_ok=True)


def _beside(target: Path) -> Path:
    return target.parent / f".stridula-{os.getpid()}-{abs(hash(target.name)) % 10**8}.part"


@contextmanager
def one_line(doing: str) -> Iterator[None]:
    """Turn an OSError into one of the same kind that says in one line what failed and why."""
    try:
        yield
    except OSError as error:
        clear = type(error)(f"{doing}: {(error.strerror or str(error)).lower()}")
        clear.errno = error.errno
        raise clear from error
