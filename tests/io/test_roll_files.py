"""What drives a sphere, and where it went: CSV, TUM and nav_msgs/Path, written and read back."""

import csv
import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tiskel import Inputs, RollParams, TiskelError, Trajectory, roll, roll_body
from tiskel.io.stages.path import is_path, parse_paths
from tiskel.io.stages.roll import COLUMNS, inputs_csv, parse_inputs, read_inputs, to_csv
from tiskel.io.stages.trajectories import BODY_COLUMNS, as_suffixed, body_csv, read_poses
from tiskel.surfaces.analytic import Ellipsoid, Torus

RUN = RollParams(radius=0.3, omega=(0.5, 0.3, 0), start=(0.3, 1.0, 0.1, 0.1, 0.4), duration=1, rate=4, meet=False)


@pytest.fixture(scope="module")
def run() -> Trajectory:
    return roll(Torus(5.0, 2.0), RUN)


def test_inputs_come_back_to_the_last_bit_and_columns_in_any_order_and_case() -> None:
    values = np.random.default_rng(0).normal(size=(3, 6))
    inputs = Inputs(np.array([0.0, 1 / 3, 2.0]), values)
    again = parse_inputs(inputs_csv(inputs), "w.csv")
    np.testing.assert_array_equal(again.t, inputs.t)
    np.testing.assert_array_equal(again.values, values)
    mixed = parse_inputs(b"\xef\xbb\xbfVZ, T ,wz,wx,wy,other\n\n7,0,3,1,2,9\n8,1,6,4,5,9\n", "w.csv")
    assert mixed.t.tolist() == [0, 1]
    assert mixed.values.tolist() == [[1, 2, 3, 0, 0, 7], [4, 5, 6, 0, 0, 8]]
    paused = parse_inputs(b"t,wx,wy,wz\n" + b"".join(b"%d,0,1,0\n" % t for t in (0, 1, 2, 3, 99)), "w.csv")
    assert len(paused.warnings) == 1
    assert "no row between t = 3 and 99" in paused.warnings[0]


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"t,wx,wy\n0,0,1\n", "w.csv has no column wz; the first line names t,wx,wy,wz,vx,vy,vz"),
        (b"", "w.csv has no column t, wx, wy, wz; the first line"),
        (b"t,wx,wy,wz\n", "w.csv has no row below its header; give at least one"),
        (b"t,wx,wy,wz\n0,0,1,0\n1,0,x,0\n", "w.csv: wy 'x' is no number in row 2; fill it or leave the row out"),
        (b"t,wx,wy,wz\n0,0,1\n", "w.csv: wz is missing in row 1; fill it"),
        (b"t,wx,wy,wz,vx\n0,0,1,0,\n", "w.csv: vx is missing in row 1; fill it"),
        (b"t,wx,wy,wz\n0,0,1,0\n0,0,1,0\n", "w.csv: "),
        (b"t,wx,wy,wz\n0,0,1,0\n1,0,nan,0\n", "row 2 has a value missing"),
        (b"t,wx\xff", "w.csv is not a CSV file: 'utf-8' codec can't decode"),
    ],
)
def test_inputs_that_mean_nothing_are_refused_with_their_row(data: bytes, said: str) -> None:
    with pytest.raises(TiskelError) as error:
        parse_inputs(data, "w.csv")
    assert said in str(error.value)


def test_inputs_from_a_file_are_named_by_it(tmp_path: Path) -> None:
    (tmp_path / "w.csv").write_bytes(b"nothing\n1\n")
    with pytest.raises(TiskelError, match=r"^w\.csv has no column t"):
        read_inputs(tmp_path / "w.csv")


def test_a_table_has_every_number_of_a_run_under_its_name(run: Trajectory) -> None:
    rows = list(csv.DictReader(io.StringIO(to_csv([run]).decode())))
    assert tuple(rows[0]) == COLUMNS
    assert {row["model"] for row in rows} == {"global"}
    columns = {
        "t": run.t, "u_o": run.state[:, 0], "v_o": run.state[:, 1], "u_s": run.state[:, 2], "v_s": run.state[:, 3],
        "psi": run.state[:, 4], "R_o": run.object_radius, "margin": run.margin, "det_Q": run.determinant,
        "way_o": run.ways[:, 0], "way_s": run.ways[:, 1],
    }  # fmt: skip
    for name, values in {"contact": run.contact, "centre": run.centre, "normal": run.normal}.items():
        columns |= {f"{name}_{axis}": values[:, i] for i, axis in enumerate("xyz")}
    columns |= {f"q_{axis}": run.orientation[:, i] for i, axis in enumerate("wxyz")}
    columns |= {name: run.inputs[:, i] for i, name in enumerate(("wx", "wy", "wz", "vx", "vy", "vz"))}
    assert set(columns) == set(COLUMNS) - {"model"}
    for name, values in columns.items():
        np.testing.assert_array_equal([float(row[name]) if row[name] else np.nan for row in rows], values)


