"""Beams, strings and plates."""
