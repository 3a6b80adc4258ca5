"""Description of the machine, as far as ratios depend on it, without its name."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
from pathlib import Path

import llvmlite.binding as llvm
import numba
import numpy as np

import stridula as st


def description() -> list[str]:
    """Return the machine, the interpreter, the packages and the compiler, a line each."""
    return [
        f"processor: {processor()}, {os.cpu_count()} cores; {llvm.get_host_cpu_name()}, {vector_bits()}",
        f"system: {platform.system()} on {platform.machine()}",
        f"python {platform.python_version()}, numpy {np.__version__}, numba {numba.__version__}, "
        f"stridula {st.__version__}",
        f"C: {compiler()}",
    ]


def processor() -> str:
    """Return the model name of the processor."""
    listed = Path("/proc/cpuinfo")
    if listed.exists():
        for line in listed.read_text(encoding="utf-8").splitlines():
            name, _, value = line.partition(":")
            if name.strip() in ("model name", "Model"):
                return value.strip()
    if platform.system() == "Darwin":
        return printed("sysctl", "-n", "machdep.cpu.brand_string")
    return platform.processor() or "unknown"


def vector_bits() -> str:
    """Return the widest vectors of doubles."""
    has = llvm.get_host_cpu_features()
    for feature, words in (("avx512f", "AVX-512, 512 bits"), ("avx2", "AVX2, 256 bits"), ("neon", "NEON, 128 bits")):
        if has.get(feature):
            return f"vectors: {words}"
    return "vectors: 128 bits"


def compiler() -> str:
    """Return the C compiler of the reference."""
    return printed("gcc", "--version").partition("\n")[0] if shutil.which("gcc") else "none"


def printed(*command: str) -> str:
    """Return the output of a command."""
    return subprocess.run(command, capture_output=True, text=True).stdout.strip()
