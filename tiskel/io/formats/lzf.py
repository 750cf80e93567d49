"""LZF, the compression inside PCD files (Lehmann's LibLZF, format of version 3)."""

LITERALS = 32  #: control bytes below it: so many bytes, and one more, follow as they are
SHORTEST = 2  #: bytes that are added to the length of a copy
LONG = 7 + SHORTEST  #: length of a copy at which one more byte of length follows


def decompress(data: bytes, size: int) -> bytes:
    """Return the bytes that were packed.

    Parameters
    ----------
    data : bytes
        The packed bytes.
    size : int
        How many they become.

    Raises
    ------
    ValueError
        Where they become more or fewer, or refer to bytes that are not there.
    """
    out = bytearray()
    at = 0
    while at < len(data) and len(out) <= size:
        control = data[at]
        at += 1
        if control < LITERALS:
            out += data[at : at + control + 1]
            at += control + 1
            continue
        length = (control >> 5) + SHORTEST
        is_long = length == LONG
        rest = data[at : at + 1 + is_long]
        if len(rest) <= is_long:
            raise ValueError("it ends within a copy")
        at += len(rest)
        length += rest[0] if is_long else 0
        back = ((control & LITERALS - 1) << 8) + rest[-1] + 1
        _copy(out, back, length)
    if len(out) != size:
        raise ValueError(f"{len(out)} bytes where {size} are promised")
    return bytes(out)


def _copy(out: bytearray, back: int, length: int) -> None:
    """Append bytes from so far back; they may reach into what is being appended, and repeat."""
    start = len(out) - back
    if start < 0:
        raise ValueError(f"a copy from {-start} bytes before the start")
    piece = out[start : start + length]
    while len(piece) < length:
        piece += piece[: length - len(piece)]
    out += piece
