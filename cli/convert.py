"""``tiskel convert``."""

from pathlib import Path
from typing import Annotated

import typer

from tiskel import messages
from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli.common import common
from tiskel.cli.progress import reading, shown

Target = Annotated[Path, typer.Argument(metavar="OUT", help="A file; its suffix names the format.", show_default=False)]


@common
def convert(
    source: o.Source,
    target: Target,
    columns: o.Columns = None,
    classification: o.Classification = None,
    sample: o.Sample = o.SAMPLE,
    seed: o.Seed = o.CONDITIONING.seed,
) -> None:
    """Convert a cloud, a mesh or a skeleton to another format.

    Clouds go to PLY, XYZ, PTS, CSV, TSV, TXT, NPY; meshes to PLY, OBJ, STL, GLB, OFF, or sampled to clouds; skeletons,
    those of other programs too, to PLY, OBJ lines, SWC, GraphML, JSON, VTP, DXF, .graph and CSV; any stage file also
    gives its input cloud back as XYZ, PTS, TXT or NPY:
    `tiskel convert curve.ply curve.swc`
    """
    from tiskel.io.clouds import dump_cloud, parse_cloud
    from tiskel.io.curves import as_skeleton, holds_curve, parse_curve
    from tiskel.io.exports import EXPORTS, export_of
    from tiskel.io.formats import WRITTEN
    from tiskel.io.mesh_file import MESHES, mesh_bytes, parse_mesh
    from tiskel.io.stages.skeleton import parse_skeleton
    from tiskel.io.stages.which import stage_of
    from tiskel.io.streams import read_bytes

    stages.check_targets(target)
    with shown(reading(source)):
        data = read_bytes(source)
        ours = stage_of(data) == "skeleton"
        points_only = target.suffix.lower() in WRITTEN and target.suffix.lower().removeprefix(".") not in EXPORTS
        if not points_only and (ours or holds_curve(data, source)):
            skeleton = parse_skeleton(data, str(source)) if ours else as_skeleton(parse_curve(data, source))
            kind = export_of(target)
            stages.write(target, lambda: EXPORTS[kind](skeleton))
            return
        mesh = parse_mesh(data, source) if target.suffix.lower() in MESHES and sample == o.SAMPLE else None
        if mesh is not None:
            stages.write(target, lambda: mesh_bytes(mesh, target))
            return
        asked, classes = stages.columns_of(columns), stages.classes_of(classification)
        cloud = parse_cloud(data, source, mesh_samples=stages.sample_of(sample), seed=seed, columns=asked)
        cloud = cloud if classes is None else cloud.of_classes(classes)
        console.warn(cloud.warnings)
        console.tell(messages.said(cloud.notes))
        stages.write(target, lambda: dump_cloud(cloud.points, target))
