"""Gaps in angle against the definition, place by place."""

import numpy as np

from reference.air import widest_gap
from tiskel.geometry.air import widest_gaps


def test_widest_gaps_are_those_of_the_definition() -> None:
    generator = np.random.default_rng(8)
    cloud = generator.normal(size=(700, 3))
    places = np.concatenate([generator.normal(size=(60, 3)), 9 + generator.normal(size=(5, 3))])
    directions = generator.normal(size=(65, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    half = generator.uniform(0.02, 0.6, 65)
    half[:3] = 1e-6  # nothing in the slab, a whole turn
    found = widest_gaps(places, directions, half, cloud)
    plain = [widest_gap(place, x, h, cloud) for place, x, h in zip(places, directions, half, strict=True)]
    wide = np.array(plain) > 2 * np.pi / 72  # a gap within one sector is not seen, and none is so narrow here
    assert wide.all()
    np.testing.assert_allclose(found, plain, rtol=1e-9)
    assert (found[:3] == 2 * np.pi).all()
    assert (found > np.pi).sum() > 5
    assert (found < np.pi).sum() > 5
