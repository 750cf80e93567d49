"""How results are looked at: which axis points up, and what the unit of length is called."""

from dataclasses import dataclass
from typing import Literal, get_args

from tiskel.errors import TiskelError

Up = Literal["auto", "x", "y", "z"]
UPS: tuple[Up, ...] = get_args(Up)
LONGEST_UNIT = 12  # letters; more is no unit, and does not fit beside an axis


@dataclass(frozen=True, kw_only=True)
class LookParams:
    """How pictures, the viewer and the report show a cloud; results do not depend on it.

    Raises TiskelError for another axis, and for a unit of more than 12 letters.

    Examples
    --------
    >>> from tiskel import LookParams
    >>> LookParams(up="y", unit="mm")
    LookParams(up='y', unit='mm')
    """

    #: the input's axis that points up; auto: z, but y where the cloud stands on y = 0 and not on z = 0
    up: Up = "auto"
    unit: str = ""  #: what the input's unit of length is called; empty where nobody knows

    def __post_init__(self) -> None:
        if self.up not in UPS:
            raise TiskelError(f"up must be one of {', '.join(UPS)}, got {self.up!r}")
        if len(self.unit) > LONGEST_UNIT:
            raise TiskelError(f"a unit has at most {LONGEST_UNIT} letters, such as mm, got {self.unit!r}")
