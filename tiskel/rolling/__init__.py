"""A sphere, or another body, that rolls over a surface."""
