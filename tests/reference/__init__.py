"""Deliberately plain implementations: loops and textbook formulas that the kernels are compared with."""
