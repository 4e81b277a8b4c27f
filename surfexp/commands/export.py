"""`surfexp export`: results of an experiment as files for other programs, as often as is asked."""

from __future__ import annotations

from pathlib import Path

import click

from surfexp.commands import choices
from surfexp.commands.click_command import results_option, shown
from surfexp.commands.terminal import echo
from surfexp.lab.errors import UserError

LINES_LEFT_OUT = 10


@click.command(
    **shown(
        "export",
        "quickstart --to exported",
        "quickstart --kind solver --kind surface --to exported",
        "quickstart --bundle",
    )
)
@click.argument("target", metavar="EXPERIMENT|RUN", shell_complete=choices.finished)
@click.option(
    "--to", "folder", type=click.Path(path_type=Path), help="folder of the files; made if not there  [default: export]"
)
@click.option(
    "--bundle", is_flag=True, help="write one .zip that surfexp rerun runs again; --to names it (surfexp[bundle])"
)
@click.option("--all", "everything", is_flag=True, help="every stored stage, not only the rows and what they stand on")
@click.option(
    "--kind",
    "kinds",
    multiple=True,
    shell_complete=choices.kind,
    help="only stages of this kind, wherever they stand; repeatable",
)
@click.option("--matrix-market", is_flag=True, help="write the matrices of operators as .mtx too")
@click.option(
    "--print",
    "for_print",
    is_flag=True,
    help="write plots as .pdf and as .png of 300 dots an inch too (surfexp[print])",
)
@results_option
def export(
    target: str,
    folder: Path | None,
    bundle: bool,
    everything: bool,
    kinds: tuple[str, ...],
    matrix_market: bool,
    for_print: bool,
    results: Path,
) -> int:
    """Write finished results as files for other programs.

    These are what the rows of the tables stand on: figures, surfaces, images, numbers.

    EXPERIMENT is a name, whose latest configuration is taken. RUN is one row of it: the key of its result (the column leaf
    of metrics.csv and the tag leaf in the dashboard; 8 digits are enough), or the id of an MLflow run.

    Surfaces become .vtp, which carries the maps exported with it, and .surf.gii where they are half of a brain; maps
    .shape.gii, labels .label.gii; eigenpairs, distances and solutions .npz; matrices SciPy's .npz; skeletons .vtk and
    .graphml; plots .svg too; all else .csv. Beside each FILE stands its certificate FILE.json; index.csv lists all files.
    """
    if bundle:
        return _bundled(results, target, folder, everything or bool(kinds))
    folder = folder or Path("export")
    from rich.progress import track

    from surfexp.commands.console import Console
    from surfexp.commands.exporting.folder import ExportFolder
    from surfexp.commands.exporting.selection import chosen_stages, find
    from surfexp.commands.exporting.stages import Export
    from surfexp.report.printing import require_printing

    if for_print:
        require_printing()
    plan, key = find(results, target)
    nodes = chosen_stages(plan, key, everything, kinds)
    with ExportFolder(folder) as destination:
        export = Export(plan, results, destination, matrix_market, for_print)
        console = Console(stderr=True)
        steps = track(
            export.stages(nodes), "export", len(nodes), console=console, disable=not console.is_terminal, transient=True
        )
        left_out = list(filter(None, steps))
        more = [f"and {len(left_out) - LINES_LEFT_OUT} more"] if len(left_out) > LINES_LEFT_OUT else []
        for line in [*left_out[:LINES_LEFT_OUT], *more]:
            echo(f"surfexp: left out: {line}", err=True)
        if not export.rows:
            return 1
        destination.publish(export.rows)
    for row in export.rows:
        echo(folder / row["file"])
    stages = len({row["key"] for row in export.rows})
    echo(f"{stages} of {len(nodes)} results in {len(export.rows)} files: {folder / 'index.csv'}", err=True)
    return 0


def _bundled(results: Path, target: str, file: Path | None, chosen: bool) -> int:
    """Write the bundle of an experiment."""
    import tempfile

    from surfexp.commands.bundling.contents import write_contents
    from surfexp.commands.bundling.crate import write_crate
    from surfexp.commands.exporting.selection import find
    from surfexp.extras import require_installed
    from surfexp.io.replacing import check_writable

    require_installed("surfexp export --bundle", "rocrate", "pyarrow")
    plan, key = find(results, target)
    if key or chosen:
        raise UserError("a bundle is of a whole experiment: name that, without --all and --kind")
    file = file or Path(f"{plan.settings.experiment}.crate.zip")
    check_writable(file)
    with tempfile.TemporaryDirectory(prefix=".bundle-", dir=results) as folder:
        facts = write_contents(plan, results, Path(folder))
        write_crate(Path(folder), file, facts)
    echo(file)
    echo(f"{len(plan.leaves)} rows in {file.stat().st_size / 1e6:.1f} MB; again: surfexp rerun {file}", err=True)
    return 0
