"""What other programs make of our files, and we of theirs: docs/tools.md.

    python benchmarks/tools.py make DIR            # with tiskel: our files of one cloud
    python benchmarks/tools.py open DIR            # in any environment: what each program that is there sees in them
    python benchmarks/tools.py back DIR --write    # with tiskel: what it sees in theirs; writes the page

Each program is tried in a process of its own and skipped where it is absent; `open` may run in several environments,
one after the other.
"""

import argparse
import contextlib
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "tools.md"
SEEN = "seen.json"
SECONDS = 300  # that a program may take for all files
CURVES = ("ply", "obj", "swc", "graphml", "json", "node-link.json", "vtp", "dxf", "csv")
MESHES = ("ply", "obj", "stl", "glb")
Found = dict[str, Any]


def make(folder: Path) -> None:
    """Write our files of a Y of three limbs."""
    from tiskel import contract, evaluate, extract_skeleton, fit_whole, make_shape, roll_on, write_contraction
    from tiskel.io.mesh_file import mesh_bytes
    from tiskel.io.stages.heat import dump_heat
    from tiskel.io.stages.roll import to_csv
    from tiskel.slicing.body_mesh import body_mesh

    c = contract(make_shape("y", 1500)[0])
    write_contraction(folder / "contraction.ply", c)
    s = extract_skeleton(c)
    for suffix in CURVES:
        s.save(folder / f"skeleton.{suffix}")
    (folder / "metrics.ply").write_bytes(dump_heat(evaluate(s)))
    body = fit_whole(s).body
    assert body is not None
    mesh = body_mesh(body, 0.05)
    for suffix in MESHES:
        (folder / f"surface.{suffix}").write_bytes(mesh_bytes(mesh, f"surface.{suffix}"))
    run = roll_on(body, duration=2.0, rate=20.0)
    (folder / "path.csv").write_bytes(to_csv([run]))


def seen(points: int = 0, edges: int = 0, faces: int = 0, scalars: Any = ()) -> Found:
    """Return what a program sees."""
    return {"points": int(points), "edges": int(edges), "faces": int(faces), "scalars": sorted(map(str, scalars))}


def theirs(path: Path, program: str, suffix: str) -> str:
    """Return where a program writes what it has read."""
    folder = path.parent / "theirs"
    folder.mkdir(exist_ok=True)
    return str(folder / f"{path.stem.split('.')[0]}-{path.suffix[1:]}-by-{program}.{suffix}")


def with_trimesh(path: Path) -> Found:
    import trimesh

    thing = trimesh.load(path, process=False)
    thing = thing.to_geometry() if isinstance(thing, trimesh.Scene) else thing
    if isinstance(thing, trimesh.path.Path3D):
        return seen(len(thing.vertices), sum(len(e.nodes) for e in thing.entities))
    raw = thing.metadata.get("_ply_raw", {})
    scalars = [name for name in raw.get("vertex", {}).get("properties", {}) if name not in "xyz"]
    edges = len(raw["edge"]["data"]) if "edge" in raw else 0
    faces = len(getattr(thing, "faces", ()))
    for suffix in ("ply", "obj", "stl", "off") if faces and path.suffix == ".ply" else ():
        thing.export(theirs(path, "trimesh", suffix))
    return seen(len(thing.vertices), edges, faces, scalars)


def with_meshio(path: Path) -> Found:
    import meshio

    mesh = meshio.read(path)
    counts = {kind: sum(len(one.data) for one in mesh.cells if one.type == kind) for kind in ("line", "triangle")}
    for suffix in ("ply", "obj", "stl", "off") if path.name == "surface.ply" else ():
        meshio.Mesh(mesh.points, mesh.cells).write(theirs(path, "meshio", suffix))
    return seen(len(mesh.points), counts["line"], counts["triangle"], mesh.point_data)


def with_pyvista(path: Path) -> Found:
    import pyvista

    mesh = pyvista.read(path)
    mesh = mesh.combine().extract_surface() if isinstance(mesh, pyvista.MultiBlock) else mesh
    edges = sum(max(0, mesh.get_cell(i).n_points - 1) for i in range(mesh.n_lines))
    suffixes = {"surface.ply": ("ply", "stl", "obj"), "skeleton.vtp": ("vtp",)}.get(path.name, ())
    for suffix in suffixes:
        mesh.save(theirs(path, "PyVista", suffix))
    return seen(mesh.n_points, edges, mesh.n_faces_strict, [*mesh.point_data, *mesh.cell_data])


