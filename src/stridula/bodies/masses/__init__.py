"""Masses without elasticity: points and rigid bodies."""
