"""Parts of all readers of files: lines of numbers, fields of Nastran, and numbers that are not finite."""
