"""The report page shows texts as they are written, and of a long table an excerpt; its work grows with the rows."""

from __future__ import annotations

import csv
import json
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import surfexp.records.table
from audits.benchmarks.synthetic_results import fill, plan_of, sweep
from surfexp.contract.metric import Metric, find_metric
from surfexp.figures.figure import whole
from surfexp.lab.plan.outcome import Outcome, event_path
from surfexp.lab.plan.plan import Leaf
from surfexp.lab.store import store
from surfexp.records.comparison import Comparison, comparisons
from surfexp.records.table import Row, number_notes, rows_of, to_csv
from surfexp.records.written_numbers import as_in_tables, format_number
from surfexp.report import page
from surfexp.report.declared import declared_by
from surfexp.report.page import write_report
from surfexp.report.render import prose
from surfexp.report.verdict import _quantity


def test_text_is_escaped_and_backticks_are_code() -> None:
    shown = prose("run `collect --group '(?P<class>a|b)'` where x < y & z")
    assert shown == ("run <code>collect --group &#39;(?P&lt;class&gt;a|b)&#39;</code> where x &lt; y &amp; z")
    assert prose("one ` alone") == "one ` alone"


METRICS = {"rmse": Metric("error", "mm", "lower"), "psnr": Metric("", "dB", "higher"), "area": Metric("area", "mm^2")}
METRICS |= {"dice {reference}": Metric("overlap", "", "higher")}


def rows_by_chance(count: int, seed: int) -> list[Row]:
    random = np.random.default_rng(seed)
    leaf = Leaf("key", "configuration", {"target": "solver"})
    rows = []
    for number in range(count):
        metrics = {
            "rmse": float(random.integers(3)),
            "psnr": random.choice([1.0, 2.0, 3.0, float("nan")]),
            "area": number / 2.0,
        }
        metrics |= {"converged": float(random.integers(2))} if random.integers(4) else {}
        metrics |= {"dice sulc": float(random.integers(4)) / 4.0} if number % 3 else {}
        data = frozenset(random.choice(["one", "other"], 1).tolist())
        parameters = {"solver.name": "rof", "solver.seed": number}
        rows.append(Row(leaf, parameters, metrics, 1.0, [f"note {number % 2}"], "", data))
    return rows


def is_best_among_all(group: Comparison, name: str, row: Row) -> bool:
    """The definition, which looks at every row for each cell."""
    certified = any("converged" in other.metrics for other in group.rows)
    rivals = [other for other in group.rows if other.metrics.get("converged", not certified) and other.data == row.data]
    values = [other.metrics[name] for other in rivals if other.metrics.get(name) == other.metrics.get(name, 0.0)]
    better = {"rmse": min, "psnr": max, "dice sulc": max}.get(name)
    if better is None or row not in rivals or name not in row.metrics or len(set(values)) < 2:
        return False
    return bool(row.metrics[name] == better(values))


@pytest.mark.parametrize("seed", range(40))
def test_the_best_of_a_column_is_among_converged_rows_on_the_same_data(seed: int) -> None:
    group = Comparison("", "", rows_by_chance(9, seed), [], METRICS)
    for row in group.rows:
        for name in group.metric_names:
            assert group.is_best(row, name) == is_best_among_all(group, name, row)
    shown = group.excerpt(4)
    assert shown[:4] == group.rows[:4] and len(shown) <= 4 + len(group.best)
    assert {name for name, _ in group.best} == {
        name for row in shown for name in group.metric_names if group.is_best(row, name)
    }
    assert number_notes(group.rows) == {"note 0": 1, "note 1": 2}


@pytest.mark.parametrize(("differs", "best"), [("solver.seed", 2), ("operator.name", 0), ("model.weight", 0)])
def test_iterations_of_another_operator_or_model_have_no_best(differs: str, best: int) -> None:
    leaf = Leaf("key", "configuration", {"target": "solver"})
    data, meaning = frozenset({"one"}), {"iterations": Metric("", "", "lower"), "rmse": Metric("", "", "lower")}
    rows = [
        Row(leaf, {differs: k}, {"iterations": 41.0 + k, "rmse": 15.0 + k, "converged": 1.0}, 1.0, [], "", data)
        for k in range(2)
    ]
    group = Comparison("", "", rows, [], meaning)
    assert group.is_best(rows[0], "rmse") and len(group.best) == 1 + (best > 0)


