"""The wire regime: limbs thinner than their points are apart, and the thick limbs that they grow from.

Sections of a front over a surface fall apart on wires. Here the curve follows the
points instead (the steps are those of tree reconstruction: AdTree, Du et al. 2019;
TEASAR, Sato et al. 2000; Verroust and Lazarus 2000):

1. A neighbour graph, its pieces joined by their shortest links (:mod:`.links`).
2. From every point the way to a root that keeps to the points (:mod:`.routes`).
3. Bins of that way fall into sections, twigs each into their own, a trunk into one (:mod:`.levels`).
4. The longest way is a limb; of every next one, what stands apart from the limbs before (:mod:`.limbs`).
5. Nodes are the means of their points; where these lie all about the limb, round cones are fitted, and the radius is
   measured, elsewhere it is a bound (:mod:`.curve`).
6. Ends that are noise, or strands of one limb side by side, go (:mod:`.spurs`); those of noisy wires are put on the
   lines of their limbs (:mod:`.tips`).
7. Loops, where ends meet head on and the body is no tree (:mod:`.loops`).
8. Where wires that are clear lines pass each other, apart, links from one to the other go, and 2 to 7 are done anew
   (:mod:`.crossings`).
9. Of a wire whose turns lie side by side, as in a spring, there are links along it alone (:mod:`.parallel`).
"""

from tiskel.arrays import Indices
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.network import Network
from tiskel.methods.robust.wire.crossings import crossings_of, parted
from tiskel.methods.robust.wire.curve import curve_of
from tiskel.methods.robust.wire.levels import RESOLVED, THREADS, levels_of
from tiskel.methods.robust.wire.limbs import crowding, limbs_of
from tiskel.methods.robust.wire.links import BRIDGE, Links, links_of
from tiskel.methods.robust.wire.loops import with_loops
from tiskel.methods.robust.wire.routes import routes_of
from tiskel.methods.robust.wire.spurs import without_spurs
from tiskel.methods.robust.wire.tips import on_their_lines
from tiskel.methods.trace import Sections
from tiskel.params import RobustParams

# Found by trial on generated trees, N r / L of their twigs from 0.1 to 5, clean and noisy.
FEW = 3.8  # points to a spacing of length, below which limbs are threads [N r / L to 1: 1.3 to 3.7, above it 4.0 up]
SELDOM = 0.28  # share of points on rings, below which what is a ring there is chance [noisy twigs to 0.26]
CLEAR = 0.5  # share of neighbourhoods that are lines, from which on wires hardly touch by chance [most trees to 0.35
# and all to 0.66, lattices from 0.9]
ROUNDS = 4  # of looking for wires that pass each other [woven lattices need two]
SMALLEST_PART = 10  # points; separate parts with fewer get no curve, unless there are no larger ones


def wire_curve(
    network: Network, params: RobustParams, tubes: Indices | None = None, noisy: bool = False,
    links: Links | None = None,
) -> tuple[ConeCurve, Sections, int]:  # fmt: skip
    """Return the curve of a cloud of wires, the sections that its nodes stand for, and how many ends met and are open.

    tubes (n,) name the sections of points on limbs that are known, -1 for
    others; noisy says that points of threads may look like rings; links are
    given where they are known.
    """
    links = links or links_of(network.points, max(SMALLEST_PART, int(params.least_part * len(network.points))))
    found = _curve(network, links, params, tubes, noisy)
    for _ in range(ROUNDS if network.linear_share > CLEAR else 0):  # one that is parted may show another
        if not (crossings := crossings_of(found[0], links.spacing)):
            break
        links = parted(links, network.points, crossings)
        found = _curve(network, links, params, tubes, noisy)
    return found


def _curve(
    network: Network, links: Links, params: RobustParams, tubes: Indices | None, noisy: bool
) -> tuple[ConeCurve, Sections, int]:
    """Return the curve that keeps to links, its sections, and how many ends met something and are left open."""
    points = network.points
    root = None if params.root is None else network.placed(params.root)
    routes = routes_of(points, links, root)
    levels = levels_of(points, links, routes, BRIDGE, RESOLVED, tubes)
    limbs = limbs_of(levels, links.spacing)
    crowd = crowding(levels, limbs, links.spacing)
    if noisy and crowd < FEW and levels.on_rings < SELDOM:
        levels = levels_of(points, links, routes, BRIDGE, THREADS, tubes)
        limbs = limbs_of(levels, links.spacing)
    curve, sections = curve_of(points, links.spacing, levels, limbs, params)
    curve = on_their_lines(without_spurs(curve, links.spacing, crowd, FEW))
    curve, left = with_loops(curve, sections, links, params.topology, network.linear_share > CLEAR)
    return curve, sections, left