def test_unknown_numbers_are_empty_and_models_of_other_normals_are_named_by_them(run: Trajectory) -> None:
    other = replace(run, object_radius=np.full(len(run.t), np.nan), params=replace(run.params, normals="pca"))
    rows = list(csv.DictReader(io.StringIO(to_csv([run, other]).decode())))
    assert [row["model"] for row in rows] == ["global"] * len(run.t) + ["global-pca"] * len(run.t)
    assert {row["R_o"] for row in rows[len(run.t) :]} == {""}


def test_a_path_is_read_from_a_table_for_the_viewer(run: Trajectory) -> None:
    other = replace(run, t=run.t + 5, params=replace(run.params, normals="pca"))
    data = to_csv([run, other])
    assert is_path(data)
    first, second = parse_paths(data, "r.csv")
    assert (first.name, second.name) == ("global", "global-pca")
    assert first.radius == pytest.approx(RUN.radius)
    for found, true in ((first.t, run.t), (second.t, run.t + 5)):
        np.testing.assert_array_equal(found, true)
    np.testing.assert_array_equal(first.contact, run.contact)
    np.testing.assert_array_equal(first.centre, run.centre)
    np.testing.assert_array_equal(first.orientation, run.orientation)
    nameless = b"\n".join(line.partition(b",")[2] for line in to_csv([run]).splitlines())
    assert [path.name for path in parse_paths(nameless, "r.csv")] == ["sphere"]


def test_what_is_no_path_is_told() -> None:
    assert not is_path(b"")
    assert not is_path(b"t,contact_x,centre_x\n")
    assert not is_path(b"\nt,contact_x,centre_x,q_w\n")
    with pytest.raises(TiskelError, match=r"r\.csv has no rows with t, contact_x"):
        parse_paths(b"a,b\n1,2\n", "r.csv")
    with pytest.raises(TiskelError, match=r"r\.csv has no rows with t, "):
        parse_paths(b"", "r.csv")
    head = b"t,contact_x,contact_y,contact_z,centre_x,centre_y,centre_z,q_w,q_x,q_y,q_z\n"
    for row in (b"0,0,0,0,0,0,1,1,0,0,x\n", b"0,0,0\n"):
        with pytest.raises(TiskelError, match=r"r\.csv is a damaged path: .*; run tiskel roll again"):
            parse_paths(head + row, "r.csv")


def test_poses_in_the_formats_of_robots(run: Trajectory, tmp_path: Path) -> None:
    for name in ("r.csv", "r.tum"):
        (tmp_path / name).write_bytes(as_suffixed(name, [run]))
        poses = read_poses(tmp_path / name)
        np.testing.assert_array_equal(poses.t, run.t)
        np.testing.assert_array_equal(poses.centre, run.centre)
        np.testing.assert_array_equal(poses.orientation, run.orientation)
    assert (tmp_path / "r.tum").read_text().startswith("# timestamp tx ty tz qx qy qz qw\n0.0 ")
    assert as_suffixed("R.YML", [run]) == as_suffixed("r.yaml", [run])
    head, poses_key, *poses_lines = as_suffixed("r.yaml", [replace(run, t=run.t + 3)]).decode().splitlines()
    assert (head, poses_key) == ("header: {stamp: {sec: 0, nanosec: 0}, frame_id: map}", "poses:")
    assert len(poses_lines) == 2 * len(run.t)
    (x, y, z), (w, i, j, k) = run.centre[1].tolist(), run.orientation[1].tolist()
    assert poses_lines[2:4] == [
        "- header: {stamp: {sec: 3, nanosec: 250000000}, frame_id: map}",
        f"  pose: {{position: {{x: {x}, y: {y}, z: {z}}}, orientation: {{x: {i}, y: {j}, z: {k}, w: {w}}}}}",
    ]
    with pytest.raises(TiskelError, match=r"r\.tum: a \.tum file holds one run, there are 2; choose one model, or CSV"):
        as_suffixed("r.tum", [run, run])


@pytest.mark.parametrize("data", [b"", b"model,t\nglobal,0\n", b"0 1 2\n", b"0 1 2 3 0 0 0 x\n", b"\xff\xfe"])
def test_what_is_no_trajectory_is_refused(data: bytes, tmp_path: Path) -> None:
    (tmp_path / "r.tum").write_bytes(data)
    with pytest.raises(TiskelError, match=r"^r\.tum holds no trajectory; give a CSV file of tiskel roll, or TUM$"):
        read_poses(tmp_path / "r.tum")


def test_a_table_of_another_body_has_its_poses() -> None:
    run = roll_body(Torus(5.0, 2.0), Ellipsoid(0.3, 0.4, 0.25), replace(RUN, radius=None))
    rows = list(csv.reader(io.StringIO(body_csv(run).decode())))
    assert tuple(rows[0]) == BODY_COLUMNS
    table = np.array(rows[1:], float)
    parts = [run.t, run.state, run.contact, run.position, run.orientation, run.margin]
    np.testing.assert_array_equal(table, np.column_stack(parts))