def test_without_a_declared_direction_there_is_no_best() -> None:
    assert not Comparison("", "", rows_by_chance(9, 0), []).best


def test_rows_on_another_image_or_surface_have_other_data(tmp_path: Path) -> None:
    plan = plan_of(sweep(200), tmp_path)  # two seeds of the noise
    fill(plan, tmp_path)
    rows = rows_of(plan, tmp_path)
    by_seed = {row.parameters["image.seed"]: row.data for row in rows}
    assert len({row.data for row in rows}) == len(set(by_seed.values())) == 2
    assert all(row.data == by_seed[row.parameters["image.seed"]] and len(row.data) == 2 for row in rows)


def test_notes_of_rows_have_the_numbers_of_tables(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = plan_of(sweep(2), tmp_path)
    monkeypatch.setattr(surfexp.records.table, "outcome", lambda *_: Outcome(notes=("The energy is -39102.7.",)))
    assert rows_of(plan, tmp_path)[0].notes == ["The energy is -39\u202f103."]


def test_a_long_table_is_an_excerpt_that_says_so_and_nothing_is_lost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = plan_of(sweep(24), tmp_path)
    fill(plan, tmp_path)
    whole = (write_report(plan, tmp_path) / "report.html").read_text()
    assert whole.count("<tr") == 25 and "rows are shown" not in whole
    monkeypatch.setattr(page, "ROWS_SHOWN", 5)
    folder = write_report(plan, tmp_path)
    short = (folder / "report.html").read_text()
    best = min(row.metrics["rmse"] for row in rows_of(plan, tmp_path))
    assert "of 24 rows are shown" in short and short.count("<tr") in (6, 7)
    assert short.count('class="number best"') == 1 and f"{best:.4g}" in short
    with (folder / "metrics.csv").open() as file:
        assert [row["leaf"] for row in csv.DictReader(file)] == [leaf.key for leaf in plan.leaves]


def test_work_grows_with_the_rows_and_each_file_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    counts: dict[str, int] = {}

    def count(name: str, original: Any) -> Any:
        def counted(*given: Any, **named: Any) -> Any:
            counts[name] = counts.get(name, 0) + 1
            return original(*given, **named)

        return counted

    monkeypatch.setattr(Row, "limited", property(count("limited", Row.limited.fget)))  # type: ignore[attr-defined]
    monkeypatch.setattr(Comparison, "_cells", count("columns", Comparison._cells))
    for reader in ("read_bytes", "read_text"):
        monkeypatch.setattr(Path, reader, count(reader, getattr(Path, reader)))
    seen = {}
    for leaves in (30, 60):
        plan = plan_of(sweep(leaves), tmp_path / str(leaves))
        fill(plan, tmp_path / str(leaves))
        write_report(plan, tmp_path / str(leaves))  # what is read once for all: the template, package versions
        counts.clear()
        write_report(plan, tmp_path / str(leaves))
        seen[leaves] = dict(counts)
        assert counts["read_bytes"] <= leaves + 2 and counts["read_text"] <= leaves + 6
    assert seen[60]["limited"] <= 2 * seen[30]["limited"] and seen[30]["columns"] == seen[60]["columns"]


def test_ratios_lie_between_those_of_the_extremes() -> None:
    from surfexp.lab.experiment.claim import Claim

    claim = Claim(claim="c", quantity={"ratio": "gap"}, rows=({}, {"a": 1}), between=(0, 1), because="b")
    random = np.random.default_rng(0)
    for _ in range(200):
        values, divisors = (list(random.normal(random.normal(), 1.0, random.integers(1, 6))) for _ in range(2))
        ratios = [above / below for above in values for below in divisors]
        assert _quantity(claim, values, divisors)[1:] == (min(ratios), max(ratios))


def test_pages_ask_no_other_host() -> None:
    folder = Path(page.__file__).parent / "templates"
    files = [file for file in folder.iterdir() if file.suffix in (".j2", ".css", ".js")]
    assert {"report.html.j2", "index.html.j2", "style.css", "tables.js"} <= {file.name for file in files}
    for file in files:
        assert not re.search(r"https?:|url\(|@import|[\"'(]//[a-z]", file.read_text()), file.name


def test_odd_numbers_are_shown_and_break_nothing(tmp_path: Path) -> None:
    plan = plan_of(sweep(3), tmp_path)
    fill(plan, tmp_path)
    for seconds, leaf in zip(("NaN", "1e999", '"soon"'), plan.leaves, strict=True):
        file = event_path(tmp_path, "solver", leaf.key)
        file.write_text(re.sub(r'"seconds": [^,]+', f'"seconds": {seconds}', file.read_text()))
    text = (write_report(plan, tmp_path) / "report.html").read_text()
    assert "∞" in text and text.count("<tr ") == 3
    assert [format_number(value) for value in (float("inf"), -float("inf"), float("nan"))] == ["∞", "−∞", "–"]


def test_a_metric_that_is_no_number_is_named_below_its_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = plan_of(sweep(3), tmp_path)
    fill(plan, tmp_path)
    assert "is NaN in" not in (write_report(plan, tmp_path) / "report.html").read_text()
    rows = rows_of(plan, tmp_path)
    rows[0].metrics["rmse"] = float("nan")
    monkeypatch.setattr(page, "rows_of", lambda *given: rows)
    text = (write_report(plan, tmp_path) / "report.html").read_text()
    assert text.count('<p class="note">rmse is NaN in 1 of 3 rows: its method gave no number there.</p>') == 1


def test_a_metric_means_what_its_own_table_declares(tmp_path: Path) -> None:
    """The gap of a solver is better when it is low, that of an eigenvalue to the next when it is high."""
    feature = {"target": "feature", "feature": "eigenmap", "comparison": "modes"}
    plan = plan_of({**sweep(2), "columns": [], "variants": [{"comparison": "solvers"}, feature]}, tmp_path)
    fill(plan, tmp_path)
    groups = {group.title: group for group in comparisons(rows_of(plan, tmp_path))}
    directions = {title: find_metric("gap", declared_by(plan, group.rows)) for title, group in groups.items()}
    assert [directions[name].better for name in ("solvers", "modes")] == ["lower", "higher"]  # type: ignore[union-attr]


def test_where_a_row_stopped_and_p_values_have_no_best_and_equal_digits_share_it() -> None:
    rows = rows_by_chance(4, 0)
    for number, row in enumerate(rows):
        row.data, row.metrics = frozenset("a"), {"relative_gap": 1e-5 * number, "p_value": 0.1 * number}
        row.metrics |= {"rmse": (15.2701, 15.2702, 15.32, 16.0)[number], "psnr": 20.00001 - 1e-6 * number}
    lower = {name: Metric("", "", "lower") for name in ("relative_gap", "p_value", "lower_bound")}
    group = Comparison("", "", rows, [], METRICS | lower)
    best = [[name for name in group.metric_names if group.is_best(row, name)] for row in rows]
    assert best == [["rmse"], ["rmse"], [], []]


def test_thousands_are_apart_in_every_number() -> None:
    shown = [format_number(value) for value in (999.94, 1203.4, 8417.0, 8416.7, -45437.2, 10437, 999.96)]
    assert shown == ["999.9", "1\u202f203", "8\u202f417", "8\u202f417", "-45\u202f437", "10\u202f437", "1\u202f000"]
    assert whole(8416.7) == shown[3]


@pytest.mark.parametrize(
    "note, written",
    [
        ("The energy of the field, -39102.7, exceeds that.", "The energy of the field, -39_103, exceeds that."),
        ("It has 25075 vertices (of 160000), 0.125 mm apart.", "It has 25_075 vertices (of 160_000), 0.125 mm apart."),
        ("As Okabe and Ito (2008), 8417.3.", "As Okabe and Ito (2008), 8_417."),
        ("seed 1234567890, v2.10.34567, a-12345, 12345e-3", "seed 1234567890, v2.10.34567, a-12345, 12345e-3"),
    ],
)
def test_numbers_of_notes_are_written_as_those_of_tables(note: str, written: str) -> None:
    assert as_in_tables(note) == written.replace("_", "\u202f")


def test_gaps_of_different_problems_have_no_best() -> None:
    rows = rows_by_chance(9, 0)
    for number, row in enumerate(rows):
        row.parameters["model.mu"] = number
        row.metrics |= {"converged": 1.0, "iterations": float(number)}
    metrics = {**METRICS, "iterations": Metric("steps", "", "lower")}
    assert "iterations" not in {name for name, _ in Comparison("", "", rows, [], metrics).best}
    for row in rows:
        del row.parameters["model.mu"]
    assert "iterations" in {name for name, _ in Comparison("", "", rows, [], metrics).best}
    rows[0].metrics |= {"relative_gap": 5.0, "iterations": -1.0}
    assert not Comparison("", "", rows, [], metrics).is_best(rows[0], "iterations")


def test_seconds_that_were_asked_for_are_one_column_in_their_place(tmp_path: Path) -> None:
    for columns in (["seconds", "relative_gap"], ["relative_gap"]):
        plan = plan_of(sweep(3) | {"columns": columns}, tmp_path)
        fill(plan, tmp_path)
        html = (write_report(plan, tmp_path) / "report.html").read_text()
        head = re.findall(r'<th scope="col" class="number" data-name="([^"]*)"', html.partition("</thead>")[0])
        assert head == (["seconds", "relative gap"] if len(columns) == 2 else ["relative gap", "seconds"])
        assert html.count('<td class="number" data-name="seconds"') == 3


def _lose(results: Path, plan: Any, kind: str, failure: str) -> None:
    """Leave no result of a kind, and of the solvers when it is one before them; its event says why."""
    for node in plan.stored:
        if node.kind == kind or (node.kind in ("solver", "figure") and kind == "operator"):
            shutil.rmtree(store.result_folder(results, node.kind, node.key))
            event_path(results, node.kind, node.key).unlink()
            if node.kind == kind:
                store.write_text(event_path(results, kind, node.key), json.dumps({"failure": failure}))


def test_a_row_that_a_stage_before_it_stopped_says_which_and_why(tmp_path: Path) -> None:
    plan = plan_of(sweep(3), tmp_path)
    fill(plan, tmp_path)
    _lose(tmp_path, plan, "operator", "MemoryError: 3 GB")
    assert {(row.failure, row.state) for row in rows_of(plan, tmp_path)} == {
        ("operator/fem: MemoryError: 3 GB", "failed")
    }
    html = (write_report(plan, tmp_path) / "report.html").read_text()
    assert "<b>Failed:</b> operator/fem: MemoryError: 3 GB (3 times)" in html and html.count("<b>failed</b>") == 3
    assert f"· {len(plan.stored) - 4} of {len(plan.stored)} stages computed" in html


def test_a_row_that_was_never_run_is_not_called_failed(tmp_path: Path) -> None:
    plan = plan_of(sweep(3), tmp_path)
    html = (write_report(plan, tmp_path) / "report.html").read_text()
    assert "<b>Without a result:</b> not computed (3 times)" in html and html.count("<b>not computed</b>") == 3
    assert "ailed" not in html.partition("<main>")[2]


def test_a_figure_that_failed_is_named(tmp_path: Path) -> None:
    plan = plan_of({**sweep(3), "figures": [{"name": "denoising"}]}, tmp_path)
    fill(plan, tmp_path)
    assert 'role="alert"' not in (write_report(plan, tmp_path) / "report.html").read_text()
    _lose(tmp_path, plan, "figure", "ValueError: no light")
    html = (write_report(plan, tmp_path) / "report.html").read_text()
    assert "figure/denoising: ValueError: no light (3 times)" in html


def test_pictures_of_an_earlier_plan_go_and_those_of_a_person_stay(tmp_path: Path) -> None:
    plan = plan_of({**sweep(3), "figures": [{"name": "denoising"}]}, tmp_path)
    fill(plan, tmp_path)
    figures = tmp_path / "synthetic" / "figures"
    figures.mkdir(parents=True)
    kept = {"mine.png", "my-drawing.svg", "notes.txt"}
    gone = {"flow-0123abcd.png", "cost-1.svg", "ranking-3-0.svg", "search.svg", "search.png"}
    for name in kept | gone:
        (figures / name).write_text("")
    write_report(plan, tmp_path)
    left = {file.name for file in figures.iterdir()}
    assert not left & gone and kept < left and len(left - kept) == 3


def test_seconds_of_a_quick_stage_are_not_zero_in_the_table_of_all_numbers() -> None:
    leaf = Leaf("key", "configuration", {"target": "solver", "comparison": ""})
    table = to_csv([Row(leaf, {"solver.name": "a"}, {}, seconds) for seconds in (0.00025, 1234.5, None)])
    assert [line["seconds"] for line in csv.DictReader(table.splitlines())] == ["0.00025", "1234.5", ""]
