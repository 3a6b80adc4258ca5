"""Reading and writing of files: whole or not at all, with errors in one line."""

from __future__ import annotations

import errno
import math
import os
import re
import stat
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, BinaryIO

from .checks import ArgumentError, at_least

try:
    import fcntl
except ImportError:
    # Windows has none.
    fcntl = None  # type: ignore[assignment]

# Longest name of a file that a message shows in full.
LONGEST_NAME = 200
# Largest file that is read into memory as a whole, and largest text of a scenario or a table [bytes].
LARGEST, LARGEST_TEXT = 4 * 1024**3, 256 * 1024**2
LEFT_OVER = re.compile(r"\.stridula-(\d+)-\d+\.part")
# Words of numbers that are not finite, and numbers with an exponent that may be too large.
NOT_FINITE = re.compile(rb"(?<![\w.])(?:nan|inf|infinity)(?![\w.])", re.IGNORECASE)
LARGE = re.compile(rb"(\d*\.?\d*)[ed]\+?(\d{3,5})", re.IGNORECASE)
# Endings of names by which programs recognise the format of a file.
TABLES = (".csv", ".tsv", ".txt", ".dat", ".xls", ".xlsx", ".ods", ".parquet", ".feather", ".json", ".yaml", ".yml")
ARRAYS = (".nc", ".nc4", ".cdf", ".netcdf", ".h5", ".hdf", ".hdf5", ".mat", ".npy", ".npz", ".pkl", ".pickle", ".zarr")
PICTURES = (".png", ".pdf", ".svg", ".jpg", ".jpeg", ".gif", ".webp", ".tif", ".tiff", ".eps", ".mp4", ".webm", ".avi")
SOUNDS = (".wav", ".wave", ".mp3", ".flac", ".ogg", ".opus", ".m4a", ".aac", ".aif", ".aiff", ".au", ".wma", ".raw")
OTHERS = (".toml", ".py", ".html", ".md", ".rst", ".zip", ".gz")
FORMATS = (*TABLES, *ARRAYS, *PICTURES, *SOUNDS, *OTHERS)
# Endings of records: NetCDF files, which are also HDF5 files.
RECORDS = (".nc", ".nc4", ".cdf", ".netcdf", ".h5", ".hdf", ".hdf5")


def read(path: str | os.PathLike[str], size: int = -1, *, most: int = LARGEST) -> bytes:
    """Return the content of a regular file of at most `most` bytes, or its first `size` bytes."""
    cannot = f"cannot read {named(path)}"
    with opened(path) as file:
        length = os.fstat(file.fileno()).st_size
        if size < 0 and length > most:
            words = f"{at_least(length / 1024**2, 4)} MiB, but at most {most // 1024**2} MiB are read"
            raise OSError(f"{cannot}: {words}")
        with one_line(cannot):
            return file.read(size)


def opened(path: str | os.PathLike[str]) -> BinaryIO:
    """Return a regular file, opened for reading.

    Raises
    ------
    OSError
        If it cannot be read, or is a pipe, a device or a socket.
    """
    check_regular(path)
    with one_line(f"cannot read {named(path)}"):
        return open(path, "rb")


def check_regular(path: str | os.PathLike[str]) -> None:
    """Raise OSError unless `path` is a regular file: reading from a pipe or a device may never end."""
    check_path("path", path)
    with one_line(f"cannot read {named(path)}"):
        kind = irregular(path)
        if kind == "directory":
            raise IsADirectoryError(errno.EISDIR, "is a directory")
        if kind:
            raise OSError(f"it must be a regular file, got a {kind}")


def irregular(path: str | os.PathLike[str]) -> str:
    """Return the kind of a path other than a regular file, such as ``pipe``; empty for a regular file."""
    mode = os.stat(path).st_mode
    kinds = {stat.S_IFDIR: "directory", stat.S_IFIFO: "pipe", stat.S_IFSOCK: "socket"}
    return "" if stat.S_ISREG(mode) else kinds.get(stat.S_IFMT(mode), "device")


def check_path(name: str, path: object) -> None:
    """Raise ValueError unless `path` is the name of a file: a number would be taken for an open file."""
    text = os.fspath(path) if isinstance(path, (str, os.PathLike)) else None
    if not isinstance(text, str) or "\0" in text:
        got = repr(path) if isinstance(path, (str, float)) else f"a {type(path).__name__}"
        raise ArgumentError(name, "be the name of a file", got=got[:LONGEST_NAME])


