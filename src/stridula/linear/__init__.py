"""Linear theory of sliding: the equilibrium of a system and its small motions about that."""
