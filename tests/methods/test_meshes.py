"""Meshes as input: what is connected, and how many handles there are, comes from their faces."""

import json
from pathlib import Path

import numpy as np
import pytest

from reference.fixtures import Runner, wrong_usage
from reference.meshes import Mesh, joined, torus, tube, write_off
from tiskel import (
    GlsParams,
    PipelineParams,
    Skeleton,
    contract,
    extract_skeleton,
    load_cloud,
    read_contraction,
    run_pipeline,
    write_contraction,
)
from tiskel.geometry.mesh_sample import sample_mesh
from tiskel.methods.robust.network import prepared

NEAR = joined(tube([0, 0, 0], [0, 0, 5], 0.3, 48), tube([0.602, 0, 0], [0.602, 0, 5], 0.3, 48))
UNEVEN = joined(tube([0, 0, 0], [0, 0, 5], 1.0), tube([0, 0, 6], [0, 0, 11], 0.1))
FIVE = joined(*(tube([3 * i, 0, 0], [3 * i, 0, 4 + i], 0.3 + 0.1 * i) for i in range(5)))
CROSSED = joined(tube([0, 0, 0], [0, 0, 5], 0.3), tube([0, 0, 3], [3, 0, 4], 0.2), tube([0, 0, 1], [0, 3, 2], 0.15))
CORNERS = ((0, 0, 3, 0), (3, 0, 3, 3), (3, 3, 0, 3), (0, 3, 0, 0))
RING = joined(*(tube([a, b, 0], [c, d, 0], 0.25) for a, b, c, d in CORNERS))
KNOWN = {  # components, loops, ends
    "torus": (torus(), (1, 1, 0)),
    "thin torus": (torus(1.0, 0.06, 96, 12), (1, 1, 0)),
    "two linked tori": (joined(torus(), (torus()[0][:, [0, 2, 1]] + [1, 0, 0], torus()[1])), (2, 2, 0)),
    "two tubes that nearly touch": (NEAR, (2, 0, 4)),
    "a thin tube before a thick one": (UNEVEN, (2, 0, 4)),
    "an open tube": (tube([0, 0, 0], [0, 0, 5], 0.3, caps=False), (1, 0, 2)),
    "tubes that run into each other": (CROSSED, (1, 0, 4)),
    "a ring of four tubes that overlap": (RING, (1, 1, 0)),
    "five cylinders": (FIVE, (5, 0, 10)),
}


def skeleton_of(mesh: Mesh, *, faces: bool = True) -> Skeleton:
    found = sample_mesh(*mesh)
    return extract_skeleton(contract(found.points, surface=found.surface if faces else None))


@pytest.mark.parametrize("name", KNOWN)
def test_the_curve_of_a_known_mesh_has_its_parts_and_loops(name: str) -> None:
    mesh, counts = KNOWN[name]
    s = skeleton_of(mesh)
    assert (s.components, s.loops, s.ends) == counts
    assert s.warnings == ()


@pytest.mark.parametrize("name", ["two tubes that nearly touch", "a thin tube before a thick one"])
def test_without_the_faces_they_fuse(name: str) -> None:
    """What the faces are for: the points alone say one thing where there are two."""
    assert skeleton_of(KNOWN[name][0], faces=False).components == 1


def test_normals_are_the_meshs_and_point_out() -> None:
    found = sample_mesh(*torus(), 2000)
    network = prepared(found.points, 14, found.surface)
    assert found.surface is not None
    np.testing.assert_allclose(network.normals @ network.axes, found.surface.normals, atol=1e-12)
    surface = network.oriented(np.zeros_like(found.points))
    assert surface.normals is network.normals


