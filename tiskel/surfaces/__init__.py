"""Parametric surfaces with two derivatives: fitted around a skeleton curve, and analytic."""
