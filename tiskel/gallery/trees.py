"""Generated trees of several habits, as graphs of round cones, down to twigs thinner than their points are apart.

A shoot grows a few segments and hands its tips on to shoots of its own: in equal
shares where it forks, a small share at a time where it is a leader with laterals.
Radii follow the pipe model (Shinozaki et al. 1964; da Vinci's rule has the
exponent 2): the radius of a limb to some power is the sum of those it carries.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Numbers, Points
from tiskel.errors import TiskelError
from tiskel.geometry.round_cones import ConeGraph

PIPE = 2.2  # exponent of the pipe model; measured ones of trees lie between 1.8 and 2.6
SEGMENTS = 6  # straight pieces of a shoot
TWIG = 1.0  # length of a shoot that carries one tip; the unit of length
LONGER = 0.3  # power of the tips that a shoot carries, by which it is longer
FIRST = 2.0  # factor of the length of the stem


@dataclass(frozen=True)
class Habit:
    """How a kind of tree grows.

    Attributes
    ----------
    stems : (int, int)
        The least and the largest number of stems at the root.
    share : (float, float)
        Of the tips that the first shoot of a fork gets.
    angles : (float, float)
        Of the shoots of a fork to the one they grow from, the first and the second, in degrees.
    wander : float
        Standard deviation of the turn of a segment against the one before, in degrees.
    upwards : float
        What is added to the direction of every segment, upwards.
    """

    stems: tuple[int, int]
    share: tuple[float, float]
    angles: tuple[float, float]
    wander: float
    upwards: float


HABITS = {
    "spreading": Habit((1, 1), (0.35, 0.65), (28, 35), 7, 0.03),
    "leader": Habit((1, 1), (0.80, 0.93), (6, 60), 5, 0.04),
    "shrub": Habit((3, 6), (0.3, 0.7), (22, 30), 9, 0.08),
    "neuron": Habit((3, 6), (0.15, 0.85), (20, 55), 16, 0.0),
}


def tree(habit: str = "spreading", *, tips: int = 100, seed: int = 0) -> ConeGraph:
    """Return a generated tree; twigs are about one unit long and have a radius of 0.02 at their tips.

    Parameters
    ----------
    habit : str
        One of the names in :data:`HABITS`.
    tips : int
        How many ends it has, besides the root.
    seed : int
        The same seed gives the same tree.

    Returns
    -------
    ConeGraph

    Raises
    ------
    TiskelError
        For another name, and for less than two tips.

    Examples
    --------
    >>> from tiskel.gallery.trees import tree
    >>> small = tree("leader", tips=20, seed=1)
    >>> small.components, small.loops, small.ends
    (1, 0, 21)
    """
    if habit not in HABITS:
        raise TiskelError(f"no tree grows like {habit!r}; choose one of {', '.join(HABITS)}")
    if tips < 2:
        raise TiskelError(f"a tree has two tips or more, got {tips}")
    growing = _Growing(HABITS[habit], np.random.default_rng(seed))
    growing.grow(tips)
    return growing.shape()


def thickened(shape: ConeGraph, count: int, thickness: float) -> ConeGraph:
    """Return a tree whose twigs are so thick against the points, where so many are even on it by area.

    Parameters
    ----------
    shape : ConeGraph
        The tree.
    count : int
        The number of points of its cloud.
    thickness : float
        N r / L of the median end branch: its points per radius of length, which is 2 pi (r / s)^2 for points s apart.

    Returns
    -------
    ConeGraph
        With all radii times one factor.

    Examples
    --------
    >>> from tiskel.gallery.trees import thickened, tree
    >>> bool(thickened(tree(), 4000, 2.0).radii.max() > thickened(tree(), 4000, 0.5).radii.max())
    True
    """
    twigs = [branch for branch in shape.branches if shape.degrees[branch[-1]] == 1 or shape.degrees[branch[0]] == 1]
    radius = float(np.median([shape.radii[branch].mean() for branch in twigs]))
    area = float((np.pi * shape.radii[shape.edges].sum(axis=1) * shape.lengths).sum())
    # All radii times c: the area is c area, the density count / (c area), and N r / L = 2 pi c^2 radius^2 density.
    factor = thickness * area / (2 * np.pi * count * radius**2)
    return ConeGraph(shape.nodes, shape.edges, shape.radii * factor)


class _Growing:
    """A tree while it grows: nodes, the node that each hangs on, and the tips that each carries."""

    def __init__(self, habit: Habit, generator: np.random.Generator) -> None:
        self.habit, self.generator = habit, generator
        self.nodes: list[Numbers] = [np.zeros(3)]
        self.parents: list[int] = [-1]
        self.carried: list[int] = [0]

    def grow(self, tips: int) -> None:
        """Grow all stems."""
        stems = min(tips, int(self.generator.integers(self.habit.stems[0], self.habit.stems[1] + 1)))
        self.carried[0] = tips
        flat = self.habit.upwards == 0
        waiting = []
        for number in range(stems):
            part = tips // stems + (number < tips % stems)
            aside = self.generator.normal(size=3) * (1.0 if flat else 0.5 * (stems > 1))
            heading = aside + (0.0 if flat else 1.0) * np.array([0.0, 0.0, 1.0])
            waiting.append((0, heading / np.linalg.norm(heading), part, FIRST if stems == 1 else 1.0))
        while waiting:
            node, heading, part, longer = waiting.pop()
            node, heading = self._shoot(node, heading, part, longer)
            if part > 1:
                one = int(np.clip(round(part * self.generator.uniform(*self.habit.share)), 1, part - 1))
                around = self.generator.uniform(0, 2 * np.pi)
                for number, share in enumerate((one, part - one)):
                    angle = np.radians(self.habit.angles[number] * self.generator.uniform(0.7, 1.3))
                    waiting.append((node, _turned(heading, angle, around + np.pi * number), share, 1.0))

    def _shoot(self, node: int, heading: Numbers, tips: int, longer: float) -> tuple[int, Numbers]:
        """Add the segments of a shoot; return its last node, and where it looks."""
        length = TWIG * longer * tips**LONGER * self.generator.uniform(0.7, 1.3)
        for _ in range(SEGMENTS):
            angle = np.radians(self.habit.wander) * abs(self.generator.normal())
            heading = _turned(heading, angle, self.generator.uniform(0, 2 * np.pi))
            heading = heading + self.habit.upwards * np.array([0.0, 0.0, 1.0])
            heading /= np.linalg.norm(heading)
            self.nodes.append(self.nodes[node] + length / SEGMENTS * heading)
            self.parents.append(node)
            self.carried.append(tips)
            node = len(self.nodes) - 1
        return node, heading

    def shape(self) -> ConeGraph:
        """Return the round cones."""
        nodes: Points = np.array(self.nodes)
        parents: npt.NDArray[np.int32] = np.array(self.parents, np.int32)
        edges = np.stack([parents[1:], np.arange(1, len(nodes), dtype=np.int32)], axis=1)
        return ConeGraph(nodes, edges, 0.02 * np.array(self.carried, float) ** (1 / PIPE))


def _turned(heading: Numbers, angle: float, around: float) -> Numbers:
    """Return a direction turned by an angle, towards a side that a second angle names."""
    first = np.cross(heading, np.eye(3)[int(np.abs(heading).argmin())])
    first /= np.linalg.norm(first)
    side = np.cos(around) * first + np.sin(around) * np.cross(heading, first)
    return np.asarray(np.cos(angle) * heading + np.sin(angle) * side)
