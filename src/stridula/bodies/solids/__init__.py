"""Bodies meshed in space."""
