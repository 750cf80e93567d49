"""The stage ``plan``: twists over time that roll a sphere from a contact to a contact, and to an attitude."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.errors import TiskelError
from tiskel.params import PlanParams
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import PlanSettings
from tiskel.progress import Report, Span
from tiskel.rolling.ambient import Ground, frame_about
from tiskel.rolling.begin import radius_of, standing_place
from tiskel.rolling.courses import pulled_tight, tight_centres, tracked
from tiskel.rolling.inputs import Inputs
from tiskel.rolling.loops import loop_to, missed
from tiskel.rolling.many import Poses, roll_many
from tiskel.rolling.reachable import Standing, reachable, shortest_way
from tiskel.rolling.roll_on import roll_on
from tiskel.rolling.second import Surroundings
from tiskel.rolling.segments import Segment, Shooting, joined, of_moves, of_way
from tiskel.rolling.trajectory import RollStatus, Trajectory
from tiskel.shown import Brief
from tiskel.surfaces.implicit import ImplicitSurface

ROUNDS = 6  # of rolling a plan and correcting it
LOOKS, TRIES = 60, 8  # ways that are looked at, each without what was too tight on those before; ways that are rolled
TIGHT = "every way that was tried leads through places that are too tight for it; take a smaller one"
SITES = 5  # places along a way where a loop for the attitude is tried besides its ends


@dataclass(frozen=True, eq=False, repr=False)
class Plan(Brief):
    """Inputs that roll a sphere to where it should be, and the run that shows it.

    Attributes
    ----------
    inputs : Inputs
        omega of the object in the carried frame over time, without slip.
    run : Trajectory
        What they do, rolled with the usual endings.
    way : (m, 3) float64
        Contacts of the way before loops, from the start to the goal.
    loop : (k, 3) float64
        Rotation vectors of the moves for the attitude; empty without.
    off : float
        How far from the goal the contact arrives, in radii of the sphere.
    turned_off : float or None
        Degrees that the attitude is off; None where none was asked for.
    rounds : int
        How often the plan was rolled and corrected.
    params : PlanParams
        The settings.

    Examples
    --------
    >>> from tiskel import PlanParams, plan_roll
    >>> from tiskel.surfaces.implicit_bodies import Capsule
    >>> params = PlanParams(start_at=(0, 0, 0.5), goal=(0.5, 0, 0.5), radius=0.25)
    >>> plan = plan_roll(Capsule((-1, 0, 0), (1, 0, 0), 0.5), params)
    >>> plan.run.status.value, plan.turned_off, round(plan.run.path_object, 2)
    ('finished', None, 0.5)
    """

    _said = ("inputs", "way", "loop", "off", "turned_off", "rounds")

    inputs: Inputs
    run: Trajectory
    way: Points
    loop: Points
    off: float
    turned_off: float | None
    rounds: int
    params: PlanParams

    def as_dict(self) -> dict[str, Any]:
        """Return the summary as plain values, ready for JSON."""
        return {
            "time": float(self.inputs.t[-1]), "rows": len(self.inputs.t), "radius": self.run.radius,
            "way": self.run.path_object, "off": self.off, "turned_off": self.turned_off, "rounds": self.rounds,
            "loop": self.loop.tolist(), "least_margin": float(self.run.margin.min()),
            "start_at": self.run.contact[0].tolist(), "end_at": self.run.contact[-1].tolist(),
            "end_attitude": self.run.orientation[-1].tolist(), "warnings": list(self.run.warnings),
        }  # fmt: skip


def plan_roll(
    surface: ImplicitSurface, params: PlanParams | None = None, *, progress: Report | None = None,
    **settings: Unpack[PlanSettings],
) -> Plan:  # fmt: skip
    """Plan how to roll a sphere from a contact to a contact and, if asked, to an attitude, without slip.

    The shortest way of the centre over places where the sphere fits is pulled
    tight; a loop of three straight moves, at the goal, the start or in between,
    gives the attitude by holonomy. Both are then rolled and corrected until the
    sphere arrives.

    Parameters
    ----------
    surface : ImplicitSurface
        The surface of a whole body, or an analytic one; lengths in any unit.
    params : PlanParams, optional
        From where to where, and what the sphere may do.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts begin; what it raises ends the search.
    **settings
        Those of :class:`tiskel.PlanParams` by name; over those of params.

    Returns
    -------
    Plan

    Raises
    ------
    TiskelError
        Where the sphere cannot stand at start or goal, the goal is not connected to the start for it, or the attitude
        is not reached; with the reason.

    Examples
    --------
    >>> from tiskel import PlanParams, plan_roll
    >>> from tiskel.surfaces.implicit_bodies import Capsule
    >>> body = Capsule((-1, 0, 0), (1, 0, 0), 0.5)
    >>> plan = plan_roll(body, PlanParams(start_at=(0, 0, 0.5), goal=(1.5, 0, 0), radius=0.25))
    >>> plan.off < 1e-3, round(plan.run.path_object, 2)
    (True, 1.79)
    """
    params, span = settled(PlanParams, params, settings), Span(progress, "plan")
    span.at(0, "places")
    ground = Ground(surface, params.roll.sigma, radius_of(surface, params.radius))
    standing = Standing(ground, Surroundings.of(ground), np.array(params.avoid, float).reshape(-1, 4))
    start = standing_place(ground, params.start_at)
    goal = standing_place(ground, params.goal, "goal")
    for name, place in (("start", start), ("goal", goal)):
        if why := standing.why_not(place):
            at = ",".join(f"{x:.4g}" for x in place)
            raise TiskelError(f"the sphere of radius {ground.radius:.4g} cannot stand at the {name} {at}: {why}")
    places = reachable(standing, start, goal, params)
    pose = _begun(ground, start, params)
    reasons: list[str] = []
    rolled = 0
    for number in range(LOOKS):
        span.at(0.3 + 0.6 * number / LOOKS, "way")
        way = pulled_tight(standing, shortest_way(standing, places))
        tight = tight_centres(standing, way)
        if len(tight) == 0:
            rolled += 1
            for segments, loop in _drafts(standing, pose, way, goal, params, reasons):
                found = _rolled(surface, standing, pose, segments, way, loop, params, reasons)
                if isinstance(found, Plan):
                    span.at(1)
                    return found
                tight = np.concatenate([tight, found])
            if len(tight) == 0 or rolled == TRIES:
                break
        standing = standing.without(tight)
    raise TiskelError(f"no plan found for a sphere of radius {ground.radius:.4g}: {reasons[-1] if reasons else TIGHT}")


def _begun(ground: Ground, start: Numbers, params: PlanParams) -> Poses:
    """Return the pose of one sphere at the start."""
    frame = frame_about(ground.touches(start[None])[1][0], None)
    attitude = np.array(params.start_attitude) / np.linalg.norm(params.start_attitude)
    return Poses(start[None], attitude[None], frame[None, :, 0])


def _attitude(params: PlanParams) -> Numbers | None:
    return None if params.attitude is None else np.array(params.attitude) / np.linalg.norm(params.attitude)


def _drafts(
    standing: Standing, pose: Poses, way: Points, goal: Numbers, params: PlanParams, reasons: list[str]
) -> Iterator[tuple[list[Segment], Points]]:
    """Yield segments that should arrive, and the moves of their loop: one without an attitude, else one a site."""
    attitude, ground = _attitude(params), standing.ground
    if attitude is None:
        omega, step, _ = tracked(standing, pose, way)
        yield of_way(omega, step), np.zeros((0, 3))
        return
    rng = np.random.default_rng(params.seed)
    for site in _sites(ground, way):
        omega, step, there = tracked(standing, pose, way[: site + 1])
        _, _, after = tracked(standing, there._replace(q=np.array([[1.0, 0, 0, 0]])), way[site:])
        if not (np.isfinite(there.q).all() and np.isfinite(after.q).all()):
            reasons.append("the way leads through a place that is too tight for the sphere; take a smaller one")
            continue
        wanted = _product(_inverse(after.q[0]), attitude)  # the way from the site on turns the sphere by after.q
        loop = loop_to(standing, there, way[site], wanted, params.spin, rng)
        if not loop.free:
            left = "no loop fits" if not np.isfinite(loop.off) else f"the best loop tried leaves {loop.off:.3g} radians"
            reasons.append(
                f"the attitude is not reached without leaving where it fits: {left}; try spin, or a smaller one"
            )
            continue
        turn = of_moves(loop.moves, params.spin)
        end = there
        for segment in turn:
            end = roll_many(ground, end, segment.omega[:, None], segment.step).poses
        rest, rest_step, _ = tracked(standing, end, way[site:])
        yield [*of_way(omega, step), *turn, *of_way(rest, rest_step)], loop.moves


def _sites(ground: Ground, way: Points) -> list[int]:
    """Return rows of a way where to turn: goal, start, then where there is most room for the sphere."""
    inner = np.linspace(0, len(way) - 1, SITES + 2)[1:-1].astype(int)
    roomy = inner[np.argsort(-ground.margin(way[inner]), kind="stable")].tolist()
    return list(dict.fromkeys([len(way) - 1, 0, *roomy]))


def _rolled(
    surface: ImplicitSurface, standing: Standing, pose: Poses, segments: Sequence[Segment], way: Points, loop: Points,
    params: PlanParams, reasons: list[str],
) -> Plan | Points:  # fmt: skip
    """Return the plan, rolled and corrected until it arrives; else centres (n, 3) where it ends early, and note why."""
    attitude, goal = _attitude(params), way[-1]
    shooting = Shooting(standing.ground, pose, segments, goal, attitude)
    by = shooting.solved(np.zeros(shooting.size))
    for rounds in range(1, ROUNDS + 1):
        inputs = joined(shooting.with_shapes(by), params.speed)
        run = roll_on(surface, replace(params.roll, radius=standing.ground.radius, start_at=tuple(way[0])), inputs)
        if run.status is not RollStatus.FINISHED:
            reasons.append(f"rolled, it ends early: {run.reason}; take a smaller one, or another start or goal")
            return run.centre[-1:]
        if not standing.avoids(run.centre).all():
            reasons.append("its way cannot be kept out of the balls to avoid; make them smaller")
            return run.centre[:0]
        end = Poses(run.contact[-1:], run.orientation[-1:], np.zeros((1, 3)))
        off = missed(standing.ground, end, goal, attitude)[0]
        far = float(np.linalg.norm(run.contact[-1] - goal)) / standing.ground.radius
        turned = None if attitude is None else float(np.degrees(np.linalg.norm(off[2:])))
        if far < params.near and (turned is None or turned < params.within):
            return Plan(inputs, run, way, loop, far, turned, rounds, params)
        by = by + shooting.step(by, off)
    said = f"it arrives {far:.3g} radii off" + ("" if turned is None else f" and {turned:.3g} degrees")
    reasons.append(f"{said} after {ROUNDS} corrections")
    return way[:0]


def _inverse(q: Numbers) -> Numbers:
    return np.asarray(q * np.array([1.0, -1, -1, -1]))


def _product(a: Numbers, b: Numbers) -> Numbers:
    """Return the product (4,) of two quaternions w, x, y, z."""
    w, v = a[0] * b[0] - a[1:] @ b[1:], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])
    return np.concatenate([[w], v])
