"""The run of each row in the dashboard: read from its database without MLflow, which takes seconds to import."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

_RUNS = """
SELECT tags.value, runs.run_uuid FROM tags
JOIN runs ON runs.run_uuid = tags.run_uuid JOIN experiments ON experiments.experiment_id = runs.experiment_id
WHERE tags.key = 'leaf' AND experiments.name = ? AND runs.lifecycle_stage = 'active' ORDER BY runs.start_time
"""
_PLACES = "SELECT run_uuid, experiment_id FROM runs WHERE run_uuid LIKE ? || '%' AND lifecycle_stage = 'active' LIMIT 2"


def run_names(database: Path, experiment: str) -> dict[str, str]:
    """Return the name of the run of each leaf, by the key of the leaf.

    Whatever is wrong with the database, there are no runs then: pages do not depend on it.
    """
    return {str(leaf): str(run) for leaf, run in _asked(database, _RUNS, experiment)}


def run_place(database: Path, run: str) -> tuple[str, str] | None:
    """Return the number of the experiment of a run, and the run's whole name, from its first letters.

    None where no run, or more than one, begins with them.
    """
    found = _asked(database, _PLACES, run) if run.isalnum() else []
    return (str(int(found[0][1])), str(found[0][0])) if len(found) == 1 else None


def _asked(database: Path, question: str, value: str) -> list[tuple[str, str]]:
    try:
        with closing(sqlite3.connect(f"{database.resolve().as_uri()}?mode=ro", uri=True, timeout=1.0)) as connection:
            return connection.execute(question, (value,)).fetchall()
    except (sqlite3.Error, OSError):
        return []
