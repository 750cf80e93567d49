"""The directions of wires side by side, and how far beside each other their points are.

Directions are those that neighbours vote for, which count as much as they agree with it (tensor voting: Medioni, Lee
and Tang 2000). Beside is measured from the mean direction of two points: on an arc of a circle it is 0, too.

Seen along the wires, neighbours are on the wire itself or a whole turn aside, and hardly any are in between: the
distribution of how far they are beside each other has a valley.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tiskel.arrays import TINY, Lists, Masks, Numbers, Points, Stack, Table

# Found by trial on coils of 2048 to 16384 points whose turns are 1.5 to 3 spacings apart, against all other shapes of
# the gallery, scans, and rings, helices and grids of even steps.
VOTERS = 12  # neighbours that vote for a direction
NEAREST = 4  # of these that have the first vote: on a wire most of them are before and behind
ROUNDS = 6  # of voting
MIDDLE = 6  # the neighbour whose usual distance votes fade with
BIN = 0.1  # spacings: width of a bin of the distribution
FARTHEST = 3.0  # spacings: where it ends
SHALLOW = 0.35  # of what is at both sides of it, what a valley holds at most [coils 0.02 to 0.25; other shapes from
# 0.38, where points are even by design]
APART = 2.5  # times as far as a valley, at most, is the wire beyond it
WIDER = 1.5  # times as wide as votes at first is what directions are taken from in the end
AGAIN = 4  # times that directions and the valley are found anew
OWN = 0.2  # weight of a point's own direction against the mean of those about it


class Valley(NamedTuple):
    """Where few neighbours are: how few, against both sides of it, and how many spacings beside."""

    depth: float
    beside: float


@dataclass(frozen=True, eq=False)
class Wires:
    """Directions (n, 3), which neighbours (n, k) are on the same wire, and the valley beyond them."""

    directions: Points
    kept: Masks
    valley: Valley


def voted(points: Points, near: Lists) -> Points:
    """Return (n, 3) the directions that the first of the neighbours (n, k) vote for, themselves not included."""
    near = near[:, :VOTERS]
    steps = points[near] - points[:, None]
    lengths = np.linalg.norm(steps, axis=2)
    ways = steps / np.maximum(lengths, TINY)[:, :, None]
    close = _fading(lengths**2, 1.0)
    directions = _main(np.einsum("nki,nkj->nij", ways[:, :NEAREST], ways[:, :NEAREST]))
    for _ in range(ROUNDS):
        agreed = np.einsum("nki,nki->nk", ways, directions[near]) ** 2
        directions = _main(np.einsum("nk,nki,nkj->nij", close * agreed, ways, ways))
    return directions


def beside(points: Points, near: Lists, directions: Points) -> Table:
    """Return (n, k) how far neighbours are beside the mean direction of both."""
    steps, theirs = points[near] - points[:, None], directions[near]
    return beside_mean(steps, directions[:, None], theirs)


def beside_mean(steps: Stack, one: Stack, other: Stack) -> Table:
    """Return (..., ) how far steps (..., 3) lead beside the mean of directions (..., 3), whose signs mean nothing."""
    mean = one + np.where((one * other).sum(axis=-1, keepdims=True) < 0, -1.0, 1.0) * other
    mean /= np.linalg.norm(mean, axis=-1, keepdims=True)
    return np.asarray(np.sqrt(np.maximum((steps**2).sum(axis=-1) - (steps * mean).sum(axis=-1) ** 2, 0)))


def valleys(distances: Numbers | Table) -> list[Valley]:
    """Return the valleys of a distribution of distances, in spacings, the nearest first; each is where it is lowest."""
    bins = np.arange(0, FARTHEST + BIN / 2, BIN)
    held = np.convolve(np.histogram(distances, bins)[0].astype(float), [0.25, 0.5, 0.25], "same")
    sides = np.array([_sides(held, number) for number in range(len(held))])
    low = np.flatnonzero(held < SHALLOW * sides)
    found = []
    for run in np.split(low, np.flatnonzero(np.diff(low) > 1) + 1) if len(low) else []:
        lowest = run[held[run] == held[run].min()]
        found.append(Valley(float((held / np.maximum(sides, 1))[lowest].min()), float(bins[lowest].mean() + BIN / 2)))
    return found


def _sides(held: Numbers, number: int) -> float:
    """Return the lesser of what is most before a bin, and beyond it within reach."""
    beyond = held[number + 1 : int(APART * number) + 2]
    return float(min(held[:number].max(initial=0), beyond.max(initial=0)))


def refined(points: Points, near: Lists, directions: Points, valley: Valley, spacing: float) -> Wires | None:
    """Return better directions, and which neighbours are on the same wire; None where there is no valley any more.

    From those on the same wire, and then in the mean with all about a point: wires side by side run the same way.
    """
    steps, away = points[near] - points[:, None], beside(points, near, directions)
    close = _fading((steps**2).sum(axis=2), WIDER)
    for _ in range(AGAIN):
        kept = away <= valley.beside * spacing
        own = _main(np.einsum("nk,nki,nkj->nij", kept * close, steps, steps))
        outer = own[:, :, None] * own[:, None, :]
        directions = _main(outer[near].mean(axis=1) + OWN * outer)
        away = beside(points, near, directions)
        if not (found := valleys(away / spacing)):
            return None
        valley = _nearest(found, valley.beside)
    return Wires(directions, away <= valley.beside * spacing, valley)


def _fading(squares: Table, wider: float) -> Table:
    """Return weights (n, k) that fade with the usual squared distance of a neighbour."""
    usual = float(np.median(squares[:, min(MIDDLE, squares.shape[1]) - 1]))
    return np.asarray(np.exp(-squares / max(wider**2 * usual, TINY)))


def _nearest(found: list[Valley], place: float) -> Valley:
    return min(found, key=lambda valley: abs(valley.beside - place))


def _main(scatter: Stack) -> Points:
    """Return (n, 3) the axis of the largest eigenvalue of symmetric matrices (n, 3, 3)."""
    return np.asarray(np.linalg.eigh(scatter)[1][:, :, 2])
