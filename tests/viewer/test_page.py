"""The viewer in a real browser: what it asks for, draws and answers; from a file, on a phone, and without WebGL."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from reference.browser import NO_WEBGL, Browser, browser, chromium
from tiskel import PipelineParams, PipelineResult, RollParams, ShapeParams, make_shape, run_pipeline, shape_graph, view
from tiskel.report.page import RunFacts, report

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(chromium() is None, reason="no Chromium; install it or set TISKEL_CHROMIUM"),
]
NAME = "<script>alert(1)</script>.ply"
VIEWER = "document.querySelector('.tiskel-viewer')"
INK = f"""(() => {{ const c = {VIEWER}.querySelector('canvas'), g = document.createElement('canvas').getContext('2d');
g.canvas.width = c.width; g.canvas.height = c.height; g.drawImage(c, 0, 0);
const d = g.getImageData(0, 0, c.width, c.height).data; let n = 0;
for (let i = 0; i < d.length; i += 4) if (d[i] + d[i + 1] + d[i + 2] < 600) n++; return n; }})()"""
NEXT_FRAME = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"


@pytest.fixture(scope="module")
def result() -> PipelineResult:
    cloud = make_shape(shape_graph("banana"), ShapeParams(count=700))[0]
    return run_pipeline(cloud, PipelineParams(roll=(RollParams(duration=2.0, rate=20.0),)))


@pytest.fixture(scope="module")
def pages(result: PipelineResult, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("pages")
    view(result, unit="mm", title=NAME).save(folder / "view.html")
    facts = RunFacts(name=NAME, command=f"tiskel run '{NAME}'", files=(NAME,))
    (folder / "report.html").write_text(report(result, facts), encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def seen() -> Iterator[Browser]:
    with browser() as tab:
        yield tab


@pytest.fixture
def tab(seen: Browser, pages: Path) -> Browser:
    """The page of a view, just opened from disk."""
    seen.errors.clear()
    seen.requests.clear()
    seen.open((pages / "view.html").as_uri())
    return seen


def quiet(tab: Browser) -> bool:
    """Tell that a page neither complained nor asked for anything but itself."""
    asked = [one for one in tab.requests if not one.startswith("data:")]
    return not tab.errors and len(asked) == 1 and asked[0].startswith("file:")


def test_a_page_draws_and_asks_for_nothing(tab: Browser) -> None:
    assert tab.value(f"{VIEWER}.dataset.state") == "ready"
    assert tab.value(INK) > 1000
    assert tab.value(f"{VIEWER}.querySelector('header b').textContent") == NAME
    assert tab.value(f"{VIEWER}.querySelector('.scale').textContent").endswith(" mm")
    assert quiet(tab), (tab.errors, tab.requests)


def test_layers_are_hidden_and_shown(tab: Browser) -> None:
    before = tab.value(INK)
    tab.value(f"[...{VIEWER}.querySelectorAll('.layers input')].filter(one => one.checked).forEach(one => one.click())")
    tab.value(NEXT_FRAME)
    assert tab.value(INK) == 0
    tab.value(f"{VIEWER}.querySelector('.layers input').click()")
    tab.value(NEXT_FRAME)
    assert 0 < tab.value(INK) < before
    assert not tab.errors


def test_colours_have_a_bar_with_the_unit(tab: Browser) -> None:
    tab.value(f"(s => {{ s.value = 'radius'; s.onchange(); }})({VIEWER}.querySelector('select'))")
    assert tab.value(f"{VIEWER}.querySelector('.legend b').textContent") == "radius, mm"
    names = tab.value(f"[...{VIEWER}.querySelectorAll('option')].map(one => one.textContent)")
    assert {"plain", "branch", "radius", "boundedness", "centredness"} <= set(names)
    for _ in names:
        tab.value(f"{VIEWER}.viewer.next()")
    assert not tab.errors


def test_hovering_the_curve_says_what_is_known(tab: Browser) -> None:
    """The mouse goes to a node of the curve, wherever that is drawn."""
    x, y = tab.value(
        f"""(v => {{ const c = v.scene.layers.find(one => one.kind === 'curve'), k = 30;
        const p = v.world.controls.target.clone().set(...c.places.slice(k, k + 3)).project(v.world.camera);
        const b = v.world.canvas.getBoundingClientRect();
        return [b.left + (p.x + 1) / 2 * b.width, b.top + (1 - p.y) / 2 * b.height]; }})({VIEWER}.viewer)"""
    )
    tab.mouse("Moved", x, y)
    tab.until(f"!{VIEWER}.querySelector('.tip').hidden")
    words = tab.value(f"{VIEWER}.querySelector('.tip').textContent")
    assert all(
        word in words for word in ("curve", "branch", "radius", " mm", "the radius is", "measured", "boundedness")
    )
    tab.mouse("Moved", 2, 740)
    assert tab.value(f"{VIEWER}.querySelector('.tip').hidden") is True


def test_a_click_selects_and_keys_turn_and_zoom(tab: Browser) -> None:
    eye = f"{VIEWER}.viewer.world.camera.position.toArray()"
    before = np.array(tab.value(eye))
    tab.key("ArrowLeft")
    turned = np.array(tab.value(eye))
    assert np.linalg.norm(turned - before) > 0.05 * np.linalg.norm(before)
    tab.key("+")
    assert np.linalg.norm(tab.value(eye)) < np.linalg.norm(turned)
    tab.key("z")
    tab.until(f"!{VIEWER}.viewer.world.flight")
    above = np.array(tab.value(eye)) - np.array(tab.value(f"{VIEWER}.viewer.world.controls.target.toArray()"))
    assert above[2] > 0.99 * np.linalg.norm(above)
    curve = f"{VIEWER}.viewer.scene.layers.find(one => one.kind === 'curve')"
    tab.value(f"{VIEWER}.viewer.select({{ layer: {curve}, row: 3 }})")
    assert tab.value(f"Boolean({VIEWER}.viewer.selected && {VIEWER}.viewer.halo)") is True
    tab.key("f")
    tab.until(f"!{VIEWER}.viewer.world.flight")
    tab.key("d")
    assert tab.value(f"{VIEWER}.dataset.theme") == "dark"
    assert not tab.errors


def test_a_trajectory_plays_to_its_end(tab: Browser) -> None:
    ball = f"{VIEWER}.viewer.player.runs[0].ball.position.toArray()"
    before = tab.value(ball)
    tab.value(f"{VIEWER}.querySelector('.player button').click()")
    tab.until(f"{VIEWER}.viewer.player.time > 0.2")
    assert tab.value(ball) != before
    tab.until(f"!{VIEWER}.viewer.player.playing")
    assert tab.value(f"{VIEWER}.querySelector('.player output').textContent") == "2 of 2 s"
    run = "(r => [r.centre.slice(-3), r.ball.position.toArray()])"
    end, drawn = tab.value(f"(a => a.map(one => [...one]))({run}({VIEWER}.viewer.player.runs[0]))")
    np.testing.assert_allclose(drawn, end, atol=1e-6)


def test_a_phone_gets_a_folded_panel_and_answers_taps(tab: Browser, pages: Path) -> None:
    tab.open((pages / "view.html").as_uri(), width=390, height=800, phone=True)
    assert tab.value(f"{VIEWER}.querySelector('.panel').classList.contains('folded')") is True
    assert tab.value("document.documentElement.scrollWidth") <= 390
    assert tab.value(INK) > 500
    boxes = tab.value(f"""['.panel', '.player', '.foot']
        .map(name => {VIEWER}.querySelector(name).getBoundingClientRect())
        .map(one => [one.left, one.top, one.right, one.bottom])""")
    for i, one in enumerate(boxes):
        assert one[0] >= 0
        assert one[2] <= 390
        for other in boxes[:i]:
            assert one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1]
    assert not tab.errors


def test_a_report_holds_a_viewer_and_names_are_only_names(tab: Browser, pages: Path) -> None:
    tab.requests.clear()
    tab.open((pages / "report.html").as_uri())
    assert tab.value(f"{VIEWER}.dataset.state") == "ready"
    assert tab.value("document.querySelector('h1').textContent") == NAME
    assert tab.value("document.scripts.length") == 3  # scene, bytes and viewer: no name became one
    titles = tab.value("[...document.querySelectorAll('nav a')].map(one => one.textContent)")
    assert {"What went in", "What came out", "Measures", "Branches", "Rolling sphere", "Settings", "Files"} <= set(
        titles
    )
    assert tab.value(INK) > 500
    assert quiet(tab), (tab.errors, tab.requests)


def test_a_report_is_read_on_a_phone_and_its_tables_have_room(tab: Browser, pages: Path) -> None:
    address = (pages / "report.html").as_uri()
    tab.open(address)
    assert tab.value("document.querySelector('.telling td:last-child').clientWidth") > 250
    tab.open(address, width=390, height=800, phone=True)
    assert tab.value("document.documentElement.scrollWidth") <= 390
    rows = tab.value("[...document.querySelectorAll('.measures tbody tr')].map(row => row.clientHeight)")
    assert 0 < np.median(rows) < 120  # a column of single words would make them 150 and more
    assert not tab.errors


def test_without_webgl_there_is_a_still_picture(pages: Path) -> None:
    with browser(*NO_WEBGL) as tab:
        tab.open((pages / "view.html").as_uri())
        assert tab.value(f"{VIEWER}.dataset.state") == "still"
        width, height = tab.value(f"(i => [i.naturalWidth, i.clientHeight])({VIEWER}.querySelector('.still img'))")
        assert width > 800
        assert height > 300
        assert "WebGL" in tab.value(f"{VIEWER}.querySelector('figcaption').textContent")
        assert quiet(tab), (tab.errors, tab.requests)
