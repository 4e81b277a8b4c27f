"""`surfexp upgrade`: experiments of an earlier version in the present spelling."""

from __future__ import annotations

from pathlib import Path

import click

from surfexp.commands.click_command import shown
from surfexp.commands.terminal import echo
from surfexp.lab.errors import UserError

EXAMPLES = ("conf/experiment/mine.yaml", "conf/experiment/*.yaml conf/axes/*.yaml --dry-run")
FORMER_FOLDER, FOLDER = "axes", "datasets"


@click.command(**shown("upgrade", *EXAMPLES, cls=click.Command))
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("--dry-run", is_flag=True, help="say what would be rewritten, and write nothing")
def upgrade(files: tuple[Path, ...], dry_run: bool) -> None:
    """Rewrite experiments of an earlier version in the present spelling.

    Only the entries that are written differently now are changed: comments and all other lines stay. A file of
    conf/axes moves to conf/datasets. A file that is up to date stays as it is.
    """
    from surfexp.io.replacing import replacing
    from surfexp.lab.experiment.upgrade import upgraded
    from surfexp.lab.experiment.yaml_files import read_yaml

    for file in files:
        if not file.is_file():
            raise UserError(f"file {str(file)!r} does not exist")
        read_yaml(file)
        of_datasets = file.resolve().parent.name in (FORMER_FOLDER, FOLDER)
        text = file.read_text(encoding="utf-8")
        new, target = upgraded(text, of_datasets), _place(file)
        if new == text and target == file:
            echo(f"{file}: up to date")
            continue
        if target != file and target.exists():
            raise UserError(f"{file} belongs into {target}, which exists; remove one of them")
        if dry_run:
            echo(f"{file}: would be rewritten" + (f" as {target}" if target != file else ""))
            continue
        target.parent.mkdir(exist_ok=True)
        with replacing(target) as written:
            written.write_text(new, encoding="utf-8")
        if target != file:
            file.unlink()
        echo(f"{file}: rewritten" + (f" as {target}" if target != file else ""))


def _place(file: Path) -> Path:
    former = file.parent.name == FORMER_FOLDER
    return file.parent.parent / FOLDER / file.name if former else file
