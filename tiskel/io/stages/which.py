"""Which stage wrote a file."""

from tiskel.io import ply

HEADER_LIMIT = 65536  # bytes; stage files name their stage in the first comment


def stage_of(data: bytes) -> str | None:
    """Return "contraction", "skeleton", "cloud", or None for a file that is not ours."""
    if not data.startswith(ply.MAGIC):
        return None
    for line in data[:HEADER_LIMIT].split(b"\n"):
        words = line.split()
        if words[:2] == [b"comment", b"tiskel"] and len(words) == 4:
            return words[3].decode("ascii", "replace")
        if words == [b"end_header"]:
            break
    return None
