"""Chapter 4: stability, the measures against their published values, and what the measures are worth."""

import base64

import numpy as np
from core import AGAINST, KIND, MET, Bench, Found, Row, missing
from defined import beta_over_a_plane, corners
from judged import demonstrated
from kept import ROOT
from measured import measured, normals_over_steps, printed_betas
from tables import PUBLISHED, SCANS, scan_row, table_row, told
from worth import doubled, effects, predicts, worth

from tiskel.pictures.canvas import new_figure
from tiskel.pictures.style import POINTS

DRAWS = 1000  # of skeletal points of the apple tree


def centred_points(bench: Bench) -> Found:
    if bench.cloud("hammer") is None or bench.cloud("horse") is None:
        return missing()
    hammer, horse = bench.many(measured, [{"path": bench.file(n), "every": 0} for n in ("hammer", "horse")])
    met = abs(hammer["raw centred"] - 0.531) < 0.002 and abs(horse["raw centred"] - 0.105) < 0.002
    return Found(f"hammer {hammer['raw centred']:.4f}, horse {horse['raw centred']:.4f}", MET if met else AGAINST,
                 "within 0.002")  # fmt: skip


def boundedness(bench: Bench) -> Found:
    path = bench.file("apple_tree")
    if not path.exists():
        return missing()
    settings = PUBLISHED["synthetic tree, 8936 points"].settings
    whole = bench.raw(measured, path=path, **settings)["bounded"]
    some = bench.raw(printed_betas, path=path, every=settings["every"])["bounded"]
    (mean, low, high), (printed, least, most) = drawn(whole, bench.sizes.beta), drawn(some, bench.sizes.beta)
    met = abs(mean - 0.83) < 0.01 and abs(printed - 0.90) < 0.01
    return Found(f"toolbox {mean:.3f} [{low:.3f}, {high:.3f}], {len(whole)} points, evenly spaced, "
                 f"{np.mean(whole):.3f}; print {printed:.3f} [{least:.3f}, {most:.3f}], the same points "
                 f"{np.mean(some):.3f}", MET if met else AGAINST,
                 f"means of {DRAWS} draws of {bench.sizes.beta} points within 0.01, with what 95 % of the draws have: "
                 "one draw says no more than that. 0.830 is print's share of all points; 0.90, of its rule, is no "
                 "published value, but an earlier count on 250 points")  # fmt: skip


def drawn(bounded: list[int], size: int) -> tuple[float, float, float]:
    """Return the mean share of many draws of so many points, and what 95 % of them lie between."""
    generator = np.random.default_rng(0)
    shares = [generator.choice(bounded, size, replace=False).mean() for _ in range(DRAWS)]
    return float(np.mean(shares)), float(np.quantile(shares, 0.025)), float(np.quantile(shares, 0.975))


def evolution(bench: Bench) -> Found:
    path = bench.file("hammer")
    if not path.exists():
        return missing()
    found = bench.raw(normals_over_steps, path=path)
    figure = new_figure(3.2 * len(found["origin"]["mean"]), 7.5)
    grid = figure.subplots(3, len(found["origin"]["mean"]), squeeze=False)
    for row, (rule, steps) in zip(grid, found.items(), strict=True):
        for number, (panel, histogram) in enumerate(zip(row, steps["histograms"], strict=True)):
            panel.bar(np.arange(40) / 40 + 1 / 80, histogram, 1 / 40, color=POINTS)
            panel.set_title(f"{rule}, step {number + 1}: mean {steps['mean'][number]:.3f}, skewness "
                            f"{steps['skewness'][number]:.2f}", fontsize=7)  # fmt: skip
    picture = bench.draw("fig-4-12.png", figure)
    ours = "; ".join(
        f"{rule}: mean {listed(s['mean'])}, skewness {listed(s['skewness'])}, peaks {s['peaks']}"
        for rule, s in found.items()
    )
    origin = found["origin"]
    met = (
        abs(origin["skewness"][0]) > 0.5 and abs(origin["mean"][-1] - 0.5) < 0.03 and abs(origin["skewness"][-1]) < 0.1
    )
    return Found(ours, MET if met else AGAINST, "with normals oriented towards the origin, as the author's routine has "
                 "them; by one rule before and after it is 1/4, by random signs 1/2 at every step", (picture,))  # fmt: skip  # noqa: E501