def with_open3d(path: Path) -> Found:
    import open3d as o3d

    if path.name == "skeleton.ply":
        lines = o3d.io.read_line_set(str(path))
        o3d.io.write_line_set(theirs(path, "Open3D", "ply"), lines)
        return seen(len(lines.points), len(lines.lines))
    if path.name in ("contraction.ply", "metrics.ply"):
        cloud = o3d.t.io.read_point_cloud(str(path))
        for suffix in ("ply", "pcd", "xyz", "pts") if path.name == "contraction.ply" else ():
            o3d.io.write_point_cloud(theirs(path, "Open3D", suffix), o3d.io.read_point_cloud(str(path)))
        return seen(len(cloud.point.positions), scalars=[key for key, _ in cloud.point.items() if key != "positions"])
    mesh = o3d.io.read_triangle_mesh(str(path))
    for suffix in ("ply", "obj", "off") if path.name == "surface.ply" else ():
        o3d.io.write_triangle_mesh(theirs(path, "Open3D", suffix), mesh)
    return seen(len(mesh.vertices), 0, len(mesh.triangles))


def with_pymeshlab(path: Path) -> Found:
    import pymeshlab

    scene = pymeshlab.MeshSet(verbose=False)
    scene.load_new_mesh(str(path))
    mesh = scene.current_mesh()
    for suffix in ("ply", "obj", "stl", "off", "xyz") if path.name == "surface.ply" else ():
        scene.save_current_mesh(theirs(path, "PyMeshLab", suffix))
    scalars = ["quality"] * mesh.has_vertex_scalar()
    return seen(mesh.vertex_number(), mesh.edge_number(), mesh.face_number(), scalars)


def with_networkx(path: Path) -> Found:
    import networkx

    if path.suffix == ".graphml":
        graph = networkx.read_graphml(path)
        networkx.write_graphml(graph, theirs(path, "networkx", "graphml"))
    else:
        document = json.loads(path.read_text())
        graph = networkx.node_link_graph(document, edges="edges" if "edges" in document else "links")
        Path(theirs(path, "networkx", "json")).write_text(json.dumps(networkx.node_link_data(graph)))
    return seen(len(graph), graph.number_of_edges(), 0, next(iter(graph.nodes(data=True)))[1])


def with_pandas(path: Path) -> Found:
    import pandas

    table = pandas.read_csv(path)
    if path.stem == "skeleton":
        table.to_csv(theirs(path, "pandas", "csv"))
    return seen(len(table), scalars=table.columns)


def with_navis(path: Path) -> Found:
    import navis

    neuron = navis.read_swc(path)
    navis.write_swc(neuron, theirs(path, "navis", "swc"))
    known = ["radius"] if (neuron.nodes.radius > 0).any() else ()
    return seen(neuron.n_nodes, int((neuron.nodes.parent_id >= 0).sum()), 0, known)


def with_blender(path: Path) -> Found:
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    wm = bpy.ops.wm
    ways = {"ply": wm.ply_import, "obj": wm.obj_import, "stl": wm.stl_import, "glb": bpy.ops.import_scene.gltf}
    ways[path.suffix[1:]](filepath=str(path))
    mesh = next(thing for thing in bpy.data.objects if thing.type == "MESH").data
    for suffix, write in (("ply", wm.ply_export), ("obj", wm.obj_export), ("stl", wm.stl_export)):
        if path.name == "surface.ply":
            write(filepath=theirs(path, "Blender", suffix))
    scalars = [one.name for one in mesh.attributes if one.domain == "POINT" and one.name not in OF_BLENDER]
    return seen(len(mesh.vertices), 0 if mesh.polygons else len(mesh.edges), len(mesh.polygons), scalars)


OF_BLENDER = ("position", ".select_vert")


