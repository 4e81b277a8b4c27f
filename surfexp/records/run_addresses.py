"""Where the dashboard shows the run of a row: read from its database without MLflow, which takes seconds to import."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

DASHBOARD = "http://127.0.0.1:5000"
_RUNS = """
SELECT tags.value, runs.experiment_id, runs.run_uuid FROM tags
JOIN runs ON runs.run_uuid = tags.run_uuid JOIN experiments ON experiments.experiment_id = runs.experiment_id
WHERE tags.key = 'leaf' AND experiments.name = ? AND runs.lifecycle_stage = 'active' ORDER BY runs.start_time
"""


def run_addresses(database: Path, experiment: str) -> dict[str, str]:
    """Return the address of the run of each leaf by its key, for as long as `surfexp ui` serves them.

    Whatever is wrong with the database, there are no addresses then: pages do not depend on it.
    """
    try:
        with closing(sqlite3.connect(f"{database.resolve().as_uri()}?mode=ro", uri=True, timeout=1.0)) as connection:
            found = connection.execute(_RUNS, (experiment,)).fetchall()
    except (sqlite3.Error, OSError):
        return {}
    return {str(leaf): f"{DASHBOARD}/#/experiments/{int(number)}/runs/{run}" for leaf, number, run in found}
