"""What the report says about measures, stages and files: what is good, and what it means."""

MEASURES = {  # by key of tiskel.metrics.tables: what is good, what it means
    "topology_bottleneck": (
        "near 0",
        "Largest difference between the barcodes of cloud and skeleton, normalised.",
    ),
    "topology_wasserstein": ("near 0", "All differences between the barcodes together, normalised."),
    "boundedness_points": ("1", "Share of skeletal points with the cloud all around them."),
    "boundedness_curve": ("1", "Share of the curve with the cloud all around it."),
    "inside_points": ("1", "Share of skeletal points inside the surface."),
    "inside_curve": ("1", "Share of the curve inside the surface."),
    "medialness_curve": (
        "near 1",
        "Distance of the curve to the surface, over the most that is possible beside it.",
    ),
    "air_curve": ("0", "Share of the curve that is neither at the points of the cloud nor between them."),
    "centredness_points": ("near 1", "Share of skeletal points in the middle of their section."),
    "centredness_curve": ("near 1", "Share of the curve in the middle of its section."),
    "smoothness_points": ("near 1", "How little the direction changes from one skeletal point to the next."),
    "smoothness_curve": ("near 1", "How little the curve bends at its nodes."),
    "loops_surface": ("", "Loops that the surface of the cloud has, counted from its holes at all scales."),
    "loops_solid": ("", "Handles of the body, where its inside is known."),
    "loops_graph": ("as the solid", "Loops of the curve; more than the solid's are wrong, fewer are cut."),
    "graph_components": ("as the bodies", "Pieces of the curve that hang together."),
    "graph_ends": ("as the tips", "Places where the curve ends."),
    "graph_joints": ("as the forks", "Places where branches meet."),
    "graph_length": ("", "All branches together, in the unit of the cloud."),
}
STAGES = {
    "read": "Reading the file",
    "condition": "Preparing the cloud",
    "contract": "Contraction",
    "skeleton": "Curve skeleton",
    "metrics": "Measures",
    "stability": "Stability of the contraction",
    "surface": "Surfaces around the branches",
    "roll": "Rolling sphere",
    "pictures": "Pictures",
}
FILES = {
    "contraction.ply": "the contracted cloud, for tiskel skeleton and stability",
    "skeleton.ply": "curve, radii and cloud, for tiskel slice, metrics and view",
    "skeleton.obj": "the curve as lines, for CloudCompare, MeshLab and Blender",
    "skeleton.swc": "the curve as a tree, for neuron tools",
    "skeleton.json": "nodes and edges for scripts",
    "metrics.ply": "every measured place, for CloudCompare and tiskel view",
    "metrics.json": "the measures as numbers",
    "stability.json": "stability, step by step",
    "surface.json": "the surfaces, for tiskel roll",
    "surface.ply": "the surfaces as triangles",
    "slices.csv": "area, perimeter and radius of every slice",
    "path.csv": "the rolling sphere over time",
    "roll.json": "the runs in numbers",
    "skeleton.png": "cloud and curve",
    "metrics.png": "the measures as heat maps",
    "stability.png": "the steps of the contraction",
    "slices.png": "slices and sections",
    "roll.png": "the rolling sphere",
    "timings.json": "how long everything took",
}
PICTURES = {
    "skeleton.png": "The cloud and its curve, from the front, the side and the top, and in space.",
    "metrics.png": "The measures at their places; H0 bars, loops of the surface, and how the values are spread.",
    "stability.png": "How normals and curvatures changed, step by step, and the contracted points.",
    "slices.png": "Slices along the longest branches, a section in the middle, and the surface.",
    "roll.png": "Where the sphere rolls, its contact on both bodies, and the state over time.",
}
RUN = {  # of the summary of a run: what it is called
    "model": "model", "side": "side", "radius": "sphere radius", "status": "ended because", "reason": "in words",
    "path_object": "way over the object", "path_sphere": "way over the sphere",
    "least_margin": "least margin, 1 / length", "evaluations": "evaluations",
}  # fmt: skip
LENGTHS = {"radius", "path_object", "path_sphere"}
