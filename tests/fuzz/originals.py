"""Small sound files of every kind that is read, and what reads them: the fuzzer changes these."""

import gzip
import importlib.util
import io
from collections.abc import Callable
from datetime import date
from functools import partial
from typing import Any

import numpy as np

from reference.e57 import SCAN
from reference.pcd import pcd_bytes
from tiskel import GlsParams, LbcParams, ShapeParams, Skeleton, contract, extract_skeleton, make_shape, shape_graph
from tiskel.io import ply as ply_file
from tiskel.io.clouds import dump_cloud
from tiskel.io.curves import parse_curve
from tiskel.io.exports import EXPORTS
from tiskel.io.formats import format_of
from tiskel.io.limits import unpacked
from tiskel.io.stages.contraction import dump_contraction, parse_contraction
from tiskel.io.stages.roll import parse_inputs
from tiskel.io.stages.skeleton import dump_skeleton, parse_skeleton
from tiskel.io.stages.surface import dump_surfaces, parse_surfaces

Reader = Callable[[bytes], Any]
POINTS = np.round(np.random.default_rng(0).normal(size=(30, 3)), 4)
CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))


def originals(*, stages: bool = True) -> dict[str, tuple[Reader, list[bytes]]]:
    """Return by the name of a reader what it is, and files that it reads; stage files take seconds to make."""
    found: dict[str, tuple[Reader, list[bytes]]] = {}
    for suffix, files in (_clouds() | _meshes() | _scans()).items():
        found[f"cloud{suffix}"] = (partial(_read_cloud, suffix), files)
    found["stdin"] = (_read_by_content, [file for _, files in found.values() for file in files])
    found["gzip"] = (partial(_read_cloud, ".xyz.gz"), [gzip.compress(dump_cloud(POINTS, "a.xyz"), mtime=0)])
    curve = make_shape(shape_graph("y"))[1]
    for suffix in EXPORTS:
        name = f"a.{suffix}"
        found[f"curve.{suffix}"] = (partial(_read_curve, name), [EXPORTS[suffix](_small(curve))])
    found["inputs"] = (
        lambda data: parse_inputs(data, "a.csv"),
        [b"t,wx,wy,wz,vx,vy,vz\n0,0,1,0,0,0,0\n2,0,3,0,0,0,1\n"],
    )
    return found | (_stages() if stages else {})


def _small(s: Skeleton) -> Skeleton:
    from dataclasses import replace

    none, nowhere = np.empty(0, np.int32), np.empty((0, 3))
    nothing: dict[str, Any] = {"node_of_point": none, "input_rows": none, "rows": none}
    return replace(s, **nothing, cloud=nowhere, contracted=nowhere, origin=nowhere)


def _read_cloud(suffix: str, data: bytes) -> Any:
    plain, inner = unpacked(data, f"a{suffix}")
    return format_of(inner, plain).parse(plain, "a")


def _read_by_content(data: bytes) -> Any:
    plain, _ = unpacked(data, "stdin")
    return format_of("stdin", plain, by_content=True).parse(plain, "stdin")


def _read_curve(name: str, data: bytes) -> Any:
    return parse_curve(data, name)


