"""A scene as a JSON document and one run of bytes: places as 16-bit steps of a box, values as 16-bit steps of a range.

A step of places is 1/65535 of the side of their layer's box, far below a pixel;
paths keep 32-bit floats about the centre of the scene, so that they move smoothly.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Numbers, Points
from tiskel.viewer.scene import Field, Layer, Scene

STEPS = 65535  # of 16 bits; of values the last one stands for none
TYPES = {"u1": "u8", "u2": "u16", "u4": "u32", "f4": "f32"}
ALIGNMENT = 4  # bytes
SPAN = (1.0, 99.0)  # percentiles between which colours change: a few far values do not take all of them


class _Bytes:
    """A run of bytes that arrays are put into."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.at = 0

    def put(self, array: npt.NDArray[Any]) -> dict[str, Any]:
        """Append an array and return where it is."""
        data = np.ascontiguousarray(array).astype(array.dtype.newbyteorder("<"))
        placed = {"at": self.at, "count": int(data.size), "type": TYPES[data.dtype.str[1:]]}
        padded = data.tobytes() + bytes(-data.nbytes % ALIGNMENT)
        self.parts.append(padded)
        self.at += len(padded)
        return placed


def pack(scene: Scene) -> tuple[dict[str, Any], bytes]:
    """Return the document of a scene, and the bytes that its arrays are in.

    Parameters
    ----------
    scene : Scene
        What is to be shown.

    Returns
    -------
    dict
        Plain JSON values; an array is {"at": byte, "count": numbers, "type": "u8", "u16", "u32" or "f32"}.
    bytes
    """
    out, body = _Bytes(), scene.body
    low, high = body.min(axis=0), body.max(axis=0)
    centre = (low + high) / 2
    document = {
        "title": scene.title,
        "unit": scene.unit,
        "up": scene.up,
        "centre": centre.tolist(),
        "box": [(low - centre).tolist(), (high - centre).tolist()],
        "from": scene.eye.tolist(),
        "colour": scene.colour,
        "layers": [_layer(layer, centre, out) for layer in scene.layers],
    }
    return document, b"".join(out.parts)


def _layer(layer: Layer, centre: Numbers, out: _Bytes) -> dict[str, Any]:
    more = {name: _plain(value, centre, name, out) for name, value in layer.more.items()}
    head = {"name": layer.name, "kind": layer.kind, "role": layer.role, "shown": layer.shown}
    if layer.kind == "path":
        return head | more
    box, steps = _steps(layer.places - centre)
    fields = [_field(one, out) for one in layer.fields]
    return head | {"count": len(layer.places), "box": box, "xyz": out.put(steps), "fields": fields} | more


MOVED = {"contact", "centre"}  # arrays of places, about the centre of the scene


def _plain(value: Any, centre: Numbers, name: str, out: _Bytes) -> Any:
    if not isinstance(value, np.ndarray):
        return value
    moved = value - centre if name in MOVED else value
    return out.put(moved.astype(np.float32) if moved.dtype == np.float64 else moved)


def _steps(places: Points) -> tuple[list[list[float]], npt.NDArray[np.uint16]]:
    """Return the box of places and their steps in it."""
    low, high = places.min(axis=0), places.max(axis=0)
    size = np.where(high > low, high - low, 1.0)
    steps = np.rint((places - low) / size * STEPS).astype(np.uint16)
    return [low.tolist(), high.tolist()], steps


def _field(field: Field, out: _Bytes) -> dict[str, Any]:
    head: dict[str, Any] = {"name": field.name, "title": field.title or field.name, "length": field.length}
    if field.labels:
        return head | {"labels": list(field.labels), "values": out.put(field.values.astype(np.uint16))}
    if field.values.ndim == 2:
        return head | {"rgb": True, "values": out.put(field.values.astype(np.uint8))}
    low, high = value_span(field)
    known = np.isfinite(field.values)
    every = field.values[known]
    least, most = (float(every.min()), float(every.max())) if len(every) else (0.0, 1.0)
    steps = np.full(len(field.values), STEPS, np.uint16)
    steps[known] = np.rint((every - least) / ((most - least) or 1.0) * (STEPS - 1))
    return head | {"low": least, "high": most, "colours": [low, high], "values": out.put(steps)}


def value_span(field: Field) -> tuple[float, float]:
    """Return the values at which the colours of a field of numbers begin and end."""
    if field.span is not None:
        return field.span
    known = field.values[np.isfinite(field.values)]
    if len(known) == 0:
        return 0.0, 1.0
    low, high = np.percentile(known, SPAN)
    return float(low), float(high)
