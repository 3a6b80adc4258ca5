"""Steps 4 and 5 for all contacts together: compliance, sweeps and direct solves."""
