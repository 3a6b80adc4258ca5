"""Packages of extras: if one is missing, an error names its purpose and the command that installs it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from typing import Any

# Purpose of each package, and its extra.
NEEDED = {
    "pydantic": ("scenarios need", "scenarios"),
    "h5netcdf": ("records in files need", "files"),
    "h5py": ("records and meshes in files need", "files"),
    "meshio": ("meshes in files need", "files"),
    "soundfile": ("sound files need", "sound"),
    "matplotlib": ("figures need", "plot"),
    "jinja2": ("reports need", "report"),
    "typer": ("the command line needs", "cli"),
    "rich": ("the command line needs", "cli"),
    "starlette": ("the page needs", "page"),
    "uvicorn": ("the page needs", "page"),
    "websockets": ("the page needs", "page"),
    "nptdms": ("TDMS files need", "signals"),
    "asammdf": ("MDF files need", "signals"),
    "mosqito": ("loudness, sharpness and roughness need", "psycho"),
    "pyvista": ("views need", "view"),
    "openturns": ("surrogates of modes need", "surrogate"),
    "distributed": ("other machines need", "distributed"),
}


class MissingPackage(ModuleNotFoundError):
    """A package of an extra is not installed."""


def missing(package: str) -> MissingPackage:
    """Return the error for a package that is not installed."""
    needs, extra = NEEDED[package]
    return MissingPackage(f"{needs} {package}, which is not installed: {how_to_install(extra)}", name=package)


def require(package: str) -> None:
    """Raise `MissingPackage` unless a package is installed."""
    if find_spec(package) is None:
        raise missing(package)


def how_to_install(extra: str) -> str:
    """Return the command that installs an extra; there is no distribution of this name on the index."""
    return f'pip install ".[{extra}]" in the source folder'


@contextmanager
def named_extras() -> Iterator[None]:
    """Turn failed imports of packages of extras into `MissingPackage`."""
    try:
        yield
    except MissingPackage:
        raise
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package not in NEEDED:
            raise
        raise missing(package) from None


def on_first_use(package: str, homes: Mapping[str, str], name: str) -> Any:
    """Return a public name of a package from its module, which is imported now, and keep it in the package.

    Raises
    ------
    AttributeError
        If the package has no such name.
    MissingPackage
        If the module needs an extra that is not installed.
    """
    if name not in homes:
        raise AttributeError(f"module {package!r} has no attribute {name!r}")
    with named_extras():
        module = import_module(f".{homes[name]}", package)
    # The next use finds it there, without a call.
    value = vars(import_module(package))[name] = getattr(module, name)
    return value
