"""Results on one page that turns under the mouse, and as a still picture: scenes of layers, and what shows them."""
