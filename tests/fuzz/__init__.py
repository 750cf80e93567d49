"""Damaged files through every reader."""
