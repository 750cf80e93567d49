"""Settings as functions are given them: an object, keywords, or both."""

import inspect
from collections.abc import Callable
from dataclasses import fields
from typing import Any, Union, get_args, get_type_hints

import numpy as np
import pytest

import tiskel
from tiskel import GlsParams, LbcParams, MetricParams, RobustParams, RollParams, StabilityParams, TiskelError
from tiskel.params import keywords
from tiskel.params.given import settled, settled_method

CLASSES = {
    getattr(keywords, name): getattr(tiskel, name.replace("Settings", "Params"))
    for name in vars(keywords)
    if name.endswith("Settings") and name != "MethodSettings"
}
TAKERS = [getattr(tiskel, name) for name in tiskel.__all__ if inspect.isfunction(getattr(tiskel, name))]


@pytest.mark.parametrize(("words", "params"), CLASSES.items(), ids=lambda kind: kind.__name__)
def test_keywords_have_the_names_and_types_of_the_settings(words: type, params: type) -> None:
    hints = get_type_hints(params)
    assert get_type_hints(words) == {field.name: hints[field.name] for field in fields(params)}


def test_those_of_methods_are_all_settings_of_all_methods() -> None:
    every: dict[str, set[Any]] = {}
    for kind in (RobustParams, GlsParams, LbcParams):
        hints = get_type_hints(kind)
        for field in fields(kind):
            hint = hints[field.name]
            every.setdefault(field.name, set()).update(get_args(hint) or {hint})
    words = get_type_hints(keywords.MethodSettings)
    assert {name: set(get_args(hint) or {hint}) for name, hint in words.items()} == every
    assert get_args(words["neighbours"]) == get_args(Union[int, None])  # noqa: UP007


def test_every_stage_takes_keywords() -> None:
    """Where a function takes params, it takes the settings by name; all stages of one cloud have an object each."""
    with_params = {taker.__name__ for taker in TAKERS if "params" in inspect.signature(taker).parameters}
    with_words = {
        taker.__name__
        for taker in TAKERS
        if any(p.kind is p.VAR_KEYWORD for p in inspect.signature(taker).parameters.values())
    }
    assert with_params - with_words == {"run_pipeline", "write_surfaces"}  # the second has those of a file


def test_progress_is_the_same_everywhere() -> None:
    signatures = {t.__name__: inspect.signature(t).parameters["progress"] for t in TAKERS if _tells(t)}
    assert {str(p.annotation) for p in signatures.values()} == {str(tiskel.progress.Report | None)}
    assert all(p.default is None for p in signatures.values())
    assert set(signatures) >= {"contract", "extract_skeleton", "skeletonize", "evaluate", "assess_stability", "roll"}
    assert set(signatures) >= {"fit_surface", "fit_body", "fit_whole", "roll_on", "roll_body", "plan_roll"}


def _tells(taker: Callable[..., Any]) -> bool:
    return "progress" in inspect.signature(taker).parameters


def test_keywords_go_over_params() -> None:
    both = settled(MetricParams, MetricParams(gap=2.0, seed=4), {"seed": 5})
    assert (both.gap, both.seed) == (2.0, 5)
    assert settled(MetricParams, None, {}) == MetricParams()


def test_arrays_and_lists_are_tuples() -> None:
    chosen = settled(RollParams, None, {"omega": np.array([0, 2.0, 0]), "heading": [1, 0, 0], "rate": np.float64(5)})
    assert chosen == RollParams(omega=(0, 2.0, 0), heading=(1, 0, 0), rate=5.0)
    assert type(chosen.rate) is float


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: settled(StabilityParams, None, {"bin": 3}), "StabilityParams has no setting bin; did you mean bins?"),
        (lambda: settled(StabilityParams, None, {"colour": 3}), "no setting colour; it has normals, neighbours, bins"),
        (lambda: settled(StabilityParams, RollParams(), {}), "settings must be StabilityParams, got RollParams"),
        (lambda: settled(tiskel.PlanParams, None, {"radius": 1}), "PlanParams needs start_at and goal; give them"),
        (lambda: settled_method(None, {"resolutoin": 3}), "no method has a setting resolutoin; did you mean resoluti"),
        (lambda: settled_method(None, {"method": "robsut"}), "method must be one of robust, gls, lbc, got 'robsut'"),
        (lambda: settled_method(LbcParams(), {"theta": 3}), "theta is a setting of method gls, lbc does not read it"),
        (lambda: settled_method(LbcParams(), {"method": "gls"}), "method is 'gls', the settings are those of lbc"),
        (lambda: settled_method(MetricParams(), {}), "settings must be those of a method, such as RobustParams, got"),  # type: ignore[arg-type]
    ],
)
def test_what_does_not_fit_is_refused(call: Callable[[], Any], message: str) -> None:
    with pytest.raises(TiskelError) as error:
        call()
    assert message in str(error.value)
