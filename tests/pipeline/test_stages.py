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
from tiskel.gallery.catalogue import SHAPES
from tiskel.pictures.quality import quality_picture
from tiskel.pictures.skeleton import skeleton_picture
from tiskel.pictures.stability import stability_picture


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "method"),
    [(name, "robust") for name in sorted(SHAPES)]
    + [(name, method) for method in ("gls", "lbc") for name in sorted(SHAPES)[::3]],
)
def test_every_shape_goes_through_every_stage(name: str, method: Literal["robust", "gls", "lbc"]) -> None:
    cloud = make_shape(shape_graph(name), ShapeParams(count=1000))[0]
    c = contract(cloud, ContractionParams(method=method))
    s = extract_skeleton(c)
    assert len(s.nodes) > 0
    quality = evaluate(s)
    stability = assess_stability(c)
    json.dumps([quality.as_dict(), stability.as_dict()], allow_nan=False)
    assert quality.graph == pytest.approx(s.counts(), rel=1e-12)  # lengths go through normalised units
    if method == "robust" and name < "d":
        pictures = skeleton_picture(s, name), quality_picture([(name, cloud, quality)])
        assert all(picture.startswith(b"\x89PNG") for picture in (*pictures, stability_picture(c, stability, name)))
