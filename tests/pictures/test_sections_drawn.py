"""What pictures of slices say is of what they show."""

import re

from tiskel import ShapeParams, SurfaceParams, fit_surface, make_shape, shape_graph
from tiskel.pictures.slices import slices_picture


def test_a_section_tells_the_error_of_the_surface_that_is_drawn() -> None:
    """The curve of a section is that of the joined surface, not of the section's own series, and so is its error."""
    surfaces = fit_surface(make_shape(shape_graph("banana"), ShapeParams(count=800))[1], SurfaceParams(interval=0.05))
    drawn = slices_picture(surfaces, "banana", "svg").decode()
    said = " ".join(" ".join(re.findall(r"<!-- (.*?) -->", drawn, re.DOTALL)).split())
    found = re.search(r"section at v = \S+ of the joined surface: order \d, points off by (\S+)% of R", said)
    assert found is not None
    assert 0 < float(found[1]) < 5  # a thin shape of few points, without noise
