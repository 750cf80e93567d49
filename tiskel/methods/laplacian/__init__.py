"""Laplacian contraction as published: lbc (Cao et al. 2010) and gls (Wen et al. 2024)."""
