"""The command line: parse, call one library function, write one file or document."""
