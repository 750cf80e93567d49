"""The shortest work that a batch can do; see :data:`tiskel.batch.plan.Work`."""

from pathlib import Path
from typing import Any


def count_bytes(path: Path, folder: Path, settings: Any) -> dict[str, Any]:
    """Write how long a file is; return it for the manifest and the summary.

    Examples
    --------
    >>> import tempfile
    >>> from tiskel.batch.example import count_bytes
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "a").write_text("abc")
    ...     count_bytes(Path(folder, "a"), Path(folder), None)
    {'row': {'length': 3}}
    """
    length = path.stat().st_size
    (folder / "size.txt").write_text(str(length))
    return {"row": {"length": length}}
