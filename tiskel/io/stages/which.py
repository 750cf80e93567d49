"""Which stage wrote a file."""

from tiskel.io import ply

HEADER_LIMIT = 65536  # bytes; stage files name their stage in the first comment


def stage_of(data: bytes) -> str | None:
    """Return the stage that the bytes of a PLY file name, such as "contraction" or "skeleton"; None for other files."""
    if not data.startswith(ply.MAGIC):
        return None
    for line in data[:HEADER_LIMIT].split(b"\n"):
        words = line.split()
        if words[:2] == [b"comment", b"tiskel"] and len(words) == 4:
            return words[3].decode("ascii", "replace")
        if words == [b"end_header"]:
            break
    return None
