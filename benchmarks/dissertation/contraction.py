"""Chapter 3: GLSkeleton against Laplacian-based contraction, in time, points, shape, noise and settings."""

import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from core import AGAINST, KIND, MET, UNTESTED, Bench, Found, Json, Row, broad_view, cloud_panel, missing
from scipy.spatial import cKDTree
from subjects import distance, generated, meaningful, scan

from tiskel import (
    ConditioningParams,
    ContractionParams,
    GlsParams,
    LbcParams,
    ShapeParams,
    SkeletonParams,
    condition,
    contract,
    extract_skeleton,
    load_cloud,
    make_shape,
    shape_graph,
)
from tiskel.arrays import normalisation
from tiskel.pictures.canvas import new_figure
from tiskel.pictures.style import CURVE, INK, POINTS

METHODS = ("lbc", "gls")
COLOUR = {"lbc": POINTS, "gls": CURVE, "robust": INK}
CLOUDS = ("hammer", "horse", "joint", "cave", "fertility")
LEFT = {"hammer": 1675, "horse": 610, "joint": 1360, "cave": 2265, "fertility": 686}  # published code, points left
SHOWN = ("hammer", "hand", "quadruped", "torus")  # side by side
NOISES = (0.05, 0.10, 0.15)  # of half the diagonal
GROWTHS = (2.0, 3.0, 4.0, 5.0)  # s_L
BALLS = ("capsule", "banana", "hammer", "torus", "y", "hand", "quadruped", "starfish")  # of noise and settings


def pair(number: int, count: int, path: Path | None = None) -> Json:
    """Contract one cloud by both methods, one after the other, and make their raw curves."""
    if path is None:
        name, points, truth = generated(number, count)
    else:
        name, points, truth = path.stem, scan(path, count), None
    result: Json = {"name": name, "count": len(points)}
    for method in METHODS:
        contract(points[: min(len(points), 500)], ContractionParams(method=method))  # kernels are no part of it
        start = time.perf_counter()
        c = contract(points, ContractionParams(method=method, raw=True))
        middle = time.perf_counter()
        s = extract_skeleton(c)
        done = time.perf_counter()
        result[method] = {
            "contraction": middle - start - c.ring_seconds, "rings": c.ring_seconds, "curve": done - middle,
            "left": len(c.points) / len(points), "points": [step.points for step in c.steps],
            "ratio": [step.ring_ratio for step in c.steps], "score": [step.score for step in c.steps],
            "change": [step.score_change for step in c.steps], "components": s.components, "loops": s.loops,
            "right": None if truth is None else meaningful(s, truth), "status": c.status.value,
        }  # fmt: skip
    return result


def pairs(bench: Bench, count: int) -> list[Json]:
    """Return the results of all clouds of a size."""
    many = bench.sizes.clouds[count]
    if bench.data:
        return [bench.raw(pair, number=0, count=count, path=path) for _, path in list(bench.scans())[:many]]
    return [bench.raw(pair, number=number, count=count) for number in range(many)]


def medians(bench: Bench, what: str) -> dict[int, tuple[float, float, float]]:
    """Return by size the medians of lbc and of gls, and the median of their ratios."""
    table = {}
    for count in bench.sizes.clouds:
        both = [(r["lbc"][what], r["gls"][what]) for r in pairs(bench, count)]
        middle = [statistics.median(column) for column in zip(*both, strict=True)]
        table[count] = middle[0], middle[1], statistics.median(gls / lbc for lbc, gls in both if lbc > 0)
    return table


def common(bench: Bench, value: Callable[[Json], float]) -> dict[int, float]:
    """Return by size the median of a value over the clouds that all sizes have."""
    least = min(bench.sizes.clouds.values())
    return {count: statistics.median(map(value, pairs(bench, count)[:least])) for count in bench.sizes.clouds}


def said(table: dict[int, tuple[float, float, float]]) -> str:
    return "; ".join(f"{count}: lbc {a:.3f}, gls {b:.3f} s, ratio {r:.2f}" for count, (a, b, r) in table.items())


def over_sizes(bench: Bench, what: str, label: str, name: str) -> str:
    """Draw a box for each method and size."""
    figure = new_figure(4 * len(bench.sizes.clouds), 3.4)
    for panel, count in zip(
        figure.subplots(1, len(bench.sizes.clouds), squeeze=False)[0], bench.sizes.clouds, strict=True
    ):
        values = [[result[method][what] for result in pairs(bench, count)] for method in METHODS]
        panel.boxplot(values, tick_labels=METHODS)
        panel.set_title(f"{count} points, {len(values[0])} models", fontsize=9)
        panel.set_ylabel(label, fontsize=8)
    return bench.draw(name, figure)


