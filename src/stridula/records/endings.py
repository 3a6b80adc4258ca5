"""Endings of runs whose results are not valid, as records name them."""

FAILED = ("not finite", "contact unsolved", "energy created", "spring too stiff")
