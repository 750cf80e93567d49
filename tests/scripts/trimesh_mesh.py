import trimesh

from tiskel import skeletonize

mesh = trimesh.creation.capsule(2.0, 0.3)
skeleton = skeletonize(mesh)
trimesh.load_path(skeleton.nodes[skeleton.edges]).export("skeleton.dxf")
print(skeleton.ends, skeleton.loops, round(skeleton.length, 1))
