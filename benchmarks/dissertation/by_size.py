"""Figures 3.4 to 3.6: time, points left, and their course, of both methods on many clouds of three sizes."""

import statistics

import numpy as np
from core import AGAINST, KIND, MET, UNTESTED, Bench, Found, near
from kept import Json
from pairs import METHODS, pair

from tiskel.pictures.canvas import new_figure
from tiskel.pictures.style import INK


def pairs(bench: Bench, count: int) -> list[Json]:
    """Return the results of all clouds of a size on which both methods make a step."""
    return [result for result in tried(bench, count) if "error" not in result]


def tried(bench: Bench, count: int) -> list[Json]:
    many = bench.sizes.clouds[count]
    if bench.data:
        return bench.many(pair, [{"number": 0, "count": count, "path": path} for _, path in [*bench.scans()][:many]])
    return bench.many(pair, [{"number": number, "count": count} for number in range(many)])


def middle(bench: Bench) -> int:
    """Return the size at which print gives spread, course and meaningful skeletons, 4096; else the largest."""
    return 4096 if 4096 in bench.sizes.clouds else max(bench.sizes.clouds)


def medians(bench: Bench, what: str) -> dict[int, tuple[float, float, float]]:
    """Return by size the medians of lbc and of gls, and the median of their ratios."""
    table = {}
    for count in bench.sizes.clouds:
        both = [(r["lbc"][what], r["gls"][what]) for r in pairs(bench, count)]
        middle = [statistics.median(column) for column in zip(*both, strict=True)]
        table[count] = middle[0], middle[1], statistics.median(gls / lbc for lbc, gls in both if lbc > 0)
    return table


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
    without = {n: len(tried(bench, n)) - len(pairs(bench, n)) for n in bench.sizes.clouds}
    why = f"rule: the ratio falls with the size and is between 0.35 and 0.65 at 4096 points, {half:.2f} here"
    if any(without.values()):
        why += "; left out, since a method makes no step: " + ", ".join(f"{c} at {n}" for n, c in without.items() if c)
    picture = over_sizes(bench, "contraction", "contraction, s of the processor", "fig-3-5-time.png")
    return Found(said(table), verdict, why, (picture,))


def spread_of_time(bench: Bench) -> Found:
    count = middle(bench)
    times = {m: [r[m]["contraction"] for r in pairs(bench, count)] for m in METHODS}
    lbc, gls = (statistics.stdev(times[m]) for m in METHODS)
    share, published = gls / lbc, 0.32 / 1.30
    return Found(f"{count} points: lbc {lbc:.2f}, gls {gls:.2f} s", MET if near(share, published) else KIND if gls < lbc
                 else AGAINST, f"rule, since seconds are of the machine: gls spreads {share:.2f} as widely as lbc, "
                 f"published {published:.2f}, within 10 %; in kind: less widely")  # fmt: skip


def points_left(bench: Bench) -> Found:
    shares = {n: statistics.median(r["gls"]["left"] for r in pairs(bench, n)) for n in bench.sizes.clouds}
    values = list(shares.values())
    falls = all(b < a for a, b in zip(values, values[1:], strict=False))
    verdict = MET if falls else KIND if values[-1] < values[0] else AGAINST
    picture = over_sizes(bench, "left", "share of points left", "fig-3-5-left.png")
    ours = ", ".join(f"{count}: {share:.1%}" for count, share in shares.items())
    return Found(
        ours, verdict, "rule: the median falls at every size; in kind: from the least to the largest", (picture,)
    )


def curve_time(bench: Bench) -> Found:
    table = medians(bench, "curve")
    faster = all(r < 1 for *_, r in table.values())
    picture = over_sizes(bench, "curve", "curve, s", "fig-3-6-curve.png")
    return Found(said(table), MET if faster else AGAINST, "rule: faster at every size", (picture,))  # fmt: skip


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
    count = middle(bench)
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
    return Found(f"on {humped} of {len(known)} runs", verdict,
                 "rule: rises at most once and ends below its top, on more than 80 % of the runs; in kind: on most",
                 (picture,))  # fmt: skip


def rises_then_falls(values: list[float]) -> bool:
    top = int(np.argmax(values))
    return top < len(values) - 1 and all(np.diff(values[: top + 1]) >= 0) and all(np.diff(values[top:]) <= 0)


def points_fall(bench: Bench) -> Found:
    count = middle(bench)
    runs = [r["gls"] for r in pairs(bench, count)]
    fall, cost = (sum(bool((np.diff([top, *run[what]]) < 0).all()) for run in runs)
                  for what, top in (("points", count), ("ratio", 1.0)))  # fmt: skip
    return Found(f"points fall at every step on {fall} of {len(runs)} runs, the ratio of ring sizes on {cost}",
                 MET if fall == len(runs) else KIND if fall > len(runs) / 2 else AGAINST)  # fmt: skip


def how_many_right(bench: Bench) -> Found:
    count = middle(bench)
    if bench.data:
        return Found("", UNTESTED, "the true components and loops of the scans")
    results = pairs(bench, count)
    shares = {m: sum(r[m]["right"] for r in results) / len(results) for m in METHODS}
    ours = ", ".join(f"{m} {share:.0%} of {len(results)}" for m, share in shares.items())
    return Found(ours, UNTESTED, "print's 216 scans, and its rule of what is meaningful; ours: components and loops "
                 "are those of the body, and gallery shapes are rounder than scans")  # fmt: skip
