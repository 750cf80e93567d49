"""Curves in the formats of other programs: one file each, with its reader and its writer."""
