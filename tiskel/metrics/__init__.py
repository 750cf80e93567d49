"""Measures of a skeleton: topology, loops, boundedness, inside, centredness, smoothness."""