def _clouds() -> dict[str, list[bytes]]:
    npz = io.BytesIO()
    np.savez_compressed(npz, points=POINTS)
    records = np.zeros(20, [("x", "f4"), ("Y", "f8"), ("z", "i2"), ("w", "u1")])
    table = io.BytesIO()
    np.save(table, records)
    rows = POINTS.tolist()
    fortran = "\n".join(" ".join(f"{v:.3e}".replace("e", "D") for v in row) for row in rows).encode()
    text = {
        ".xyz": [dump_cloud(POINTS, "a.xyz"), fortran],
        ".csv": [
            dump_cloud(POINTS, "a.csv"),
            ("a;X (m);Y (m);Z (m)\n" + "\n".join(f"k;{x};{y};{z}" for x, y, z in rows).replace(".", ",")).encode(),
            ('"x","y","z","i"\n' + "\n".join(f'"{x}","{y}",,"{z}"' for x, y, z in rows)).encode("utf-16"),
        ],
        ".tsv": [dump_cloud(POINTS, "a.tsv")],
        ".pts": [dump_cloud(POINTS, "a.pts")],
        ".ptx": [b"5\n6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
                 + "".join(f"{x} {y} {z} .5\n" for x, y, z in rows).encode()],
    }  # fmt: skip
    properties = b"property float X\nproperty double y\nproperty float z\nend_header\n"
    single = ply_file.dump([ply_file.element("vertex", ply_file.xyz(POINTS.astype(np.float32)))], "cloud", {})
    ascii_ply = b"ply\nformat ascii 1.0\ncomment H\xf6he\nelement vertex 30\n" + properties
    return text | {
        ".npy": [dump_cloud(POINTS, "a.npy"), table.getvalue()],
        ".npz": [npz.getvalue()],
        ".pcd": [pcd_bytes(layout) for layout in ("ascii", "binary", "binary_compressed")],
        ".ply": [dump_cloud(POINTS, "a.ply"), single, ascii_ply + dump_cloud(POINTS, "a.xyz")],
    }


def _meshes() -> dict[str, list[bytes]]:
    points, faces = CORNERS.tolist(), [list(face) for face in FACES]
    columns = {"vertex_indices": ply_file.ragged([np.array(face, np.int32) for face in faces])}
    mesh = [
        ply_file.element("vertex", ply_file.xyz(CORNERS)),
        ply_file.element("face", columns, {"vertex_indices": ("u1", "i4")}),
    ]
    vertex = "".join(f"v {x} {y} {z}\n" for x, y, z in points)
    corners = [[points[i] for i in face] for face in faces]
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in one) + "endloop\nendfacet\n"
        for one in corners
    )
    packed = b"".join(bytes(12) + np.array(one, "<f4").tobytes() + b"\0\0" for one in corners)
    off = (
        "OFF\n4 4 0\n"
        + "".join(f"{x} {y} {z}\n" for x, y, z in points)
        + "".join(f"3 {a} {b} {c}\n" for a, b, c in FACES)
    )
    return {
        ".mesh.ply": [ply_file.dump(mesh, "mesh", {})],
        ".obj": [(vertex + "".join(f"f {a + 1}/1 {b + 1} {c - 4}\n" for a, b, c in FACES)).encode()],
        ".off": [off.encode()],
        ".stl": [b"solid a\n" + facets.encode() + b"endsolid a\n", bytes(80) + b"\4\0\0\0" + packed],
    }


def _scans() -> dict[str, list[bytes]]:
    files = {".e57": [SCAN]} if importlib.util.find_spec("e57") else {}
    if not importlib.util.find_spec("laspy"):
        return files
    import laspy

    for suffix in (".las", ".laz"):
        made = laspy.create(point_format=3, file_version="1.4")
        made.header.scales = [0.001] * 3
        made.header.creation_date = date(2026, 1, 1)  # a case is the same on every day
        made.x, made.y, made.z = POINTS.T
        made.classification = np.arange(30) % 5
        out = io.BytesIO()
        made.write(out, do_compress=suffix == ".laz")
        files[suffix] = [out.getvalue()]
    return files


def _stages() -> dict[str, tuple[Reader, list[bytes]]]:
    from tiskel import SurfaceParams, fit_surface

    cloud = make_shape(shape_graph("y"), ShapeParams(count=60))[0]
    robust = contract(cloud)
    laplacian = [contract(cloud, params) for params in (LbcParams(max_steps=2), GlsParams(max_steps=3))]
    true = make_shape(shape_graph("banana"), ShapeParams(count=200))[1]
    surfaces = fit_surface(true, SurfaceParams(interval=0.2))
    files = [dump_contraction(c, history=True) for c in (robust, *laplacian)]
    return {
        "stage.contraction": (lambda data: parse_contraction(data, "a.ply"), files),
        "stage.skeleton": (lambda data: parse_skeleton(data, "a.ply"), [dump_skeleton(extract_skeleton(robust))]),
        "stage.surface": (lambda data: parse_surfaces(data, "a.json"), [dump_surfaces(surfaces)]),
    }
