"""Contractions of gallery shapes whose true curve is known: by print's stopping rule, with noise, with another s_L."""

from typing import Any

from subjects import distance, meaningful

from tiskel import (
    ConditioningParams,
    ContractionParams,
    GlsParams,
    ShapeParams,
    TiskelError,
    condition,
    contract,
    extract_skeleton,
    make_shape,
    shape_graph,
)

Json = dict[str, Any]


def printed_stop(name: str, count: int, variant: str) -> Json:
    """Contract by the stopping rule alone, without a least number of steps; none where the first one fails."""
    try:
        c = contract(
            make_shape(shape_graph(name), ShapeParams(count=count))[0], GlsParams(min_steps=1, variant=variant)
        )
    except TiskelError:
        return {"steps": 0}
    return {"steps": len(c.steps)}


def noisy(name: str, noise: float, method: str, count: int) -> Json:
    """Contract a noisy shape; is the topology of the curve right? Without a curve where the contraction fails."""
    shape = shape_graph(name)
    clean = make_shape(shape, ShapeParams(count=count))[0]
    cloud = condition(clean, ConditioningParams(noise=noise, noise_kind="diagonal"))[0]
    drawn: Json = {"cloud": cloud[::4].round(3).tolist(), "nodes": [], "edges": []}
    try:
        s = extract_skeleton(contract(cloud, ContractionParams(method=method)))
    except TiskelError:
        return drawn | {"right": False, "distance": float("nan")}
    flat = {"nodes": s.nodes.round(4).tolist(), "edges": s.edges.tolist()}
    return drawn | flat | {"right": meaningful(s, shape), "distance": distance(s, shape)}


def grown(name: str, growth: float, method: str, count: int) -> Json:
    """Contract with another s_L."""
    shape = shape_graph(name)
    cloud = make_shape(shape, ShapeParams(count=count))[0]
    try:
        c = contract(cloud, ContractionParams(method=method, growth=growth))
    except TiskelError:
        return {"steps": 0, "right": False, "distance": float("nan")}
    s = extract_skeleton(c)
    return {"steps": len(c.steps), "right": meaningful(s, shape), "distance": distance(s, shape)}