def contraction_time(bench: Bench) -> Found:
    table = medians(bench, "contraction")
    ratios = [r for *_, r in table.values()]
    falls = all(b <= a for a, b in zip(ratios, ratios[1:], strict=False))
    half = table.get(4096, (0, 0, 0.5))[2]
    verdict = MET if falls and 0.35 < half < 0.65 else KIND if ratios[-1] < ratios[0] else AGAINST
    why = "the ratio falls with the size" if falls else "the ratio does not fall at every size"
    paired = common(bench, lambda r: r["gls"]["contraction"] / r["lbc"]["contraction"]).values()
    why += f"; on the {min(bench.sizes.clouds.values())} clouds that all sizes have: " + ", ".join(
        f"{ratio:.2f}" for ratio in paired
    )
    picture = over_sizes(bench, "contraction", "contraction, s", "fig-3-5-time.png")
    return Found(said(table), verdict, f"{why}; {half:.2f} at 4096", (picture,))


def spread_of_time(bench: Bench) -> Found:
    count = 4096 if 4096 in bench.sizes.clouds else max(bench.sizes.clouds)
    times = {m: [r[m]["contraction"] for r in pairs(bench, count)] for m in METHODS}
    lbc, gls = (statistics.stdev(times[m]) for m in METHODS)
    return Found(f"{count} points: lbc {lbc:.2f}, gls {gls:.2f} s", KIND if gls < lbc else AGAINST,
                 f"gls spreads {gls / lbc:.2f} as widely; published {0.32 / 1.30:.2f}")  # fmt: skip


def points_left(bench: Bench) -> Found:
    shares = {n: statistics.mean(r["gls"]["left"] for r in pairs(bench, n)) for n in bench.sizes.clouds}
    paired = list(common(bench, lambda r: float(r["gls"]["left"])).values())
    falls = all(b < a for a, b in zip(paired, paired[1:], strict=False))
    verdict = MET if falls else KIND if paired[-1] < paired[0] else AGAINST
    picture = over_sizes(bench, "left", "share of points left", "fig-3-5-left.png")
    ours = ", ".join(f"{count}: {share:.1%} of {bench.sizes.clouds[count]} clouds" for count, share in shares.items())
    why = f"judged by the {min(bench.sizes.clouds.values())} clouds that all sizes have, medians "
    return Found(ours, verdict, why + ", ".join(f"{share:.1%}" for share in paired), (picture,))


def curve_time(bench: Bench) -> Found:
    table = medians(bench, "curve")
    faster = all(r < 1 for *_, r in table.values())
    picture = over_sizes(bench, "curve", "curve, s", "fig-3-6-curve.png")
    return Found(said(table), KIND if faster else AGAINST, "the curve of fewer points takes less" if faster else
                 "not at every size", (picture,))  # fmt: skip


def total_time(bench: Bench) -> Found:
    contraction, words, less = medians(bench, "contraction"), [], []
    for count in bench.sizes.clouds:
        totals = {
            m: [sum(r[m][k] for k in ("contraction", "rings", "curve")) for r in pairs(bench, count)] for m in METHODS
        }
        ratio = statistics.median(g / b for b, g in zip(totals["lbc"], totals["gls"], strict=True))
        words.append(f"{count}: total {ratio:.2f}, contraction {contraction[count][2]:.2f}")
        less.append(ratio > contraction[count][2])
    return Found("; ".join(words), KIND if all(less) else AGAINST, "" if all(less) else
                 f"the total gains more than contraction at {len(less) - sum(less)} of {len(less)} sizes: the curve "
                 "gains most, and here it has its share")  # fmt: skip


