"""Wide limbs: the curve of a flat limb is its middle line, without bends to and fro and without its corners."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from tiskel import ShapeParams, contract, extract_skeleton, make_shape, named_shape
from tiskel.geometry.curve import curve_samples

NOISE = pytest.mark.parametrize("noise", [0.0, 0.1])


@NOISE
@pytest.mark.parametrize("name", ["flat-tube", "strap"])
def test_a_flat_limb_has_its_middle_line(name: str, noise: float) -> None:
    """Bent tubes of 4 : 1 and 8 : 1; thinned curves of the strap are up to three times as long as its middle line."""
    shape = named_shape(name)
    made = extract_skeleton(contract(make_shape(shape, ShapeParams(count=16384, noise=noise))[0]))
    assert (made.components, made.loops, made.ends) == (1, 0, 2)
    assert 0.9 * shape.length < made.length < 1.1 * shape.length
    truth = cKDTree(curve_samples(shape, 2000).points)
    assert truth.query(curve_samples(made, 500).points)[0].mean() < 0.015  # half thicknesses are .03 and .06
    ends = made.nodes[made.degrees == 1]
    assert truth.query(ends)[0].max() < 0.16  # not in a corner, which is .24 away
    assert not made.warnings


@NOISE
@pytest.mark.parametrize("count", [4096, 8192, 16384])
def test_a_band_is_a_ring_without_ends(count: int, noise: float) -> None:
    """What thinning leaves in a wide ring may lead to its rim; it stays within the band's width and is no limb."""
    made = extract_skeleton(contract(make_shape(named_shape("band"), ShapeParams(count=count, noise=noise))[0]))
    assert (made.components, made.loops, made.ends) == (1, 1, 0)


def test_a_strap_thinner_than_three_spacings_is_a_sheet_between_its_faces() -> None:
    """Its nodes lie in the middle of their points, and these were owned to and fro: the curve was 2.3 times as long."""
    shape = named_shape("strap")
    cloud = make_shape(shape)[0]
    made = extract_skeleton(contract(cloud))
    assert made.length < 1.4 * shape.length
    sheet = np.flatnonzero(made.regimes == 2)
    assert len(sheet) > 10
    truth = cKDTree(curve_samples(shape, 2000).points)
    away = truth.query(made.nodes[sheet])[0]
    assert np.median(away) < 0.5 * cKDTree(cloud).query(made.nodes[sheet])[0].mean() + 0.02  # faces are .03 away
