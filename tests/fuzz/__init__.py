"""Inputs at random, from a seed, and what must hold for each of them."""
