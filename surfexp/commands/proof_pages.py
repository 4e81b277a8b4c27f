"""The page that proves the result of a command where it is read."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from surfexp.commands.certificate import Inputs
from surfexp.commands.surface_results import ready
from surfexp.commands.terminal import echo

if TYPE_CHECKING:
    from surfexp.contract.arrays import Floats
    from surfexp.mesh.surface import Surface


def ready_proof(path: Path | None, files: Inputs) -> None:
    """Refuse a page that cannot be written, before anything is computed."""
    if path is not None:
        from surfexp.tasks.proving import check_proof_target

        ready(path, files, check_proof_target)


def ready_proof_of(path: Path | None, files: Inputs, surface: Surface, *maps: Floats, **numbers: int) -> None:
    """Refuse also one that would be too large for a surface, by the numbers that `check_proof_size` takes."""
    ready_proof(path, files)
    if path is not None:
        from surfexp.tasks.proving import check_proof_size

        check_proof_size(surface, *maps, **numbers)


def save_proof(path: Path | None, result: Any, *surfaces: Any) -> None:
    """Write the page of a result, where one was asked for: last, since a result that has none is a result all the same."""
    if path is not None:
        from surfexp.tasks.proving import proof_page

        proof_page(result, *surfaces).save(path)
        echo(f"{path}: open it in any browser, it computes the certificate again")
