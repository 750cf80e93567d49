"""Options for the settings of the methods: what is not given stays what the method has it."""

from typing import Annotated, Any

import typer

from tiskel.cli.surface_options import three
from tiskel.cli.words import completes
from tiskel.params import (
    GlsParams,
    LbcParams,
    MaxPoints,
    Normalisation,
    RegimeChoice,
    RobustParams,
    Solver,
    Topology,
    Variant,
)

ROBUST, GLS, LBC = RobustParams(), GlsParams(), LbcParams()
PUBLISHED = "gls and lbc"


def _setting(kind: Any, metavar: str | None, meaning: str, method: str, default: object, words: Any = None) -> Any:
    """Return an option without a value of its own that names its method and the default there."""
    told = "" if default is None else f" [default: {default}]"
    whose = "" if method == "all" else f" ({method})"
    option = typer.Option(
        metavar=metavar, help=f"{meaning}{whose}.{told}", show_default=False, rich_help_panel="Method",
        autocompletion=words,
    )  # fmt: skip
    return Annotated[kind | None, option]


Option = tuple[Any, Any]
CONTRACTING: dict[str, Option] = {
    "neighbours": (
        _setting(
            int, "K", "Nearest neighbours that a point is seen with, itself included", "all",
            f"{ROBUST.neighbours} for robust, else 0.012 n within 8 and 30",
        ), None,
    ),
    "max_steps": (
        _setting(
            int, "N", "Step limit; of robust, the number of fronts", "all",
            f"{ROBUST.max_steps} for robust, {GLS.max_steps} for gls, {LBC.max_steps} for lbc",
        ), None,
    ),
    "normalise": (
        _setting(
            Normalisation, None, "What is scaled to 1.6 inside, the longest side or the diagonal", "all",
            ROBUST.normalise,
        ), None,
    ),
    "resolution": (
        _setting(
            float, "W", "How coarse the curve sees: the least width of a section, in point spacings. Larger is "
            "smoother and misses small parts", "robust", ROBUST.resolution,
        ), None,
    ),
    "max_points": (
        _setting(
            str, "N|auto|all", "Points that fronts run over at most, the others go with the nearest: so many, as many "
            "as the surface of a large cloud needs, or all", "robust", ROBUST.max_points, completes("auto", "all"),
        ), None,
    ),
    "least_part": (
        _setting(
            float, "SHARE", "Separate pieces with less than this share of the points, such as loose leaves or dust, "
            "get no curve", "robust", ROBUST.least_part,
        ), None,
    ),
    "variant": (
        _setting(
            Variant, None, "Whose algorithm: the paper's, or that of its toolbox with all its departures", "gls",
            GLS.variant,
        ), None,
    ),
    "growth": (
        _setting(float, "S_L", "Factor by which the contraction weight grows a step", PUBLISHED, GLS.growth), None,
    ),
    "contraction_weight": (
        _setting(
            float, "W_L", "Contraction weight of the first step", PUBLISHED, "1 / (5 mean ring lengths)",
        ), None,
    ),
    "attraction_weight": (
        _setting(float, "W_H", "Attraction weight of the first step", PUBLISHED, GLS.attraction_weight), None,
    ),
    "epsilon": (
        _setting(float, "E", "Factor of the mean shrinkage of the rings where points are chosen to merge", "gls",
                 GLS.epsilon), None,
    ),
    "phi": (_setting(float, "PHI", "A point merges where F < PHI s^2", "gls", f"{GLS.phi:g}"), None),
    "theta": (
        _setting(float, "T", "Least change of the explained score; a step that changes it by less ends the run", "gls",
                 GLS.theta), None,
    ),
    "solver": (_setting(Solver, None, "Sparse solver, else the variable TISKEL_SOLVER", PUBLISHED, GLS.solver), None),
}  # fmt: skip
CURVING: dict[str, Option] = {
    "raw": (_setting(bool, None, "The curve exactly as published: spurs stay", PUBLISHED, None), None),
    "radius": (
        _setting(float, "SHARE", "Radius of the sampling balls, as a share of the diagonal", PUBLISHED, GLS.radius),
        None,
    ),
    "extra_fronts": (
        _setting(
            int, "N", "How many more tries from other ends where the curve looks wrong; 0 is fastest", "robust",
            ROBUST.extra_fronts,
        ), None,
    ),
    "least_branch": (
        _setting(
            float, "R", "A branch that sticks out of the rest by less than so many of its radii goes: raise it for "
            "fewer twigs, lower it for more", "robust", ROBUST.least_branch,
        ), None,
    ),
    "merge_junctions": (
        _setting(
            float, "R", "Forks closer than so many radii become one", "robust", ROBUST.merge_junctions,
        ), None,
    ),
    "grow_ends": (
        _setting(
            int, "N", "Steps by which an end may grow into its tip; 0 leaves ends where they are", "robust",
            ROBUST.grow_ends,
        ), None,
    ),
    "bridge_gaps": (
        _setting(
            float, "R", "Widest gap in the scan that is bridged, in thicknesses of what it interrupts; 0 bridges none",
            "robust", ROBUST.bridge_gaps,
        ), None,
    ),
    "straightness": (
        _setting(
            float, "W", "How strongly the curve is held straight: more for noisy scans, less for crooked ones",
            "robust", ROBUST.straightness,
        ), None,
    ),
    "regime": (
        _setting(
            RegimeChoice, None, "What the limbs are: tubes, or wires thinner than their points are apart", "robust",
            ROBUST.regime,
        ), None,
    ),
    "seen_from": (
        _setting(
            str, "X,Y,Z", "Where the sensor stood, of a scan from one side", "robust", None,
        ), None,
    ),
    "topology": (
        _setting(
            Topology, None, "Whether limbs close loops: never, wherever they meet, or only where the body is no "
            "tree", "robust", ROBUST.topology,
        ), None,
    ),
    "root": (
        _setting(str, "X,Y,Z", "Where limbs of wires grow from, else where most points are", "robust", None), None,
    ),
    "rounds": (_setting(int, "N", "Rounds of the fit of round cones to the points", "robust", ROBUST.rounds), None),
}  # fmt: skip


def so_many(name: str, value: str) -> MaxPoints:
    """Return a number of points, or one of the words for it; raise where it is neither."""
    words: dict[str, MaxPoints] = {"auto": "auto", "all": "all"}
    if value in words:
        return words[value]
    if not (value.isascii() and value.isdigit()):
        raise typer.BadParameter(f"{name} must be auto, all or a whole number, got {value!r}")
    return int(value)


#: How values are read that are neither one number nor one word.
READ = {"root": three, "seen_from": three, "max_points": so_many}