def with_cloudcompare(path: Path) -> Found:
    out = path.parent / "cloudcompare"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir()
    copy = Path(shutil.copy(path, out))
    command = ["CloudCompare", "-SILENT", "-AUTO_SAVE", "OFF", "-C_EXPORT_FMT", "ASC", "-ADD_HEADER", "-ADD_PTS_COUNT"]
    command += ["-NO_TIMESTAMP", "-O", str(copy)]
    mesh = path.name.startswith("surface")
    command += ["-EXTRACT_VERTICES"] if mesh else []
    command += ["-SAVE_CLOUDS", "-C_EXPORT_FMT", "PLY", "-SAVE_CLOUDS"] if path.suffix == ".ply" else ["-SAVE_CLOUDS"]
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    said = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=False).stdout
    files = sorted(out.glob("*.asc"))
    if not files:
        raise ValueError(re.sub(r"\s+", " ", said)[-100:])
    if path.name in ("contraction.ply", "metrics.ply"):
        shutil.copy(copy, theirs(path, "CloudCompare", "ply"))  # it has taken the place of ours
        shutil.copy(files[0], theirs(path, "CloudCompare", "asc"))
    heads = [file.read_text().splitlines()[:2] for file in files]
    names = [name for name in heads[0][0].lstrip("/").split() if name not in "XYZ"]
    return seen(sum(int(count) for _, count in heads), 0, int("mesh(es) loaded" in said), names)


def with_pcl(path: Path) -> Found:
    out = Path(theirs(path, "PCL", "pcd"))
    out.unlink(missing_ok=True)
    command = ["pcl_ply2pcd", "-format", "0", str(path), str(out)]
    said = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    if not out.exists():
        raise ValueError((said.stdout + said.stderr)[-100:])
    head = dict(line.split(" ", 1) for line in out.read_text("latin-1").splitlines()[:11] if " " in line)
    return seen(int(head["POINTS"]), 0, 0, [name for name in head["FIELDS"].split() if name not in "xyz"])


PROGRAMS: dict[str, tuple[str, Callable[[Path], Found], tuple[str, ...]]] = {
    "CloudCompare": ("CloudCompare", with_cloudcompare, ("ply", "obj", "dxf", "stl")),
    "PyMeshLab": ("pymeshlab", with_pymeshlab, ("ply", "obj", "stl", "glb")),
    "Open3D": ("open3d", with_open3d, ("ply", "obj", "stl", "glb")),
    "trimesh": ("trimesh", with_trimesh, ("ply", "obj", "dxf", "stl", "glb")),
    "meshio": ("meshio", with_meshio, ("ply", "obj", "stl")),
    "PyVista": ("pyvista", with_pyvista, ("ply", "obj", "vtp", "stl", "glb")),
    "Blender": ("bpy", with_blender, ("ply", "obj", "stl", "glb")),
    "PCL": ("pcl_ply2pcd", with_pcl, ("ply",)),
    "navis": ("navis", with_navis, ("swc",)),
    "networkx": ("networkx", with_networkx, ("graphml", "node-link.json")),
    "pandas": ("pandas", with_pandas, ("csv",)),
}


def suffix_of(path: Path) -> str:
    return "node-link.json" if path.name.endswith(".node-link.json") else path.suffix[1:]


def tried(name: str, folder: Path) -> None:
    """Print what one program sees in each file, a line of JSON each."""
    _, look, suffixes = PROGRAMS[name]
    for path in sorted(folder.iterdir()):
        if path.is_file() and path.name != SEEN and suffix_of(path) in suffixes:
            try:
                found: Found = look(path)
            except (Exception, SystemExit) as error:
                found = {"error": f"{type(error).__name__}: {error}"[:160]}
            print("SEEN " + json.dumps([path.name, found]), flush=True)


def open_all(folder: Path) -> None:
    """Try every program that is here, and add what it sees to what is known."""
    every = known(folder)
    for name, (module, _, _) in PROGRAMS.items():
        if importlib.util.find_spec(module) is None and shutil.which(module) is None:
            continue
        command = [sys.executable, __file__, "tried", str(folder), "--program", name]
        done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
        rows = [json.loads(line[5:]) for line in done.stdout.splitlines() if line.startswith("SEEN ")]
        every[name] = {"version": version_of(module), "files": dict(rows)}
        print(name, every[name]["version"], len(rows), "files", done.stderr[-200:] if done.returncode else "")
    (folder / SEEN).write_text(json.dumps(every, indent=1))


def known(folder: Path) -> dict[str, Any]:
    """Return what was seen before, by program."""
    file = folder / SEEN
    return dict(json.loads(file.read_text())) if file.exists() else {}


def version_of(module: str) -> str:
    """Return the version of a program, as its package or the system's says."""
    from importlib.metadata import PackageNotFoundError, version

    for name in (module, f"{module}-cpu"):
        with contextlib.suppress(PackageNotFoundError):
            return version(name)
    package = {"CloudCompare": "cloudcompare", "pcl_ply2pcd": "pcl-tools"}.get(module, module)
    command = ["dpkg-query", "-W", "-f", "${Version}", package]
    said = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    return re.split(r"[-+]", said)[0]


