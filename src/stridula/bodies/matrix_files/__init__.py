"""Files of matrices: NumPy, MATLAB, Matrix Market, and the formats of finite-element programs.

Each format has a module here and a line in `formats.py`; all readers return `Entries`, which `aligned.py` brings to
the same degrees of freedom.
"""

from .aligned import AlignedMatrices, files_of, read_container, read_matrices
from .containers import POINT, write_npz
from .nodes import Nodes, read_nodes

__all__ = [
    "POINT",
    "AlignedMatrices",
    "Nodes",
    "files_of",
    "read_container",
    "read_matrices",
    "read_nodes",
    "write_npz",
]
