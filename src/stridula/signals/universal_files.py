"""Time responses in universal files: dataset 58, as text or binary."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from ..disk import read
from .channels import UNKNOWN, Channel, Uneven, grid, plain_units, round_rate, seconds

END = b"-1"
FUNCTIONS, UNITS = "58", "164"
# Types of functions that are signals: general ones over time, and time responses.
GENERAL, RESPONSE = 0, 1
KINDS = {
    2: "auto spectrum",
    3: "cross spectrum",
    4: "frequency response function",
    6: "coherence",
    9: "power spectral density",
    12: "spectrum",
}
# Ordinates: whether double, and whether complex.
FORMS = {2: (False, False), 4: (True, False), 5: (False, True), 6: (True, True)}
TIME = 17
# Units of data by their type: exponents of length and force, and the SI unit.
SI = {
    8: (1, 0, "m"),
    9: (0, 1, "N"),
    11: (1, 0, "m/s"),
    12: (1, 0, "m/s2"),
    13: (0, 1, "N"),
    15: (-2, 1, "Pa"),
}
DIRECTIONS = {0: "", **{sign * k: f" {'-' if sign < 0 else '+'}{'XYZ'[k - 1]}" for k in (1, 2, 3) for sign in (1, -1)}}
DIRECTIONS |= {sign * k: f" {'-' if sign < 0 else '+'}R{'XYZ'[k - 4]}" for k in (4, 5, 6) for sign in (1, -1)}
# Relative error of numbers in format E13.5, and lines of the header.
SIX_DIGITS, HEADER = 1e-5, 11
NONE = "NONE"


@dataclass
class _Lines:
    """Bytes of a file, read line by line.

    Attributes
    ----------
    path : str
        The file.
    content : bytes
        Its content.
    at, number : int
        Place of the next line, and the number of the last one, from 1.
    """

    path: str
    content: bytes
    at: int = 0
    number: int = 0

    @property
    def is_done(self) -> bool:
        """Whether no line is left."""
        return self.at >= len(self.content)

    def line(self) -> bytes:
        """Return the next line without its end."""
        if self.is_done:
            raise self.wrong("the file is cut off")
        stop = self.content.find(b"\n", self.at)
        stop = len(self.content) if stop < 0 else stop
        found = self.content[self.at : stop].rstrip(b"\r")
        self.at, self.number = stop + 1, self.number + 1
        return found

    def taken(self, size: int) -> bytes:
        """Return the next bytes, however many lines they seem to have."""
        found = self.content[self.at : self.at + size]
        self.at += size
        if len(found) < size:
            raise self.wrong(f"{size} bytes must follow, got {len(found)}: the file is cut off")
        return found

    def wrong(self, words: str) -> ValueError:
        """Return the error that the last line cannot be read."""
        return ValueError(f"{self.path}, line {self.number}: {words}")

    def numbers(self, line: bytes, widths: tuple[int, ...], kinds: str) -> list[float]:
        """Return the fields of a line: whole numbers (i), numbers (e), or fields that are skipped (-)."""
        found, at = [], 0
        for width, kind in zip(widths, kinds, strict=True):
            text, at = line[at : at + width].strip(), at + width
            if kind == "-":
                continue
            try:
                found.append(float(_decimal(text)) if kind == "e" else int(text or b"0"))
            except ValueError:
                raise self.wrong(f"a number must be in columns {at - width + 1} to {at}, got {_shown(text)}") from None
        return found


def read_universal_signals(path: Path) -> list[Channel]:
    """Return the time responses of a universal file.

    Raises
    ------
    ValueError
        If it has none, or a line cannot be read; the message has file and line.
    """
    lines = _Lines(str(path), read(path))
    functions: list[_Function] = []
    others: list[str] = []
    factors: tuple[float, float] | None = None
    while not lines.is_done:
        if lines.line().strip() != END:
            continue
        if lines.is_done:
            break
        head = lines.line()
        kind = head[:6].strip().decode("latin-1")
        if kind == FUNCTIONS:
            found = _function(lines, head)
            if isinstance(found, str):
                others.append(found)
            else:
                functions.append(found)
        elif kind == UNITS:
            factors = _factors(lines)
        else:
            others.append(f"dataset {kind}")
            _skip(lines)
    if not functions:
        got = ", ".join(dict.fromkeys(others)) or "no dataset"
        raise ArgumentError("path", "have a time response, dataset 58", str(path), got=f"{got} in {str(path)!r}")
    return _named(functions, factors)


@dataclass(frozen=True)
class _Function:
    """A time response: its identification, its place, type, label and units of its ordinate, and its samples."""

    title: str
    place: str
    kind: int
    label: str
    units: str
    values: Array
    start: float
    rate: float


def _named(functions: list[_Function], factors: tuple[float, float] | None) -> list[Channel]:
    """Return time responses as channels, named by their titles if these differ, else by their places."""
    titles = [one.title for one in functions]
    by_title = all(title != NONE for title in titles) and len(set(titles)) == len(titles)
    channels = []
    for number, one in enumerate(functions):
        name = one.title if by_title else one.place
        alike = [other.place for other in functions[:number]].count(one.place)
        name = f"{name} ({alike + 1})" if not by_title and alike else name
        units, scale = one.units, 1.0
        if units == UNKNOWN and factors is not None and one.kind in SI:
            length, force, units = SI[one.kind]
            scale = factors[0] ** -length * factors[1] ** -force
        meaning = one.label if one.label != NONE else "" if by_title or one.title == NONE else one.title
        channels.append(Channel(name, units, one.values * scale, one.rate, one.start, meaning))
    return channels


def _factors(lines: _Lines) -> tuple[float, float]:
    """Return the length and the force of the file per metre and per newton."""
    lines.line()
    found = lines.numbers(lines.line(), (25, 25), "ee")
    if not all(factor > 0.0 for factor in found):
        raise lines.wrong("factors of units must be above 0")
    _skip(lines)
    return found[0], found[1]


def _skip(lines: _Lines) -> None:
    while not lines.is_done and lines.line().strip() != END:
        pass


def _function(lines: _Lines, head: bytes) -> _Function | str:
    """Return the time response that follows, or the kind of another function in words."""
    is_binary = head[6:7].lower() == b"b"
    order, count_of_lines, size = 1, HEADER, 0
    if is_binary:
        found = lines.numbers(head, (6, 1, 6, 6, 12, 12), "--iiii")
        order, count_of_lines, size = int(found[0]), int(found[2]), int(found[3])
        if order not in (1, 2) or found[1] != 2 or count_of_lines != HEADER:
            raise lines.wrong("a binary dataset 58 must have 11 lines and IEEE numbers of either order of bytes")
    title = _word(lines.line()[:80])
    for _ in range(4):
        lines.line()
    line = lines.line()
    kind, node, direction = lines.numbers(line, (5, 10, 5, 10, 11, 10, 4), "i----ii")
    entity = _word(line[30:41])
    place = f"{'' if entity == NONE else entity + ' '}{int(node)}{DIRECTIONS.get(int(direction), '')}"
    form, number, spacing, start, interval = lines.numbers(lines.line(), (10, 10, 10, 13, 13), "iiiee")
    if int(form) not in FORMS or number < 0:
        raise lines.wrong(f"the type of data must be 2, 4, 5 or 6 and its number 0 or more, got {form} and {number}")
    abscissa, along = _axis(lines)
    at_axis = lines.number
    ordinate, across = _axis(lines)
    lines.line()
    lines.line()
    is_double, is_complex = FORMS[int(form)]
    if kind not in (GENERAL, RESPONSE) or (kind == GENERAL and abscissa != TIME):
        if is_binary:
            lines.taken(size)
        _skip(lines)
        return KINDS.get(int(kind), f"function of type {int(kind)}")
    if is_complex:
        raise lines.wrong("a time response must be real, got complex numbers")
    first, count = lines.number + 1, int(number) * (1 if spacing else 2)
    values = _binary(lines, size, order, is_double, count) if is_binary else _text(lines, is_double, spacing, count)
    scale = 1.0 if along[1] == NONE else seconds(along[1])
    if scale is None:
        raise ValueError(f"{lines.path}, line {at_axis}: times must have a unit of time, got {along[1]!r}")
    if number < 2:
        raise ValueError(f"{lines.path}, line {first}: a time response must have at least 2 samples, got {number:g}")
    units = UNKNOWN if across[1] == NONE else plain_units(across[1])
    if spacing:
        if not interval > 0.0:
            raise ValueError(f"{lines.path}, line {at_axis - 1}: the interval of times must be above 0, got {interval}")
        rate = round_rate(1.0 / (interval * scale), 0.5 * SIX_DIGITS)
        return _Function(title, place, int(ordinate), across[0], units, values, start * scale, rate)
    times = values[::2] * scale
    try:
        start, rate = grid(times, _six_digits(times, scale))
    except Uneven as error:
        raise ValueError(f"{lines.path}, dataset that begins at line {first}: {error.words}") from None
    return _Function(title, place, int(ordinate), across[0], units, values[1::2].copy(), start, rate)


def _six_digits(times: Array, scale: float) -> Array:
    """Return the value of the last digit of times in format E13.5 [s]."""
    size = np.abs(times) / scale
    exponent = np.floor(np.log10(np.where(size > 0.0, size, 1.0)))
    return np.where(size > 0.0, scale * 10.0 ** (exponent - 5.0), 0.0)


def _axis(lines: _Lines) -> tuple[int, tuple[str, str]]:
    """Return type, label and units of an axis."""
    line = lines.line()
    (kind,) = lines.numbers(line, (10,), "i")
    return int(kind), (_word(line[25:46]), _word(line[46:67]))


def _word(text: bytes) -> str:
    try:
        found = text.decode("utf-8").strip()
    except UnicodeDecodeError:
        found = text.decode("latin-1").strip()
    return NONE if not found or found.upper() == NONE else found


def _binary(lines: _Lines, size: int, order: int, is_double: bool, count: int) -> Array:
    kind = np.dtype(f"{'<' if order == 1 else '>'}f{8 if is_double else 4}")
    if size != count * kind.itemsize:
        raise lines.wrong(f"{count} numbers must have {count * kind.itemsize} bytes, got {size}")
    values = np.frombuffer(lines.taken(size), kind).astype(float)
    wrong = np.flatnonzero(~np.isfinite(values))
    if wrong.size:
        raise lines.wrong(f"samples must be finite, got {values[wrong[0]]} at place {wrong[0]} (from 0)")
    # The line of the end may follow at once.
    if not lines.is_done and lines.line().strip() not in (END, b""):
        raise lines.wrong("the dataset must end with -1 after its numbers")
    return values


def _text(lines: _Lines, is_double: bool, spacing: float, count: int) -> Array:
    """Return the numbers up to the end of the dataset, separated by blanks or in fields of fixed width."""
    widths: tuple[int, ...] = (13,) * 6
    if is_double:
        widths = (20,) * 4 if spacing else (13, 20, 13, 20)
    body: list[bytes] = []
    while (line := lines.line()).strip() != END:
        body.append(line)
    while body and not body[-1].strip():
        body.pop()
    found: list[float] = []
    end, lines.number = lines.number, lines.number - len(body) - 1
    for number, line in enumerate(body, 1):
        lines.number = end - len(body) - 1 + number
        values = _words(line)
        if not values or (len(values) != len(widths) and number < len(body)):
            values = _fields(lines, line, widths, count - len(found))
        if not np.isfinite(values).all():
            raise lines.wrong("numbers must be finite")
        found += values
    lines.number = end
    if len(found) != count:
        raise lines.wrong(f"the dataset must have {count} numbers, got {len(found)}")
    return np.array(found)


def _words(line: bytes) -> list[float]:
    """Return the numbers of a line between blanks, empty if some are not separated or are none."""
    try:
        return [float(_decimal(word)) for word in line.split()]
    except ValueError:
        return []


def _fields(lines: _Lines, line: bytes, widths: tuple[int, ...], left: int) -> list[float]:
    """Return the numbers of a line in fields of fixed width."""
    used = widths[: max(0, min(len(widths), left))]
    if len(line.rstrip()) > sum(used):
        raise lines.wrong(f"{len(used)} numbers must be here, got {_shown(line)}")
    return lines.numbers(line, used, "e" * len(used))


def _decimal(text: bytes) -> bytes:
    return text.replace(b"D", b"E").replace(b"d", b"e")


def _shown(text: bytes) -> str:
    return repr(text.decode("latin-1").strip()[:60])
