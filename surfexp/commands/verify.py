"""`surfexp verify`: hash every stored result again and name those that are damaged."""

from __future__ import annotations

from pathlib import Path

from surfexp.commands.parser import Parser
from surfexp.lab.errors import StageFailure, UserError
from surfexp.lab.store.store import faults


def command(name: str, arguments: list[str]) -> int:
    """Read the whole store, whatever was verified before; exit with 1 if a result is not what was written."""
    parser = Parser(f"surfexp {name}", description=__doc__)
    parser.add_argument("--results", type=Path, default=Path("results"), help="results folder")
    given = parser.parse_args(arguments)
    if not (given.results / "store").is_dir():
        raise UserError(f"{given.results} holds no stored results")
    folders = sorted(file.parent for file in (given.results / "store").glob("*/*/record.json"))
    found = faults(given.results, [(folder.parent.name, folder.name) for folder in folders], anew=True)
    print(f"{len(folders) - len(found)} of {len(folders)} stored results are as they were written")
    if found:
        raise StageFailure(
            "\n".join(f"{fault}; the next run that needs it computes it again" for fault in found.values())
        )
    return 0
