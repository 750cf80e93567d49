"""The page of benchmarks/field.py: a table for families and views, one for trees, one for warnings, and real clouds."""

import platform
from collections.abc import Callable, Iterable
from importlib import metadata
from typing import Any

import numpy as np
from field_methods import PATH, missing
from field_scores import IN_AIR, OUTSIDE, TREE_F, UNREACHED, by_code, classified
from field_subjects import AGAIN, FAMILIES, FILES, REAL, TREES, VIEWS, commit

Row = dict[str, Any]
Column = tuple[str, Callable[[list[Row]], str]]  # a heading, and the cell of some rows


def mean(key: str, digits: int = 3) -> Callable[[list[Row]], str]:
    def cell(rows: list[Row]) -> str:
        values = [row[key] for row in rows if row.get(key) is not None]
        return f"{np.mean(values):.{digits}f}" if values else ""

    return cell


def share_right(*keys: str) -> Callable[[list[Row]], str]:
    def cell(rows: list[Row]) -> str:
        asked = [row for row in rows if "wrong" in row and not any(row.get(key, 0) is None for key in keys)]
        return f"{sum(all(row.get(key, 0) == 1 for key in keys) for row in asked)} of {len(asked)}" if asked else ""

    return cell


def failed(rows: list[Row]) -> str:
    crashed, refused = (sum(key in row for row in rows) for key in ("crashed", "refused"))
    return f"{crashed} + {refused}" if crashed + refused else "0"


def seconds(rows: list[Row]) -> str:
    values = [row["seconds"] for row in rows if "seconds" in row]
    return f"{np.median(values):.2f}" if values else ""


SHAPES: tuple[Column, ...] = (
    ("clouds", lambda rows: str(len(rows))), ("crashes + refusals", failed),
    ("components and loops right", share_right("components_right", "loops_right")),
    ("ends right", share_right("ends_right")), ("inside", mean("inside")), ("medialness", mean("medialness")),
    ("in the air", mean("air")), ("to truth", mean("to_truth")), ("from truth", mean("from_truth")),
    ("seconds", seconds),
)  # fmt: skip
SEEN: tuple[Column, ...] = (
    *SHAPES[:2], ("in one piece", share_right("components_right")), ("in the air", mean("air")),
    ("reached", mean("reached")), ("reached or said", mean("reached_or_said")), ("seconds", seconds),
)  # fmt: skip
GROWN: tuple[Column, ...] = (
    *SHAPES[:2], ("one component", share_right("components_right")), ("no loop", share_right("loops_right")),
    ("precision", mean("tree_precision")), ("recall", mean("tree_recall")), ("F", mean("tree_f")),
    ("area", mean("tree_area")), ("tips recall", mean("tree_tips_recall")),
    ("tips precision", mean("tree_tips_precision")), ("joints recall", mean("tree_joints_recall")),
    ("joints precision", mean("tree_joints_precision")), ("length", mean("tree_length_ratio")),
    ("radius error, measured", mean("radius_error_measured")), ("bounded", mean("radius_error_bounded")),
    ("in the air", mean("air")), ("seconds", seconds),
)  # fmt: skip
TWICE: tuple[Column, ...] = (
    *SHAPES[:2], ("same graph", share_right("same_graph")), ("same tips", mean("same_tips")),
    ("95 % within, radii", mean("same_radii_95")),
)  # fmt: skip
REAL_KEYS = (
    "points", "components", "loops", "ends", "air", "tree_f", "tree_tips_recall", "tree_tips_precision", "seconds",
)  # fmt: skip


def table(head: Iterable[str], lines: Iterable[Iterable[str]]) -> str:
    names = list(head)
    rows = [f"| {' | '.join(cells)} |" for cells in lines]
    return "\n".join([f"| {' | '.join(names)} |", "|" + "---|" * len(names), *rows]) + "\n"


def by_setting(rows: list[Row], settings: Iterable[str], columns: tuple[Column, ...]) -> str:
    """Return a table with a line for each setting, group and method."""
    lines = []
    for setting in settings:
        for group in sorted({row["group"] for row in rows if row["setting"] == setting}):
            for method in methods_of(rows):
                chosen = [r for r in rows if (r["setting"], r["group"], r["method"]) == (setting, group, method)]
                chosen = [row for row in chosen if "skipped" not in row]
                if chosen:
                    name = f"{setting}, {group}" if group else setting
                    lines.append([name, method, *(cell(chosen) for _, cell in columns)])
    return table(["setting", "method", *(name for name, _ in columns)], lines) if lines else "not scored\n"


def methods_of(rows: list[Row]) -> list[str]:
    return list(dict.fromkeys(row["method"] for row in rows if row["method"]))


