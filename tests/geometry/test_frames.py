"""Directions across directions, and labels of what hangs together."""

import numpy as np

from tiskel.geometry.frames import across, step_lengths, unit
from tiskel.geometry.graph import component_labels, connected_sets


def test_two_directions_across_one_make_a_right_handed_frame_with_it() -> None:
    x = unit(np.concatenate([np.random.default_rng(0).normal(size=(200, 3)), np.eye(3), -np.eye(3)]))
    frames = np.concatenate([across(x), x[:, None]], axis=1)
    np.testing.assert_allclose(frames @ np.swapaxes(frames, 1, 2), np.tile(np.eye(3), (len(x), 1, 1)), atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(frames), 1, atol=1e-14)
    np.testing.assert_array_equal(across(x)[7], across(x[7]))  # one alone, to the last bit


def test_a_vector_of_length_zero_stays_zero() -> None:
    assert unit(np.array([[0, 0, 0], [0, 3.0, 4.0]])).tolist() == [[0, 0, 0], [0, 0.6, 0.8]]
    assert step_lengths(np.array([[0, 0, 0], [0, 3.0, 4.0]])).tolist() == [5.0]


def test_sets_are_numbered_by_their_first_members_and_nothing_has_none() -> None:
    links = np.array([[4, 2], [2, 4], [3, 0]], np.int32)
    assert component_labels(5, links).tolist() == [0, 1, 2, 0, 2]
    assert [members.tolist() for members in connected_sets(5, links)] == [[0, 3], [1], [2, 4]]
    assert connected_sets(0, links[:0]) == []
