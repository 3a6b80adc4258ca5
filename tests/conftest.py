"""Settings shared by all tests."""

from __future__ import annotations

from hypothesis import settings

# The same examples in every run: a test that fails must fail again.
settings.register_profile("repeatable", derandomize=True, database=None)
settings.load_profile("repeatable")
