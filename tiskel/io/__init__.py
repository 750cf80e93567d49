"""Reading and writing files: the only place in the library that touches them."""
