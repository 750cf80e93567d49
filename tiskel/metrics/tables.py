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
    """

    path: tuple[str, str]
    heading: str
    best: str = ""  #: "high", "low" or nothing

    @property
    def key(self) -> str:
        """The name of the column in CSV."""
        return "_".join(self.path)


COLUMNS = (
    Column(("topology", "bottleneck"), "d_B", "low"),
    Column(("topology", "wasserstein"), "d_W", "low"),
    Column(("boundedness", "points"), "bounded points", "high"),
    Column(("boundedness", "curve"), "bounded curve", "high"),
    Column(("inside", "points"), "inside points", "high"),
    Column(("inside", "curve"), "inside curve", "high"),
    Column(("medialness", "curve"), "medial curve", "high"),
    Column(("air", "curve"), "curve in the air", "low"),
    Column(("centredness", "points"), "centred points", "high"),
    Column(("centredness", "curve"), "centred curve", "high"),
    Column(("smoothness", "points"), "smooth points", "high"),
    Column(("smoothness", "curve"), "smooth curve", "high"),
    Column(("loops", "surface"), "loops surface"),
    Column(("loops", "solid"), "loops solid"),
    Column(("loops", "graph"), "loops curve"),
    Column(("graph", "components"), "components"),
    Column(("graph", "ends"), "ends"),
    Column(("graph", "joints"), "joints"),
    Column(("graph", "length"), "length"),
)


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
