"""Settings of methods: what each method's number of neighbours is, and values that none can have."""

from math import inf, nan
from typing import Any

import pytest

from tiskel import ContractionParams, GlsParams, LbcParams, RobustParams, TiskelError
from tiskel.params.methods import published_neighbours


@pytest.mark.parametrize("kind", [GlsParams, LbcParams])
@pytest.mark.parametrize("name", ["growth", "contraction_weight", "attraction_weight"])
@pytest.mark.parametrize("value", [0.0, -1.0, inf, nan])
def test_weights_are_positive(kind: Any, name: str, value: float) -> None:
    with pytest.raises(TiskelError, match=f"{name} must be a positive number, got {value}"):
        kind(**{name: value})
    assert getattr(kind(**{name: 1e-9}), name) == 1e-9


@pytest.mark.parametrize("value", [0.0, 1.0, -0.1, nan])
def test_the_radius_of_sampling_balls_is_a_share(value: float) -> None:
    with pytest.raises(TiskelError, match=f"radius must be a share of the diagonal between 0 and 1, got {value}"):
        LbcParams(radius=value)
    assert LbcParams(radius=0.999).radius == 0.999


def test_neighbours_are_chosen_by_the_method_and_no_more_than_there_are_points() -> None:
    assert [published_neighbours(count) for count in (5, 100, 1000, 10_000)] == [5, 8, 12, 30]
    assert GlsParams().neighbours_for(1000) == 12
    assert GlsParams(neighbours=9).neighbours_for(1000) == 9
    assert RobustParams().neighbours_for(7) == 7


def test_places_are_settings_of_robust_alone() -> None:
    """Settings without places are the same in other coordinates."""
    lbc = ContractionParams(method="lbc")
    assert lbc.placed(lambda place: (0.0, 0.0, 0.0)) is lbc
    moved = RobustParams(root=(1, 2, 3)).placed(lambda place: (place[0] + 10, place[1], place[2]))
    assert (moved.root, moved.seen_from) == ((11, 2, 3), None)
