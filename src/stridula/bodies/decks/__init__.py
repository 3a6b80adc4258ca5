"""Decks of finite-element programs: models as text, with nodes, elements, sets, placed parts and materials."""
