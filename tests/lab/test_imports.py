"""What a command imports is what its user waits for: nothing heavy where it is not needed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

LABORATORY = {"matplotlib", "pandas", "sklearn", "statsmodels", "mlflow", "hydra", "snakemake"}
NUMERICS = {"numpy", "scipy", "numba"}


def loaded_by(statement: str, *, cwd: Path) -> set[str]:
    """Names of the outside packages that a statement imports, in a process of its own."""
    program = f"import sys, os\n{statement}\nos.write(2, ' '.join({{m.split('.')[0] for m in sys.modules}}).encode())"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=cwd)
    assert done.returncode == 0, done.stderr
    return set(done.stderr.split())


def call(*arguments: str) -> str:
    return f"from surfexp.commands.command_line import main; main({list(arguments)!r})"


def test_a_stage_imports_no_laboratory(tmp_path: Path) -> None:
    assert not loaded_by("import surfexp.lab.running.stage", cwd=tmp_path) & LABORATORY


def test_a_warm_process_imports_no_laboratory_but_what_plugins_need(tmp_path: Path) -> None:
    assert not loaded_by("import surfexp.lab.running.stage_server", cwd=tmp_path) & LABORATORY


@pytest.mark.parametrize(
    "arguments",
    [["list"], ["list", "solver"], ["info", "solver/primal_dual"], ["run", "--help"], ["run", "surface.szie=1"]],
    ids=" ".join,
)
def test_what_there_is_to_choose_from_is_shown_without_numerics(tmp_path: Path, arguments: list[str]) -> None:
    loaded_by(call(*arguments), cwd=tmp_path)  # describes the plugins, if nobody has
    assert not loaded_by(call(*arguments), cwd=tmp_path) & (LABORATORY | NUMERICS)


def test_a_plan_needs_no_pictures_and_no_records(tmp_path: Path) -> None:
    loaded = loaded_by(call("plan", "experiment=isospectral_drums"), cwd=tmp_path)
    assert not loaded & (LABORATORY - {"hydra"})


def test_a_request_that_was_planned_before_needs_neither_hydra_nor_plugins(tmp_path: Path) -> None:
    request = call("plan", "experiment=isospectral_drums")
    loaded_by(request, cwd=tmp_path)
    assert not loaded_by(request, cwd=tmp_path) & (LABORATORY | {"scipy", "numba"})


def test_what_a_run_with_nothing_to_do_imports(tmp_path: Path) -> None:
    modules = ("commands.request", "commands.execution", "commands.views", "report.convergence", "records.table")
    statement = f"import {', '.join(f'surfexp.{name}' for name in modules)}"
    assert not loaded_by(statement, cwd=tmp_path) & (LABORATORY | {"scipy", "numba"})
