"""Functions in universal files, of which time responses are signals: dataset 58, as text or binary."""

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
    functions, factors, others = _read(path, only_signals=True)
    signals = [_response(str(path), one) for one in functions]
    if not signals:
        got = ", ".join(dict.fromkeys(others)) or "no dataset"
        raise ArgumentError("path", "have a time response, dataset 58", str(path), got=f"{got} in {str(path)!r}")
    return _named(signals, factors)


def read_functions(path: Path) -> tuple[list[Function], tuple[float, float] | None]:
    """Return all functions of a universal file, and its length and force per metre and per newton.

    Raises
    ------
    ValueError
        If a line cannot be read; the message has file and line.
    """
    functions, factors, _ = _read(path, only_signals=False)
    return functions, factors


def _read(path: Path, *, only_signals: bool) -> tuple[list[Function], tuple[float, float] | None, list[str]]:
    """Return functions, factors of units, and the kinds of what is left out."""
    lines = _Lines(str(path), read(path))
    functions: list[Function] = []
    others: list[str] = []
    factors: tuple[float, float] | None = None
    while not lines.is_done:
        if lines.line().strip() != END:
            continue
        # An end without a dataset before it would take the next beginning for its end.
        head = END
        while not lines.is_done and head.strip() == END:
            head = lines.line()
        if head.strip() == END:
            break
        kind = head[:6].strip().decode("latin-1")
        if kind == FUNCTIONS:
            found = _function(lines, head, only_signals)
            if isinstance(found, str):
                others.append(found)
            else:
                functions.append(found)
        elif kind == UNITS:
            given = _factors(lines)
            if factors is not None and not np.allclose(given, factors, rtol=1e-6, atol=0.0):
                raise lines.wrong(f"units must not be mixed, got factors of {given} after {factors} in dataset 164")
            factors = given
        else:
            others.append(f"dataset {kind}")
            _skip(lines)
    return functions, factors, others


@dataclass(frozen=True)
class Function:
    """A function of dataset 58.

    Attributes
    ----------
    line : int
        Number of the line at which its values begin.
    title : str
        Its first line.
    kind : int
        Type of the function.
    place, reference : str
        Nodes with directions of the response and of the excitation, ``7 +Z``.
    data, over : int
        Types of the data of the response, and of that by which it is divided.
    label : str
        Label of the ordinate.
    units, over_units : str
        Units of both, `UNKNOWN` where the file does not state them.
    abscissa_units : str
        Units of the abscissa, or NONE.
    values : ndarray, shape (samples,)
        Real or complex.
    abscissa : ndarray, shape (samples,)
        In units of the file.
    start, interval : float
        Of an even abscissa; the interval is 0 for others.
    """

    line: int
    title: str
    kind: int
    place: str
    reference: str
    data: int
    over: int
    label: str
    units: str
    over_units: str
    abscissa_units: str
    values: Array
    abscissa: Array
    start: float
    interval: float


@dataclass(frozen=True)
class _Response:
    """A time response: its identification, its place, type, label and units of its ordinate, and its samples."""

    title: str
    place: str
    kind: int
    label: str
    units: str
    values: Array
    start: float
    rate: float


def _named(functions: list[_Response], factors: tuple[float, float] | None) -> list[Channel]:
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


