"""Results in one line, in a notebook, and beside each other."""

import importlib
import pkgutil
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from typing import Any, get_args, get_origin, get_type_hints

import numpy as np
import pytest

import tiskel
from tiskel import PipelineParams, RollParams, ShapeParams, make_shape, roll_body, run_pipeline
from tiskel.surfaces.analytic import Ellipsoid, Torus


def classes() -> Iterator[type]:
    """Yield the dataclasses of the library."""
    for module in pkgutil.walk_packages(tiskel.__path__, "tiskel."):
        if not module.name.startswith(("tiskel.cli", "tiskel.kernels")):
            for thing in vars(importlib.import_module(module.name)).values():
                if isinstance(thing, type) and is_dataclass(thing) and thing.__module__ == module.name:
                    yield thing


def compares_arrays(kind: Any, within: tuple[Any, ...] = ()) -> bool:
    """Return whether == of two of these would compare arrays, and raise."""
    if isinstance(kind, type) and is_dataclass(kind):
        if kind in within or not kind.__dataclass_params__.eq:  # type: ignore[attr-defined]
            return False
        hints = get_type_hints(kind)
        return any(compares_arrays(hints[f.name], (*within, kind)) for f in fields(kind) if f.compare)
    if kind is np.ndarray or get_origin(kind) is np.ndarray:
        return True
    return get_origin(kind) is not Callable and any(compares_arrays(part, within) for part in get_args(kind))


def test_no_comparison_raises() -> None:
    found = list(classes())
    assert len(found) > 150
    assert [kind.__name__ for kind in found if compares_arrays(kind)] == []


@pytest.fixture(scope="module")
def results() -> dict[str, Any]:
    cloud, true = make_shape("capsule", ShapeParams(count=500))
    result = run_pipeline(cloud, PipelineParams(stages=("contract", "skeleton", "metrics", "surface", "roll")))
    params = RollParams(omega=(0.5, 0.3, 0), start=(0.3, 1.0, 0.1, 0.1, 0.4), duration=0.1, rate=10)
    return {
        "cloud": tiskel.Cloud(cloud, name="a.ply"),
        "contraction": result.contraction,
        "skeleton": true,
        "graph": tiskel.shape_graph("y"),
        "quality": result.quality,
        "surfaces": result.surfaces,
        "tube": result.surface,
        "body": result.surfaces and result.surfaces.body,
        "run": result.trajectories[0],
        "bodies": roll_body(Torus(5.0, 2.0), Ellipsoid(0.3, 0.4, 0.25), params),
        "pipeline": result,
        "inputs": tiskel.Inputs(np.array([0.0]), np.zeros((1, 6))),
        "view": true.view(),
    }


def test_results_say_themselves_in_one_line(results: dict[str, Any]) -> None:
    for name, result in results.items():
        line = repr(result)
        assert "\n" not in line
        assert "array" not in line
        assert len(line) <= 300, name
        assert line.startswith(f"<{type(result).__name__} ")
    assert repr(results["cloud"]) == "<Cloud name='a.ply' points=500 properties=0 warnings=0>"
    assert repr(results["skeleton"]).startswith("<Skeleton nodes=2 components=1 loops=0 ends=2 junctions=0 length=")
    assert repr(results["contraction"]).startswith("<Contraction method='robust' points=")
    assert "inside_curve=" in repr(results["quality"])


def test_results_are_equal_to_themselves_alone(results: dict[str, Any]) -> None:
    for result in results.values():
        assert result == result  # noqa: PLR0124
        assert (result == results["graph"]) is (result is results["graph"])
        assert result in {result}


@pytest.mark.parametrize("name", ["cloud", "contraction", "skeleton", "graph", "surfaces", "tube", "run", "pipeline"])
def test_a_notebook_shows_what_has_a_place_in_space(name: str, results: dict[str, Any]) -> None:
    assert "<iframe" in results[name]._repr_html_()


def test_a_notebook_shows_measures_as_a_table(results: dict[str, Any]) -> None:
    assert results["quality"]._repr_html_().startswith("<table><tr><th>measure</th><th>value</th></tr><tr><td>bounded")
