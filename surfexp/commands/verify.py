"""`surfexp verify`: hash every stored result again and name those that are damaged."""

from __future__ import annotations

from pathlib import Path

import click

from surfexp.commands.click_command import results_option, shown
from surfexp.commands.terminal import echo
from surfexp.lab.errors import StageFailure, UserError


@click.command(**shown("verify", "", "--results other/results", cls=click.Command))
@results_option
def verify(results: Path) -> None:
    """Check the hash of every stored result and name what is damaged.

    The whole store is read, whatever was verified before. The exit code is 1 if a result is not what was written.
    """
    from surfexp.lab.store.store import faults

    if not (results / "store").is_dir():
        raise UserError(f"{results} holds no stored results")
    folders = sorted(file.parent for file in (results / "store").glob("*/*/record.json"))
    found = faults(results, [(folder.parent.name, folder.name) for folder in folders], anew=True)
    echo(f"{len(folders) - len(found)} of {len(folders)} stored results are as they were written")
    if found:
        raise StageFailure(
            "\n".join(f"{fault}; the next run that needs it computes it again" for fault in found.values())
        )