def below_path(rows: list[Row]) -> str:
    """Return by how much each method's mean F is above that of the plain baseline, at worst over the classes."""
    lines = []
    for method in methods_of(rows):
        gaps = []
        for setting, group in sorted({(r["setting"], r["group"]) for r in rows if r["setting"] in TREES}):
            of = [_f(rows, setting, group, name) for name in (method, PATH)]
            if None not in of:
                gaps.append((of[0] - of[1], f"{setting}, {group}"))  # type: ignore[operator]
        if gaps and method != PATH:
            lines.append(f"- {method}: {min(gaps)[0]:+.3f} ({min(gaps)[1]})")
    return "\n".join(lines) + "\n" if lines else "not scored\n"


def _f(rows: list[Row], setting: str, group: str, method: str) -> float | None:
    chosen = [r for r in rows if (r["setting"], r["group"], r["method"]) == (setting, group, method)]
    values = [row.get("tree_f") or 0.0 for row in chosen if "skipped" not in row]
    return float(np.mean(values)) if values else None


def warned(rows: list[Row]) -> str:
    """Return how well warnings tell wrong curves from right ones, by method."""
    lines = []
    for method in methods_of(rows):
        c = classified(rows, method)
        cells = [(c[f"{word}, warned"], c[word]) for word in ("wrong", "right")]
        lines.append(
            [method, *(f"{part} of {whole}" + (f" ({part / whole:.0%})" if whole else "") for part, whole in cells)]
        )
    return table(["method", "wrong curves with a warning", "right curves with one"], lines)


def codes(rows: list[Row]) -> str:
    """Return for each method and code how many wrong and right curves carry it."""
    found = {method: by_code(rows, method) for method in methods_of(rows)}
    lines = [[m, code, str(c["wrong"]), str(c["right"])] for m, of in found.items() for code, c in sorted(of.items())]
    return table(["method", "warning", "wrong curves", "right curves"], lines) if lines else "none\n"


def faults(rows: list[Row]) -> str:
    """Return what is wrong, setting by setting and method by method."""
    lines = []
    for setting in dict.fromkeys(row["setting"] for row in rows):
        for method in methods_of(rows):
            scored = [r for r in rows if (r["setting"], r["method"]) == (setting, method)]
            if not scored:
                continue
            bad = [r for r in scored if r.get("wrong")]
            said = [
                f"{r['shape']} ({r.get('crashed') or r['wrong']}{'' if r.get('warnings') else '; no warning'})"
                for r in bad
            ]
            lines.append(f"- {setting}, {method}: {', '.join(said) or 'none'}")
    return "\n".join(lines) + "\n"


def of_clouds(rows: list[Row], setting: str) -> str:
    lines = []
    for row in rows:
        if row["setting"] == setting and not missing(row["method"]):
            values = [row.get(key) for key in REAL_KEYS]
            cells = ["" if v is None else f"{v:.3f}" if isinstance(v, float) else str(v) for v in values]
            why = row.get("crashed") or row.get("refused") or row.get("skipped") or row.get("codes", "")
            lines.append([row["shape"], row["method"], *cells, row.get("wrong", ""), why])
    return table(["cloud", "method", *REAL_KEYS, "wrong", "warnings"], lines) if lines else "not scored\n"


def page(rows: list[Row]) -> str:
    """Return the whole page."""
    packages = ", ".join(f"{package} {metadata.version(package)}" for package in ("tiskel", "numpy", "scipy", "taichi"))
    absent = "; ".join(f"{method}: {why}" for method in methods_of(rows) if (why := missing(method)))
    return (
        "# In the field\n\n"
        f"Made by `python benchmarks/field.py` with Python {platform.python_version()}, {packages}, on commit "
        f"`{commit()}`, whose digits seed the trees. {f'Not scored: {absent}. ' if absent else ''}"
        "Families are the bodies of `tiskel shape` that are no unions of round cones; inside and medialness are by "
        "their exact surfaces, distances means in local radii, or spacings where these are larger, in the air the mean "
        "share of the length. Seconds are medians, one thread, two processes side by side.\n\n"
        f"## Families\n\n{by_setting(rows, FAMILIES, SHAPES)}\n"
        f"## Sampled twice\n\n{by_setting(rows, [AGAIN], TWICE)}\n"
        "## From one side\n\nReached is the share of the curve within half a local radius of the middle of what was "
        "seen, or of the true curve; said is what the method calls a sheet.\n\n"
        f"{by_setting(rows, VIEWS, SEEN)}\n"
        f"## Generated trees\n\n{by_setting(rows, TREES, GROWN)}\n"
        f"Mean F above that of the shortest-path tree, in the class where that is least:\n\n{below_path(rows)}\n"
        "## Warnings\n\nA curve is wrong whose components, loops or ends are; that is in the air for more than "
        f"{IN_AIR:.0%}, outside for more than {OUTSIDE:.0%}, from one side beyond reach for more than "
        f"{UNREACHED:.0%} without saying so; and a tree of F below {TREE_F}. Ends of views and trees are not asked "
        f"for.\n\n{warned(rows)}\n{codes(rows)}\n"
        f"## Reference clouds\n\n{of_clouds(rows, REAL)}\n## Cases\n\n{of_clouds(rows, FILES)}\n"
        f"## What is wrong\n\n{faults(rows)}"
    )
