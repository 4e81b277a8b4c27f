"""Tables of rows: a row that several tables ask for stands in each."""

from __future__ import annotations

from pathlib import Path

import pytest

from surfexp.lab.errors import UserError
from surfexp.lab.experiment.configuration import expand
from surfexp.lab.plan.plan import read_plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry.loading import load_all
from surfexp.records.comparison import comparisons
from surfexp.records.leaf_run import names_of_runs
from surfexp.records.table import rows_of, to_csv
from surfexp.report.declared import check_names

load_all(Path("/nonexistent"))


def test_a_row_that_two_tables_ask_for_stands_in_both(tmp_path: Path) -> None:
    sizes = [
        {"comparison": "one", "grid": {"surface.levels": [1, 2]}},
        {"comparison": "two", "columns": ["area"], "grid": {"surface.levels": [3, 2, 4]}},
    ]
    context = {"target": "surface", "experiment": "balls", "surface": {"name": "icosphere"}, "variants": sizes}
    written = make_plan(expand(context))
    plan = read_plan(written.write(tmp_path))
    rows = rows_of(plan, tmp_path)
    shown = {group.title: group.rows for group in comparisons(rows)}
    levels = {title: [row.parameters["surface.levels"] for row in some] for title, some in shown.items()}
    assert levels == {"one": [1, 2], "two": [3, 2, 4]} and len(rows) == 4
    assert [row.leaf.settings["columns"] for row in shown["two"]] == [["area"]] * 3
    table = [line.split(",")[:2] for line in to_csv(rows).splitlines()[1:]]
    assert [title for title, _ in table] == ["one", "one", "two", "two", "two"] and table[1][1] == table[3][1]
    names = names_of_runs(plan)
    assert len(names) == 4 and names[rows[1].leaf.key].endswith("one")


def test_a_row_of_two_tables_is_refused_for_columns_of_either(tmp_path: Path) -> None:
    tables = [{"comparison": "one"}, {"comparison": "two", "columns": ["arae"]}]
    context = {"target": "surface", "experiment": "ball", "surface": {"name": "icosphere"}, "variants": tables}
    with pytest.raises(UserError, match=r"'arae'.*area"):
        check_names(make_plan(expand(context)))
