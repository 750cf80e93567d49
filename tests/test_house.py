"""The rules of the house: imports go one way, kernels follow Taichi's, the public surface is complete and cheap."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

import tiskel

ROOT = Path(__file__).parents[1]
LINKS = (ROOT / "tiskel" / "cli", ROOT / "tiskel" / "kernels")
MODULES = [
    path
    for room in ("tiskel", "kernels", "cli")
    for path in sorted((ROOT / room).rglob("*.py"))
    if not any(path.is_relative_to(link) for link in LINKS)
]


def imported(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return found


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_imports_go_from_cli_to_library_to_kernels(path: Path) -> None:
    room, names = path.relative_to(ROOT).parts[0], imported(path)
    if room == "kernels":
        assert not any(name.split(".")[0] == "tiskel" for name in names)
    if room == "tiskel":
        assert not any(name.startswith("tiskel.cli") for name in names)
        assert "taichi" not in names
    if room == "cli":
        assert not {name.split(".")[0] for name in names} & {"scipy", "taichi", "open3d"}


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_files_are_short_and_say_what_they_are_for(path: Path) -> None:
    source = path.read_text()
    assert ast.get_docstring(ast.parse(source))
    assert source.count("\n") <= 250


def test_kernels_do_not_postpone_annotations() -> None:
    """Taichi reads them (taichi-dev/taichi#6144)."""
    assert not any("__future__" in (ROOT / "kernels" / p).read_text() for p in (ROOT / "kernels").glob("*.py"))


def undocumented(path: Path) -> list[str]:
    """Return the public functions, classes and methods of a file that say nothing, in words of their own."""
    named = (ast.FunctionDef, ast.ClassDef)
    top = [node for node in ast.parse(path.read_text()).body if isinstance(node, named) and node.name[0] != "_"]
    inner = [node for kind in top if isinstance(kind, ast.ClassDef) for node in kind.body if isinstance(node, named)]
    public = [node for node in (*top, *inner) if node.name[0] != "_"]
    return [node.name for node in public if not ast.get_docstring(node) and node.name not in OF_A_PROTOCOL]


# What a protocol or a base class documents is not said again where it is implemented.
OF_A_PROTOCOL = {"jet", "level", "v_range", "periods", "forms", "frame", "rates", "neighbours_for"}


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_everything_public_is_documented(path: Path) -> None:
    """Read from the source: Python writes docstrings of its own for dataclasses and enums that have none."""
    assert undocumented(path) == []


def test_every_package_goes_into_the_wheel() -> None:
    """An editable installation finds those that are forgotten there."""
    listed = (ROOT / "pyproject.toml").read_text().split("packages = [")[1].split("]")[0]
    packages = [path.parent.relative_to(ROOT) for path in MODULES if path.name == "__init__.py"]
    names = [".".join(parts if parts[0] == "tiskel" else ("tiskel", *parts)) for parts in (p.parts for p in packages)]
    assert sorted(names) == sorted(name.strip().strip('"') for name in listed.split(",") if name.strip())


@pytest.mark.parametrize("name", tiskel.__all__)
def test_public_names_exist(name: str) -> None:
    assert getattr(tiskel, name).__module__.startswith("tiskel.")


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'skeletonise'"):
        _ = tiskel.skeletonise


@pytest.mark.parametrize("code", ["import tiskel", "import tiskel.params", "import tiskel.cli.app"])
def test_importing_loads_nothing_heavy(code: str) -> None:
    heavy = (
        "{'numpy', 'scipy', 'taichi', 'open3d', 'ripser', 'matplotlib', 'networkx', 'plyfile', 'importlib.metadata'}"
    )
    assert loaded_by(code, heavy) == "[]"


def test_the_package_alone_loads_next_to_nothing() -> None:
    assert loaded_by("import tiskel", "{'importlib.metadata', 'dataclasses', 'tiskel.params', 'email'}") == "[]"


def test_the_overview_loads_no_command_and_no_rich() -> None:
    """Or the first answer of the program takes three times as long."""
    code = "import contextlib, io; from tiskel.cli.app import app\n"
    code += "with contextlib.redirect_stdout(io.StringIO()): app(['--help'], standalone_mode=False)\n"
    assert loaded_by(code, "{'rich.console', 'tiskel.params', 'tiskel.cli.contract'}") == "[]"


def loaded_by(code: str, modules: str) -> str:
    """Return which of the modules are there after the code and were not before."""
    check = f"import sys; before = set(sys.modules)\n{code}\nprint(sorted({modules} & set(sys.modules) - before))"
    done = subprocess.run([sys.executable, "-c", check], capture_output=True, text=True, check=True, cwd=ROOT / "tests")
    return done.stdout.strip()


def test_every_other_file_goes_into_the_wheel() -> None:
    """Scripts, styles and licences of a package are in package-data; the recipe of the viewer's script is not."""
    listed = (ROOT / "pyproject.toml").read_text().split("[tool.setuptools.package-data]")[1].split("\n\n")[0]
    patterns = dict(re.findall(r'^"?([\w.]+)"? = \["([^"]+)"\]', listed, re.MULTILINE))
    kept = {ROOT.joinpath(*package.split("."), *pattern.split("/")) for package, pattern in patterns.items()}
    recipe = ROOT / "tiskel" / "viewer" / "build"
    for path in (ROOT / "tiskel").rglob("*"):
        ours = not any(path.is_relative_to(folder) for folder in (*LINKS, recipe))
        if ours and path.is_file() and path.suffix not in {".py", ".pyc"}:
            assert any(path.match(str(pattern)) for pattern in kept), path


def test_every_dependency_is_weighed_and_explained() -> None:
    listed = (ROOT / "pyproject.toml").read_text()
    needed = listed.split("dependencies = [")[1].split("\n]")[0] + listed.split("full = [")[1].split("]")[0]
    names = re.findall(r'"([a-z0-9]+)>=', needed)
    table = (ROOT / "docs" / "install.md").read_text()
    assert len(names) >= 9
    assert [name for name in names if not re.search(rf"^\| {name}[ ,|]", table, re.MULTILINE)] == []
