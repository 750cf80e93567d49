"""Clouds with known curve skeletons: unions of round cones, and bodies of other kinds."""
