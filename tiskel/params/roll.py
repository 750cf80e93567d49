"""Settings of rolling."""

from dataclasses import dataclass
from math import inf, pi
from typing import Literal, get_args

from tiskel.errors import TiskelError
from tiskel.params.checks import among, at_least, finite

Model = Literal["global", "local", "body"]
Side = Literal["outside", "inside"]
Twist = Literal["object", "sphere", "world"]
Normals = Literal["surface", "pca"]
OnMeeting = Literal["stop", "follow"]
Trusted = Literal["any", "seen", "measured"]


@dataclass(frozen=True, kw_only=True)
class RollParams:
    """Settings of :func:`tiskel.roll`; lengths in the input's unit, angles in radians, times in seconds.

    omega and velocity are those of the object relative to the sphere in the
    axes of the contact frame (twist "object"), of the sphere relative to the
    object in axes that are fixed in the sphere, as gyroscopes in it measure
    ("sphere"), or of the sphere in the axes of the cloud ("world"). Velocities
    are those of the material at the contact; a part along the normal does not
    count, and is refused where it can be told.

    Examples
    --------
    >>> from tiskel import RollParams, TiskelError
    >>> RollParams(side="inside", omega=(0, 2, 0)).sigma
    -1.0
    >>> try:
    ...     RollParams(rate=0)
    ... except TiskelError as error:
    ...     print(error)
    rate must be a positive number, got 0
    """

    model: Model = "global"  #: on the surface as it is; "local": made straight along its skeleton; "body": no chart
    side: Side = "outside"  #: of the surface that the sphere rolls on
    radius: float | None = None  #: of the sphere; None: a quarter of the median radius of the surface
    omega: tuple[float, float, float] = (0.0, 1.0, 0.0)  #: angular velocity, radians per second
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)  #: slip, lengths per second
    twist: Twist = "object"  #: whose axes omega and velocity are in, see above
    duration: float | None = None  #: None: 10, or as long as the inputs last
    rate: float = 100.0  #: rows of the trajectory per second
    start: tuple[float, float, float, float, float] = (0.1, pi / 2, 0.1, 0.1, pi / 2)  #: u_o, v_o, u_s, v_s, psi [T]
    start_at: tuple[float, float, float] | None = None  #: instead of u_o and v_o: the surface's point nearest to it
    attitude: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)  #: body: the sphere's quaternion at the start
    heading: tuple[float, float, float] | None = None  #: body: where omega_x = 1 rolls to at first; None: up
    on_meeting: OnMeeting = "stop"  #: body: what a second contact does; "follow": it takes the place of the first
    trusted: Trusted = "any"  #: body: the least that the surface has to be worth, or the run ends
    normals: Normals = "surface"  #: where curvature comes from; "pca": normals of neighbours, as printed, to compare
    neighbours: int = 20  #: of these normals [T]
    meet: bool = True  #: the run ends where the sphere meets another part of the cloud
    rtol: float = 1e-6  #: of the solver, relative; published: 1e-3, slipping by per cents where the sphere hardly fits
    atol: float = 1e-8  #: of the solver, absolute; published: 1e-5

    def __post_init__(self) -> None:
        among("model", self.model, get_args(Model))
        among("side", self.side, get_args(Side))
        among("twist", self.twist, get_args(Twist))
        among("normals", self.normals, get_args(Normals))
        among("on_meeting", self.on_meeting, get_args(OnMeeting))
        among("trusted", self.trusted, get_args(Trusted))
        at_least("neighbours", self.neighbours, 6)
        for name, count in (
            ("omega", 3),
            ("velocity", 3),
            ("start", 5),
            ("start_at", 3),
            ("attitude", 4),
            ("heading", 3),
        ):
            finite(name, getattr(self, name), count)
        for name in ("radius", "duration", "rate", "rtol", "atol"):
            value = getattr(self, name)
            if value is not None and not 0 < value < inf:
                raise TiskelError(f"{name} must be a positive number, got {value}")
        if not any(self.attitude) or self.heading == (0, 0, 0):
            raise TiskelError(f"attitude and heading need a length, got {self.attitude} and {self.heading}")
        if self.model == "local" and self.normals == "pca":
            raise TiskelError('the local model has its curvature from the Fourier series; take normals "surface"')
        if self.twist == "object" and self.velocity[2] != 0:
            raise TiskelError(f"velocity along the normal must be 0, contact is kept; got {self.velocity[2]}")

    @property
    def sigma(self) -> float:
        """The side as a sign: 1 outside, -1 inside."""
        return 1.0 if self.side == "outside" else -1.0
