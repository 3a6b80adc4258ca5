"""Reduction of matrices to modes, dense or sparse."""
