"""The site: it builds without a warning and a network, its links lead somewhere, and it documents what there is."""

import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from html.parser import HTMLParser
from importlib import import_module
from pathlib import Path
from urllib.parse import unquote

import pytest

from reference.blocks import blocks_of

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)\s]*)?\)")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")
OURS = re.compile(r"\btiskel (?!\.)([a-z]+)")
OTHERS = {  # options of other programs that the pages name
    "--group-add", "--array", "--cpus-per-task", "--mem", "--signal", "--sshlogin", "--rm", "--user", "--wheel-dir",
    "--constraint", "--no-index", "--find-links", "--host", "--nthreads", "--only", "--data", "--clouds", "--stale",
    "--version", "--help", "--install-completion", "--resolution", "--extra", "--strict",
    "--chapter", "--cases", "--state", "--write", "--parts", "--quit",
}  # fmt: skip
EXTERNAL = {"https://keepachangelog.com/en/1.1.0/"}  # not fetched here: look at them before a release


class Anchors(HTMLParser):
    """What a page links to, asks for, and can be jumped to."""

    def __init__(self, page: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loads: list[str] = []
        self.names: set[str] = set()
        self.formulas = 0
        self.feed(page.read_text())

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = dict(attributes)
        self.formulas += tag == "math"
        self.names |= {str(given[key]) for key in ("id", "name") if given.get(key)}
        if tag == "a" and given.get("href"):
            self.links.append(str(given["href"]))
        elif tag != "a":
            self.loads += [str(given[key]) for key in ("src", "href") if given.get(key)]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    line = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", str(DOCS), str(folder)]
    done = subprocess.run(line, capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, Anchors]:
    return {page: Anchors(page) for page in site.glob("*.html")}


def test_links_of_the_site_lead_somewhere(site: Path, pages: dict[Path, Anchors]) -> None:
    assert len(pages) > 20
    for page, found in pages.items():
        for link in found.links:
            if "://" in link:
                continue
            name, _, anchor = unquote(link).partition("#")
            target = (page.parent / name).resolve() if name else page
            assert target.exists(), f"{page.name}: {link}"
            if anchor and target in pages:
                assert anchor in pages[target].names, f"{page.name}: {link}"


def test_no_page_asks_for_anything_from_elsewhere(site: Path, pages: dict[Path, Anchors]) -> None:
    for page, found in pages.items():
        assert not [one for one in found.loads if "://" in one or one.startswith("//")], page.name
    for sheet in site.rglob("*.css"):
        assert "url(http" not in sheet.read_text().replace('"', "").replace("'", "")


def test_formulas_are_drawn_by_the_browser(pages: dict[Path, Anchors]) -> None:
    count = {page.stem: found.formulas for page, found in pages.items()}
    assert all(count[name] > 3 for name in ("contract", "metrics", "slice", "roll"))


def test_every_public_name_is_in_the_reference(site: Path, pages: dict[Path, Anchors]) -> None:
    import tiskel

    names = next(found.names for page, found in pages.items() if page.stem == "api")
    assert {f"tiskel.{name}" for name in tiskel.__all__} <= names


@pytest.fixture(scope="module")
def reference() -> Iterator[object]:
    sys.path.insert(0, str(DOCS / "extensions"))
    yield import_module("command_reference")
    sys.path.remove(str(DOCS / "extensions"))


def test_every_option_is_documented_once(reference: object) -> None:
    """Each command has each of its arguments and options in one row: its own, or one that names the command."""
    text = reference.reference()  # type: ignore[attr-defined]
    own, _, shared = text.partition("## Options of several commands")
    sections = dict(re.findall(r"## tiskel (\w+)\n(.*?)(?=\n## |\Z)", own, re.S))
    taken = reference.parameters()  # type: ignore[attr-defined]
    assert set(sections) == set(taken)
    for name, ones in taken.items():
        assert all(one.words.strip() for one in ones), name
        for one in ones:
            rows = (f"| `{one.names}`", f"| `{one.names} ")
            here = sum(line.startswith(rows) for line in sections[name].splitlines())
            there = sum(line.startswith(rows) and name in _owners(line) for line in shared.splitlines())
            assert here + there == 1, (name, one.names, here, there)


def _owners(row: str) -> list[str]:
    """Return the commands that a row of the shared table names, in italics at its end."""
    return row.rpartition("*")[0].rpartition("*")[2].split(", ")


def test_the_pages_name_only_options_that_there_are(reference: object) -> None:
    taken = reference.parameters()  # type: ignore[attr-defined]
    known = {word for ones in taken.values() for one in ones for word in one.names.split(", ")}
    for page in PAGES:
        text = page.read_text()
        assert set(OPTION.findall(text)) <= known | OTHERS, page.name
        for block in blocks_of(page):
            if block.kind == "sh":
                assert set(OURS.findall(block.code)) <= set(taken), page.name


def test_links_between_files_lead_somewhere() -> None:
    outside: Counter[str] = Counter()
    for page in [*PAGES, ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"]:
        for link in LINK.findall(page.read_text()):
            if "://" in link:
                outside[link] += 1
            else:
                assert (page.parent / unquote(link)).exists(), f"{page.name}: {link}"
    assert set(outside) == EXTERNAL


def test_pictures_of_the_site_are_small() -> None:
    assert sum(path.stat().st_size for path in (DOCS / "pictures").glob("*.png")) < 1_500_000
