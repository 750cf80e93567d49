"""A light installation: the whole chain where nothing of the extra `full` can be imported, and nobody tries."""

import json
import os
from pathlib import Path
from typing import Any

import pytest

from reference.forked import outcomes
from tiskel import ShapeParams, contract, evaluate, extract_skeleton, load_cloud, make_shape, read_skeleton, shape_graph
from tiskel.io.clouds import dump_cloud
from tiskel.io.stages.skeleton import dump_skeleton

FULL = ("ripser", "persim", "sklearn", "networkx", "matplotlib", "PIL")  #: what `tiskel[full]` brings
OTHERS = ("open3d", "trimesh", "pandas", "gudhi", "laspy", "lazrs", "e57", "cvxopt", "distributed", "dask")
BLOCK = f"""
import os, sys
class Absent:
    def find_spec(self, name, path=None, target=None):
        package = name.partition(".")[0]
        if package in {(*FULL, *OTHERS)}:
            with open(os.environ["ASKED_FOR"], "a") as file:
                file.write(package + "\\n")
            raise ModuleNotFoundError(f"No module named {{package!r}}", name=package)
sys.meta_path.insert(0, Absent())
"""
Runs = list[dict[str, Any]]


@pytest.fixture
def asked(tmp_path: Path) -> Path:
    """Return the file that names what processes of :func:`light` tried to import."""
    (tmp_path / "absent").mkdir()
    (tmp_path / "absent" / "sitecustomize.py").write_text(BLOCK)
    (tmp_path / "asked").write_text("")
    return tmp_path / "asked"


def light(runs: list[str], asked: Path) -> Runs:
    """Run the program so many times where nothing but the light installation can be imported."""
    ahead = os.pathsep.join(filter(None, (str(asked.with_name("absent")), os.environ.get("PYTHONPATH"))))
    return outcomes([words.split() for words in runs], asked.parent, PYTHONPATH=ahead, ASKED_FOR=str(asked))


def test_the_chain_runs_and_asks_for_nothing_that_is_absent(asked: Path, tmp_path: Path) -> None:
    points = make_shape(shape_graph("y"), ShapeParams(count=600))[0]
    for name in ("y.ply", "y.xyz", "y.csv", "y.npy"):
        (tmp_path / name).write_bytes(dump_cloud(points, name))
    runs = light(
        [
            *(f"contract {name} -o {name}.c.ply" for name in ("y.ply", "y.xyz", "y.csv", "y.npy")),
            *(f"skeleton {name}.c.ply -o {name}.s.ply" for name in ("y.ply", "y.xyz", "y.csv", "y.npy")),
            "slice y.ply.s.ply -o y.json --interval 0.05 --mesh y.mesh.ply --csv y.slices.csv",
            "roll y.json -o y.path.csv --duration 0.2",
            "roll y.json -o body.csv --model body --duration 0.2",
        ],
        asked,
    )
    assert [run["code"] for run in runs] == [0] * len(runs), [run["err"] for run in runs]
    assert asked.read_text() == ""
    cloud = load_cloud(tmp_path / "y.ply")
    made = extract_skeleton(contract(cloud.points))
    assert (tmp_path / "y.ply.s.ply").read_bytes() == dump_skeleton(made, cloud.source)
    assert {len(read_skeleton(tmp_path / f"y.{kind}.s.ply").nodes) for kind in ("xyz", "csv", "npy")} == {
        len(made.nodes)
    }
    [measured] = light(["metrics y.ply.s.ply"], asked)
    assert set(asked.read_text().split()) <= {"ripser"}  # looked for, since loops of the surface need it
    told = json.loads(measured["out"])
    assert told["loops"]["surface"] is None
    assert told["loops"]["reasons"]["surface"] == "it needs ripser; pip install 'tiskel[full]'"
    expected = json.loads(json.dumps(evaluate(read_skeleton(tmp_path / "y.ply.s.ply")).as_dict()))
    for document in (told, expected):
        del document["loops"]
    assert {"file": "y.ply.s.ply", **expected} == told


def test_what_needs_more_says_so_before_the_work(asked: Path, tmp_path: Path) -> None:
    points = make_shape(shape_graph("capsule"), ShapeParams(count=400))[0]
    (tmp_path / "a.ply").write_bytes(dump_cloud(points, "a.ply"))
    (tmp_path / "s.ply").write_bytes(dump_skeleton(extract_skeleton(contract(points))))
    picture = "a picture needs matplotlib; pip install 'tiskel[full]'"
    refused = {
        "contract nowhere.ply --plot a.png": picture,
        "roll nowhere.json --animate a.gif": picture,
        "view s.ply -o s.png": picture,
        "convert s.ply s.graphml": "GraphML needs networkx; pip install 'tiskel[full]'",
        "convert s.ply s.node-link.json": "a graph of networkx needs networkx; pip install 'tiskel[full]'",
        "contract nowhere.ply --cap": "--cap needs matplotlib; pip install 'tiskel[full]'",
    }
    runs = light([*refused, "run a.ply -o out", "view s.ply -o s.html", "doctor"], asked)
    for run, said in zip(runs, refused.values(), strict=False):
        assert (run["code"], run["out"], run["err"].strip()) == (1, "", f"error: {said}")
    whole, page, doctor = runs[len(refused) :]
    assert (whole["code"], page["code"], doctor["code"]) == (0, 0, 0), runs
    assert "no pictures: they need matplotlib" in whole["err"]
    found = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"contraction.ply", "skeleton.ply", "metrics.json", "surface.json", "path.csv", "report.html"} <= found
    assert not [name for name in found if name.endswith(".png")]
    assert "matplotlib   not installed; optional: pictures, films, --cap" in doctor["out"]
    assert "BAD" not in doctor["out"]
