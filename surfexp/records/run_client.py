"""MLflow runs through its client alone: what `run_database` does, in many more transactions.

It takes the place of that where a version of MLflow has other tables.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from mlflow.entities import Dataset, DatasetInput, Metric, Param

from surfexp.records.run_content import LONGEST_PARAMETER, LONGEST_TAG, KnownRun, RunContent

PAGE = 1000
# the client's own limits of one call
METRICS_AT_ONCE, PARAMETERS_AT_ONCE = 1000, 100


def known_runs(client: Any, experiment: str, tags: Iterable[str]) -> list[KnownRun]:
    """The active runs of an experiment that have one of the tags, the latest first."""
    wanted = list(tags)
    runs: list[KnownRun] = []
    token = None
    while True:
        page = client.search_runs(
            [experiment], max_results=PAGE, order_by=["attributes.start_time DESC"], page_token=token
        )
        for run in page:
            found = {key: run.data.tags[key] for key in wanted if key in run.data.tags}
            runs += [KnownRun(run.info.run_id, run.info.status, found)] if found else []
        if not (token := page.token):
            return runs


def write_runs(client: Any, experiment: Any, contents: Iterable[tuple[str | None, RunContent]]) -> list[str]:
    """Write runs, each with the identity of the run that it takes the place of, which is deleted (None for a new one).

    Returns their identities.
    """
    written = []
    for identity, content in contents:
        kept: dict[str, str] = {}
        if identity is not None:  # parameters of a run can never be changed; a person's note on it stays
            kept = client.get_run(identity).data.tags
            client.delete_run(identity)
        written.append(_write(client, experiment.experiment_id, content, kept))
    return written


def _write(client: Any, experiment: str, content: RunContent, kept: Mapping[str, str]) -> str:
    start = int(time.time() * 1000)
    tags = {key: value[:LONGEST_TAG] for key, value in {**kept, **content.tags}.items()}
    run = client.create_run(experiment, start_time=start, tags=tags, run_name=content.name).info.run_id
    parameters = [Param(key, value[:LONGEST_PARAMETER]) for key, value in content.parameters.items()]
    metrics = [Metric(name, value, 0, step) for name, step, value in dict.fromkeys(content.series)]
    for first in range(0, len(parameters), PARAMETERS_AT_ONCE):
        client.log_batch(run, params=parameters[first : first + PARAMETERS_AT_ONCE])
    for first in range(0, len(metrics), METRICS_AT_ONCE):
        client.log_batch(run, metrics=metrics[first : first + METRICS_AT_ONCE])
    if content.datasets:
        data = [Dataset(one.name, one.digest, "local", one.source, profile=one.profile) for one in content.datasets]
        client.log_inputs(run, [DatasetInput(one) for one in data])
    client.set_terminated(run, content.status, end_time=start + round(1000.0 * content.seconds))
    return str(run)


def set_tag(client: Any, identities: Sequence[str], key: str, value: str) -> None:
    """Give a tag of several runs another value."""
    for identity in identities:
        client.set_tag(identity, key, value)


def relocate(client: Any, experiment: Any, location: str) -> None:
    """Nothing: artifacts of a folder that was moved stay where they were, for a client cannot tell them their new place."""
