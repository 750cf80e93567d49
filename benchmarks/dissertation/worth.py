"""What the measures are worth: noise, thinning, the true error, and what stability predicts."""

import numpy as np
from core import AGAINST, KIND, MET, UNTESTED, Bench, Found, interval, ranked
from judged import CONDITIONS, judged
from kept import Json
from keys import KEYS

from tiskel.gallery.catalogue import SHAPES
from tiskel.pictures.canvas import new_figure
from tiskel.pictures.style import CURVE, INK, POINTS

AGREED = {  # by condition, where both known bodies of Table 4.2, tree and cave, move the same way
    CONDITIONS[1]: {"d_B": 1, "d_W": 1, "centred points": -1, "smooth points": -1},
    CONDITIONS[2]: {"d_B": 1, "d_W": 1, "bounded points": -1, "bounded curve": -1, "smooth points": 1},
}


def all_judged(bench: Bench, condition_name: str, method: str = "lbc") -> list[Json]:
    names = list(SHAPES)[: bench.sizes.shapes]
    settings = {"condition_name": condition_name, "method": method, "count": bench.sizes.points}
    return [r for r in bench.many(judged, [{"name": name, **settings} for name in names]) if "failed" not in r]


def predicts(bench: Bench) -> Found:
    words, clear = [], []
    for method in ("lbc", "gls"):
        rows = all_judged(bench, CONDITIONS[0], method)
        rho, p = ranked([r["spread"] for r in rows], [r["error"] for r in rows])
        stable, other = [r for r in rows if r["stable"]], [r for r in rows if not r["stable"]]
        words.append(f"{method}: stable {sum(r['right'] for r in stable)} of {len(stable)} right, not stable "
                     f"{sum(r['right'] for r in other)} of {len(other)}; rank correlation {rho:.2f} "
                     f"(p {p:.2f})")  # fmt: skip
        clear.append(p < 0.05 and rho > 0)
    return Found("; ".join(words), KIND if all(clear) else AGAINST,
                 "" if all(clear) else "stability does not predict the distance to the true curve")  # fmt: skip


def changes(before: list[Json], after: list[Json]) -> dict[str, tuple[float, float, float]]:
    """Return of every measure the mean change from shape to shape, and its 95 % interval."""
    by_name = {r["name"]: r for r in after}
    found = {}
    for key in KEYS:
        pairs = [(a[key], by_name[a["name"]][key]) for a in before if a["name"] in by_name]
        change = [b - a for a, b in pairs if a is not None and b is not None]
        if change:
            found[key] = float(np.mean(change)), *interval(change)
    return found


def effects(bench: Bench) -> Found:
    before, words, figure, same, against = all_judged(bench, CONDITIONS[0]), [], new_figure(9, 4), 0, 0
    panel = figure.subplots()
    for shift, (how, colour) in enumerate(zip(CONDITIONS[1:], (CURVE, POINTS), strict=True)):
        found = changes(before, all_judged(bench, how))
        for place, (key, (mean, low, high)) in enumerate(found.items()):
            panel.errorbar(place + 0.2 * shift, mean, [[max(mean - low, 0)], [max(high - mean, 0)]], fmt="o",
                           color=colour, label=how if place == 0 else None)  # fmt: skip
            sign = AGREED[how].get(key, 0)
            same, against = same + (min(sign * low, sign * high) > 0), against + (max(sign * low, sign * high) < 0)
        words.append(f"{how}: " + ", ".join(f"{k} {m:+.3f} [{a:+.3f}, {b:+.3f}]" for k, (m, a, b) in found.items()))
    panel.axhline(0, color=INK, linewidth=0.6)
    panel.set_xticks(range(len(KEYS)), list(KEYS), rotation=30, fontsize=7)
    panel.set_ylabel("mean change, with 95 % interval", fontsize=8)
    panel.legend(fontsize=7)
    asked = sum(map(len, AGREED.values()))
    verdict = MET if same == asked else KIND if same > asked / 2 and not against else AGAINST
    why = (f"of {asked} changes that tree and cave of Table 4.2 share, {same} have the same sign here, their interval "
           f"clear of 0, and {against} the opposite; lbc, {len(before)} shapes; rule set after a look at "
           "14 shapes")  # fmt: skip
    return Found("; ".join(words), verdict, why, (bench.draw("effects.png", figure),))


def doubled(bench: Bench) -> Found:
    before, words, ratios = {r["name"]: r for r in all_judged(bench, CONDITIONS[0])}, [], []
    for how in CONDITIONS[1:]:
        after = all_judged(bench, how)
        for key in ("d_B", "d_W"):
            both = [(b[key], before[b["name"]][key]) for b in after if b["name"] in before and b[key] is not None]
            ratios.append(float(np.median([b / a for b, a in both if a])) if both else float("nan"))
            words.append(f"{key} {how}: x{ratios[-1]:.2f}")
    double = sum(1.6 < r < 2.4 for r in ratios)
    return Found("; ".join(words), MET if double == 4 else KIND if double >= 2 else AGAINST,
                 f"between x1.6 and x2.4 in {double} of 4; thinning doubles them, noise raises them less")  # fmt: skip


def worth(bench: Bench) -> Found:
    lots = [(how, "lbc") for how in CONDITIONS] + [(CONDITIONS[0], "gls")]
    rows = [r for how, method in lots for r in all_judged(bench, how, method)]
    words, bars = [], {}
    for key in (*KEYS, "inside curve", "medialness", "air"):
        known = [(r[key], r["error"]) for r in rows if r[key] is not None and np.isfinite(r["error"])]
        rho, p = ranked(*zip(*known, strict=True)) if len(known) > 2 else (float("nan"), 1.0)
        bars[key] = rho
        words.append(f"{key} {rho:+.2f}" + ("" if p < 0.01 else " (not clear)"))
    figure = new_figure(8, 3.4)
    panel = figure.subplots()
    panel.bar(list(bars), list(bars.values()), color=POINTS)
    panel.tick_params(axis="x", rotation=35, labelsize=7)
    panel.set_ylabel("rank correlation with the\ndistance to the true curve", fontsize=8)
    return Found(f"{len(rows)} curves: {', '.join(words)}", UNTESTED, "print names no truth to hold measures against; "
                 "ours are made, and theirs is known", (bench.draw("worth.png", figure),))  # fmt: skip
