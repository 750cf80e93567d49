"""Clouds and meshes of other programs, as objects."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tiskel import Cloud, TiskelError, condition, contract, evaluate, fit_surface, load_cloud, make_shape, run_pipeline
from tiskel.geometry.given import given_cloud

CLOUD, TRUE = make_shape("banana", 900)


class Vector:
    """As Open3D has its vectors: no array, but it can become one."""

    def __init__(self, rows: Any) -> None:
        self.rows = rows

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        return np.array(self.rows, dtype)


def test_a_cloud_is_what_has_points() -> None:
    for thing in (CLOUD.tolist(), Cloud(CLOUD), SimpleNamespace(points=Vector(CLOUD)), SimpleNamespace(vertices=CLOUD)):
        points, surface = given_cloud(thing)
        assert np.array_equal(points, CLOUD)
        assert surface is None


def test_stages_take_clouds_as_they_take_arrays() -> None:
    cloud = SimpleNamespace(points=Vector(CLOUD))
    one, other = contract(CLOUD), contract(cloud)
    assert np.array_equal(one.points, other.points)
    assert evaluate(cloud, TRUE).as_dict() == evaluate(CLOUD, nodes=TRUE.nodes, edges=TRUE.edges).as_dict()
    assert len(condition(cloud, sample=500)[0]) == 500
    assert fit_surface(TRUE, cloud=cloud, interval=0.05)[0].error == fit_surface(TRUE, interval=0.05)[0].error
    assert np.array_equal(run_pipeline(cloud, stages_only()).contraction.points, one.points)


def stages_only() -> Any:
    from tiskel import PipelineParams

    return PipelineParams(stages=("contract", "skeleton"))


def test_a_mesh_is_sampled_as_its_file_is(tmp_path: Any) -> None:
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.creation.torus(2.0, 0.5)
    mesh.vertices *= np.exp(0.1 * mesh.vertices[:, :1]) * [1, 1.3, 0.7]  # axes and ends that are no matter of rounding
    rows = [f"{x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist()] + [f"3 {a} {b} {c}" for a, b, c in mesh.faces]
    (tmp_path / "torus.off").write_text(f"OFF\n{len(mesh.vertices)} {len(mesh.faces)} 0\n" + "\n".join(rows))
    read = load_cloud(tmp_path / "torus.off")
    open3d_like = SimpleNamespace(vertices=Vector(mesh.vertices), triangles=Vector(mesh.faces))
    for thing in (mesh, open3d_like):
        points, surface = given_cloud(thing)
        assert np.array_equal(points, read.points)
        assert surface is not None
        assert surface.handles == 1
    assert np.array_equal(contract(mesh).points, contract(points, surface=surface).points)
    assert given_cloud(read)[1] is read.surface


def test_what_has_no_points_is_refused() -> None:
    with pytest.raises(TiskelError, match=r"cannot be the path 'a[.]ply'; read it with load_cloud"):
        contract("a.ply")
    with pytest.raises(TiskelError, match="points must be numbers in an array of shape"):
        contract(SimpleNamespace(corners=CLOUD))
    with pytest.raises(TiskelError, match=r"must have shape \(n, 3\), got \(3, 900\); transpose them"):
        contract(SimpleNamespace(points=CLOUD.T))
    with pytest.raises(TiskelError, match="a face of the mesh names vertex 9, there are 3"):
        given_cloud(SimpleNamespace(vertices=np.eye(3), faces=[[0, 1, 9]]))


def test_evaluating_asks_for_a_cloud_where_there_is_none() -> None:
    from tiskel.geometry.graph import CurveGraph

    with pytest.raises(TiskelError, match=r"the curve comes without its cloud; give that first: evaluate\(cloud, cur"):
        evaluate(CurveGraph(TRUE.nodes, TRUE.edges))
    with pytest.raises(TiskelError, match="leave them out, or give arrays"):
        evaluate(TRUE, nodes=TRUE.nodes)
    with pytest.raises(TiskelError, match="leave them out, or give arrays"):
        evaluate(CLOUD, TRUE, origin=CLOUD)