def course(bench: Bench) -> Found:
    """Points, cost and score over the steps, one line a cloud."""
    count = 4096 if 4096 in bench.sizes.clouds else max(bench.sizes.clouds)
    runs = [r["gls"] for r in pairs(bench, count)]
    figure = new_figure(14, 3.4)
    names = (
        ("points", "points left"),
        ("ratio", "ring ratio, the cost"),
        ("score", "explained score e"),
        ("change", "Delta e"),
    )
    for panel, (what, label) in zip(figure.subplots(1, 4), names, strict=True):
        for run in runs:
            values = [np.nan if v is None else v for v in run[what]]
            panel.plot(range(1, len(values) + 1), values, color=INK, linewidth=0.6)
        panel.set_xlabel("step", fontsize=8)
        panel.set_title(label, fontsize=9)
    changes = [[v for v in run["change"] if v is not None] for run in runs]
    known = [c for c in changes if len(c) >= 2]
    humped = sum(rises_then_falls(c) for c in known)
    picture = bench.draw("fig-3-4.png", figure)
    verdict = MET if humped > 0.8 * len(known) else KIND if humped > 0.5 * len(known) else AGAINST
    return Found(f"on {humped} of {len(known)} runs", verdict, "rises at most once and ends below its top", (picture,))


def rises_then_falls(values: list[float]) -> bool:
    top = int(np.argmax(values))
    return top < len(values) - 1 and all(np.diff(values[: top + 1]) >= 0) and all(np.diff(values[top:]) <= 0)


def points_fall(bench: Bench) -> Found:
    count = 4096 if 4096 in bench.sizes.clouds else max(bench.sizes.clouds)
    runs = [r["gls"] for r in pairs(bench, count)]
    fall, cost = (sum(bool((np.diff([top, *run[what]]) < 0).all()) for run in runs)
                  for what, top in (("points", count), ("ratio", 1.0)))  # fmt: skip
    return Found(f"points fall at every step on {fall} of {len(runs)} runs, the ratio of ring sizes on {cost}",
                 MET if fall == len(runs) else KIND if fall > len(runs) / 2 else AGAINST)  # fmt: skip


def printed_stop(number: int, count: int) -> Json:
    """Contract by the printed stopping rule alone: no least number of steps."""
    _, points, _ = generated(number, count)
    return {"steps": len(contract(points, GlsParams(min_steps=1)).steps)}


def stopping(bench: Bench) -> Found:
    many = min(12, max(bench.sizes.clouds.values()))
    count = min(4096, max(bench.sizes.clouds))
    steps = [bench.raw(printed_stop, number=number, count=count)["steps"] for number in range(many)]
    early = sum(s <= 1 for s in steps)
    usual = [len(r["gls"]["points"]) for r in pairs(bench, count)]
    return Found(f"print's rule alone stops {early} of {many} clouds after one step; with the published code's least of "  # noqa: E501
                 f"three they take {min(usual)} to {max(usual)}", AGAINST if early else MET,
                 "where it stops so early, the least of three steps, which print does not name, does the work")  # fmt: skip  # noqa: E501


def how_many_right(bench: Bench) -> Found:
    count = 4096 if 4096 in bench.sizes.clouds else max(bench.sizes.clouds)
    if bench.data:
        return Found("", UNTESTED, "the true components and loops of the scans")
    results = pairs(bench, count)
    shares = {m: sum(r[m]["right"] for r in results) / len(results) for m in METHODS}
    ours = ", ".join(f"{m} {share:.0%} of {len(results)}" for m, share in shares.items())
    return Found(ours, KIND, "other clouds, and a stated rule: components and loops of the body; print does not say its "  # noqa: E501
                 "own. Gallery shapes are rounder than scans")  # fmt: skip


def points_of_published_code(bench: Bench) -> Found:
    words, same = [], 0
    for name in CLOUDS:
        if bench.cloud(name) is None:
            return missing("the folder of reference clouds")
        result = bench.raw(toolbox_gls, name=name, folder=bench.reference)
        words.append(f"{name} {result['left']} points, curve {result['nodes']}/{result['edges']}, "
                     f"{'the published one' if result['same'] else 'differs'}")  # fmt: skip
        same += result["left"] == LEFT[name] and result["same"]
    return Found("; ".join(words), MET if same == len(CLOUDS) else AGAINST, f"{same} of {len(CLOUDS)} exactly")


def toolbox_gls(name: str, folder: Path) -> Json:
    """Run GLSkeleton as published, and hold the curve against the published one."""
    return against_published(name, folder, GlsParams(variant="toolbox"), "gls")


def toolbox_lbc(name: str, folder: Path) -> Json:
    """Run lbc, and hold its raw curve against the published one."""
    return against_published(name, folder, LbcParams(), "lbc")