def listed(values: list[float]) -> str:
    return ", ".join(f"{value:.3f}" for value in values)


def shares_of_time(bench: Bench) -> Found:
    if bench.cloud("hammer") is None:
        return missing()
    seconds = bench.raw(measured, path=bench.file("hammer"), every=0)["seconds"]
    total = sum(seconds.values())
    said = ", ".join(f"{part} {value / total:.0%}" for part, value in sorted(seconds.items(), key=lambda x: -x[1]))
    return Found(f"hammer: {said}", KIND if seconds.get("topology", 0) > total / 2 else AGAINST,
                 "rule in kind: topology takes most; it needs the edges of the minimum spanning tree only, not all "
                 "pairs; boundedness is by the default rule, that of the published code takes far longer")  # fmt: skip


def demonstrations(bench: Bench) -> Found:
    found = bench.raw(demonstrated, root=ROOT / "benchmarks")
    for name, picture in found["pictures"].items():
        bench.keep(name, base64.b64decode(picture))
    cut, bent, ellipse, mean = (found[key] for key in ("cut", "bent", "ellipse", "mean"))
    return Found(f"d_B of a cut at least {cut:.3f}, of a bend at most {bent:.3f}; centre off by {ellipse:.2f} "
                 f"(ellipse), {mean:.2f} (barycentre) of the radius",
                 MET if cut > 0.02 > bent and ellipse < mean / 5 else AGAINST,
                 "rule: d_B of every cut above d* = 0.02, of every bend below; the ellipse's centre off by less than a "
                 "fifth of the barycentre's", tuple(found["pictures"]))  # fmt: skip


def over_a_plane(bench: Bench) -> Found:
    beta = bench.raw(beta_over_a_plane)["beta"]
    return Found(f"{beta:.4f}", MET if abs(beta - 0.75) < 0.001 else AGAINST, "the hull of directions to a disc 10 000 "
                 "times as wide as the place is high; within 0.001")  # fmt: skip


def smooth_corners(bench: Bench) -> Found:
    found = bench.raw(corners)
    met = abs(found["straight"] - 1) + abs(found["right angle"]) < 1e-6
    return Found(", ".join(f"{name} {value:.3f}" for name, value in found.items()), MET if met else AGAINST,
                 "a hairpin is as smooth as a straight line by the formula, which print does not say: tiskel metrics "
                 "counts them")  # fmt: skip


ROWS = (
    Row("Prop 4.2, Fig 4.12", "differences of normals are first skewed, then symmetric about one half",
        "skewed, then symmetric", evolution, "tiskel stability c.ply --normals origin --plot f.png"),
    Row("Text of chapter 4", "the pattern of stability shows whether the curve will be good", "it shows", predicts,
        "tiskel stability c.ply"),
    Row("Definition of topological similarity, centredness, smoothness", "what each measure sees, on drawn shapes",
        "a cut is seen, a bend is not; ellipses keep the centre", demonstrations),
    Row("Definition of boundedness", "beta of a point on a flat, endless surface, the threshold", "3/4", over_a_plane),
    Row("Definition of smoothness", "1 in a straight line, 0 at a right angle", "1, 0", smooth_corners),
    Row("Eq 4.14", "centredness of skeletal points, share above 0.75 before boundedness", "hammer 0.531, horse 0.105",
        centred_points, "tiskel metrics"),
    Row("Definition of boundedness", "bounded share of 250 skeletal points of the synthetic tree, 8936 points",
        "toolbox 0.830; print's rule 0.90", boundedness,
        "tiskel metrics --beta toolbox"),
    *(Row("Table 4.1" if name.startswith("hammer") else "Table 4.2", name, told(entry.published), table_row(name))
      for name, entry in PUBLISHED.items()),
    *(Row("Tables 4.1 and 4.2", f"{name}, 4096 points", told(values), scan_row(name)) for name, values in SCANS.items()),  # noqa: E501
    Row("Text of chapter 4", "sparse or noisy clouds: d_B and d_W about double", "x2", doubled),
    Row("Text of chapter 4", "effect of noise and thinning on every measure", "in the tables", effects),
    Row("Text of chapter 4", "which measures follow the true error", "not asked", worth),
    Row("Text of chapter 4", "time at 4096 points, and its shares", "34 s; 76 % topology, 23 % boundedness", shares_of_time),  # noqa: E501
)  # fmt: skip
