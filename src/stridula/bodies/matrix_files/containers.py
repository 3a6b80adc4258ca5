"""Files with a whole body: NumPy's and MATLAB's."""

from __future__ import annotations

import io
import math
import os
import zipfile
from collections.abc import Mapping
from typing import Any

import numpy as np
import scipy.io
import scipy.sparse

from ...checks import ArgumentError, at_least, listed
from ...disk import opened, write
from .. import limits
from ..limits import check_size
from .matlab import read_matlab

# Readers of the headers of NumPy's arrays by version; version 3 is only for arrays with named fields.
HEADERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
LONGEST_HEADER = 10_000

MATRICES = ("mass", "stiffness", "damping")
OTHERS = ("translation", "rayleigh", "cutoff", "residual_flexibility", "name")
SYNONYMS = {"M": "mass", "K": "stiffness", "C": "damping"}
POINT = "point_"


def read_npz(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the arrays of an .npz file by the parameters of `ReducedBody`."""
    return _parts(_npz(path))


def read_mat(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the arrays of a MATLAB file by the parameters of `ReducedBody`."""
    return _parts(_mat(path))


def _parts(arrays: Mapping[str, Any]) -> dict[str, Any]:
    contents = {name: arrays[name] for name in (*MATRICES, *OTHERS) if name in arrays}
    contents["points"] = {name[len(POINT) :]: rows for name, rows in arrays.items() if name.startswith(POINT)}
    return contents


def write_npz(path: str | os.PathLike[str], arrays: Mapping[str, Any]) -> None:
    """Write arrays to an .npz file, whole or not at all."""
    content = io.BytesIO()
    plain: dict[str, Any] = dict(arrays)
    np.savez(content, **plain)
    write(path, content.getbuffer())


def _npz(path: str | os.PathLike[str]) -> dict[str, Any]:
    with opened(path) as content, zipfile.ZipFile(content) as archive:
        unpacked = sum(entry.file_size for entry in archive.infolist())
        if unpacked > limits.LARGEST_FILE:
            raise ValueError(f"{at_least(unpacked / 1024**3, 3)} GiB when unpacked, but at most 2 GiB are read")
        entries = _arrays_in(archive)
        for name, entry in entries.items():
            _check_header(name, archive, entry)
    with opened(path) as content, np.load(content, allow_pickle=False) as file:
        return _by_words({name: file[name] for name in entries})


def _arrays_in(archive: zipfile.ZipFile) -> dict[str, zipfile.ZipInfo]:
    """Return the entries of the known arrays by name."""
    entries = {entry.filename.removesuffix(".npy"): entry for entry in archive.infolist()}
    known = (*SYNONYMS, *MATRICES, *OTHERS)
    return {name: entry for name, entry in entries.items() if name in known or name.startswith(POINT)}


def _check_header(name: str, archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> None:
    """Raise ValueError unless the header of an array announces numbers or a text that fit into its file."""
    with archive.open(entry) as file:
        try:
            version = np.lib.format.read_magic(file)
        except ValueError:
            raise ArgumentError(name, "be an array of numbers", got="other bytes") from None
        if version not in HEADERS:
            raise ArgumentError(name, "be an array of numbers", got=f"one of version {version} of its format")
        shape, _, kind = HEADERS[version](file, max_header_size=LONGEST_HEADER)
    if kind.kind not in "fiubcSU":
        raise ArgumentError(name, "be an array of numbers", got=f"one of kind {kind}")
    check_size(name, max(shape, default=0))
    if math.prod(shape) * kind.itemsize > entry.file_size:
        raise ArgumentError(name, f"hold the {math.prod(shape)} numbers that its header announces, but holds fewer")


def _by_words(held: Mapping[str, Any]) -> dict[str, Any]:
    """Return arrays by the parameters of `ReducedBody`; a matrix may have both its names only if both are equal."""
    arrays = {name: array for name, array in held.items() if name not in SYNONYMS}
    for symbol, word in SYNONYMS.items():
        if symbol not in held:
            continue
        if word in held and not _equal(held[symbol], held[word]):
            raise ValueError(f"it must hold {word} once, but holds {word} and {symbol}, which differ")
        arrays[word] = held[symbol]
    for name in MATRICES[:2]:
        if name not in arrays:
            raise ValueError(f"it must hold {name}, but holds {listed(sorted(arrays) or ['nothing known'])}")
    return arrays


def _equal(one: Any, other: Any) -> bool:
    first, second = (part.toarray() if scipy.sparse.issparse(part) else np.asarray(part) for part in (one, other))
    return np.array_equal(first, second)


def _mat(path: str | os.PathLike[str]) -> dict[str, Any]:
    with opened(path) as file:
        # A file of version 4 begins with a number below 5000.
        is_of_version_5 = 0 not in file.read(4)
    arrays = _by_words((read_matlab if is_of_version_5 else _of_version_4)(path, _is_matrix, _check_shape))
    damping = arrays.get("damping")
    if isinstance(damping, np.ndarray) and 1 in damping.shape and damping.shape != arrays["mass"].shape:
        # MATLAB stores numbers and lists as matrices: one number is a ratio, a row or a column a list of ratios.
        arrays["damping"] = damping.ravel() if damping.size > 1 else damping.ravel()[0]
    return arrays


def _is_matrix(name: str) -> bool:
    return name in (*SYNONYMS, *MATRICES, "translation") or name.startswith(POINT)


def _check_shape(name: str, shape: tuple[int, ...]) -> None:
    check_size(name, max(shape, default=0))


def _of_version_4(path: str | os.PathLike[str], is_wanted: Any, check_shape: Any) -> dict[str, Any]:
    shapes = {name: shape for name, shape, _ in scipy.io.whosmat(os.fspath(path), appendmat=False)}
    wanted = [name for name in shapes if is_wanted(name)]
    for name in wanted:
        check_shape(name, shapes[name])
    held = scipy.io.loadmat(os.fspath(path), appendmat=False, variable_names=wanted)
    return {name: held[name] for name in wanted}
