"""The page that proves the result of a command where it is read."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from surfexp.commands.certificate import Inputs
from surfexp.commands.surface_results import ready
from surfexp.commands.terminal import echo


def ready_proof(path: Path | None, files: Inputs) -> None:
    """Refuse a page that cannot be written, before anything is computed."""
    if path is not None:
        from surfexp.tasks.proving import check_proof_target

        ready(path, files, check_proof_target)


def save_proof(path: Path | None, result: Any, *surfaces: Any) -> None:
    """Write the page of a result, where one was asked for."""
    if path is not None:
        from surfexp.tasks.proving import proof_page

        proof_page(result, *surfaces).save(path)
        echo(f"{path}: open it in any browser, it computes the certificate again")
