"""The measures as a whole: published values, odd input, documents without NaN."""

import json
from typing import Any

import numpy as np
import pytest

from reference.fixtures import Load
from reference.quality import SECTIONS
from tiskel import MetricParams, Quality, ShapeParams, TiskelError, evaluate, make_shape, shape_graph
from tiskel.arrays import Points
from tiskel.metrics.tables import COLUMNS, best_rows, row_of, to_csv
from tiskel.pictures.quality import quality_picture


def strict(quality: Quality) -> dict[str, Any]:
    """Return the document after a round trip through JSON that refuses NaN."""
    return dict(json.loads(json.dumps(quality.as_dict(), allow_nan=False)))


PUBLISHED = {  # by the toolbox, on its own arrays; centredness of the points before boundedness is asked for
    "hammer": {"d_B": 0.00841, "d_W": 0.00762, "points": 0.827, "curve": 0.982, "centred": 0.531},
    "cave": {"d_B": 0.0361, "d_W": 0.0167, "points": 0.469, "curve": 0.923},
    "horse": {"centred": 0.105},
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_values_are_met(name: str, toolbox: Load) -> None:
    arrays, published = toolbox(f"{name}_lbc"), PUBLISHED[name]
    q = strict(
        evaluate(
            arrays["points"], arrays["contracted"], arrays["nodes"], arrays["edges"], origin=arrays["points"],
            params=MetricParams(bars="toolbox"),
        )
    )  # fmt: skip
    found = {
        "d_B": q["topology"]["bottleneck"], "d_W": q["topology"]["wasserstein"],
        "points": q["smoothness"]["points"], "curve": q["smoothness"]["curve"],
        "centred": q["centredness"]["points_raw"],
    }  # fmt: skip
    for measure, value in published.items():
        within = 0.006 * value if measure in ("d_B", "d_W") else 0.001
        assert found[measure] == pytest.approx(value, abs=within), measure
    if name != "horse":
        assert q["boundedness"]["points"] == pytest.approx(1, abs=0.005)
    if name == "hammer":
        assert q["topology"]["similar"] is True


def test_without_the_diagonal_hammer_is_as_far_as_print_says(toolbox: Load) -> None:
    arrays = toolbox("hammer_lbc")
    q = evaluate(arrays["points"], arrays["contracted"], params=MetricParams(diagonal=False))
    assert q.topology is not None
    assert q.topology.bottleneck == pytest.approx(0.0118, rel=0.01)


def shape(count: int = 600) -> tuple[Points, Points, Points, np.ndarray]:
    """Return a cloud, points on its axis that belong to its rows, and its true curve."""
    cloud, true = make_shape(shape_graph("capsule"), ShapeParams(count=count))
    return cloud, cloud * [0.01, 0.01, 0.75], true.nodes, true.edges


def test_keys_are_the_same_whatever_is_given() -> None:
    cloud, points, nodes, edges = shape()
    for given in ((points, nodes, edges), (points, None, None), (None, nodes, edges), (None, None, None)):
        document = strict(evaluate(cloud, *given))
        assert {part: set(document[part]) for part in SECTIONS} == SECTIONS
        for part in SECTIONS:
            for key, value in document[part].items():
                if value is None and part != "graph" and key in ("points", "curve", "bottleneck", "solid", "graph"):
                    assert document[part]["reasons"][key]


def test_the_middle_of_a_capsule_is_good() -> None:
    q = strict(evaluate(*shape()))
    assert q["boundedness"]["points"] == q["inside"]["points"] == q["inside"]["curve"] == 1
    assert q["medialness"] == {"curve": pytest.approx(1, abs=0.05), "reasons": {}}
    assert q["air"] == {"curve": 0, "places": [], "reasons": {}}
    assert q["settings"]["correspondence"] == "rows"
    assert q["graph"] == {"components": 1, "loops": 0, "ends": 2, "joints": 0, "length": pytest.approx(1.4)}


def test_a_skeleton_outside_its_cloud_is_bad_and_measured() -> None:
    cloud, points, nodes, edges = shape()
    q = strict(evaluate(cloud, points + [5, 0, 0], nodes + [5, 0, 0], edges))
    assert q["boundedness"]["points"] == q["boundedness"]["curve"] == 0
    assert q["inside"]["points"] == q["inside"]["curve"] == 0
    assert q["centredness"]["points"] == q["centredness"]["curve"] == 0
    assert q["medialness"]["curve"] == 0
    assert q["air"]["curve"] == 1
    places = np.array(q["air"]["places"])  # in the units of the input
    assert len(places) == 3
    np.testing.assert_allclose(places[:, :2], np.tile([5, 0], (3, 1)), atol=1e-9)
    assert np.ptp(places[:, 2]) > 1


def test_unbounded_points_have_no_centredness_however_their_originals_lie() -> None:
    cloud, points, *_ = shape()
    outside = points + [5, 0, 0]
    around = outside + np.where(np.arange(len(points)) % 2 == 0, 1.0, -1.0)[:, None] * [0, 0.3, 0]
    q = evaluate(cloud, outside, origin=around)
    assert q.points is not None
    assert q.points.raw_centredness.mean() > 0.5
    assert (q.points.centredness == 0).all()


def test_an_empty_curve_is_null_with_its_reason() -> None:
    cloud, points, *_ = shape()
    q = strict(evaluate(cloud, points, np.zeros((0, 3)), np.zeros((0, 2))))
    assert q["boundedness"]["curve"] is None
    assert "no curve with edges" in q["boundedness"]["reasons"]["curve"]
    assert q["loops"]["graph"] == q["graph"]["components"] == 0


def test_an_isolated_node_is_a_component_and_a_joint_alone_is_a_curve() -> None:
    cloud, points, nodes, edges = shape()
    lonely = strict(evaluate(cloud, points, np.vstack([nodes, [0.0, 0, 0]]), edges))
    assert lonely["graph"]["components"] == 2
    star = np.array([[0.0, 0, 0], [0, 0, 0.4], [0, 0.1, -0.3], [0.1, 0, -0.3]])
    joint = strict(evaluate(cloud, points, star, [[1, 0], [2, 0], [3, 0]]))
    assert joint["graph"]["joints"] == 1
    assert joint["smoothness"]["curve"] == 1
    only = strict(evaluate(cloud, points, star[:1], None))
    assert only["smoothness"]["curve"] is None
    assert only["graph"] == {"components": 1, "loops": 0, "ends": 0, "joints": 0, "length": 0}


def test_a_curve_at_one_place_has_no_direction() -> None:
    cloud, points, *_ = shape()
    q = strict(evaluate(cloud, points, np.zeros((2, 3)), [[0, 1]]))
    assert q["smoothness"]["curve"] is q["centredness"]["curve"] is None
    assert q["smoothness"]["reasons"]["curve"]


def test_ten_points_are_enough_and_nine_are_not() -> None:
    generator = np.random.default_rng(9)
    cloud = generator.normal(size=(10, 3))
    q = strict(evaluate(cloud, cloud * 0.1, [[0.0, 0, 0], [0.1, 0, 0]], [[0, 1]]))
    assert q["counts"]["cloud"] == 10
    with pytest.raises(TiskelError, match="at least 10 distinct points"):
        evaluate(cloud[:9], cloud[:9])


@pytest.mark.parametrize("count", [1, 2, 3, 5])
def test_few_skeletal_points_are_measured_as_far_as_they_go(count: int) -> None:
    cloud, points, *_ = shape()
    q = strict(evaluate(cloud, points[:count]))
    assert q["settings"]["correspondence"] == "nearest"
    assert q["boundedness"]["points"] == 1
    assert (q["smoothness"]["points"] is None) == (count == 1)


def test_where_counts_differ_the_nearest_originals_stand_in_and_it_is_said() -> None:
    cloud, points, *_ = shape()
    q = evaluate(cloud, points[::3])
    assert q.correspondence == "nearest"
    assert q.points is not None
    nearest = cloud[np.linalg.norm(cloud - points[::3][:, None], axis=2).argmin(axis=1)]
    np.testing.assert_allclose(q.points.originals, nearest, atol=1e-12)
    assert evaluate(cloud, points[::3], origin=cloud[::3]).correspondence == "given"
    with pytest.raises(TiskelError, match="origin must have a row for each of the 200 points, got 600"):
        evaluate(cloud, points[::3], origin=cloud)


def test_some_points_at_one_place_have_no_tangent_and_no_nan() -> None:
    cloud, points, *_ = shape()
    q = strict(evaluate(cloud, np.zeros_like(points), origin=cloud))
    assert q["smoothness"]["points"] is None
    assert q["smoothness"]["reasons"]["points"] == "all of it is at one place"
    assert q["counts"]["points_without_tangent"] == len(points)


def test_broken_rows_and_edges_are_dropped_counted_or_refused() -> None:
    cloud, points, nodes, edges = shape()
    holed, bad = points.copy(), np.vstack([cloud, [[np.nan, 0, 0]]])
    holed[3] = np.inf
    q = evaluate(bad, holed, nodes, [*edges.tolist(), [0, 0], edges[0].tolist()], origin=cloud)
    assert len(q.warnings) == 3
    assert strict(q)["counts"]["points_measured"] == len(points) - 1
    with pytest.raises(TiskelError, match="names node 99"):
        evaluate(cloud, points, nodes, [[0, 99]])
    with pytest.raises(TiskelError, match="node 0 of the curve is not finite"):
        evaluate(cloud, points, [[np.nan, 0, 0]], [])
    with pytest.raises(TiskelError, match="bars must be one of"):
        MetricParams(bars="all")  # type: ignore[arg-type]


def test_units_and_place_do_not_matter_but_for_length() -> None:
    cloud, points, nodes, edges = shape()
    here = strict(evaluate(cloud, points, nodes, edges))
    there = strict(evaluate(1000 * cloud + 1e4, 1000 * points + 1e4, 1000 * nodes + 1e4, edges))
    assert there["graph"]["length"] == pytest.approx(1000 * here["graph"]["length"])
    for part in ("topology", "boundedness", "inside", "centredness", "smoothness"):
        assert there[part]["reasons"] == here[part]["reasons"]
        for key in here[part].keys() - {"reasons", "similar"}:
            assert there[part][key] == pytest.approx(
                here[part][key], abs=2e-3
            )  # rounding at 1e4 picks other neighbours


def test_a_comparison_marks_the_best_value_of_each_column() -> None:
    cloud, points, nodes, edges = shape()
    rows = [row_of(strict(evaluate(cloud, points + [d, 0, 0], nodes + [d, 0, 0], edges))) for d in (0.0, 5.0)]
    best = best_rows(rows)
    assert (0, "inside_points") in best
    assert (1, "inside_points") not in best
    assert {(0, "smoothness_curve"), (1, "smoothness_curve")} <= best  # a tie
    assert not best_rows(rows[:1])
    table = to_csv(rows).decode().splitlines()
    assert table[0].split(",") == [column.key for column in COLUMNS]
    assert len(table) == 3


def test_pictures_of_everything_and_of_nothing_are_drawn() -> None:
    cloud, points, nodes, edges = shape()
    whole, bare = evaluate(cloud, points, nodes, edges), evaluate(cloud)
    broken = np.vstack([cloud, [[np.nan, 0, 0]]])
    assert quality_picture([("broken", broken, bare)]) == quality_picture([("broken", cloud, bare)])
    picture = quality_picture([("whole", cloud, whole), ("bare", cloud, bare)])
    assert picture.startswith(b"\x89PNG")
    assert picture == quality_picture([("whole", cloud, whole), ("bare", cloud, bare)])
    assert b"<svg" in quality_picture([("whole", cloud, whole)], "svg")
    with pytest.raises(TiskelError, match="cannot be written as 'bmp'"):
        quality_picture([("whole", cloud, whole)], "bmp")


def test_a_line_halfway_to_the_wall_is_half_medial() -> None:
    """The radius of the capsule is 0.2."""
    cloud, _, nodes, edges = shape(3000)
    q = strict(evaluate(cloud, nodes=nodes + [0.1, 0, 0], edges=edges))
    assert q["medialness"]["curve"] == pytest.approx(0.5, abs=0.05)


def test_where_inside_is_not_known_medialness_is_not() -> None:
    generator = np.random.default_rng(0)
    fog = generator.random((400, 3))
    q = strict(evaluate(fog, nodes=np.array([[0.2, 0.2, 0.2], [0.8, 0.8, 0.8]]), edges=[[0, 1]]))
    assert q["medialness"]["curve"] is None
    assert q["medialness"]["reasons"]["curve"] == q["inside"]["reasons"]["curve"]