def test_a_stage_file_keeps_what_the_mesh_knows(tmp_path: Path) -> None:
    found = sample_mesh(*NEAR, 2000)
    points = np.concatenate([found.points, found.points[:3]])  # with duplicates, as rows of a file may have them
    assert found.surface is not None
    rows = np.arange(2003, dtype=np.int32) % 2000
    c = contract(points, surface=found.surface.at(rows))
    write_contraction(tmp_path / "c.ply", c)
    again = read_contraction(tmp_path / "c.ply")
    assert c.surface is not None
    assert again.surface is not None
    for name in ("normals", "areas", "links"):
        assert getattr(again.surface, name).tobytes() == getattr(c.surface, name).tobytes()
    assert (again.surface.outward, again.surface.handles) == (True, 0)
    one, other = extract_skeleton(c), extract_skeleton(again)
    assert one.nodes.tobytes() == other.nodes.tobytes()
    assert one.components == 2


def test_stray_points_beside_a_mesh_change_nothing() -> None:
    found = sample_mesh(*NEAR, 2000)
    assert found.surface is not None
    far = np.concatenate([found.points, [[0, 0, 900.0]]])
    rows = np.minimum(np.arange(2001, dtype=np.int32), 1999)
    s = extract_skeleton(contract(far, surface=found.surface.at(rows)))
    alone = extract_skeleton(contract(found.points, surface=found.surface))
    assert s.components == alone.components == 2


def test_the_published_methods_take_a_mesh_as_points() -> None:
    found = sample_mesh(*torus(), 600)
    one, other = (contract(found.points, GlsParams(max_steps=2), surface=s) for s in (found.surface, None))
    assert one.points.tobytes() == other.points.tobytes()
    assert one.surface is None


@pytest.fixture
def near(tmp_path: Path) -> Path:
    write_off(tmp_path / "near.off", NEAR)
    return tmp_path / "near.off"


def test_a_file_says_what_it_is_and_how_it_was_sampled(near: Path) -> None:
    cloud, asked = load_cloud(near), load_cloud(near, mesh_samples=700)
    assert (len(cloud.points), len(asked.points)) == (4096, 700)
    assert cloud.mesh is not None
    assert (cloud.mesh.components, cloud.mesh.watertight) == (2, True)
    assert "2 components, genus 0, watertight" in cloud.notes[0]
    assert "its thickness asks for" in cloud.notes[1]
    assert "sampled to 700 points, closer where it is thin (as asked)" in asked.notes[1]
    assert cloud.warnings == ()


def test_the_pipeline_uses_the_faces_unless_points_are_changed(near: Path) -> None:
    from tiskel import ConditioningParams

    cloud = load_cloud(near, mesh_samples=1500)
    whole = run_pipeline(cloud.points, surface=cloud.surface)
    assert whole.skeleton.components == 2
    params = PipelineParams(conditioning=ConditioningParams(voxel=0.02))
    assert run_pipeline(cloud.points, params, surface=cloud.surface).contraction.surface is None


def test_the_chain_of_commands(tiskel: Runner, near: Path) -> None:
    facts = json.loads(tiskel("info", near, TI_DEBUG="0").stdout)  # Taichi prints when it checks indices
    assert facts["mesh"]["components"] == 2
    made = tiskel("contract", near, "--sample", "auto", "--strict", "-o", "c.ply")
    assert made.returncode == 0
    assert b"2 components, genus 0, watertight" in made.stderr
    assert b"sampled to 4096 points" in made.stderr
    done = tiskel("skeleton", "c.ply", "-o", "s.ply")
    assert b"components 2, loops 0, ends 4" in done.stderr
    assert tiskel("convert", near, "p.xyz", "--sample", 50).returncode == 0
    assert len(np.loadtxt(near.with_name("p.xyz"))) == 50
    for words in (("contract", near), ("convert", near, "q.xyz")):
        said = wrong_usage(tiskel(*words, "--sample", "many"))
        assert "--sample: it needs auto or a number of points, got 'many'." in said


def test_the_file_of_the_report_has_five_cylinders(cases_folder: Path) -> None:
    cloud = load_cloud(cases_folder / "five_cylinders.stl")
    assert cloud.mesh is not None
    assert cloud.mesh.components == 5
    s = extract_skeleton(contract(cloud.points, surface=cloud.surface))
    assert (s.components, s.loops, s.ends) == (5, 0, 10)
