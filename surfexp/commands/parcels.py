"""`surfexp parcels`: a map by parcels, as a table."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from surfexp.commands.click_command import shown
from surfexp.commands.given_maps import given_maps, shown_labels
from surfexp.commands.given_surfaces import opened
from surfexp.commands.surface_options import surface_options
from surfexp.commands.surface_results import files_made, has_room_for_names, ready_map
from surfexp.commands.table_file import ready_table
from surfexp.commands.terminal import echo

EXAMPLES = (
    "lh.white lh.thickness lh.aparc.annot --to thickness.csv",
    "lh.white+rh.white myelin.dscalar.nii lh.aparc.annot+rh.aparc.annot --to myelin.csv --means myelin-means.dscalar.nii",
)


@click.command(**shown("parcels", *EXAMPLES))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("map_name", metavar="MAP", type=click.Path())
@click.argument("labels", metavar="LABELS", type=click.Path())
@click.option("--means", type=click.Path(path_type=Path), metavar="FILE", help="write the mean of each parcel as a map")
@surface_options
@click.option("--to", "target", type=click.Path(path_type=Path), required=True, help="table, .csv")
def parcels(path: str, map_name: str, labels: str, means: Path | None, target: Path, **given: Any) -> None:
    """Write the mean and median of a map in each parcel, weighted by area.

    MAP is a file, or a map that the surface carries. LABELS is .annot, .label.gii or .dlabel.nii. The table has the area of each
    parcel, how many vertices it has, and the share of its area where the map is NaN.
    """
    from surfexp.commands.certificate import write_certificate
    from surfexp.io.map_files import side_by_side
    from surfexp.io.map_shapes import scalar_channels
    from surfexp.tasks.parcellation import parcels as task
    from surfexp.tasks.written_files import written

    surface, files = opened(path, **given)
    read = given_maps(surface, map_name, files, given["hemisphere"])
    values = side_by_side(read, map_name)
    table = shown_labels(surface, labels, files, given["hemisphere"])
    if table is None:
        raise ValueError(f"{labels} is no file of labels, give .annot, .label.gii or .dlabel.nii")
    ready_table(target, files, "--to")
    channels = 1 if values.ndim == 1 else values.shape[1]
    if means is not None:
        ready_map(means, files, surface, channels=channels)
    found = replace(task(surface, values, table), channels=tuple(scalar_channels(read)) if len(read) > 1 else ())
    from surfexp.io.csv_cells import write_columns

    write_columns(target, found.table())
    notes = found.notes
    if means is not None:
        notes += written(means, found.named("mean") if has_room_for_names(means) else {"mean": found.values}, surface)
    facts = {"parcels": len(found.names), "area": float(found.areas.sum())}
    write_certificate(target, "means by area", {"labels": labels}, files, facts, notes)
    for note in notes:
        echo(note, err=True)
    echo(f"{target}: {len(found.names)} parcels of area {facts['area']:.4g} (certificate: {target.name}.json)")
    if means is not None:
        echo(f"{files_made(means, found.values, surface)}: the mean of each parcel")
