"""Compiled kernels of the march, which depend on numpy and numba only."""
