"""How often the cloud comes back to a file it has left, between entering extract_skeleton and the result.

    python benchmarks/returns.py             # counts
    python benchmarks/returns.py --route     # and the way itself

How it is counted. While a skeleton is extracted every call of a function of this
package that is given the cloud is recorded (sys.setprofile), with the place it is
called from: an argument, or a variable of the function around it, with a row for
every point, or an object that holds one. As a reader follows code and not a run, a
place counts once, however often a loop passes it, and of a function called again
only the call counts, not once more what it does inside. Calls one after the other
in one file are one stay; every stay in a file that was left before is a return.
Properties, lambdas and special methods are no calls, nor are those of kernels,
which start and end in one place.
"""

import argparse
import sys
from dataclasses import fields, is_dataclass
from pathlib import Path
from types import CodeType, FrameType

import numpy as np

import tiskel
from tiskel import ContractionParams, ShapeParams, contract, extract_skeleton, make_shape, shape_graph

ROOT = Path(tiskel.__file__).resolve().parent
METHODS = ("robust", "lbc", "gls")
DEEP = 3  # objects within objects that are looked into for the cloud
COUNT = 2039  # points, and nothing else has as many rows
# A hand with holes, seen unevenly: limbs that are missed and grow, gaps that are bridged, doubt and further fronts.
CLOUD = ShapeParams(count=COUNT, noise=0.25, missing=0.3, seed=1)


def holds_cloud(thing: object, deep: int = DEEP) -> bool:
    """Tell whether a thing is the cloud, has a row for each of its points, or holds something that has."""
    if isinstance(thing, np.ndarray):
        return thing.ndim > 0 and len(thing) == COUNT
    if is_dataclass(thing) and not isinstance(thing, type) and deep:
        return any(holds_cloud(getattr(thing, field.name), deep - 1) for field in fields(thing))
    return False


def accessors() -> set[CodeType]:
    """Return the code of all properties of the package."""
    modules = [module for name, module in sys.modules.items() if name.startswith("tiskel")]
    kinds = {kind for module in modules for kind in vars(module).values() if isinstance(kind, type)}
    found = set()
    for member in (member for kind in kinds for member in vars(kind).values()):
        getter = member.fget if isinstance(member, property) else getattr(member, "func", None)
        if getter is not None and hasattr(getter, "__code__"):
            found.add(getter.__code__)
    return found


class Route:
    """The calls of a run, as a reader of the code would follow them."""

    def __init__(self) -> None:
        self.stops: list[tuple[str, str]] = []
        self.skipped = accessors()
        self.known: set[CodeType] = set()  # functions that have been entered
        self.places: set[tuple[CodeType, int]] = set()  # calls that have been followed
        self.followed: list[bool] = []

    def __call__(self, frame: FrameType, event: str, argument: object) -> None:
        if event == "call":
            self.followed.append(self._enter(frame))
        elif event == "return" and self.followed:
            self.followed.pop()

    def _enter(self, frame: FrameType) -> bool:
        """Record a call where it is followed; return whether calls from inside it are."""
        code, inside = frame.f_code, not self.followed or self.followed[-1]
        if not inside or not self._is_stop(frame):
            return inside
        place = (frame.f_back.f_code, frame.f_back.f_lasti) if frame.f_back else (code, 0)
        if place in self.places:
            return False
        self.places.add(place)
        self.stops.append((Path(code.co_filename).resolve().relative_to(ROOT).as_posix(), code.co_name))
        new = code not in self.known
        self.known.add(code)
        return new

    def _is_stop(self, frame: FrameType) -> bool:
        code = frame.f_code
        if code.co_name.startswith(("<", "__")) or code in self.skipped or f"{ROOT}/" not in code.co_filename:
            return False
        given = (*code.co_varnames[: code.co_argcount + code.co_kwonlyargcount], *code.co_freevars)
        return any(holds_cloud(frame.f_locals.get(name)) for name in given)

    def stays(self) -> list[tuple[str, list[str]]]:
        """Return the files in the order of the way, each with the functions entered in a row."""
        way: list[tuple[str, list[str]]] = []
        for file, name in self.stops:
            if way and way[-1][0] == file:
                way[-1][1].append(name)
            else:
                way.append((file, [name]))
        return way


def route_of(method: str) -> Route:
    points = make_shape(shape_graph("hand"), CLOUD)[0]
    contraction = contract(points, ContractionParams(method=method))  # type: ignore[arg-type]
    extract_skeleton(contraction)  # modules are loaded
    route = Route()
    sys.setprofile(route)
    try:
        extract_skeleton(contraction)
    finally:
        sys.setprofile(None)
    return route


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--route", action="store_true", help="print the way, stay by stay")
    options = parser.parse_args()
    for method in METHODS:
        way = route_of(method).stays()
        files = len({file for file, _ in way})
        print(f"{method}: {len(way)} stays in {files} files, {len(way) - files} returns to a file that was left")
        for file, names in way if options.route else []:
            print(f"    {file}: {', '.join(names)}")


if __name__ == "__main__":
    main()
