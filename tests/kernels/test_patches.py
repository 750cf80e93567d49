"""The blend of quadrics against sums of NumPy over all patches."""

import numpy as np
import pytest

from tiskel.arrays import Table
from tiskel.kernels.patches import BLOCK, COLUMNS, FOUND, LARGE, blend


def boxes(low: Table, high: Table, size: int) -> Table:
    starts = np.arange(0, len(low), size)
    return np.concatenate([np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)], axis=1)


def reference(places: Table, patches: Table) -> Table:
    """f, gradient and Hessian of sum w q / sum w by the quotient rule, one place after the other."""
    out = np.full((len(places), FOUND), np.nan)
    out[:, 10] = -1
    for row, place in enumerate(places):
        d = place - patches[:, :3]
        left = 1 - (d**2).sum(axis=1) / patches[:, 3]
        there = left > 0
        if not there.any():
            continue
        d, left, some = d[there], left[there], patches[there]
        h = some[:, [8, 11, 12, 11, 9, 13, 12, 13, 10]].reshape(-1, 3, 3)
        slope = some[:, 5:8] + np.einsum("kij,kj->ki", h, d)
        q = some[:, 4] + (some[:, 5:8] * d).sum(axis=1) + np.einsum("ki,kij,kj->k", d, h, d) / 2
        w, dw = left**4, -8 * (left**3 / some[:, 3])[:, None] * d
        ddw = 48 * (left**2 / some[:, 3] ** 2)[:, None, None] * d[:, :, None] * d[:, None, :]
        ddw -= 8 * (left**3 / some[:, 3])[:, None, None] * np.eye(3)
        total, f = w.sum(), (w * q).sum() / w.sum()
        gradient = (w[:, None] * slope + q[:, None] * dw - f * dw).sum(axis=0) / total
        mixed = dw[:, :, None] * slope[:, None, :]
        hessian = (w[:, None, None] * h + (q - f)[:, None, None] * ddw + mixed + mixed.transpose(0, 2, 1)).sum(axis=0)
        turned = np.outer(gradient, dw.sum(axis=0))
        hessian = (hessian - turned - turned.T) / total
        xx, xy, xz, yy, yz, zz = hessian[np.triu_indices(3)]
        out[row] = [f, *gradient, xx, yy, zz, xy, xz, yz, np.flatnonzero(there)[w.argmax()]]
    return out


@pytest.mark.parametrize("count", [1, BLOCK + 1, 5 * BLOCK * LARGE + 3])
def test_the_blend_is_the_sum_over_all_patches(count: int) -> None:
    generator = np.random.default_rng(4)
    patches = generator.normal(size=(count, COLUMNS))
    patches[:, :3] = np.sort(generator.uniform(size=(count, 3)), axis=0)
    patches[:, 3] = generator.uniform(0.01, 0.1, count)
    reach = np.sqrt(patches[:, 3:4])
    small = boxes(patches[:, :3] - reach, patches[:, :3] + reach, BLOCK)
    places = np.concatenate([generator.uniform(-0.2, 1.2, (50, 3)), patches[:20, :3] + 0.05])
    found = np.empty((len(places), FOUND))
    blend(places, patches, small, boxes(small[:, :3], small[:, 3:], LARGE), found)
    expected = reference(places, patches)
    assert np.isnan(expected[:, 0]).any()
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-8)
