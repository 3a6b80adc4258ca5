"""After the step: ledger, records, and runs that end."""
