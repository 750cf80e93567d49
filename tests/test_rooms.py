"""The rooms of the house and the arrows between them: imports go downwards only, and nowhere in circles."""

import ast
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
LINKS = (ROOT / "tiskel" / "cli", ROOT / "tiskel" / "kernels")

# A room, and the rooms that it may import from, besides itself. Anything not named here fails.
BASE = "errors arrays params timing progress wording extras shown"
GEOMETRY = f"{BASE} kernels geometry"
STAGES = f"{GEOMETRY} methods contraction skeleton"
ALLOWED = {
    "kernels": "",
    "errors": "kernels",  # the error is defined there, so that a kernel can raise it
    "version": "",
    "extras": "errors",
    "timing": "",
    "wording": "",
    "shown": "tiskel",  # results show themselves in notebooks
    "progress": "",
    "params": "errors wording",
    "arrays": "errors params",
    "geometry": "errors arrays params kernels shown",
    "preprocess": GEOMETRY,
    "methods": GEOMETRY,
    "contraction": f"{GEOMETRY} methods",
    "skeleton": f"{GEOMETRY} methods contraction tiskel",  # to be looked at, through the face of the package
    "metrics": STAGES,
    "gallery": STAGES,
    "surfaces": GEOMETRY,
    "tiles": STAGES,
    "slicing": f"{STAGES} surfaces",
    "rolling": f"{STAGES} surfaces slicing",
    "io": f"{STAGES} version preprocess metrics surfaces slicing rolling tiles",
    "pictures": f"{STAGES} metrics surfaces slicing rolling",
    "messages": f"{STAGES} surfaces slicing rolling metrics",  # the wording of what the stages report
    "pipeline": f"{STAGES} preprocess metrics surfaces slicing rolling io messages",
    "one_call": f"{STAGES} io pictures",
    "viewer": f"{STAGES} metrics surfaces slicing rolling io pictures pipeline",
    "report": f"{STAGES} version metrics surfaces slicing rolling pictures messages pipeline viewer",
    "batch": f"{BASE} kernels version io metrics",  # many clouds; what is done with each, it is told
    "tiskel": "",  # the face of the package hands names on when they are asked for
    "cli": f"{STAGES} tiskel version preprocess metrics gallery surfaces slicing rolling io pictures pipeline messages "
    "batch viewer report",
}
WITHIN = {  # the same inside rooms that have rooms of their own
    "methods.trace": "",
    "methods.laplacian": "methods.trace",
    "methods.robust": "methods.trace",
    "methods": "methods.trace methods.laplacian methods.robust",
    "io.limits": "",
    "io.streams": "io.limits",
    "io.ply": "io.streams",
    "io.formats": "io.limits io.streams io.ply",
    "io.lines": "io.limits io.streams io.ply io.formats",
    "io.stages": "io.streams io.ply",
}


def modules(root: Path = ROOT) -> list[Path]:
    """Return the files of the package, the command line and the kernels, each once."""
    links = [root / link.relative_to(ROOT) for link in LINKS]
    every = [path for room in ("tiskel", "kernels", "cli") for path in sorted((root / room).rglob("*.py"))]
    return [path for path in every if not any(path.is_relative_to(link) for link in links)]


def name_of(path: Path, root: Path = ROOT) -> str:
    """Return the dotted name of a module, as it is imported."""
    parts = path.relative_to(root).with_suffix("").parts
    parts = parts if parts[0] == "tiskel" else ("tiskel", *parts)
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def room_of(module: str) -> str:
    """Return the room of a module: what stands below the package, or its face."""
    return module.split(".")[1] if "." in module else "tiskel"


def imports(path: Path, known: set[str], root: Path = ROOT) -> Iterator[str]:
    """Yield the modules of the package that a file imports, wherever in it, relative imports included."""
    own = name_of(path, root)
    package = own if path.name == "__init__.py" else own.rpartition(".")[0]
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (found for alias in node.names if (found := _module(alias.name, known)))
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            source = ".".join([*above, *([node.module] if node.module else [])])
            for alias in node.names:
                if found := _module(f"{source}.{alias.name}", known):
                    yield found


def _module(name: str, known: set[str]) -> str:
    """Return the longest known module that a dotted name begins with, empty where it is not of this package."""
    while name and name not in known:
        name = name.rpartition(".")[0]
    return name


def arrows(root: Path = ROOT) -> dict[str, set[str]]:
    """Return for every module those that it imports; type-checking imports count too."""
    files = modules(root)
    known = {name_of(path, root) for path in files}
    return {name_of(path, root): set(imports(path, known, root)) - {name_of(path, root)} for path in files}


def forbidden(found: dict[str, set[str]]) -> list[str]:
    """Return the arrows that no table allows, in words."""
    wrong = []
    for module, targets in sorted(found.items()):
        room = room_of(module)
        if room == "tiskel":
            continue
        for target in sorted(targets):
            other = room_of(target)
            if other != room and other not in ALLOWED.get(room, "").split():
                wrong.append(f"{module} imports {target}: room {room} may import from {ALLOWED.get(room, 'nothing')}")
            elif other == room and not _allowed_within(module, target):
                wrong.append(f"{module} imports {target}: {_part(module)} may not import from {_part(target)}")
    return wrong


def _part(module: str) -> str:
    """Return the part of a room that a module belongs to, the room itself where it has no parts in the table."""
    name = module.removeprefix("tiskel.")
    return max((part for part in WITHIN if f"{name}.".startswith(f"{part}.")), key=len, default="")


def _allowed_within(module: str, target: str) -> bool:
    one, other = _part(module), _part(target)
    return not one or not other or one == other or other in WITHIN[one].split()


def test_every_arrow_is_in_the_table() -> None:
    assert forbidden(arrows()) == []


def test_no_circles() -> None:
    """Between modules, which is stricter than between rooms; the face of the package is left out."""
    found = {module: targets - {"tiskel"} for module, targets in arrows().items() if module != "tiskel"}
    try:
        TopologicalSorter(found).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def test_every_room_is_in_the_table() -> None:
    assert {room_of(name_of(path)) for path in modules()} == set(ALLOWED)


@pytest.fixture
def house(tmp_path: Path) -> Path:
    """A house of three rooms that keeps the rules."""
    for file, source in {
        "tiskel/__init__.py": "",
        "tiskel/errors.py": "",
        "tiskel/geometry/__init__.py": "",
        "tiskel/geometry/graph.py": "from tiskel.errors import TiskelError",
        "tiskel/methods/__init__.py": "from tiskel.geometry import graph",
    }.items():
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text(source)
    return tmp_path


@pytest.mark.parametrize(
    ("file", "source"),
    [
        ("tiskel/geometry/graph.py", "from tiskel.methods import x"),
        ("tiskel/geometry/graph.py", "from ..methods import x"),
        ("tiskel/geometry/graph.py", "def f():\n    import tiskel.methods"),
        ("tiskel/geometry/__init__.py", "from .. import methods"),
    ],
)
def test_an_arrow_that_runs_up_is_found(house: Path, file: str, source: str) -> None:
    assert forbidden(arrows(house)) == []
    (house / file).write_text(source)
    assert len(forbidden(arrows(house))) == 1
