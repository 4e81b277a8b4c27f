"""Verdicts are computed from rows: their words, their intervals, and that wrong code overturns them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from surfexp.mesh.icosphere import icosphere
from surfexp.operators import diagnostics
from surfexp.operators.fem import fem
from surfexp.report.claims import as_markdown, judge
from surfexp.report.table import Row
from surfexp.workflow import registry
from surfexp.workflow.plan import Leaf

EXPERIMENTS = Path(__file__).resolve().parents[2] / "conf" / "experiment"
CLAIM: dict[str, Any] = {"claim": "twice", "metric": "energy", "of": {"solver.name": "a"}, "holds": [1.9, 2.1]}


def row(name: str, seconds: float = 1.0, failure: str = "", **metrics: float) -> Row:
    return Row(Leaf(name, name, {}, {}), {"solver.name": name}, metrics, seconds, failure=failure)


def verdict(claim: dict[str, Any], *rows: Row) -> str:
    return judge([claim], rows)[0].verdict


@pytest.mark.parametrize(
    ("more", "energy", "word"),
    [
        ({"printed": "2"}, 2.0, "reproduced"),
        ({"printed": "2"}, 3.0, "not reproduced"),
        ({"printed": "2", "otherwise": "corrected"}, 3.0, "corrected"),
        ({}, 2.0, "holds"),
        ({}, 3.0, "does not hold"),
    ],
)
def test_words_tell_published_claims_from_our_own(more: dict[str, Any], energy: float, word: str) -> None:
    assert verdict(CLAIM | more, row("a", energy=energy)) == word


def test_a_ratio_has_the_range_over_its_rows() -> None:
    rows = [row("a", energy=3.0), row("a", energy=5.0), row("b", energy=1.0), row("b", energy=3.0)]
    found = judge([CLAIM | {"over": {"solver.name": "b"}}], rows)[0]
    assert (found.value, found.low, found.high, found.verdict) == (2.0, 1.0, 5.0, "holds")


def test_seconds_can_be_claimed() -> None:
    assert verdict(CLAIM | {"metric": "seconds"}, row("a", seconds=2.0)) == "holds"


@pytest.mark.parametrize(
    "rows", [[], [row("b", energy=2.0)], [row("a", other=2.0)], [row("a", failure="x", energy=2.0)]]
)
def test_nothing_is_claimed_of_rows_that_are_missing_or_failed(rows: list[Row]) -> None:
    assert verdict(CLAIM, *rows) == "not computed"


@pytest.mark.parametrize(
    ("holds", "text"),
    [([1, 2], "1 to 2"), ([None, 2], "≤ 2"), ([1, None], "≥ 1"), ([1, 1], "1"), ([None, None], "any")],
)
def test_the_interval_is_shown(holds: list[float | None], text: str) -> None:
    found = judge([CLAIM | {"holds": holds}], [row("a", energy=1.0)])
    assert found[0].interval == text and f"| {text} |" in as_markdown("x", "", found)


def test_a_wrong_sign_in_the_divergence_overturns_the_verdict(monkeypatch: pytest.MonkeyPatch) -> None:
    claims = yaml.safe_load((EXPERIMENTS / "operator_convergence.yaml").read_text())["claims"]
    claim = next(claim for claim in claims if claim["claim"].startswith("The face-based divergence"))
    assert verdict(claim, measured()) == "holds"
    right = diagnostics.divergence
    monkeypatch.setattr(diagnostics, "divergence", lambda operator, field: -right(operator, field))
    assert verdict(claim, measured()) == "does not hold"


def measured() -> Row:
    surface = icosphere(2)
    registry.load_all(Path("/nonexistent"))
    method = registry.plugin("solver", "operator_errors")
    metrics = method.function(method.options(), surface=surface, operator=fem(surface.mesh)).metrics
    return Row(Leaf("key", "fem", {}, {}), {"operator.name": "fem"}, metrics, 0.0)
