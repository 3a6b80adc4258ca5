"""Names of all that the march is given and keeps: columns, rows, arguments, values of a contact."""
