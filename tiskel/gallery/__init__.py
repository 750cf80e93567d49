"""Clouds with known curve skeletons, made from unions of round cones."""
