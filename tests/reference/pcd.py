"""PCD files of every layout, written the plain way."""

import struct

import numpy as np

POINTS = np.random.default_rng(5).random((40, 3)) * 10 + 5e6


def packed(data: bytes) -> bytes:
    """LZF of literals, and of one copy for every run of one byte that is long enough."""
    out, i = bytearray(), 0
    while i < len(data):
        run = 1
        while i + run < len(data) and run < 264 and data[i + run] == data[i]:
            run += 1
        out += bytes([0, data[i]])
        i += 1
        if run > 3:
            length = run - 3  # of the copy, less 2; from one byte back
            out += bytes([7 << 5, length - 7, 0]) if length >= 7 else bytes([length << 5, 0])
            i += run - 1
    return bytes(out)


FIELDS = [
    ("_", "u1", 3),
    ("z", "f8", 1),
    ("rgb", "u4", 1),
    ("y", "f4", 1),
    ("x", "f8", 1),
    ("hist", "i2", 4),
    ("_", "u1", 1),
]
VALUES = {"x": POINTS[:, 0], "y": POINTS[:, 1].astype("f4"), "z": POINTS[:, 2], "rgb": np.arange(40) + 2**31}


def pcd_bytes(layout: str, **changes: str) -> bytes:
    """A file of 40 points with padding, a field of four numbers, and axes in another order."""
    entries = {
        "VERSION": "0.7",
        "FIELDS": " ".join(key for key, _, _ in FIELDS),
        "SIZE": " ".join(kind[1] for _, kind, _ in FIELDS),
        "TYPE": " ".join(kind[0].upper() for _, kind, _ in FIELDS),
        "COUNT": " ".join(str(many) for _, _, many in FIELDS),
        "WIDTH": "8",
        "HEIGHT": "5",
        "VIEWPOINT": "1 2 3 1 0 0 0",
        "POINTS": "40",
        "DATA": layout,
    } | changes
    header = "# .PCD v0.7 - Point Cloud Data file format\n" + "".join(f"{k} {v}\n" for k, v in entries.items() if v)
    table = np.zeros(40, dtype=[(f"{key}{i}", f"<{kind}", (many,)) for i, (key, kind, many) in enumerate(FIELDS)])
    for i, (key, _, _) in enumerate(FIELDS):
        if key in VALUES:
            table[f"{key}{i}"][:, 0] = VALUES[key]
    if layout == "ascii":
        rows = [" ".join(repr(n) for field in row for n in np.asarray(field).tolist()) for row in table.tolist()]
        return header.encode() + "".join(row + "\n" for row in rows).encode()
    if layout == "binary":
        return header.encode() + table.tobytes()
    flat = b"".join(table[key].tobytes() for key in table.dtype.names or ())
    body = packed(flat)
    return header.encode() + struct.pack("<II", len(body), len(flat)) + body
