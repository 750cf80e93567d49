"""Families of shapes that are no unions of round cones, by group."""

from collections.abc import Callable, Mapping
from functools import partial

from tiskel.gallery import machined, plants, torsos, tubes, wires
from tiskel.gallery.body import Body, Shape
from tiskel.gallery.catalogue import SHAPES
from tiskel.gallery.trees import HABITS, thickened, tree
from tiskel.geometry.round_cones import ConeGraph

# Groups of names, in the order in which they are listed. Beside SHAPES: benchmarks over those stay as they are.
FAMILIES: dict[str, dict[str, Callable[[], Body]]] = {
    group: {make.__name__.replace("_", "-"): make for make in makers}
    for group, makers in {
        "tubes": (
            tubes.flat_tube, tubes.strap, tubes.square_bar, tubes.twisted_bar, tubes.horn, tubes.band,
            tubes.half_torus, tubes.bundle, tubes.twins,
        ),
        "plants": (plants.leaf, plants.seedling, plants.maize),
        "blocks": (
            machined.block_1, machined.block_2, machined.block_3, machined.washer_plate, machined.strip,
            machined.l_bracket, machined.u_bracket,
        ),
        "torsos": (torsos.torso, torsos.knobs),
        "wires": (wires.coil, wires.crossing, wires.lattice, wires.stent),
    }.items()
}  # fmt: skip

BODIES: dict[str, Callable[[], Body]] = {name: make for group in FAMILIES.values() for name, make in group.items()}

TREE_POINTS, TREE_THICKNESS = 4096, 1.0  # the cloud whose points per radius of length a named tree is made for


def grown(habit: str) -> ConeGraph:
    """Return a tree of 100 tips whose twigs are about as thick as 4096 points on it are apart."""
    return thickened(tree(habit), TREE_POINTS, TREE_THICKNESS)


TREES: dict[str, Callable[[], ConeGraph]] = {f"{habit}-tree": partial(grown, habit) for habit in HABITS}

# All names, in the groups and in the order in which they are listed.
GROUPS: Mapping[str, Mapping[str, Callable[[], Shape]]] = {"round cones": SHAPES, **FAMILIES, "trees": TREES}
