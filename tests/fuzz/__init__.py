"""Deliberately wrong inputs: each gives a result, or a refusal in one line."""