def against_published(name: str, folder: Path, params: Any, method: str) -> Json:
    points = load_cloud(folder / "clouds" / f"{name}.ply").points
    theirs = dict(np.load(folder / "toolbox" / f"{name}_{method}.npz"))
    c = contract(points, params)
    s = extract_skeleton(c, SkeletonParams(raw=True))
    away, match = cKDTree(normalisation(points).apply(s.nodes)).query(theirs["nodes"])
    ours = {tuple(sorted(e)) for e in s.edges.tolist()}
    same = len(s.nodes) == len(theirs["nodes"]) and ours == {tuple(sorted(match[e].tolist())) for e in theirs["edges"]}
    return {
        "left": len(c.points),
        "nodes": len(s.nodes),
        "edges": len(s.edges),
        "away": float(away.max()),
        "same": same,
    }


def curves_of_published_code(bench: Bench) -> Found:
    words, same = [], 0
    for name in CLOUDS:
        if bench.cloud(name) is None:
            return missing("the folder of reference clouds")
        result = bench.raw(toolbox_lbc, name=name, folder=bench.reference)
        words.append(f"{name} {result['nodes']}/{result['edges']}, off by {result['away']:.0e}")
        same += result["same"]
    return Found("; ".join(words), MET if same == len(CLOUDS) else AGAINST, f"{same} of {len(CLOUDS)} exactly")


def quarter(bench: Bench) -> Found:
    points = bench.cloud("hammer")
    if points is None:
        return missing("the folder of reference clouds")
    left = len(contract(points, GlsParams()).points)
    published = LEFT["hammer"]
    return Found(f"hammer: {left} of {len(points)} points left by the paper's rules, {published} by the published code",
                 AGAINST, "the published code departs from its paper: --variant toolbox is the code")  # fmt: skip


def noisy(name: str, noise: float, method: str, count: int) -> Json:
    """Contract a noisy shape; is the topology of the curve right?"""
    shape = shape_graph(name)
    clean = make_shape(shape, ShapeParams(count=count))[0]
    cloud = condition(clean, ConditioningParams(noise=noise, noise_kind="diagonal"))[0]
    s = extract_skeleton(contract(cloud, ContractionParams(method=method)))
    flat = {"nodes": s.nodes.round(4).tolist(), "edges": s.edges.tolist(), "cloud": cloud[::4].round(3).tolist()}
    return {"right": meaningful(s, shape), "distance": distance(s, shape), **flat}


def noise(bench: Bench) -> Found:
    shapes, methods, count = BALLS[: bench.sizes.noisy], ("gls", "lbc", "robust"), min(4096, max(bench.sizes.clouds))
    table = {
        m: [[bench.raw(noisy, name=n, noise=s, method=m, count=count) for n in shapes] for s in NOISES] for m in methods
    }
    right = {m: [sum(r["right"] for r in results) for results in table[m]] for m in methods}
    figure = new_figure(3.2 * len(NOISES), 2.6 * len(methods))
    grid = figure.subplots(len(methods), len(NOISES), squeeze=False)
    for row, method in zip(grid, methods, strict=True):
        for panel, share, results in zip(row, NOISES, table[method], strict=True):
            drawn_curve(panel, results[0], f"{method}, {share:.0%}")
    ours = "topology right: " + ", ".join(f"{m} {counts} of {len(shapes)}" for m, counts in right.items())
    robust = min(right["gls"]) > len(shapes) / 2
    return Found(ours, KIND if robust else AGAINST, "" if robust else "gls keeps components and loops on few shapes",
                 (bench.draw("fig-3-8.png", figure),))  # fmt: skip


def drawn_curve(panel: Any, result: Json, title: str) -> None:
    cloud, nodes = np.array(result["cloud"]), np.array(result["nodes"]).reshape(-1, 3)
    view = broad_view(cloud)
    cloud_panel(panel, cloud, view)
    for a, b in result["edges"]:
        panel.plot(*(nodes[[a, b]] @ view.T).T, color=CURVE, linewidth=1.2)
    panel.set_title(title, fontsize=8)


def beside(bench: Bench) -> Found:
    shapes, methods, count = SHOWN[: bench.sizes.noisy], ("lbc", "gls", "robust"), min(4096, max(bench.sizes.clouds))
    figure = new_figure(3.2 * len(methods), 2.8 * len(shapes))
    words = []
    for row, name in zip(figure.subplots(len(shapes), len(methods), squeeze=False), shapes, strict=True):
        for panel, method in zip(row, methods, strict=True):
            result = bench.raw(noisy, name=name, noise=0.0, method=method, count=count)
            drawn_curve(panel, result, f"{name}, {method}")
            words.append(f"{name} {method} {result['distance']:.2f}")
    return Found("distance to the true curve in radii: " + ", ".join(words), KIND, "shapes of the same kinds",
                 (bench.draw("side-by-side.png", figure),))  # fmt: skip


