"""Linear theory of sliding: where a system is when nothing vibrates, and its small motions about that."""
