"""Many runs of one system: what its starts leave to chance."""

from .ensembles import ensemble, mean_and_interval, share_of

__all__ = ["ensemble", "mean_and_interval", "share_of"]
