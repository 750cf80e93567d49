"""What a batch leaves for other programs: a table of all clouds, and a list of those that failed."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from tiskel.batch.manifest import Manifest, Record, locked
from tiskel.batch.plan import Plan
from tiskel.batch.tasks import COMMENT, TAB, stem
from tiskel.io.streams import write_bytes
from tiskel.metrics.tables import to_csv

HEAD = ("name", "status", "kind", "message", "path", "size", "seconds", "peak_mb")


def write_summary(plan: Plan) -> None:
    """Write summary.csv and failed.txt from all that the manifest holds; one process at a time does."""
    with locked(plan.manifest):
        manifest = Manifest(plan.manifest)
        manifest.refresh()
        records = manifest.records()
        if records:
            write_bytes(plan.output / "summary.csv", to_csv(rows_of(records)))
        write_bytes(plan.output / "failed.txt", failures(records).encode())


def rows_of(records: Iterable[Record]) -> list[dict[str, Any]]:
    """Return a row for each record, all with the same keys; None where a cloud has no such value."""
    rows = [_row(record) for record in records]
    keys = dict.fromkeys(key for row in rows for key in row)
    return [{key: row.get(key) for key in keys} for row in rows]


def _row(record: Record) -> dict[str, Any]:
    warnings = record.get("warnings", {})
    return {
        **{key: record.get(key) for key in HEAD},
        "output_bytes": sum(record.get("files", {}).values()),
        "warnings": sum(warnings.values()),
        "warning_codes": " ".join(f"{code}:{count}" for code, count in warnings.items()),
        **record.get("row", {}),
        **{f"seconds_{part}": seconds for part, seconds in record.get("parts", {}).items()},
    }


def failures(records: Iterable[Record]) -> str:
    """Return a list of the clouds that failed, as ``tiskel batch @FILE`` reads it, each below its reason."""
    lines = []
    for record in records:
        if record["status"] == "failed":
            path, name = record["path"], record["name"]
            lines.append(f"{COMMENT} {record['kind']}: {record['message']}")
            lines.append(path if name == stem(Path(path).name) else f"{path}{TAB}{name}")
    return "".join(f"{line}\n" for line in lines)


def by_kind(records: Iterable[Record]) -> str:
    """Return how many failures there are of each kind, in words."""
    counts = Counter(record["kind"] for record in records)
    return ", ".join(f"{count} {kind}" for kind, count in counts.most_common())
