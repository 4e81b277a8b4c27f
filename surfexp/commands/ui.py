"""`surfexp ui`: the MLflow dashboard on this machine."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import click

from surfexp.commands.click_command import results_option, shown
from surfexp.commands.processes import end_session
from surfexp.lab.errors import UserError


@click.command(**shown("ui", "", "--port 5001", "3f2a91c0", cls=click.Command))
@click.argument("run", required=False, default="")
@click.option("--port", default=5000, help="port on this machine (loopback only)")
@results_option
def ui(run: str, port: int, results: Path) -> int:
    """Start the MLflow dashboard on this machine.

    RUN is the name of a run, or its first letters, as tables of a report have it. Ctrl-C ends it.
    """
    if not (results / "mlflow.db").exists():
        raise UserError(f"no runs are recorded in {results}; start with: surfexp run")
    from surfexp.records.run_names import run_page

    page = run_page(results / "mlflow.db", run) if run else ""
    if page is None:
        raise UserError(f"no run, or more than one, begins with {run!r}: its name is in the column run of a report")
    from mlflow.tracking import MlflowClient

    from surfexp.records.tracking import tracking_uri

    found = MlflowClient(tracking_uri(results)).search_experiments(order_by=["last_update_time DESC"])
    shown_first = next((item.experiment_id for item in found if item.name != "Default"), "0")
    view = "orderByKey=metrics.%60relative_gap%60&orderByAsc=true&searchFilter=tags.current%3D%22true%22"
    address = (
        f"http://127.0.0.1:{port}/?workflowType=machine_learning#/{page or f'experiments/{shown_first}/runs?{view}'}"
    )
    print(f"dashboard: {address}   (Ctrl-C ends it)", flush=True)
    server = [sys.executable, "-P", "-m", "mlflow", "server", "--host", "127.0.0.1", "--port", str(port)]
    environment = {**os.environ, "MLFLOW_SERVER_ENABLE_JOB_EXECUTION": "false", "MLFLOW_DISABLE_TELEMETRY": "true"}
    arguments = ["--backend-store-uri", tracking_uri(results), "--workers", "1"]
    return served([*server, *arguments], environment)


def served(command: list[str], environment: dict[str, str]) -> int:
    """Run a server until it ends, or this process is told to; nothing that the server has started is left."""
    with subprocess.Popen(  # noqa: S603, this interpreter, a path and a port, no shell
        command, env=environment, start_new_session=True
    ) as process:
        try:
            return process.wait()
        finally:
            end_session(process)