def check_ending(name: str, path: str | os.PathLike[str], own: Sequence[str], kind: str, other: str = "") -> None:
    """Raise ValueError if a file has the ending of a format other than its own; any other ending, or none, may be used.

    Parameters
    ----------
    name : str
        Name of the argument, for the message.
    path : str or Path
        The file.
    own : sequence of str
        Endings of its format, the usual one first.
    kind : str
        Its format in words.
    other : str, optional
        Ways to write other formats, in words, for the message.
    """
    check_path(name, path)
    ending = Path(path).suffix.lower()
    if ending in FORMATS and ending not in own:
        got = f"{named(path)}; {other}" if other else named(path)
        raise ArgumentError(name, f"be a {kind}, {own[0]}", str(path), got=got)


def is_there(path: str | os.PathLike[str]) -> bool:
    """Return whether `path` exists; False for a name that the operating system refuses."""
    try:
        return os.path.exists(path)
    except (OSError, ValueError):
        return False


def named(path: str | os.PathLike[str]) -> str:
    """Return the name of a file for messages, without its beginning where it is long."""
    text = str(path)
    return repr(text) if len(text) <= LONGEST_NAME else f"'...{text[-LONGEST_NAME:]}'"


def line_not_finite(path: str | os.PathLike[str]) -> str:
    """Return the first line of a text file with a number that is not finite, as ``line 5: ``; empty without one."""
    with opened(path) as file:
        for number, line in enumerate(file, 1):
            if b"\0" in line:
                return ""
            if NOT_FINITE.search(line) or any(map(_overflows, LARGE.findall(line))):
                return f"line {number}: "
    return ""


def _overflows(parts: tuple[bytes, bytes]) -> bool:
    with suppress(ValueError):
        return math.isinf(float(b"e".join(parts)))
    return False


def check_writable(path: str | Path) -> None:
    """Raise OSError if no file can be written at `path`; change nothing on disk."""
    check_path("path", path)
    target = _target(path)
    cannot = f"cannot write {named(path)}"
    with one_line(cannot):
        exists, is_file = target.exists(), target.is_file()
    if target.is_dir():
        raise IsADirectoryError(f"{cannot}: it is a directory")
    if not target.parent.is_dir():
        raise FileNotFoundError(f"{cannot}: there is no folder {named(Path(path).parent)}")
    if exists and not os.access(target, os.W_OK):
        raise PermissionError(f"{cannot}: permission denied")
    if is_file or not exists:
        with one_line(cannot), open(_beside(target), "xb"):
            pass
        _beside(target).unlink()


def write(path: str | os.PathLike[str], content: bytes | memoryview) -> None:
    """Write a file under a temporary name in the same folder, then rename it; write directly to a device."""
    check_path("path", path)
    target = _target(path)
    with one_line(f"cannot write {named(path)}"):
        is_device = target.exists() and not target.is_file()
    written = target if is_device else _beside(target)
    try:
        with one_line(f"cannot write {named(path)}"):
            _sweep(target.parent)
            with open(written, "wb") as file:
                with suppress(OSError):
                    _lock(file)
                file.write(content)
                file.flush()
                if not is_device:
                    os.fsync(file.fileno())
            if not is_device:
                os.replace(written, target)
    finally:
        if not is_device:
            written.unlink(missing_ok=True)


def _target(path: str | os.PathLike[str]) -> Path:
    with one_line(f"cannot write {named(path)}"):
        try:
            return Path(path).resolve()
        except RuntimeError as error:
            raise OSError("its links form a loop") from error


def _sweep(folder: Path) -> None:
    """Remove temporary files of processes that were killed while writing, where that is possible."""
    with suppress(OSError):
        for name in os.listdir(folder):
            found = LEFT_OVER.fullmatch(name)
            if found and not _is_running(int(found[1])):
                with suppress(OSError), opened(folder / name) as file:
                    # Where machines share a folder, the process may run on another machine.
                    _lock(file)
                    (folder / name).unlink()


def _lock(file: IO[bytes]) -> None:
    """Lock a file until it is closed; raise OSError if another process holds the lock."""
    if fcntl is not None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _is_running(process: int) -> bool:
    """Return whether a process is running; True for processes of other users."""
    if os.name == "nt":
        # On Windows a signal of 0 would end it.
        return True
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        return True
    return True


def _beside(target: Path) -> Path:
    return target.parent / f".stridula-{os.getpid()}-{abs(hash(target.name)) % 10**8}.part"


@contextmanager
def one_line(doing: str) -> Iterator[None]:
    """Turn an OSError into one of the same kind with a message of one line: the action and the reason."""
    try:
        yield
    except OSError as error:
        clear = type(error)(f"{doing}: {(error.strerror or str(error)).lower()}")
        clear.errno = error.errno
        raise clear from error