def _function(lines: _Lines, head: bytes, only_signals: bool) -> Function | str:
    """Return the function that follows, or the kind of one that is left out in words."""
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
    kind, node, way, other, other_way = lines.numbers(line, (5, 10, 5, 10, 11, 10, 4, 11, 10, 4), "i----ii-ii")
    place, reference = (_place(line[at : at + 11], *ends) for at, ends in ((30, (node, way)), (55, (other, other_way))))
    form, number, spacing, start, interval = lines.numbers(lines.line(), (10, 10, 10, 13, 13), "iiiee")
    if int(form) not in FORMS or number < 0:
        raise lines.wrong(f"the type of data must be 2, 4, 5 or 6 and its number 0 or more, got {form} and {number}")
    abscissa, along = _axis(lines)
    ordinate, across = _axis(lines)
    over, below = _axis(lines)
    lines.line()
    is_double, is_complex = FORMS[int(form)]
    is_signal = kind == RESPONSE or (kind == GENERAL and abscissa == TIME)
    if only_signals and not is_signal:
        if is_binary:
            lines.taken(size)
        _skip(lines)
        return KINDS.get(int(kind), f"function of type {int(kind)}")
    if is_signal and is_complex:
        raise lines.wrong("a time response must be real, got complex numbers")
    parts = 2 if is_complex else 1
    first, count = lines.number + 1, int(number) * (parts if spacing else parts + 1)
    values = (
        _binary(lines, size, order, (is_double, is_complex), count)
        if is_binary
        else _text(lines, _widths(is_double, is_complex, bool(spacing)), count)
    )
    if spacing and not interval > 0.0:
        words = f"the interval of {'times' if is_signal else 'the abscissa'} must be above 0, got {interval}"
        raise ValueError(f"{lines.path}, line {first - 5}: {words}")
    rows = values.reshape(int(number), -1)
    even = start + interval * np.arange(int(number))
    return Function(
        line=first,
        title=title,
        kind=int(kind),
        place=place,
        reference=reference,
        data=int(ordinate),
        over=int(over),
        label=across[0],
        units=_units(across[1]),
        over_units=_units(below[1]),
        abscissa_units=along[1],
        values=rows[:, -2] + 1j * rows[:, -1] if is_complex else rows[:, -1].copy(),
        abscissa=even if spacing else rows[:, 0].copy(),
        start=start,
        interval=interval if spacing else 0.0,
    )


def _place(entity: bytes, node: float, direction: float) -> str:
    """Return a node with its direction in words, after the name of its entity, if it has one."""
    word = _word(entity)
    return f"{'' if word == NONE else word + ' '}{int(node)}{DIRECTIONS.get(int(direction), '')}"


def _units(word: str) -> str:
    return UNKNOWN if word == NONE else plain_units(word)


def _response(path: str, one: Function) -> _Response:
    """Return a function over time as samples at a rate."""
    scale = 1.0 if one.abscissa_units == NONE else seconds(one.abscissa_units)
    if scale is None:
        at_axis = one.line - 4
        raise ValueError(f"{path}, line {at_axis}: times must have a unit of time, got {one.abscissa_units!r}")
    count = one.values.size
    if count < 2:
        raise ValueError(f"{path}, line {one.line}: a time response must have at least 2 samples, got {count}")
    if one.interval:
        start, rate = one.start * scale, round_rate(1.0 / (one.interval * scale), 0.5 * SIX_DIGITS)
    else:
        times = one.abscissa * scale
        try:
            start, rate = grid(times, _six_digits(times, scale))
        except Uneven as error:
            raise ValueError(f"{path}, dataset that begins at line {one.line}: {error.words}") from None
    return _Response(one.title, one.place, one.data, one.label, one.units, one.values, start, rate)


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


def _binary(lines: _Lines, size: int, order: int, form: tuple[bool, bool], count: int) -> Array:
    is_double, is_complex = form
    kind = np.dtype(f"{'<' if order == 1 else '>'}f{8 if is_double else 4}")
    # pyuff counts the bytes of complex numbers as if they were real; the end of the dataset shows which are meant.
    size = 2 * size if is_complex and 2 * size == count * kind.itemsize else size
    if size != count * kind.itemsize:
        raise lines.wrong(f"{count} numbers must have {count * kind.itemsize} bytes, got {size}")
    values = np.frombuffer(lines.taken(size), kind).astype(float)
    wrong = np.flatnonzero(~np.isfinite(values))
    if wrong.size:
        raise lines.wrong(f"samples must be finite, got {values[wrong[0]]} at place {wrong[0]} (from 0)")
    # The line of the end may follow at once, or after an empty one.
    if (lines.line().strip() or lines.line().strip()) != END:
        raise lines.wrong("the dataset must end with -1 after its numbers")
    return values


def _widths(is_double: bool, is_complex: bool, is_even: bool) -> tuple[int, ...]:
    """Return the widths of the fields of a line; lines of uneven double numbers are those of whole samples."""
    if not is_double:
        return (13,) * 6
    if is_even:
        return (20,) * 4
    return (13, 20, 20) if is_complex else (13, 20, 13, 20)


def _text(lines: _Lines, widths: tuple[int, ...], count: int) -> Array:
    """Return the numbers up to the end of the dataset, separated by blanks or in fields of fixed width."""
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
