"""Method "robust": sections of the original cloud by fronts, their graph, and a curve of round cones fitted to it."""
