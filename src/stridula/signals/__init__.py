"""Signals in files of other programs: sound files, tables, universal files, TDMS and MDF4."""

from .mobilities import read_mobilities
from .reading import read_signal, read_signals
from .writing import write_signal

__all__ = ["read_mobilities", "read_signal", "read_signals", "write_signal"]
