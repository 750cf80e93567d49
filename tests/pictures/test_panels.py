"""Panels of pictures that have nothing to show keep what they were."""

import numpy as np
import pytest

from tiskel.geometry.views import broad_view
from tiskel.pictures.canvas import MARGIN, Sight, cloud_panel, dots, framed, new_figure

POINTS = np.random.default_rng(0).random((30, 3)) * [4, 2, 1]
SIGHT = Sight(POINTS, broad_view(POINTS, "z"), "mm")


def test_nothing_is_drawn_and_framed_of_no_points() -> None:
    panel = new_figure(4, 4).add_subplot()
    panel.set(xlim=(3, 4), ylim=(5, 7))
    dots(panel, np.zeros((0, 2)), np.zeros(0))
    framed(panel, SIGHT, POINTS[:0])
    assert list(panel.collections) == []
    assert (panel.get_xlim(), panel.get_ylim()) == ((3, 4), (5, 7))


def test_a_panel_frames_what_it_is_asked_to() -> None:
    panel = new_figure(4, 4).add_subplot()
    cloud_panel(panel, SIGHT, POINTS[:5])
    flat = SIGHT.flat(POINTS[:5])
    margin = MARGIN * np.ptp(flat, axis=0).max()
    assert sorted(panel.get_xlim()) == pytest.approx([flat[:, 0].min() - margin, flat[:, 0].max() + margin])
    assert len(panel.collections[0].get_offsets()) == len(POINTS)
    assert panel.get_xlabel().endswith(", mm")
