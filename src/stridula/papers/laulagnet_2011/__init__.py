"""Laulagnet, *Friction noise model for two beams in contact*, ICSV 18, Rio de Janeiro, 2011 (hal-00609457)."""

from .claims import CLAIMS, Claim
from .reproduce import reproduce
from .runs import Runs

__all__ = ["CLAIMS", "Claim", "Runs", "reproduce"]
