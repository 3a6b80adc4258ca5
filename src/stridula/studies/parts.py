"""Parts of a study on disk: each is complete or absent, so that a study can be resumed."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

import xarray as xr

from ..checks import ArgumentError
from ..disk import RECORDS, check_ending, check_writable, one_line, read, write
from ..records.files import is_record, load, save
from .task import Outcome


class Parts:
    """The file of a study, and the folder beside it with the finished parts.

    Two processes on one study write the same parts: the later one replaces a file by an equal one.

    Parameters
    ----------
    out : str or Path
        Path of the file; the folder has the same name followed by ``.parts``.
    identity : dict of str
        Attributes that identify the study: its scenario, arguments and version.
    study : str, optional
        Kind of study in one word: the name of the attribute with its arguments.

    Raises
    ------
    OSError
        If the file cannot be written.
    ValueError
        If the file or the folder exists and belongs to another study; nothing is changed.
    """

    def __init__(self, out: str | Path, identity: dict[str, str], study: str = "sweep") -> None:
        self.study = study
        self.out, self.folder, self.identity = Path(out), Path(f"{out}.parts"), identity
        check_ending("out", out, RECORDS, "NetCDF file")
        check_writable(out)
        self.finished = self._finished()
        self._check_folder()

    def _finished(self) -> xr.Dataset | None:
        """Return the study if its file is complete, None if there is none."""
        if not self.out.exists():
            return None
        if not self.out.is_file() or not is_record(self.out):
            raise ArgumentError(
                "out",
                f"be a new file or that of this {self.study}",
                str(self.out),
                got=f"{str(self.out)!r}, another file",
            )
        found = load(self.out)
        if {name: found.attrs.get(name) for name in self.identity} != self.identity:
            raise ArgumentError(
                "out",
                f"be a new file or that of this {self.study}",
                str(self.out),
                got=f"{str(self.out)!r}{self._why(found.attrs)}",
            )
        return found

    def _check_folder(self) -> None:
        """Raise ValueError if the folder exists and belongs to another study."""
        if not self.folder.exists():
            return
        if not self.folder.is_dir():
            raise ArgumentError(f"{str(self.folder)!r}", f"be free for the parts of the {self.study}", got="a file")
        known = self._identity_on_disk()
        if known is None and all(path.name.startswith(".stridula-") for path in self.folder.iterdir()):
            # Stopped before the description was written.
            return
        if known != self.identity:
            raise ArgumentError(
                f"{str(self.folder)!r}", f"hold parts of this {self.study}", got=f"others{self._why(known or {})}"
            )

    def _identity_on_disk(self) -> dict[str, str] | None:
        try:
            found = json.loads(read(self._description))
        except (OSError, ValueError):
            return None
        return found if isinstance(found, dict) else None

    def _why(self, other: dict[str, Any]) -> str:
        """Return the differences of another study as text."""
        words = {
            "scenario": "another scenario",
            "function": "another function",
            self.study: "other points or options",
            "stridula_version": "another version",
        }
        if self.study not in other:
            return ", another file"
        differing = [word for name, word in words.items() if name in other and other[name] != self.identity.get(name)]
        return f", of {' and '.join(differing)}" if differing else ""

    def done(self, sizes: dict[int, int]) -> dict[int, list[Outcome]]:
        """Return the finished parts.

        Parameters
        ----------
        sizes : dict
            Number of points of each part.
        """
        found = {number: self._read(number) for number in sizes}
        return {number: part for number, part in found.items() if part is not None and len(part) == sizes[number]}

    def keep(self, number: int, outcomes: list[Outcome]) -> None:
        """Write a part.

        Raises
        ------
        OSError
            If it cannot be written.
        """
        self._open()
        write(self._path(number), _json(outcomes))

    def finish(self, found: xr.Dataset) -> None:
        """Write the whole study and remove the parts.

        Raises
        ------
        OSError
            If it cannot be written; the parts stay.
        """
        save(found, self.out)
        self.clear()

    def clear(self) -> None:
        """Remove the parts and their folder, unless it holds other files."""
        if not self.folder.is_dir():
            return
        for path in self.folder.glob("[0-9]*.json"):
            path.unlink(missing_ok=True)
        for path in self.folder.glob(".stridula-*"):
            path.unlink(missing_ok=True)
        # The description is deleted last, so that a folder with parts always has one.
        self._description.unlink(missing_ok=True)
        with suppress(OSError):
            self.folder.rmdir()

    def _open(self) -> None:
        with one_line(f"cannot write {str(self.folder)!r}"):
            self.folder.mkdir(exist_ok=True)
        if not self._description.exists():
            write(self._description, _json(self.identity))

    @property
    def _description(self) -> Path:
        """Path of the description of the study, kept beside the parts."""
        return self.folder / f"{self.study}.json"

    def _path(self, number: int) -> Path:
        return self.folder / f"{number:06d}.json"

    def _read(self, number: int) -> list[Outcome] | None:
        """Return a part, None if it is missing or damaged."""
        try:
            part = json.loads(read(self._path(number)))
        except (OSError, ValueError):
            return None
        is_whole = isinstance(part, list) and all(
            isinstance(outcome, dict) and outcome.keys() == {"ended", "message", "values"} for outcome in part
        )
        return part if is_whole else None


def _json(content: Any) -> bytes:
    return json.dumps(content, ensure_ascii=False).encode()
