"""Ways from a cloud to a curve skeleton, one room each."""
