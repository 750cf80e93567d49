"""The picture of slices: a surface that is small against its body is drawn close up."""

import numpy as np

from tiskel import ShapeParams, fit_surface, make_shape, shape_graph
from tiskel.geometry.strays import body_of
from tiskel.pictures.canvas import sight_of
from tiskel.pictures.slices import SMALL, frame_of


def test_a_small_surface_is_framed_with_room_and_a_large_one_by_its_body() -> None:
    for name, close in (("hand", True), ("banana", False)):
        surfaces = fit_surface(make_shape(shape_graph(name), ShapeParams(count=2000))[1])
        surface = min(surfaces, key=lambda s: s.length)
        body = sight_of(body_of(surface.cloud))
        frame = frame_of(surface, body)
        assert (frame is not body.cloud) == close
        points = surface.cloud[surface.rows]
        assert (frame.min(axis=0) <= points.min(axis=0)).all()
        assert (frame.max(axis=0) >= points.max(axis=0)).all()
        whole = np.linalg.norm(np.ptp(body.cloud, axis=0))
        if close:
            assert np.linalg.norm(np.ptp(frame, axis=0)) < 2 * SMALL * whole
