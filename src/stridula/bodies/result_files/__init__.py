"""Modes computed by other programs, in their files of results."""
