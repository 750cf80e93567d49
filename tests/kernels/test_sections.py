"""Cross-sections against every point beside every plane."""

import numpy as np

from tiskel.kernels.sections import section_counts, section_points

GENERATOR = np.random.default_rng(5)
POINTS = GENERATOR.normal(size=(500, 3))
CENTRES = GENERATOR.normal(size=(7, 3)) * 0.3
FRAMES = np.linalg.qr(GENERATOR.normal(size=(7, 3, 3)))[0]
X, Y, Z = (np.ascontiguousarray(FRAMES[:, :, k]) for k in range(3))
HALF, REACH = 0.2, np.array([0.5, 1.0, np.inf, 2.0, 0.0, 1.5, 1.0])


def test_every_section_has_the_points_of_its_slab_within_its_reach_in_its_own_frame() -> None:
    counts = np.empty(7, np.int32)
    section_counts(POINTS, CENTRES, X, HALF, REACH, counts)
    offsets = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
    rows, (across, up, ahead) = np.empty(offsets[-1], np.int32), np.empty((3, offsets[-1]))
    section_points(POINTS, CENTRES, X, Y, Z, HALF, REACH, offsets[:-1], rows, across, up, ahead)
    for s in range(7):
        local = (POINTS - CENTRES[s]) @ FRAMES[s]
        inside = (np.abs(local[:, 0]) <= HALF) & (np.hypot(local[:, 1], local[:, 2]) <= REACH[s])
        part = slice(offsets[s], offsets[s + 1])
        assert rows[part].tolist() == np.flatnonzero(inside).tolist()
        found = np.stack([ahead[part], across[part], up[part]], axis=1)
        np.testing.assert_allclose(found, local[inside], atol=1e-14)  # sums of three products, in another order
    assert counts[2] > counts[0] > 0
