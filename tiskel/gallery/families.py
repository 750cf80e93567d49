"""Families of shapes that are no unions of round cones, by group."""

from collections.abc import Callable

from tiskel.gallery import machined, plants, torsos, tubes, wires
from tiskel.gallery.body import Body

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
