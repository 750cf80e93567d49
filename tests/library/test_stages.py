"""Every shape through every stage, with its pictures: whatever comes out, it comes out whole."""

import json
from typing import Literal

import pytest

from tiskel import (
    ContractionParams,
    ShapeParams,
    assess_stability,
    contract,
    evaluate,
    extract_skeleton,
    make_shape,
    shape_graph,
)
from tiskel.pictures.quality import quality_picture
from tiskel.pictures.skeleton import skeleton_picture
from tiskel.pictures.stability import stability_picture
from tiskel.shapes.catalogue import SHAPES


@pytest.mark.slow
@pytest.mark.parametrize("method", ["gls", "lbc"])
@pytest.mark.parametrize("name", sorted(SHAPES))
def test_every_shape_goes_through_every_stage(name: str, method: Literal["gls", "lbc"]) -> None:
    cloud = make_shape(shape_graph(name), ShapeParams(count=1000))[0]
    c = contract(cloud, ContractionParams(method=method))
    s = extract_skeleton(c)
    assert len(s.nodes) > 0
    quality = evaluate(s.cloud, c.points, s.nodes, s.edges, origin=c.origin)
    stability = assess_stability(c)
    json.dumps([quality.as_dict(), stability.as_dict()], allow_nan=False)
    assert quality.graph == pytest.approx(s.counts(), rel=1e-12)  # lengths go through normalised units
    if method == "gls":
        pictures = skeleton_picture(s, name), quality_picture([(name, cloud, quality)])
        assert all(picture.startswith(b"\x89PNG") for picture in (*pictures, stability_picture(c, stability, name)))
