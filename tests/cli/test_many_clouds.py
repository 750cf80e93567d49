"""``tiskel batch`` in processes of its own: the files of `tiskel run`, broken clouds, Ctrl-C."""

import csv
import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

from reference.fixtures import PROGRAM, Runner, one_error_line, wrong_usage
from tiskel import ShapeParams, make_shape, named_shape
from tiskel.io.clouds import dump_cloud

#: Ten ways in which a file is no cloud.
BROKEN = {
    "empty.ply": b"",
    "words.xyz": b"this is\nno cloud\n",
    "cut.ply": b"ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty float x\nend_header\n1",
    "head.ply": b"ply\nformat ascii 1.0\n",
    "few.xyz": b"0 0 0\n1 1 1\n",
    "nan.xyz": b"nan nan nan\n" * 100,
    "same.xyz": b"1 2 3\n" * 100,
    "zipped.ply.gz": b"\x1f\x8b nothing",
    "array.npy": b"\x93NUMPY\x01\x00nothing",
    "mesh.stl": b"solid nothing\nfacet",
}

QUICK = ("--stages", "skeleton", "--method", "lbc", "--max-steps", "3")


@pytest.fixture
def scans(tmp_path: Path) -> Path:
    folder = tmp_path / "scans"
    folder.mkdir()
    for i, name in enumerate(("y", "torus")):
        points = make_shape(named_shape(name), ShapeParams(count=400, seed=i))[0]
        (folder / f"{name}.ply").write_bytes(dump_cloud(points, "a.ply"))
    return folder


@pytest.mark.slow
def test_good_clouds_are_as_from_run_and_broken_ones_have_their_reasons(
    scans: Path, tiskel: Runner, tmp_path: Path
) -> None:
    for name, data in BROKEN.items():
        (scans / name).write_bytes(data)
    done = tiskel("batch", "scans", "-o", "out", "--jobs", 2, "--json", "--timeout", 300)
    assert done.returncode == 1
    assert json.loads(done.stdout) == {"done": 2, "failed": 10, "kept": 0}
    last = done.stderr.decode().splitlines()[-1]
    assert last.startswith("error: 10 of 12 clouds failed: ")
    assert "out/failed.txt" in last
    rows = {row["name"]: row for row in csv.DictReader((tmp_path / "out" / "summary.csv").open())}
    assert {rows[name.partition(".")[0]]["status"] for name in BROKEN} == {"failed"}
    assert {rows[name.partition(".")[0]]["kind"] for name in BROKEN} == {"unreadable", "refused"}
    assert all(row["message"] for row in rows.values() if row["status"] == "failed")
    assert rows["torus"]["loops"] == "1"
    assert float(rows["y"]["topology_bottleneck"]) >= 0
    assert tiskel("run", "scans/y.ply", "-o", "alone").returncode == 0
    alone, among = tmp_path / "alone", tmp_path / "out" / "y"
    names = sorted(path.name for path in among.iterdir())
    pages = {"report.html", "timings.json"}
    assert {path.name for path in alone.iterdir() if path.suffix != ".png"} - pages == set(names)
    assert [name for name in names if (among / name).read_bytes() != (alone / name).read_bytes()] == []
    again = tiskel("batch", "scans/y.ply", "-o", "out", "--json")
    assert (again.returncode, json.loads(again.stdout)["kept"]) == (0, 1)


@pytest.mark.slow
def test_stages_choose_what_is_done(scans: Path, tiskel: Runner, tmp_path: Path) -> None:
    done = tiskel("batch", "scans/y.ply", "-o", "out", "--stages", "skeleton,stability,pictures", "--strict")
    assert done.returncode == 0, done.stderr.decode()
    assert sorted(path.name for path in (tmp_path / "out" / "y").iterdir()) == [
        "report.html", "skeleton.json", "skeleton.obj", "skeleton.ply", "skeleton.png", "skeleton.swc",
        "stability.json", "stability.png",
    ]  # fmt: skip
    page = (tmp_path / "out" / "y" / "report.html").read_text()
    assert "stability.png" in page
    assert "metrics.png" not in page


@pytest.mark.slow
def test_ctrl_c_ends_everything_and_the_rest_can_be_done_later(scans: Path, tiskel: Runner, tmp_path: Path) -> None:
    for i in range(20):  # more than a fast machine does before the signal arrives
        (scans / f"y{i}.ply").write_bytes((scans / "y.ply").read_bytes())
    process = subprocess.Popen(
        [PROGRAM, "batch", scans, "-o", tmp_path / "out", "--jobs", "1", *QUICK], stderr=subprocess.PIPE, text=True,
        start_new_session=True,
    )  # fmt: skip
    manifest = tmp_path / "out" / "manifest.jsonl"
    deadline = time.monotonic() + 200
    while not (manifest.exists() and manifest.read_text().count("\n") > 1):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to the children as well
    done = manifest.read_text().count("\n") - 1
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 130, said
    assert done < 22
    assert said.splitlines()[-1] == "interrupted"
    assert not (tmp_path / "out" / ".batch").exists()
    with pytest.raises(ProcessLookupError):  # nobody of the group is left
        os.killpg(process.pid, 0)
    assert json.loads(tiskel("batch", "scans", "-o", "out", "--json", *QUICK).stdout)["kept"] >= 1


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--shard", "5/4"), "from 1 to N"),
        (("--timeout", "0"), "timeout must be a positive number"),
    ],
)
def test_wrong_settings_are_refused_before_anything_is_made(
    tiskel: Runner, tmp_path: Path, words: tuple[str, str], complaint: str
) -> None:
    (tmp_path / "a.xyz").write_text("0 0 0\n")
    assert complaint in one_error_line(tiskel("batch", "a.xyz", "-o", "out", *words))
    assert not (tmp_path / "out").exists()


def test_stages_and_shards_that_there_are_not_are_wrong_usage(tiskel: Runner, tmp_path: Path) -> None:
    (tmp_path / "a.xyz").write_text("0 0 0\n")
    assert "'view' is not one of" in wrong_usage(tiskel("batch", "a.xyz", "-o", "out", "--stages", "skeleton,view"))
    assert "--shard: it needs I/N, such as 1/4" in wrong_usage(tiskel("batch", "a.xyz", "-o", "out", "--shard", "half"))
    assert not (tmp_path / "out").exists()
