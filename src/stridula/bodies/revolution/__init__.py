"""Bodies of revolution: discs, wheels, bells and glasses."""
