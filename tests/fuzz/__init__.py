"""Inputs that are wrong on purpose: what comes of each is a result, or a refusal in one line."""
