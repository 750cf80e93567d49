from pathlib import Path

import open3d as o3d

from tiskel import skeletonize

cloud = o3d.io.read_point_cloud(Path("scan.ply"))
s = skeletonize(cloud, method="robust")
lines = o3d.geometry.LineSet(o3d.utility.Vector3dVector(s.nodes), o3d.utility.Vector2iVector(s.edges))
o3d.io.write_line_set(Path("lines.ply"), lines)
