"""Experiments from a notebook: run one, and read its rows, figures and arrays."""

from __future__ import annotations

import subprocess
import sys
import warnings
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from surfexp.contract.summary import Summarized, Summary
from surfexp.extras import require_installed

# exit code of `surfexp run` where a row did not converge
UNCONVERGED = 3
LABORATORY = ("hydra", "snakemake", "mlflow", "pydantic", "pandas")


@dataclass(frozen=True, eq=False, repr=False)
class ExperimentRun(Summarized):
    """The results of an experiment.

    Parameters
    ----------
    name : str
    table : pandas.DataFrame
        One row a configuration, indexed by the key of its result: `comparison`, parameters (`solver.name`, `model.weight`,
        ...), metrics, `seconds`, `notes`, `failure` (empty where there is none).
    figures : dict of str to Path
        Finished pictures by the name of their file.
    folder : Path
        Where `report.html` is.
    _kinds : dict of str to str
        Stage kind of each row by its key.
    """

    name: str
    table: Any
    figures: dict[str, Path]
    folder: Path
    _kinds: dict[str, str]

    def _summary(self) -> Summary:
        failed = int((self.table["failure"] != "").sum()) if "failure" in self.table else 0
        facts = {"rows": len(self.table), "failed": failed or None, "figures": len(self.figures), "folder": self.folder}
        return Summary(self.name, facts)

    def _repr_html_(self) -> str:
        return self._summary().table() + self.table._repr_html_()

    def result(self, key: str) -> Any:
        """Return the stored result of a row: a solution, eigenpairs, a statistic, ...

        Parameters
        ----------
        key : str
            From the index of `table`.

        Returns
        -------
        object
            Of the class that the kind of the row's stage declares.

        Raises
        ------
        ValueError
            If no row has this key, or its stage has not finished.
        """
        from surfexp.lab.store import store

        if key not in self._kinds:
            raise ValueError(f"{self.name!r} has no row {key!r}; table.index lists its {len(self._kinds)}")
        if not store.is_done(self.folder.parent, self._kinds[key], key):
            raise ValueError(f"row {key!r} of {self.name!r} is not finished: sx.run({self.name!r})")
        return store.load(self.folder.parent, self._kinds[key], key)

    def arrays(self, key: str) -> dict[str, Any]:
        """Return the arrays of the result of a row by name.

        Parameters
        ----------
        key : str
            From the index of `table`.

        Returns
        -------
        dict of str to array

        Raises
        ------
        ValueError
            As `result`.
        """
        import numpy as np

        found = vars(self.result(key))
        return {name: value for name, value in found.items() if isinstance(value, np.ndarray)}


def load(experiment: str, results: str | Path = "results") -> ExperimentRun:
    """Read what an experiment has found, as often as wanted; nothing is computed.

    Parameters
    ----------
    experiment : str
        Its name; the configuration that ran last is taken.
    results : path
        The folder of results.

    Returns
    -------
    ExperimentRun
        `table` (pandas), `figures`, `result(key)` and `arrays(key)`.

    Raises
    ------
    ImportError
        If the laboratory (Hydra, Snakemake, MLflow, pydantic, pandas) is not installed.
    ValueError
        If nothing was run under this name.

    Examples
    --------
    >>> import surfexp as sx
    >>> sx.load("quickstart", results="nowhere")
    Traceback (most recent call last):
    ...
    ValueError: unknown finished experiment in nowhere 'quickstart'; choose from: none
    """
    require_installed("sx.load", *LABORATORY)
    from surfexp.lab.errors import UserError
    from surfexp.lab.plan.kinds_of_plans import load_known_kinds
    from surfexp.lab.plan.plan import latest_plan
    from surfexp.records.table import in_tables, rows_of

    root = Path(results).resolve()
    try:
        plan = latest_plan(Path(results), experiment)
    except UserError as error:
        raise ValueError(str(error)) from None
    load_known_kinds(plan)  # a plugin may declare a stage kind of its own
    folder = root / experiment
    figures = {file.stem: file for file in sorted((folder / "figures").glob("*.[ps][nv]g"))}
    kinds = {leaf.key: plan.nodes[leaf.key].kind for leaf in plan.leaves}
    return ExperimentRun(experiment, _frame(in_tables(rows_of(plan, root))), figures, folder, kinds)


def run(experiment: str, results: str | Path = "results", **overrides: Any) -> ExperimentRun:
    """Run an experiment, in a process of its own, and read its results; what is there already is not computed again.

    A row that did not converge, or whose gap is over its bound, is a warning.

    Parameters
    ----------
    experiment : str
        A name that `surfexp list experiment` shows.
    results : path
        The folder of results.
    **overrides
        As on the command line: `solver="newton"`, `cores=2`, and with dots in a dict, `**{"solver.tolerance": 1e-5}`.
        A list is a sweep.

    Returns
    -------
    ExperimentRun
        As `load`.

    Raises
    ------
    ImportError
        If the laboratory (Hydra, Snakemake, MLflow, pydantic, pandas) is not installed.
    ValueError
        If the request is wrong.
    RuntimeError
        If a stage fails; results that others gave are kept.

    Examples
    --------
    >>> import surfexp as sx
    >>> sx.run("quickstrat")
    Traceback (most recent call last):
    ...
    ValueError: unknown experiment 'quickstrat'; did you mean 'quickstart'?
    """
    require_installed("sx.run", *LABORATORY)
    arguments = [f"experiment={experiment}", f"results={results}"]
    arguments += [f"{name}={_written(value)}" for name, value in overrides.items()]
    command = [sys.executable, "-P", "-m", "surfexp.commands.command_line", "run", *arguments]
    done = subprocess.run(  # noqa: S603, this interpreter, this package, no shell
        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    said = [line.removeprefix("surfexp: ") for line in done.stderr.splitlines() if line.startswith("surfexp: ")]
    for line in said if done.returncode == UNCONVERGED else ():
        warnings.warn(line.removeprefix("warning: "), stacklevel=2)
    if done.returncode not in (0, UNCONVERGED):
        kind = ValueError if done.returncode == 2 else RuntimeError
        raise kind("\n".join(said) or f"surfexp run ended with exit code {done.returncode}")
    return load(experiment, results)


def _written(value: Any) -> str:
    if isinstance(value, bool) or value is None:
        return "null" if value is None else str(value).lower()
    return ",".join(map(_written, value)) if isinstance(value, list) else str(value)


def _frame(rows: list[Any]) -> Any:
    pandas: Any = import_module("pandas")
    records = [
        {"comparison": row.leaf.settings["comparison"], **row.parameters, **row.metrics}
        | {"seconds": row.seconds, "notes": "; ".join(row.notes), "failure": row.failure}
        for row in rows
    ]
    keys = pandas.Index([row.leaf.key for row in rows], name="key")
    return pandas.DataFrame(records, index=keys)