def back(folder: Path) -> dict[str, str]:
    """Return what tiskel sees in each of their files."""
    from tiskel import TiskelError
    from tiskel.io.anything import MeshFile, read_anything
    from tiskel.io.clouds import Cloud
    from tiskel.io.curves import Curve, load_curve

    found = {}
    for path in sorted((folder / "theirs").iterdir()):
        if path.suffix == ".mtl" or path.name.startswith(("skeleton-ply-by-PCL", "surface-ply-by-PCL")):
            continue  # materials, and points alone of what is no cloud
        try:
            thing = load_curve(path) if path.name.startswith("skeleton") else read_anything(path)
        except TiskelError as error:
            found[path.name] = f"no: {error}"
            continue
        counts = {Curve: lambda c: f"{len(c.nodes)} nodes, {len(c.edges)} edges", MeshFile: lambda m:
                  f"{len(m.points)} vertices, {len(m.faces)} faces", Cloud: cloud_words}  # fmt: skip
        found[path.name] = counts[type(thing)](thing)
    return found


def cloud_words(cloud: Any) -> str:
    return f"{len(cloud.points)} points" + (f"; {', '.join(cloud.properties)}" if cloud.properties else "")


def cell(found: Found | None) -> str:
    """Return what a program sees in a file, as the table has it."""
    if found is None:
        return ""
    if "error" in found:
        return "no"
    counts = [f"{found[key]} {key}" for key in ("points", "edges", "faces") if found[key]]
    return ", ".join(counts or ["nothing"]) + (f"; {', '.join(found['scalars'])}" if found["scalars"] else "")


def page(folder: Path) -> str:
    """Return the page: a table for our files, one for theirs, and what is to be known of both."""
    every, text = known(folder), INTRODUCTION
    names = list(dict.fromkeys(name for one in every.values() for name in one["files"]))
    for name in sorted(names):
        text += f"\n### {name}\n\n| program | what it sees |\n|---|---|\n"
        rows = {program: one["files"].get(name) for program, one in every.items()}
        text += "".join(f"| {p} | {cell(row)} |\n" for p, row in rows.items() if row is not None)
    text += "\n## Their files\n\nWhat each program wrote of what it had read, and what tiskel reads in that.\n\n"
    text += "| file | program | what tiskel sees |\n|---|---|---|\n"
    for name, words in back(folder).items():
        stem, _, program = name.partition("-by-")
        text += f"| {stem.partition('-')[0]}, {program.partition('.')[2]} | {program.partition('.')[0]} | {words} |\n"
    versions = ", ".join(f"{program} {one['version']}" for program, one in every.items())
    return f"{text}\nTried with {versions}.\n"


INTRODUCTION = """# What other programs make of these files

Made by `benchmarks/tools.py`, of a Y of three limbs: `make` writes the files, `open` has every program that is
installed read them, `back` reads what they wrote. "no" is an error of the program.

- **CloudCompare** shows PLY properties named `scalar_...` as scalar fields (here without the prefix), and no edges of
  PLY: take DXF or OBJ, which become polylines. **MeshLab** shows `quality` as colours: the radius of a skeleton, beta
  of `metrics.ply`, trust of a surface.
  It takes the `red` in `centredness` for a colour, which shows where no scalar field is chosen.
- **meshio** reads PLY files of vertices and faces alone, so none with edges or a cloud inside. **PyVista** (VTK) drops
  edges and properties of PLY: take VTP, which has both.
- Lines of OBJ are edges in **MeshLab**, **Blender** and **PyVista**, polylines in **CloudCompare**; trimesh and meshio
  see their points alone, Open3D nothing. trimesh reads DXF as flat, without z.
- **trimesh** and **Open3D** read the edges of `skeleton.ply` (`trimesh.load(...).metadata["_ply_raw"]`,
  `read_line_set`).

## Our files
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["make", "open", "tried", "back"])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--program", help="the one that is tried")
    parser.add_argument("--write", action="store_true", help="the page, in docs/")
    asked = parser.parse_args()
    asked.folder.mkdir(exist_ok=True, parents=True)
    if asked.what == "make":
        make(asked.folder)
    elif asked.what == "open":
        open_all(asked.folder)
    elif asked.what == "tried":
        tried(asked.program, asked.folder)
    elif asked.write:
        PAGE.write_text(page(asked.folder))
    else:
        print(page(asked.folder))


if __name__ == "__main__":
    main()
