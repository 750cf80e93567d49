"""Measures of several skeletons side by side."""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from tiskel.metrics.result import Document

Value = float | int | bool | str | None


@dataclass(frozen=True)
class Column:
    """One measure in a table of skeletons.

    Attributes
    ----------
    path : (str, str)
        The section and the key of its value in the document.
    heading : str
        The heading of its column.
    best : str
        Which value is best: "high", "low", or nothing where none is.
    good : str
        What a good value is, in words.
    """

    path: tuple[str, str]
    heading: str
    best: str = ""  #: "high", "low" or nothing
    good: str = ""

    @property
    def key(self) -> str:
        """The name of the column in CSV."""
        return "_".join(self.path)


SHARE = "near 1"  #: of a share of points or of places on the curve that are as they should be
COLUMNS = (
    Column(("topology", "bottleneck"), "d_B", "low", "near 0"),
    Column(("topology", "wasserstein"), "d_W", "low", "near 0"),
    Column(("boundedness", "points"), "bounded points", "high", SHARE),
    Column(("boundedness", "curve"), "bounded curve", "high", SHARE),
    Column(("inside", "points"), "inside points", "high", SHARE),
    Column(("inside", "curve"), "inside curve", "high", SHARE),
    Column(("medialness", "curve"), "medial curve", "high", SHARE),
    Column(("air", "curve"), "curve in the air", "low", "0"),
    Column(("centredness", "points"), "centred points", "high", SHARE),
    Column(("centredness", "curve"), "centred curve", "high", SHARE),
    Column(("smoothness", "points"), "smooth points", "high", SHARE),
    Column(("smoothness", "curve"), "smooth curve", "high", SHARE),
    Column(("loops", "surface"), "loops surface", good="2 x solid"),
    Column(("loops", "solid"), "loops solid"),
    Column(("loops", "graph"), "loops curve", good="as solid"),
    Column(("graph", "components"), "components", good="as the body"),
    Column(("graph", "ends"), "ends", good="as the body"),
    Column(("graph", "joints"), "joints", good="as the body"),
    Column(("graph", "length"), "length"),
)
SIGNS = (
    "* best of its row. d_B, d_W: how far the barcodes of cloud and skeletal points are apart, in sizes scaled to 1.6. "
    "Points are those of the contraction, curve is the graph; their values are means or shares, from 0 to 1."
)  #: what the signs of a table mean


def row_of(document: Document) -> dict[str, Value]:
    """Return the overall values of one skeleton by column key, from its document."""
    return {column.key: document[column.path[0]][column.path[1]] for column in COLUMNS}


def best_rows(rows: Sequence[dict[str, Value]]) -> set[tuple[int, str]]:
    """Return (row, key) of the best values; all of them where several tie, none in a single row."""
    found: set[tuple[int, str]] = set()
    for column in COLUMNS if len(rows) > 1 else ():
        known = [(float(value), i) for i, row in enumerate(rows) if (value := row[column.key]) is not None]
        if column.best and known:
            top = (max if column.best == "high" else min)(known)[0]
            found |= {(i, column.key) for value, i in known if value == top}
    return found


def said(value: Value) -> str:
    """Return a value as a table shows it: four digits of a number, nothing for None."""
    if value is None:
        return ""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def to_csv(rows: Sequence[dict[str, Any]]) -> bytes:
    """Return rows of equal keys as CSV with a header, in UTF-8; a missing value is empty."""
    out = io.StringIO()
    writer = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: "" if value is None else value for key, value in row.items()} for row in rows)
    return out.getvalue().encode()
