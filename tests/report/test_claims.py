"""Claims are checked when read and judged from rows: their words, their quantities, and that wrong code overturns them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from surfexp.lab.errors import UserError
from surfexp.lab.experiment.claim import claims_of, read_claims
from surfexp.lab.plan.plan import Leaf
from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators import diagnostics
from surfexp.operators.fem import fem
from surfexp.records.table import Row
from surfexp.report.verdict import Verdict, judge
from surfexp.reproduction.page import section

EXPERIMENTS = Path(__file__).resolve().parents[2] / "conf" / "experiment"
PUBLISHED = {"published": {"table 2.2": "2"}}
PLEIJEL = {"published": {"Pleijel 1956": "2"}}
NOT_COMPARED: dict[str, Any] = {"between": "not comparable", "because": "Seconds of another machine."}
CLAIM: dict[str, Any] = {
    "claim": "twice",
    "quantity": {"all": "energy"},
    "rows": {"solver.name": "a"},
    "between": [1.9, 2.1],
    "because": "a twentieth either way",
}
RATIO = {"quantity": {"ratio": "energy"}, "rows": [{"solver.name": "a"}, {"solver.name": "b"}]}


def row(name: str, seconds: float = 1.0, failure: str = "", seed: int = 0, **metrics: float) -> Row:
    parameters = {"solver.name": name, "image.seed": seed}
    return Row(Leaf(name, name, {"target": "solver"}), parameters, metrics, seconds, failure=failure)


def judged(claim: dict[str, Any], *rows: Row) -> Verdict:
    return judge(read_claims([claim]), rows)[0]


@pytest.mark.parametrize(
    ("more", "energy", "word"),
    [
        (PUBLISHED, 2.0, "reproduced"),
        (PUBLISHED, 3.0, "not reproduced"),
        (PUBLISHED | {"otherwise": "corrected"}, 3.0, "corrected"),
        (PLEIJEL, 2.0, "reproduced"),
        (PLEIJEL, 3.0, "not reproduced"),
        (PUBLISHED | NOT_COMPARED, 2.0, "not comparable"),
        (PUBLISHED | NOT_COMPARED, 3.0, "not comparable"),
        ({}, 2.0, "holds"),
        ({}, 3.0, "does not hold"),
    ],
)
def test_words_tell_published_claims_from_our_own(more: dict[str, Any], energy: float, word: str) -> None:
    assert judged(CLAIM | more, row("a", energy=energy)).verdict == word


def test_what_is_not_comparable_shows_both_numbers_and_why_and_asks_nothing() -> None:
    verdict = judged(CLAIM | PUBLISHED | NOT_COMPARED | {"cause": "A factorisation today."}, row("a", energy=7.0))
    assert (verdict.number, verdict.interval, verdict.claim.source) == ("7", "–", "table 2.2: 2")
    assert verdict.why == "Seconds of another machine. A factorisation today."
    line = next(line for line in section("x", "", [verdict], "a" * 20).splitlines() if "**not comparable**" in line)
    assert line.startswith("| twice | table 2.2: 2 | all energy | – | – | 1 | 7 | **not comparable** | Seconds of")
    missing = judged(CLAIM | PUBLISHED | NOT_COMPARED)
    assert (missing.verdict, missing.why) == ("not computed", "no row is selected")


@pytest.mark.parametrize(
    ("quantity", "energies", "word", "number"),
    [
        ("all", (2.0, 2.0), "holds", "2"),
        ("all", (2.0, 2.05), "holds", "2 to 2.05"),
        ("all", (1.0, 3.0), "does not hold", "1 to 3"),  # its mean is 2
        ("any", (2.0, 9.0), "holds", "2 to 9"),
        ("any", (1.0, 3.0), "does not hold", "1 to 3"),
        ("mean", (1.0, 3.0), "holds", "2 (1 to 3)"),
        ("mean", (2.0, 9.0), "does not hold", "5.5 (2 to 9)"),
        ("min", (2.0, 9.0), "holds", "2 (2 to 9)"),
        ("min", (1.0, 2.0), "does not hold", "1 (1 to 2)"),
        ("max", (1.0, 2.0), "holds", "2 (1 to 2)"),
        ("max", (2.0, 9.0), "does not hold", "9 (2 to 9)"),
    ],
)
def test_each_quantity_has_its_own_verdict(quantity: str, energies: tuple[float, ...], word: str, number: str) -> None:
    rows = [row("a", seed=seed, energy=energy) for seed, energy in enumerate(energies)]
    verdict = judged(CLAIM | {"quantity": {quantity: "energy"}}, *rows, row("b", energy=-7.0))
    assert (verdict.verdict, verdict.number, verdict.count) == (word, number, 2)


def test_a_ratio_has_the_range_over_its_pairs_of_rows() -> None:
    rows = [row("a", energy=3.0), row("a", energy=5.0), row("b", energy=1.0), row("b", energy=3.0)]
    verdict = judged(CLAIM | RATIO, *rows)
    assert (verdict.value, verdict.low, verdict.high, verdict.verdict) == (2.0, 1.0, 5.0, "holds")
    negative = [row("a", energy=-4.0), row("b", energy=-2.0), row("b", energy=-1.0)]
    verdict = judged(CLAIM | RATIO, *negative)
    assert (verdict.low, verdict.high) == (2.0, 4.0)


def test_seconds_can_be_claimed() -> None:
    assert judged(CLAIM | {"quantity": {"all": "seconds"}}, row("a", seconds=2.0)).verdict == "holds"


GOOD = [row("a", seed=seed, energy=2.0) for seed in range(9)]


@pytest.mark.parametrize("quantity", ["all", "any", "mean", "min", "max"])
@pytest.mark.parametrize(
    ("spoilt", "reason"),
    [
        (row("a", seed=77, failure="x", energy=2.0), "failed: 77 (1 of 10 rows)"),
        (row("a", seed=77, failure="not computed"), "not run: 77 (1 of 10 rows)"),
        (row("a", seed=77, other=2.0), "without energy: 77 (1 of 10 rows)"),
        (row("a", seed=77, energy=float("nan")), "without energy: 77 (1 of 10 rows)"),
        (row("a", seed=77, energy=float("inf")), "without energy: 77 (1 of 10 rows)"),
        (row("a", seed=77, energy=2.0, converged=0.0), "not converged: 77 (1 of 10 rows)"),
    ],
)
def test_one_unusable_row_leaves_a_claim_not_computed_and_is_named(quantity: str, spoilt: Row, reason: str) -> None:
    verdict = judged(CLAIM | {"quantity": {quantity: "energy"}}, *GOOD, spoilt)
    assert (verdict.verdict, verdict.why, verdict.number) == ("not computed", reason, "–")


def test_unusable_rows_to_divide_by_count_too() -> None:
    ratio = CLAIM | RATIO
    assert judged(ratio, *GOOD).why == "no row is selected"
    assert judged(ratio, *GOOD, row("b", failure="x")).why == "failed: b (1 of 1 rows)"
    for zero in ([0.0], [1.0, 0.0], [1.0, -1.0]):
        verdict = judged(ratio, *GOOD, *(row("b", seed=k, energy=value) for k, value in enumerate(zero)))
        assert verdict.verdict == "not computed" and "energy is 0 in rows to divide by" in verdict.why


def test_no_row_is_no_verdict() -> None:
    assert judged(CLAIM).verdict == judged(CLAIM, row("b", energy=2.0)).verdict == "not computed"


def test_rows_that_stopped_early_count_where_a_claim_says_why_and_where_convergence_is_the_question() -> None:
    rows = [row("a", energy=2.0, converged=0.0), row("a", energy=2.0, converged=1.0)]
    assert judged(CLAIM, *rows).verdict == "not computed"
    assert judged(CLAIM | {"unconverged": "the scheme has no certificate"}, *rows).verdict == "holds"
    assert judged(CLAIM | {"quantity": {"all": "converged"}, "between": [1, 1]}, *rows).verdict == "does not hold"


@pytest.mark.parametrize(
    ("wanted", "count"),
    [
        ({"image.seed": 3}, 1),
        ({"image.seed": [3, 4, 99]}, 2),
        ({"image.seed": 3.0}, 1),
        ({"image.seed": "3"}, 0),
        ({"image.seed": True}, 0),
        ({}, 9),
        ({"model.name": "rof"}, 0),
    ],
)
def test_rows_are_selected_by_typed_values_and_lists_of_them(wanted: dict[str, Any], count: int) -> None:
    assert judged(CLAIM | {"rows": wanted}, *GOOD).count == count


def test_an_option_that_is_a_list_is_matched_as_a_whole_or_as_one_of_several() -> None:
    turned = Row(Leaf("x", "x", {"target": "surface"}), {"clean.rotation": [30.0, 25.0]}, {"energy": 2.0}, 0.0)
    for wanted in ([30, 25], [[0, 0], [30, 25]]):
        assert judged(CLAIM | {"rows": {"clean.rotation": wanted}}, turned).count == 1
    assert judged(CLAIM | {"rows": {"clean.rotation": [30, 26]}}, turned).count == 0


@pytest.mark.parametrize(
    ("between", "text"), [([1, 2], "1 to 2"), ([None, 2], "≤ 2"), ([1, None], "≥ 1"), ([1, 1], "1")]
)
def test_the_interval_its_reason_and_where_it_was_before_are_shown(between: list[float | None], text: str) -> None:
    verdict = judged(CLAIM | {"between": between, "moved": "≤ 9"}, row("a", energy=1.0))
    page = section("x", "", [verdict], "a" * 20)
    assert verdict.interval == text and f"| {text} (before the result: ≤ 9) | a twentieth either way | 1 | 1 |" in page


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"row": {}}, "unknown key 'row'; did you mean 'rows'?"),
        ({"quantity": None}, "claim.quantity = None"),
        ({"quantity": "median"}, "claim.quantity = 'median'"),
        ({"quantity": {"maxx": "energy"}}, "unknown quantity 'maxx'; did you mean 'max'?"),
        ({"quantity": {}}, "claim.quantity = {}"),
        ({"quantity": {"max": "energy", "min": "energy"}}, "claim.quantity = "),
        (PUBLISHED | {"because": ""}, "'because' is missing"),
        ({"between": [None, None]}, "both ends are open"),
        ({"between": [2, 1]}, "the lower end 2 is above the upper end 1"),
        ({"between": [1, float("inf")]}, "null is an open end"),
        (NOT_COMPARED, "published has no place of it"),
        (PLEIJEL | NOT_COMPARED, "published has no place of it"),
        (PUBLISHED | NOT_COMPARED | {"because": ""}, "'because' is missing"),
        (PUBLISHED | NOT_COMPARED | {"otherwise": "corrected"}, "otherwise: what is not comparable has no verdict"),
        ({"quantity": {"ratio": "energy"}}, "rows: a ratio needs two selections"),
        ({"rows": [{}, {}]}, "rows: a ratio needs two selections and nothing else has two; this is 'all'"),
        (RATIO | {"rows": [{}, {}, {}]}, "claim.rows"),
        ({"otherwise": "corrected"}, "ours does not hold"),
        ({"published": {"tabel 2.2": "2"}}, "'tabel' is no kind of place; did you mean 'table'?"),
        ({"published": {"table": "2"}}, "'table' has no number"),
        ({"published": {"table 1": "2", "figure 2": "2"}}, "claim.published = "),
        ({"published": {"table 1": ""}}, "a source and the value that stands there are needed"),
    ],
)
def test_a_wrong_claim_is_refused_in_one_line(change: dict[str, Any], message: str) -> None:
    with pytest.raises(UserError) as error:
        read_claims([CLAIM | change])
    assert message in str(error.value) and "\n" not in str(error.value)
    assert str(error.value).startswith("claim 1 (twice): ")


@pytest.mark.parametrize("key", ["quantity", "between"])
def test_a_key_that_is_missing_is_named(key: str) -> None:
    with pytest.raises(UserError, match=f"'{key}' is missing"):
        read_claims([{name: value for name, value in CLAIM.items() if name != key}])


@pytest.mark.parametrize("file", sorted(EXPERIMENTS.glob("*.yaml")), ids=lambda file: file.stem)
def test_the_claims_of_every_experiment_are_well_formed(file: Path) -> None:
    read_claims(claims_of(file))


def test_a_wrong_sign_in_the_divergence_overturns_the_verdict(monkeypatch: pytest.MonkeyPatch) -> None:
    claim = CLAIM | {
        "quantity": {"all": "adjointness_defect"},
        "rows": {"operator.name": "fem"},
        "between": [None, 1e-12],
    }
    assert judged(claim, measured()).verdict == "holds"
    right = diagnostics.divergence
    monkeypatch.setattr(diagnostics, "divergence", lambda operator, field: -right(operator, field))
    assert judged(claim, measured()).verdict == "does not hold"


def measured() -> Row:
    surface = icosphere(2)
    load_all(Path("/nonexistent"))
    method = registry.plugin("statistic", "operator_errors")
    metrics = method({}, surface=surface, operator=fem(surface.mesh)).metrics
    return Row(Leaf("key", "fem", {}), {"operator.name": "fem"}, metrics, 0.0)


@pytest.mark.parametrize(
    ("between", "energy", "word"),
    [
        ([2.0, 3.0], 2.0, "reproduced"), ([1.0, 2.0], 2.0, "reproduced"), ([2.0, 2.0], 2.0, "reproduced"),
        ([None, 2.0], 2.0, "reproduced"), ([2.0, None], 2.0, "reproduced"),
        ([2.0 + 1e-12, 3.0], 2.0, "not reproduced"), ([1.0, 2.0 - 1e-12], 2.0, "not reproduced"),
    ],
)  # fmt: skip
def test_the_ends_belong_to_the_interval(between: list[float | None], energy: float, word: str) -> None:
    assert judged(CLAIM | PUBLISHED | {"between": between}, row("a", energy=energy)).verdict == word


@pytest.mark.parametrize(
    ("between", "energy", "shown"),
    [
        ([0.95, None], 0.949996, "0.949996"),
        ([None, 1e-6], 1.04e-6, "1.04e-06"),
        ([None, 1e-6], 9.96e-7, "1.0e-6"),  # inside, as it is shown
        ([0.95, None], 0.95004, "0.95"),
        ([None, 20000.0], 20000.4, "20000.4"),
        ([None, 1.234], 1.23401234567, "1.23401"),  # as few digits as say it
    ],
)
def test_no_number_is_rounded_over_an_end_of_its_interval(between: list[float], energy: float, shown: str) -> None:
    found = judged(CLAIM | {"between": between}, row("a", energy=energy))
    assert found.number == shown
    low, high = (None if end is None else float(end) for end in between)
    inside = (low is None or float(shown) >= low) and (high is None or float(shown) <= high)
    assert inside == (found.verdict == "holds")
    assert judged(CLAIM | {"between": [1234567.5, None]}, row("a", energy=1.0)).interval == "≥ 1234567.5"
