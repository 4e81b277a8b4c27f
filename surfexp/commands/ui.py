"""`surfexp ui`: the MLflow dashboard on this machine."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from surfexp.commands.click_command import results_option, shown
from surfexp.commands.processes import end_session
from surfexp.lab.errors import UserError


@click.command(**shown("ui", "", "--port 5001", "3f2a91c0", "3f2a91c0 26a13223", cls=click.Command))
@click.argument("runs", metavar="[RUN]...", nargs=-1)
@click.option("--port", default=5000, help="port on this machine (loopback only)")
@results_option
def ui(runs: tuple[str, ...], port: int, results: Path) -> int:
    """Start the MLflow dashboard on this machine.

    It opens on the experiment that was recorded last, with RUN on this run, with several RUN on what differs between them. RUN
    is the name of a run or its first letters, as tables of a report have it, or the key of a row, as surfexp diff takes it. Ctrl-C
    ends it.
    """
    if not (results / "mlflow.db").exists():
        raise UserError(f"no runs are recorded in {results}; start with: surfexp run")
    _check_free(port)
    from mlflow.tracking import MlflowClient

    from surfexp.records.tracking import tracking_uri
    from surfexp.report.dashboard_view import VIEW

    client = MlflowClient(tracking_uri(results))
    places = [_place(client, name, results) for name in runs]
    if len(places) == 1:
        page = "experiments/{}/runs/{}?workflowType=machine_learning".format(*places[0])
    elif places:
        page = _compared(client, places)
    else:
        found = client.search_experiments(order_by=["last_update_time DESC"])
        experiment = next((item.experiment_id for item in found if item.name != "Default"), "0")
        page = f"experiments/{experiment}/runs?workflowType=machine_learning&viewStateShareKey={VIEW}"
    address = f"http://127.0.0.1:{port}/#/{page}"
    print(f"dashboard: {address}   (Ctrl-C ends it)", flush=True)
    server = [sys.executable, "-P", "-m", "mlflow", "server", "--host", "127.0.0.1", "--port", str(port)]
    environment = {**os.environ, "MLFLOW_SERVER_ENABLE_JOB_EXECUTION": "false", "MLFLOW_DISABLE_TELEMETRY": "true"}
    arguments = ["--backend-store-uri", tracking_uri(results), "--workers", "1"]
    return served([*server, *arguments], environment)


def _check_free(port: int) -> None:
    """Refuse a port that cannot be listened on; UserError."""
    try:
        with socket.socket() as trial:
            trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            trial.bind(("127.0.0.1", port))
    except (OSError, OverflowError) as error:
        reason = "0 to 65535" if isinstance(error, OverflowError) else error.strerror
        raise UserError(f"port {port}: {reason}; choose another one: surfexp ui --port {port % 60000 + 1}") from None


def _place(client: Any, name: str, results: Path) -> tuple[str, str]:
    """The number of the experiment of a run, and the run, by its name or by the key of its row."""
    from surfexp.commands.exporting.selection import find
    from surfexp.records.run_names import run_place

    if place := run_place(results / "mlflow.db", name):
        return place
    plan, key = find(results, name)
    experiment = client.get_experiment_by_name(plan.settings.experiment)
    found = client.search_runs([experiment.experiment_id], f"tags.leaf = '{key}'", max_results=1) if key else []
    if not found:
        raise UserError(f"{name!r} is no run: write its name, in the column run of a report, or the key of its row")
    return str(experiment.experiment_id), str(found[0].info.run_id)


def _compared(client: Any, places: Sequence[tuple[str, str]]) -> str:
    """The page that compares runs of one experiment; its view is kept as a tag of the experiment."""
    from surfexp.report.dashboard_view import COMPARED, TAG, of_runs

    numbers = {number for number, _ in places}
    if len(numbers) > 1:
        names = sorted(client.get_experiment(number).name for number in numbers)
        raise UserError(f"a comparison takes runs of one experiment: these are of {', '.join(names)}")
    tags = client.get_experiment(number := numbers.pop()).tags
    client.set_experiment_tag(number, COMPARED, of_runs(tags.get(TAG, "{}"), [run for _, run in places]))
    view = f"compareRunsMode=CHART&viewStateShareKey={COMPARED.rpartition('.')[2]}"
    return f"experiments/{number}/runs?workflowType=machine_learning&{view}"


def served(command: list[str], environment: dict[str, str]) -> int:
    """Run a server until it ends, or this process is told to; nothing that the server has started is left."""
    with subprocess.Popen(  # noqa: S603, this interpreter, a path and a port, no shell
        command, env=environment, start_new_session=True
    ) as process:
        try:
            return process.wait()
        finally:
            end_session(process)
