"""Figure 3.8 and the curves of the text: noise, methods side by side, and s_L, on gallery shapes."""

from typing import Any

import numpy as np
from core import AGAINST, KIND, UNTESTED, Bench, Found, broad_view, cloud_panel
from kept import Json
from pairs import METHODS
from trials import grown, noisy

from tiskel.pictures.canvas import new_figure
from tiskel.pictures.style import CURVE, INK, POINTS

COLOUR = {"lbc": POINTS, "gls": CURVE, "robust": INK}
SHOWN = ("hammer", "hand", "quadruped", "torus")  # side by side
NOISES = (0.05, 0.10, 0.15)  # of half the diagonal
GROWTHS = (2.0, 3.0, 4.0, 5.0)  # s_L
BALLS = ("capsule", "banana", "hammer", "torus", "y", "hand", "quadruped", "starfish")  # of noise and settings


def noise(bench: Bench) -> Found:
    shapes, methods, count = BALLS[: bench.sizes.noisy], ("gls", "lbc", "robust"), min(4096, max(bench.sizes.clouds))
    asked = [(m, s, n) for m in methods for s in NOISES for n in shapes]
    found = bench.many(noisy, [{"name": n, "noise": s, "method": m, "count": count} for m, s, n in asked])
    table = dict(zip(asked, found, strict=True))
    right = {m: [sum(table[m, s, n]["right"] for n in shapes) for s in NOISES] for m in methods}
    figure = new_figure(3.2 * len(NOISES), 2.6 * len(methods))
    grid = figure.subplots(len(methods), len(NOISES), squeeze=False)
    for row, method in zip(grid, methods, strict=True):
        for panel, share in zip(row, NOISES, strict=True):
            drawn_curve(panel, table[method, share, shapes[0]], f"{method}, noise of {share:.0%}")
    ours = "topology right: " + ", ".join(f"{m} {counts} of {len(shapes)}" for m, counts in right.items())
    robust = min(right["gls"]) > len(shapes) / 2
    return Found(ours, KIND if robust else AGAINST, "rule: gls keeps components and loops on more than half of the "
                 "shapes at every noise", (bench.draw("fig-3-8.png", figure),))  # fmt: skip


def drawn_curve(panel: Any, result: Json, title: str) -> None:
    cloud, nodes = np.array(result["cloud"]), np.array(result["nodes"]).reshape(-1, 3)
    view = broad_view(cloud)
    cloud_panel(panel, cloud, view)
    for a, b in result["edges"]:
        panel.plot(*(nodes[[a, b]] @ view.T).T, color=CURVE, linewidth=1.2)
    panel.set_title(title, fontsize=8)


def beside(bench: Bench) -> Found:
    shapes, methods, count = SHOWN[: bench.sizes.noisy], ("lbc", "gls", "robust"), min(4096, max(bench.sizes.clouds))
    asked = [(n, m) for n in shapes for m in methods]
    found = bench.many(noisy, [{"name": n, "noise": 0.0, "method": m, "count": count} for n, m in asked])
    figure = new_figure(3.2 * len(methods), 2.8 * len(shapes))
    panels = figure.subplots(len(shapes), len(methods), squeeze=False).ravel()
    for panel, (name, method), result in zip(panels, asked, found, strict=True):
        drawn_curve(panel, result, f"{name}, {method}")
    words = (f"{n} {m} {r['distance']:.2f}{'' if r['right'] else ' (topology wrong)'}"
             for (n, m), r in zip(asked, found, strict=True))  # fmt: skip
    return Found("distance to the true curve in radii: " + ", ".join(words), UNTESTED,
                 "print shows pictures only, of its own scans", (bench.draw("side-by-side.png", figure),))  # fmt: skip


def growth(bench: Bench) -> Found:
    shapes, count = BALLS[: bench.sizes.noisy], min(2048, max(bench.sizes.clouds))
    asked = [(m, g, n) for m in METHODS for g in GROWTHS for n in shapes]
    found = bench.many(grown, [{"name": n, "growth": g, "method": m, "count": count} for m, g, n in asked])
    table, words, figure = dict(zip(asked, found, strict=True)), [], new_figure(10, 3.2)
    panels = figure.subplots(1, 3)
    for method in METHODS:
        rows = [[float(np.nanmean([table[method, g, n][k] for n in shapes])) for g in GROWTHS]
                for k in ("steps", "right", "distance")]  # fmt: skip
        words += [f"{method}: " + ", ".join(f"s_L {g:g} {s:.1f} steps, {r:.0%} right, {d:.2f} radii off"
                                            for g, s, r, d in zip(GROWTHS, *rows, strict=True))]  # fmt: skip
        for panel, values, label in zip(panels, rows, ("steps", "topology right", "distance, radii"), strict=True):
            panel.plot(GROWTHS, values, "o-", color=COLOUR[method], label=method)
            panel.set_title(label, fontsize=9)
            panel.set_xlabel("s_L", fontsize=8)
    panels[0].legend(fontsize=8)
    return Found("; ".join(words), UNTESTED, "print leaves s_L to the user, and says of no value what it does",
                 (bench.draw("growth.png", figure),))  # fmt: skip
