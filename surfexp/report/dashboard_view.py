"""How the dashboard shows an experiment: the columns that differ, the numbers of its tables, sorted by what is sought.

MLflow keeps such a view as a tag of the experiment, as its button "Share" does, and opens it by its name in the address.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from surfexp.records.comparison import Comparison
from surfexp.records.table import SECONDS

VIEW = "surfexp"
TAG = f"mlflow.sharedViewState.{VIEW}"
COMPARED = f"{TAG}-compared"
CURRENT = 'tags.`current` = "true"'
# beyond these a screen is too narrow
OPTIONS, NUMBERS = 6, 6
ROWS_DRAWN = 20


def dashboard_view(groups: Sequence[Comparison], objective: str | None = None) -> str:
    """Write the view of an experiment's tables.

    Parameters
    ----------
    groups : sequence of Comparison
        With the declarations of their metrics.
    objective : str, optional
        The metric that the experiment minimises: rows are sorted by it.

    Returns
    -------
    str
        JSON.
    """
    options = list(dict.fromkeys(name for group in groups for name in group.varying))[:OPTIONS]
    numbers = _numbers(groups)[:NUMBERS]
    if objective is not None and objective not in numbers:
        numbers = [objective, *numbers][:NUMBERS]
    directions = {name: _direction(groups, name) for name in numbers}
    sought = objective or next((name for name, better in directions.items() if better), None)
    ascending = sought is None or sought == objective or directions[sought] != "higher"
    columns = [*(f"metrics.`{name}`" for name in numbers), *(f"params.`{name}`" for name in options)]
    view: dict[str, Any] = {
        "searchFilter": CURRENT,
        "orderByKey": f"metrics.`{sought}`" if sought else "attributes.`Start Time`",
        "orderByAsc": ascending,
        "selectedColumns": columns,
        "columnOrder": columns,
        "runsHiddenMode": "FIRST_20_RUNS",
        "autoRefreshEnabled": False,
        **_charts(numbers),
    }
    return json.dumps(view, ensure_ascii=True)


def of_runs(view: str, runs: Sequence[str]) -> str:
    """The view of an experiment with some of its runs alone.

    Examples
    --------
    >>> of_runs('{"searchFilter": ""}', ["one", "two"])
    '{"searchFilter": "attributes.run_id IN (\'one\', \'two\')"}'
    """
    chosen = ", ".join(f"'{run}'" for run in runs)
    return json.dumps({**json.loads(view), "searchFilter": f"attributes.run_id IN ({chosen})"})


def _numbers(groups: Sequence[Comparison]) -> list[str]:
    """The metrics of the tables by the turn of their columns: the first of each table, then the second."""
    columns = [[name for name in group.metric_names if name != SECONDS] for group in groups]
    longest = max(map(len, columns), default=0)
    return list(dict.fromkeys(names[place] for place in range(longest) for names in columns if place < len(names)))


def _direction(groups: Sequence[Comparison], name: str) -> str:
    return next((better for group in groups if (better := group.meaning(name).better)), "")


def _charts(numbers: Sequence[str]) -> dict[str, Any]:
    """What the view of charts begins with: a table of what differs between the runs, then a bar chart of each number."""
    differs: dict[str, Any] = {
        "type": "DIFFERENCE",
        "chartName": "What differs",
        "compareGroups": ["Parameters", "Model metrics"],
        "showChangeFromBaseline": True,
        "showDifferencesOnly": True,
        "baselineColumnUuid": "",
    }
    bars = [{"type": "BAR", "metricKey": name} for name in numbers]
    shared = {"runsCountToCompare": ROWS_DRAWN, "deleted": False, "isGenerated": False}
    charts = [
        {"uuid": f"{VIEW}-{place}", "metricSectionId": f"{VIEW}-{section}", **chart, **shared}
        for place, (section, chart) in enumerate([("differs", differs), *(("numbers", bar) for bar in bars)])
    ]
    sections = [
        {
            "uuid": f"{VIEW}-{name}",
            "name": title,
            "columns": width,
            "display": True,
            "isReordered": True,
            "deleted": False,
        }
        for name, title, width in (("differs", "What differs", 1), ("numbers", "Numbers of the tables", 3))
    ]
    return {"compareRunCharts": charts, "compareRunSections": sections, "isAccordionReordered": True}
