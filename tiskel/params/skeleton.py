"""Settings of the curve that take the place of those its contraction was made with."""

from dataclasses import dataclass, fields, replace
from typing import TypeVar

from tiskel.params.methods import ContractionParams, Place, RegimeChoice, Topology, refuse_foreign, settings_of

P = TypeVar("P", bound=ContractionParams)


@dataclass(frozen=True, kw_only=True)
class SkeletonParams:
    """Settings of :func:`tiskel.extract_skeleton`; None leaves what the contraction was made with.

    What they mean, and what they are by default, say the settings of the
    methods: :class:`tiskel.RobustParams`, :class:`tiskel.LbcParams` and
    :class:`tiskel.GlsParams`.

    Examples
    --------
    >>> from tiskel import LbcParams, SkeletonParams
    >>> SkeletonParams(radius=0.03).over(LbcParams()).radius
    0.03
    """

    raw: bool | None = None
    radius: float | None = None
    extra_fronts: int | None = None
    least_branch: float | None = None
    merge_junctions: float | None = None
    grow_ends: int | None = None
    bridge_gaps: float | None = None
    straightness: float | None = None
    rounds: int | None = None
    regime: RegimeChoice | None = None
    topology: Topology | None = None
    root: Place | None = None
    seen_from: Place | None = None

    def over(self, params: P) -> P:
        """Return a method's settings with these in their place; raise TiskelError for one that it does not read."""
        given = {field.name: getattr(self, field.name) for field in fields(self)}
        changes = {name: value for name, value in given.items() if value is not None}
        if changes.get("raw") is False and "raw" not in settings_of(type(params)):
            del changes["raw"]
        refuse_foreign(type(params), changes)
        return replace(params, **changes)  # type: ignore[type-var]
