"""The terminal ends with a line a claim: what was found, what was asked, the worst last."""

from __future__ import annotations

import re
from importlib.resources import files
from io import StringIO
from types import SimpleNamespace
from typing import Any, cast

from rich.console import Console

from surfexp.commands.verdict_lines import STYLES, print_verdicts
from surfexp.lab.plan.plan import Leaf, Plan
from surfexp.records.table import Row

CLAIM: dict[str, Any] = {"quantity": {"all": "energy"}, "because": "why not"}


def printed(claims: list[dict[str, Any]], *energies: float | None) -> list[str]:
    plan = cast(Plan, SimpleNamespace(settings=SimpleNamespace(claims=claims)))
    rows = []
    for number, energy in enumerate(energies):
        leaf = Leaf(f"row{number}", f"row{number}", {"target": "solver"})
        metrics = {} if energy is None else {"energy": energy}
        rows.append(Row(leaf, {"solver.name": f"row{number}"}, metrics, 1.0, failure="" if metrics else "no mesh"))
    stream = StringIO()
    print_verdicts(plan, rows, Console(file=stream, width=40))
    return stream.getvalue().splitlines()


def test_each_claim_is_a_line_with_its_number_and_interval_the_worst_last() -> None:
    below, above = ({"claim": word, "between": ends} for word, ends in (("[b]below", [None, 1]), ("above", [0, 5])))
    lines = printed([CLAIM | below, CLAIM | above], 2.0, 3.0)
    assert lines == [
        "holds  above: all energy 2 to 3, asked 0 to 5",
        "does not hold  [b]below: all energy 2 to 3, asked ≤ 1",
        "",
    ]


def test_a_row_without_a_number_is_named() -> None:
    (line, _) = printed([CLAIM | {"claim": "low", "between": [None, 1]}], 2.0, None)
    assert line.startswith("not computed  low: ") and "failed: row1" in line


def test_without_claims_nothing_is_printed_and_every_verdict_has_a_style() -> None:
    assert printed([], 2.0) == []
    words = {"holds", "does not hold", "reproduced", "corrected", "not reproduced", "not comparable", "not computed"}
    assert words == set(STYLES)


def test_only_what_fails_is_red() -> None:
    assert {word for word, style in STYLES.items() if style == "red"} == {"not reproduced", "does not hold"}
    rules = files("surfexp.report").joinpath("templates/style.css").read_text(encoding="utf-8")
    red = re.findall(r"\.([\w-]+)[^{}\n]*\{ color: var\(--(?:bad|accent)\); font-weight: 600", rules)
    assert red == ["not-reproduced"]  # its rule is that of does-not-hold too


def test_what_is_not_comparable_stands_beside_the_published_value() -> None:
    claim = CLAIM | {"claim": "seconds", "between": "not comparable", "because": "another machine"}
    (line, _) = printed([claim | {"published": {"table 2.2": "18.61s"}}], 2.0)
    assert line == "not comparable  seconds: all energy 2, published 18.61s (another machine)"
