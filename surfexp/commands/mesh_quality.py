"""`surfexp check` and `surfexp repair`: the defects of mesh files, and meshes without them."""

from __future__ import annotations

from pathlib import Path

import click

from surfexp.commands.certificate import Inputs, write_certificate
from surfexp.commands.click_command import shown
from surfexp.commands.surface_results import files_made, ready
from surfexp.commands.terminal import echo

DEFECTIVE = 2
EXPERIMENTS = (".yaml", ".yml")


@click.command(**shown("check", "scan.ply", "conf/experiment/mine.yaml"))
@click.argument("files", nargs=-1, required=True, type=click.Path())
def check(files: tuple[str, ...]) -> int:
    """Name the defects of mesh files, or the first mistake of experiment files.

    An experiment is a file .yaml. The exit code is 2 where something is wrong.
    """
    from surfexp.tasks.repairing import check as task
    from surfexp.tasks.stored_surface import stored_surface

    sound = True
    for file in files:
        if Path(file).suffix in EXPERIMENTS:
            from surfexp.commands.experiment_check import check_experiment

            echo(check_experiment(Path(file)))
            continue
        if Path(file).is_dir():
            sound = False
            echo(f"{file} is a folder: name its files, as {file.rstrip('/')}/*")
            continue
        try:
            found = stored_surface(file)
        except ValueError as error:
            sound = False
            echo(str(error))
            continue
        report = task(found)
        sound &= report.ok
        echo(
            "\n  ".join(
                [f"{file}: {len(found.vertices)} vertices, {len(found.faces)} faces", *found.notes, *report.lines()]
            )
        )
    return 0 if sound else DEFECTIVE


@click.command(**shown("repair", "scan.ply --to sound.ply", "scan.obj --largest-component --to sound.ply"))
@click.argument("file", type=click.Path())
@click.option("--largest-component", is_flag=True, help="keep the component of largest area only")
@click.option("--renumber", is_flag=True, help="drop vertices without faces; without it all keep their numbers")
@click.option("--hemisphere", type=click.Choice(["left", "right"]), help="overrides what the file says")
@click.option("--to", "target", type=click.Path(path_type=Path), required=True, help="result; the suffix decides")
def repair(file: str, largest_component: bool, renumber: bool, hemisphere: str | None, target: Path) -> None:
    """Repair the defects of a mesh and name each change.

    Maps are taken along where the format of the result holds some. Vertices keep their numbers, so that maps beside FILE fit;
    copies of vertices that are split stand behind all others.
    """
    import numpy as np

    from surfexp.tasks.repairing import repair as task
    from surfexp.tasks.stored_surface import stored_surface
    from surfexp.tasks.written_files import written
    from surfexp.tasks.written_targets import check_surface_target

    files = Inputs(file)
    found = stored_surface(file, hemisphere or "")
    ready(target, files, check_surface_target, hemisphere=found.hemisphere)
    surface = task(found, largest_component=largest_component, renumber=renumber)
    mesh, changes = surface.mesh, surface.notes
    lost = written(target, surface)
    facts = {"vertices": len(mesh.vertices), "faces": len(mesh.faces), "changes": len(changes)}
    proof = write_certificate(
        target, "repair", {"largest_component": largest_component, "renumber": renumber}, files, facts, changes
    )
    echo("\n".join(f"repaired: {change}" for change in changes) or f"{file}: nothing to repair")
    echo(
        f"{files_made(target, surface)}: {len(mesh.vertices)} vertices, {len(mesh.faces)} faces (certificate: {proof.name})"
    )
    loose = len(mesh.vertices) - len(np.unique(mesh.faces))
    if loose:
        echo(f"{loose} vertices have no face and keep their numbers: --renumber drops them.")
    for note in lost:
        echo(note)
