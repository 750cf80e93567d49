"""Slices across a skeleton, and the Fourier surface through them."""
