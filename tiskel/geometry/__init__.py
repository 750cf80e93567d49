"""Geometry that knows no stage: neighbours, rings, graphs, curves, oriented clouds, solids, round cones."""
