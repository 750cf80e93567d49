"""How much a file may ask for: what is read, and what it unpacks to, stays in proportion to what was given."""

import gzip
import io
import os
import zlib

from tiskel.errors import TiskelError

GZIP = b"\x1f\x8b"  #: first bytes of a file packed by gzip
VARIABLE = "TISKEL_MAX_INPUT"  #: environment variable: megabytes that a pipe or a device may give
MOST_MEGABYTES = 4096  #: of a pipe, unless the variable says otherwise; a file on disk says itself how long it is
FREE_BYTES, PER_BYTE = 20 << 20, 50  #: packed data may become so many bytes, and so many for each of theirs


PART_BYTES = 90  #: of a list or an element, at least, however short it is in the file
PARTS_FREE, PARTS_PER_BYTE = 200 << 20, 10  #: bytes that parts may take: so many, and so many for each of the file's


def most_bytes() -> int:
    """Return how many bytes are read from what has no end of its own.

    Raises
    ------
    TiskelError
        Where TISKEL_MAX_INPUT is no whole number of megabytes.
    """
    value = os.environ.get(VARIABLE, str(MOST_MEGABYTES))
    if not (value.isascii() and value.isdigit() and 0 < len(value) <= 9 and int(value)):
        raise TiskelError(f"{VARIABLE} must be a whole number of megabytes, got {value[:40]!r}; correct or unset it")
    return int(value) << 20


def most_unpacked(packed: int) -> int:
    """Return how many bytes so many packed ones may become; clouds become a few times as many, bombs a thousand."""
    return FREE_BYTES + PER_BYTE * packed


def check_unpacked(size: int, packed: int, name: str, how: str = "unpacks to") -> None:
    """Raise TiskelError where so many packed bytes of a file become more than they may."""
    if size > most_unpacked(packed):
        raise TiskelError(
            f"{name} {how} {size >> 20} MB from {packed >> 10} kB, more than {PER_BYTE} times as much; "
            "if it is meant to, unpack it before"
        )


def check_nested(data: bytes, openings: bytes, name: str) -> None:
    """Raise TiskelError where a document of many tiny parts would take far more memory than the file.

    Parameters
    ----------
    data : bytes
        The document.
    openings : bytes
        The characters that a part begins with.
    name : str
        The file's name, for messages.
    """
    needed = PART_BYTES * sum(data.count(openings[i : i + 1]) for i in range(len(openings)))
    if needed > PARTS_FREE + PARTS_PER_BYTE * len(data):
        raise TiskelError(
            f"{name} has parts that would take {needed >> 20} MB of memory, it has {len(data) >> 20} MB; write it "
            "with fewer and larger parts"
        )


def unpacked(data: bytes, name: str) -> tuple[bytes, str]:
    """Return what gzip packed, and the name without its suffix; anything else as it is."""
    if not data.startswith(GZIP):
        return data, name
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as packed:
            plain = packed.read(most_unpacked(len(data)) + 1)
    except (OSError, EOFError, zlib.error, MemoryError) as error:
        raise TiskelError(f"{name} is no whole gzip file: {error}; pack it again") from None
    check_unpacked(len(plain), len(data), name)
    if not plain:
        raise TiskelError(f"{name} is empty; check how it was made")
    return plain, name.removesuffix(".gz").removesuffix(".GZ")
