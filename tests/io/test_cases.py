"""The files of reported trouble, each in a process of its own: right values or one line, soon, in little memory."""

from pathlib import Path
from typing import Any

import numpy as np

from reference.forked import outcomes

REFUSED = {  # file: what the one line says; all others are read
    "npy_3xN.npy": "got (3, 600); transpose it",
    "npz_two.npz": "holds a, b; name the cloud 'points'",
    "ply_comma_decimal.ply": "property 'x': malformed input",
    "pts_two_scans.pts": "promises 300 points, 601 follow",
    "xyz_ragged.xyz": "line 301 has 2 columns",
}
FAR = np.array([694386.21, 5155487.48, 381.0])  #: where pcd_double.pcd stands
READ = {"novertex_cloud.ply"}  #: of the broken ones, a file that is sound
VALID = (  # clouds on which stages failed; tests of the stages have them, reading is no trouble
    "cone", "elbow", "float32copy", "gauss", "near_", "outliers_many", "pairs", "sphere11", "structured_tube",
    "tenpoints", "twice_jitter", "twofar", "wire4000",
)  # fmt: skip
STAGES = {".skeleton": "skeleton", ".surface": "surface"}


def sound(run: dict[str, Any], name: str) -> str:
    """Return the last line that a run says, having checked that it ended as it should, soon and small."""
    assert run["code"] in (0, 1), (name, run)
    assert run["seconds"] < 5, name
    assert run["megabytes"] < 1000, name
    lines = [line for line in run["err"].splitlines() if line]
    assert "unexpected" not in run["err"], (name, run)
    assert all(len(line) <= 320 for line in lines), (name, lines)
    if run["code"] == 1:
        errors = [line for line in lines if not line.startswith("warning: ")]
        assert len(errors) == 1, (name, lines)
        assert errors[0].startswith("error: "), name
        assert run["out"] == ""
    return lines[-1] if lines else ""


def test_every_file_of_formats_gives_the_tube_or_a_reason(cases_folder: Path, tmp_path: Path) -> None:
    files = sorted((cases_folder / "formats").iterdir())
    runs = outcomes([["convert", str(path), f"{path.name}.npy"] for path in files], tmp_path)
    for path, run in zip(files, runs, strict=True):
        said = sound(run, path.name)
        if path.name in REFUSED:
            assert run["code"] == 1, path.name
            assert REFUSED[path.name] in said
            continue
        assert run["code"] == 0, run
        points = np.load(tmp_path / f"{path.name}.npy")
        points = points[np.isfinite(points).all(axis=1)]
        low, high = points.min(axis=0), points.max(axis=0)
        size = (2, 2, 12) if path.suffix == ".obj" else (9.97, 2.97, 1)
        np.testing.assert_allclose(high - low, size, atol=0.05, err_msg=path.name)
        if path.suffix != ".obj":
            np.testing.assert_allclose(low - (FAR if path.suffix == ".pcd" else 0), (0.02, -0.48, -0.5), atol=0.05)


def test_every_broken_file_gives_a_cloud_or_one_line(cases_folder: Path, tmp_path: Path) -> None:
    files = sorted((cases_folder / "broken").iterdir())
    runs = outcomes([["info", str(path)] for path in files], tmp_path)
    for path, run in zip(files, runs, strict=True):
        sound(run, path.name)
        is_read = path.name in READ or path.name.startswith(VALID)
        assert run["code"] == (0 if is_read else 1), (path.name, run)


def test_no_broken_file_passes_as_a_curve(cases_folder: Path, tmp_path: Path) -> None:
    curve, cloud = cases_folder / "broken" / "four.json", cases_folder / "twigs.xyz"
    (run,) = outcomes([["metrics", "--curve", str(curve), "--cloud", str(cloud)]], tmp_path)
    assert "rows of 4 numbers" in sound(run, "four.json")
