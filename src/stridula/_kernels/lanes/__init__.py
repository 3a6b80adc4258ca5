"""The numbers of the march: plain, or vectors of modes or runs, and how functions of them are compiled."""