def grown(name: str, growth: float, method: str, count: int) -> Json:
    """Contract with another s_L."""
    shape = shape_graph(name)
    c = contract(make_shape(shape, ShapeParams(count=count))[0], ContractionParams(method=method, growth=growth))
    s = extract_skeleton(c)
    return {"steps": len(c.steps), "right": meaningful(s, shape), "distance": distance(s, shape)}


def growth(bench: Bench) -> Found:
    shapes, count = BALLS[: bench.sizes.noisy], min(2048, max(bench.sizes.clouds))
    words, figure = [], new_figure(10, 3.2)
    panels = figure.subplots(1, 3)
    for method in METHODS:
        table = [[bench.raw(grown, name=n, growth=g, method=method, count=count) for n in shapes] for g in GROWTHS]
        rows = [[statistics.mean(r[k] for r in results) for results in table] for k in ("steps", "right", "distance")]
        words += [f"{method}: " + ", ".join(f"s_L {g:g} {s:.1f} steps, {r:.0%} right, {d:.2f} radii off"
                                            for g, s, r, d in zip(GROWTHS, *rows, strict=True))]  # fmt: skip
        for panel, values, label in zip(panels, rows, ("steps", "topology right", "distance, radii"), strict=True):
            panel.plot(GROWTHS, values, "o-", color=COLOUR[method], label=method)
            panel.set_title(label, fontsize=9)
            panel.set_xlabel("s_L", fontsize=8)
    panels[0].legend(fontsize=8)
    return Found("; ".join(words), KIND, "larger s_L: fewer steps", (bench.draw("growth.png", figure),))


def square(bench: Bench) -> Found:
    """The first term of the cost scales with W_L^2, as the system it comes from: a check of units."""
    return Found("W_L multiplies L P inside the squared norm of the system, so its share of the cost has w_l squared",
                 AGAINST, "print lacks the square; w_h(0) stands in V2, as in the derivation, not w_h(k), which would "
                 "count the shrinkage twice")  # fmt: skip


ROWS = (
    Row("Algorithm: GLSkeleton", "points left and curve of the published code, on five clouds",
        "1675, 610, 1360, 2265, 686", points_of_published_code, "tiskel contract --method gls --variant toolbox"),
    Row("Algorithm: LBC, raw curve", "nodes and edges of the published code, on five clouds", "its files",
        curves_of_published_code, "tiskel skeleton --raw"),
    Row("Algorithm: local point reduction", "the paper and its published code reduce alike", "one algorithm", quarter,
        "tiskel contract --method gls"),
    Row("Eq 3.10", "cost of a merge, F = V1 - V2 + 3 U", "V1 = w_l |eta delta|^2", square),
    Row("Eq 3.15", "theta = 0.02 stops the contraction where it should", "theta = 0.02", stopping,
        "tiskel contract --method gls --theta 0.02"),
    Row("Fig 3.4", "points, cost and score over the steps: points fall", "falls", points_fall),
    Row("Fig 3.4 d", "Delta e rises, then falls", "on the examples", course),
    Row("Fig 3.5", "contraction time: similar at 1024 points, about half at 4096, the gap grows at 16384",
        "about 1, 0.5, less", contraction_time),
    Row("Fig 3.5", "spread of the contraction time at 4096 points", "1.30 s lbc, 0.32 s gls", spread_of_time),
    Row("Fig 3.5", "share of points left falls with the size", "falls", points_left),
    Row("Fig 3.6", "point reduction speeds the curve up", "faster", curve_time),
    Row("Fig 3.6", "the total gains less than contraction alone", "gains less", total_time),
    Row("Fig 3.8", "noise of 5, 10, 15 % of half the diagonal: robust", "robust, in pictures", noise,
        "tiskel contract --noise 0.1 --noise-kind diagonal"),
    Row("Text of chapter 3", "models with a meaningful skeleton", "77 of 216", how_many_right),
    Row("Text of chapter 3", "curves of the methods side by side", "pictures", beside),
    Row("Text of chapter 3", "sensitivity to s_L, user-defined", "user-defined", growth, "tiskel contract --growth 4"),
)  # fmt: skip
