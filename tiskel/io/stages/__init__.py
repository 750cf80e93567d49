"""One file for each stage file."""
