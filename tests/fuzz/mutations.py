"""How files are damaged: one to four changes each, by seed."""

import re

import numpy as np

Random = np.random.Generator
HEAD = 600  #: bytes at the beginning in which every other change falls: headers are there
NUMBERS = re.compile(rb"-?\d+(?:\.\d+)?(?:[eEdD][-+]?\d+)?")
EXTREMES = (
    b"0", b"-1", b"1", b"2", b"255", b"65536", b"2147483647", b"-2147483648", b"4294967295", b"9223372036854775807",
    b"1e400", b"-1e308", b"1e160", b"nan", b"inf", b"-inf", b"1" + b"0" * 400, b"1,5", b"0x10", b"", b"1e", b"\xb2",
)  # fmt: skip
PIECES = (
    b"\0", b"\xff", b"\n", b"\r\n", b" ", b"\t", b",", b";", b'"', b"#", b"[", b"{", b"]", b"<a>", b"<!DOCTYPE a>",
    b"&lt;", b"NaN", b"null", b"true", b"[[[[", b"comment ",
    b"element vertex 1000000\n", b"property list uchar int a\n",
    b"\x1b[31m", b"\xef\xbb\xbf", b"PK\x03\x04", b"\x1f\x8b",
)  # fmt: skip


def damaged(files: list[bytes], seed: int) -> bytes:
    """Return one of the files with one to four changes, the same for the same seed."""
    rng = np.random.default_rng(seed)
    data = files[int(rng.integers(len(files)))]
    for _ in range(int(rng.integers(1, 5))):
        change = CHANGES[int(rng.integers(len(CHANGES)))]
        data = change(data, rng, files)
    return data


def _at(data: bytes, rng: Random) -> int:
    return int(rng.integers(0, max(1, min(len(data), HEAD) if rng.random() < 0.5 else len(data))))


def _flip(data: bytes, rng: Random, _: list[bytes]) -> bytes:
    at = _at(data, rng)
    return data[:at] + bytes([(data[at] if at < len(data) else 0) ^ (1 << int(rng.integers(8)))]) + data[at + 1 :]


def _number(data: bytes, rng: Random, _: list[bytes]) -> bytes:
    """Put an extreme number in the place of one in text."""
    part = data[:HEAD] if rng.random() < 0.7 else data[:20_000]
    found = list(NUMBERS.finditer(part))
    if not found:
        return data
    one = found[int(rng.integers(len(found)))]
    return data[: one.start()] + EXTREMES[int(rng.integers(len(EXTREMES)))] + data[one.end() :]


def _binary(data: bytes, rng: Random, _: list[bytes]) -> bytes:
    """Put an extreme number in the place of bytes."""
    at, size = _at(data, rng), int(rng.choice([1, 2, 4, 8]))
    values = (0, 1, 2 ** (8 * size) - 1, 2 ** (8 * size - 1), 2 ** (8 * size - 1) - 1, int(rng.integers(256)))
    return data[:at] + int(rng.choice(np.array(values, object))).to_bytes(size, "little") + data[at + size :]


def _floats(data: bytes, rng: Random, _: list[bytes]) -> bytes:
    at, kind = _at(data, rng), str(rng.choice(["<f4", "<f8"]))
    with np.errstate(over="ignore"):
        piece = np.array([float(rng.choice([np.nan, np.inf, -np.inf, 1e300, 1e30, -1.0, 0.0]))]).astype(kind).tobytes()
    return data[:at] + piece + data[at + len(piece) :]


def _cut(data: bytes, rng: Random, _: list[bytes]) -> bytes:
    return data[: _at(data, rng)]


def _without(data: bytes, rng: Random, _: list[bytes]) -> bytes:
    at = _at(data, rng)
    return data[:at] + data[at + int(rng.integers(1, 40)) :]


def _twice(data: bytes, rng: Random, _: list[bytes]) -> bytes:
    at, size = _at(data, rng), int(rng.integers(1, 200))
    return data[:at] + data[at : at + size] * int(rng.integers(2, 5)) + data[at + size :]


def _piece(data: bytes, rng: Random, _: list[bytes]) -> bytes:
    at = _at(data, rng)
    return data[:at] + PIECES[int(rng.integers(len(PIECES)))] + data[at:]


def _splice(data: bytes, rng: Random, files: list[bytes]) -> bytes:
    other = files[int(rng.integers(len(files)))]
    return data[: _at(data, rng)] + other[_at(other, rng) :]


def _lines(data: bytes, rng: Random, _: list[bytes]) -> bytes:
    """Leave a line out, have it twice, or change places."""
    rows = data.split(b"\n")
    a, b = rng.integers(len(rows), size=2).tolist()
    kind = int(rng.integers(3))
    if kind == 0:
        del rows[a]
    elif kind == 1:
        rows.insert(b, rows[a])
    else:
        rows[a], rows[b] = rows[b], rows[a]
    return b"\n".join(rows)


CHANGES = (_flip, _number, _number, _binary, _floats, _cut, _without, _twice, _piece, _splice, _lines)
