"""Stage function, matching, renaming and merging against loops."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reference import gls as plain
from reference.rings import same
from tiskel.arrays import Points
from tiskel.geometry.neighbours import cloud_rings
from tiskel.geometry.rings import Rings, smallest_distances
from tiskel.methods.laplacian.reduction import matching, merge, rename, stage_function


def as_lists(rings: Rings) -> list[tuple[list[int], bool]]:
    return [(rings.of(i).tolist(), bool(rings.closed[i])) for i in range(len(rings))]


@pytest.mark.parametrize("shrinkage", [0.0, 0.4, 3.0, -0.2])
def test_stage_function_equals_the_formula(capsule: Points, shrinkage: float) -> None:
    generator = np.random.default_rng(5)
    rings = cloud_rings(capsule, 12)
    there = capsule * 0.6 + generator.normal(size=capsule.shape) * 1e-3
    delta, first, now = (
        generator.normal(size=capsule.shape),
        smallest_distances(capsule, rings),
        smallest_distances(there, rings),
    )
    now[:5] = first[:5]  # V2 vanishes there
    ours = stage_function(
        capsule, there, delta, rings, first, now, shrinkage=shrinkage, contraction_weight=150.0, guard=1e-4
    )
    theirs = plain.stage_function(capsule, there, delta, as_lists(rings), first, now, shrinkage, 150.0)
    # Differences of squares: relative to the largest term, a few roundings.
    np.testing.assert_allclose(ours, theirs, rtol=1e-9)


@given(st.integers(0, 2**32 - 1), st.floats(0, 1))
def test_matching_is_the_greedy_one_in_index_order(seed: int, share: float) -> None:
    generator = np.random.default_rng(seed)
    n = 60
    points = generator.integers(0, 6, size=(n, 3)).astype(float)  # a coarse lattice, so that distances tie
    sizes = generator.integers(0, 6, size=n).astype(np.int32)
    members = np.full((n, 5), -1, np.int32)
    for i, size in enumerate(sizes):
        others = np.delete(np.arange(n), i)
        members[i, :size] = generator.choice(others, size, replace=False)
    rings = Rings(members, sizes, np.ones(n, np.int32))
    marked = generator.random(n) < share
    merged = matching(points, rings, marked)
    found = {int(lost): int(merged[lost]) for lost in np.flatnonzero(merged >= 0)}
    assert found == plain.greedy_matching(points, as_lists(rings), marked)
    touched = [*found, *found.values()]
    assert len(touched) == len(set(touched))


def test_matching_of_a_long_chain_takes_every_other_pair() -> None:
    """Every pair depends on the one before it."""
    n = 500
    points = np.cumsum(np.linspace(2, 1, n))[:, None] * [1.0, 0, 0]
    members = np.append(np.arange(1, n), n - 2)[:, None].astype(np.int32)
    merged = matching(points, Rings(members, np.ones(n, np.int32), np.zeros(n, np.int32)), np.ones(n, bool))
    assert np.flatnonzero(merged >= 0).tolist() == list(range(1, n, 2))


def test_renaming_keeps_the_first_of_repeats_and_drops_the_owner() -> None:
    rings = Rings(np.array([[1, 2, 3, 4], [3, 0, 2, -1], [0, 1, -1, -1], [4, 1, -1, -1], [3, -1, -1, -1]], np.int32),
                  np.array([4, 3, 2, 2, 1], np.int32), np.ones(5, np.int32))  # fmt: skip
    merged = np.array([-1, 3, -1, -1, 0], np.int32)  # 1 into 3, 4 into 0
    fresh = rename(rings, merged)
    assert [fresh.of(i).tolist() for i in range(4)] == [[3, 2], [3, 0, 2], [0, 3], [0]]


def test_merging_equals_the_plain_one_with_scipys_delaunay(capsule: Points) -> None:
    rings = cloud_rings(capsule, 12)
    merged_into = matching(capsule, rings, np.random.default_rng(2).random(len(capsule)) < 0.5)
    directions = np.random.default_rng(3).normal(size=capsule.shape)
    ours = merge(capsule, rings, merged_into, directions)
    pairs = {int(lost): int(merged_into[lost]) for lost in np.flatnonzero(merged_into >= 0)}
    merged, theirs = plain.merge(capsule, as_lists(rings), pairs, directions)
    assert {int(lost): int(ours.merged_into[lost]) for lost in np.flatnonzero(ours.merged_into >= 0)} == merged
    assert 50 < len(merged) <= len(pairs)
    lists = as_lists(ours.rings)
    assert all(same(lists[i], theirs[i]) for i in range(len(capsule)) if i not in merged)


def test_a_merge_that_leaves_fewer_than_three_members_does_not_happen() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, -1, 0]])
    rings = Rings(
        np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]], np.int32), np.full(4, 3, np.int32), np.ones(4, np.int32)
    )
    asked = np.array([-1, 0, -1, -1], np.int32)
    result = merge(points, rings, asked, np.tile([0.0, 0, 1], (4, 1)))
    assert (result.merged_into == -1).all()
    assert result.kept().tolist() == [0, 1, 2, 3]
