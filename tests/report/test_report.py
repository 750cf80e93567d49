"""The report: everything of a run is in it, nothing of a name is more than a name, and no time unless given."""

import re
from dataclasses import replace

import numpy as np
import pytest

from tiskel import PipelineParams, PipelineResult, RollParams, ShapeParams, make_shape, run_pipeline, shape_graph
from tiskel.messages import Message
from tiskel.metrics.tables import COLUMNS
from tiskel.params import LookParams, RobustParams
from tiskel.pictures.canvas import new_figure, rendered
from tiskel.report import markup as m
from tiskel.report.page import RunFacts, report
from tiskel.report.settings import settings
from tiskel.report.words import MEASURES

NAME = 'a "<img src=x onerror=alert(1)>" & b.ply'


@pytest.fixture(scope="module")
def result() -> PipelineResult:
    cloud = make_shape(shape_graph("y"), ShapeParams(count=700))[0]
    params = PipelineParams(contraction=RobustParams(neighbours=13), roll=(RollParams(duration=0.5),))
    return run_pipeline(cloud, params)


def words_of(page: str) -> str:
    """Return what a reader sees: no script, no style, no tag."""
    bare = re.sub(r"<(script|style).*?</\1>", "", page, flags=re.DOTALL)
    return re.sub(r"<[^>]*>", " ", bare)


def test_everything_of_a_run_is_said(result: PipelineResult) -> None:
    told = [("contract", (Message("doubtful", warning=True), Message("done")))]
    facts = RunFacts(
        name="b.ply", sha256="abc123", command="tiskel run b.ply -o out", told=told, look=LookParams(unit="mm"),
        seconds={"contract": 1.25, "contract.rings": 0.5}, files=("skeleton.ply", "roll.json"),
    )  # fmt: skip
    words = words_of(report(result, facts, {"skeleton.png": rendered(new_figure(1, 1))}))
    wanted = (
        "abc123", "tiskel run b.ply -o out", "doubtful", "1.25 s", "rings 0.50", "length, mm", "neighbours", "13",
        "Other than usual", "skeleton.ply", "roll.json", "ended because", "misfit",
    )  # fmt: skip
    assert [one for one in wanted if one not in words] == []
    assert result.stability is not None
    assert result.stability.reason in words
    assert "ring ratio" in words
    assert "contraction weight" not in words  # fronts have none


def test_many_warnings_and_rows_do_not_fill_the_page(result: PipelineResult) -> None:
    """A tree has fifty warnings of its surfaces and hundreds of branches: a few are seen at once, all are there."""
    told = [("slice", tuple(Message(f"branch {i} is off", warning=True) for i in range(30)))]
    page = report(result, RunFacts(name="b.ply", told=told))
    assert page.count("is off</li>") == 30
    shown, _, rest = page.partition("<summary>26 more warnings</summary>")
    assert shown.count("is off</li>") == 4
    assert rest
    few, many = (m.table(("a",), [(i,) for i in range(count)]) for count in (5, 50))
    assert ('class="wide long"' in many, 'class="wide long"' in few) == (True, False)
    assert many.count("<tr>") == 51


def test_a_setting_as_the_command_line_writes_it_is_the_default() -> None:
    usual = PipelineParams().roll[0]
    a, b, c, d, e = (float(f"{value:.10g}") for value in usual.start)
    assert (a, b, c, d, e) != usual.start
    written, other = (replace(usual, start=start) for start in ((a, b, c, d, e), (a, 1.5, c, d, 1.5)))
    assert "Other than usual" not in settings(PipelineParams(roll=(written,)))
    assert "Other than usual" in settings(PipelineParams(roll=(other,)))


def test_steps_have_the_columns_of_their_method(result: PipelineResult) -> None:
    words = words_of(report(result, RunFacts(name="b.ply")))
    assert "ring ratio" in words
    assert "explained score" not in words
    assert "contraction weight" not in words


def test_every_measure_has_words() -> None:
    assert set(MEASURES) == {column.key for column in COLUMNS}


def test_names_and_messages_are_escaped(result: PipelineResult) -> None:
    facts = RunFacts(name=NAME, command=NAME, told=[(NAME, (Message(NAME),))], files=(NAME,))
    page = report(result, facts)
    assert "<img src=x" not in page
    assert words_of(page).count("&lt;img src=x onerror=alert(1)&gt;") >= 6


def test_without_times_the_same_run_gives_the_same_bytes(result: PipelineResult) -> None:
    facts = RunFacts(name="b.ply")
    assert report(result, facts) == report(result, facts)


def test_what_was_left_out_has_no_section(result: PipelineResult) -> None:
    less = replace(result, surfaces=None, trajectories=(), reason="no branch is long enough")
    page = report(less, RunFacts(name="b.ply"))
    assert "no branch is long enough" in page
    assert 'id="roll"' not in page
    assert 'id="measures"' in page


def test_pictures_are_inside(result: PipelineResult) -> None:
    page = report(result, RunFacts(name="b.ply"), {"metrics.png": rendered(new_figure(1, 1))})
    assert re.findall(r'<img[^>]* src="(?!data:)', page) == []
    assert np.unique(re.findall(r'href="(#?)', page)).size >= 1
    assert not re.search(r'(src|href)="https?:', page)
