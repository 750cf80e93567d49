"""What a viewer shows: layers of places, and fields of values that they can be coloured by."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Points
from tiskel.geometry.strays import body_of
from tiskel.geometry.views import eye_direction, up_axis
from tiskel.params import LookParams

Kind = Literal["points", "curve", "tube", "mesh", "lines", "marks", "path"]
Role = Literal["cloud", "points", "curve", "tube", "surface", "slices", "warning", "note", "path"]


@dataclass(frozen=True, eq=False)
class Field:
    """A value for every place of a layer.

    Attributes
    ----------
    name : str
        Fields of several layers with one name are one choice.
    values : (n,) float64, (n,) int or (n, 3) uint8
        Numbers, NaN for none; or places in ``labels``; or red, green and blue.
    title : str
        What a reader is told; the name where empty.
    labels : tuple of str
        Names of values that are no numbers; an empty one stands for "none".
    length : bool
        Whether the numbers are lengths in the cloud's unit.
    span : (float, float) or None
        Where the colours begin and end; without it at the 1st and 99th percentile.
    """

    name: str
    values: npt.NDArray[Any]
    title: str = ""
    labels: tuple[str, ...] = ()
    length: bool = False
    span: tuple[float, float] | None = None

    def at(self, rows: npt.NDArray[Any]) -> "Field":
        """Return the same for some of the places."""
        return replace(self, values=self.values[rows])


@dataclass(frozen=True, eq=False)
class Layer:
    """Things of one kind that are shown and hidden together.

    Attributes
    ----------
    name : str
        What a reader is told.
    kind : str
        How it is drawn: points, curve, tube, mesh, lines, marks or path.
    role : str
        What it is, which sets its colour.
    places : (n, 3) float64
        In the cloud's unit.
    fields : tuple of Field
        What it can be coloured by, and what is said about a place.
    shown : bool
        Whether it is visible at first.
    more : dict
        What its kind needs besides: arrays and plain values.
    """

    name: str
    kind: Kind
    role: Role
    places: Points
    fields: tuple[Field, ...] = ()
    shown: bool = True
    more: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Remark:
    """A warning or a note, and where it is.

    Attributes
    ----------
    text : str
        For a reader.
    severity : "warning" or "note"
    places : (k, 3) float64
        Empty where it is about the whole.
    """

    text: str
    severity: str
    places: Points


@dataclass(frozen=True, eq=False)
class Scene:
    """What is shown together.

    Attributes
    ----------
    title : str
        Its name.
    layers : tuple of Layer
    remarks : tuple of Remark
        Warnings and notes of the results.
    said : tuple of str
        What the viewer left out.
    up : str
        "x", "y" or "z".
    unit : str
        Of length; empty where unknown.
    colour : str
        The field it is coloured by at first; empty for none.
    """

    title: str
    layers: tuple[Layer, ...]
    remarks: tuple[Remark, ...]
    said: tuple[str, ...]
    up: str
    unit: str
    colour: str = ""

    @property
    def body(self) -> Points:
        """(n, 3) the places that set the scale: those of all layers but marks."""
        found = [layer.places for layer in self.layers if layer.kind != "marks" and len(layer.places)]
        return np.concatenate(found) if found else np.zeros((1, 3))

    @property
    def eye(self) -> npt.NDArray[np.float64]:
        """(3,) the unit vector to the eye at first."""
        return eye_direction(self.body, self.up)  # type: ignore[arg-type]


def scene_of(
    title: str, layers: Sequence[Layer], remarks: Sequence[Remark], said: Sequence[str], look: LookParams
) -> Scene:
    """Return the scene of layers: marks for remarks added, and what is up decided by the largest layer."""
    largest = max((layer.places for layer in layers if layer.kind != "marks"), key=len, default=np.zeros((0, 3)))
    up = up_axis(body_of(largest), look.up)
    drawn = [layer for layer in layers if len(layer.places)]
    return Scene(title, (*drawn, *_marks(remarks)), tuple(remarks), tuple(said), up, look.unit)


def _marks(remarks: Sequence[Remark]) -> list[Layer]:
    """Return the layers of warnings and of notes that have places."""
    made = []
    for severity, name, role in (("warning", "warnings", "warning"), ("note", "notes", "note")):
        placed = [remark for remark in remarks if remark.severity == severity and len(remark.places)]
        if placed:
            places = np.concatenate([remark.places for remark in placed])
            texts = [remark.text for remark in placed for _ in remark.places]
            shown = severity == "warning"
            made.append(Layer(name, "marks", role, places, shown=shown, more={"texts": texts}))  # type: ignore[arg-type]
    return made
