"""Steps 1, 2 and 6: motion of the modes, under loads, coupled, and of bodies that turn."""
