"""Bodies given by matrices or by modes, from other programs and measurements."""
