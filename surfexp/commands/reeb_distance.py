"""`surfexp reeb-distance`: how far apart the Reeb graphs of maps on two surfaces are."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from surfexp.commands.certificate import Inputs
from surfexp.commands.click_command import shown
from surfexp.commands.given_maps import map_of
from surfexp.commands.given_surfaces import notes_of, surface_of
from surfexp.commands.skeleton import level_options
from surfexp.commands.surface_options import repair_option, result_option
from surfexp.commands.surface_results import NOT_CERTIFIED, finish, ready
from surfexp.commands.terminal import echo

if TYPE_CHECKING:
    from surfexp.contract.arrays import Floats
    from surfexp.mesh.surface import Surface

AXES = ("x", "y", "z")
EXAMPLES = ("a.ply b.ply --map x", "scan.ply scan.ply --map first.csv --second-map again.csv --to space.npz")


@click.command(**shown("reeb-distance", *EXAMPLES))
@click.argument("first", type=click.Path())
@click.argument("second", type=click.Path())
@click.option("--map", "map_name", metavar="MAP", default="z", help="a file, a map of the surfaces, or x, y, z")
@click.option("--second-map", metavar="MAP", help="of SECOND, where it is another")
@level_options
@click.option("--effort", default=10_000, help="steps of each search")
@repair_option
@result_option(required=False)
def reeb_distance(
    first: str,
    second: str,
    map_name: str,
    second_map: str | None,
    count: int,
    levels: Any,
    persistence: float,
    effort: int,
    repair: bool,
    target: Path | None,
) -> int:
    """Bound the distance of the Reeb graphs of maps on two surfaces.

    Where the bounds meet, the distance is proved. --to writes the space that proves the upper bound, as .npz; it is checked.
    """
    from surfexp.skeleton.export import check_common_space_target
    from surfexp.tasks.reeb_distances import check_reeb_distance
    from surfexp.tasks.reeb_distances import reeb_distance as task
    from surfexp.tasks.skeletons import reeb_graph

    files = Inputs(first, second)
    surfaces = surface_of(first, repair), surface_of(second, repair)
    names = map_name, second_map or map_name
    maps = [_map(surface, name, files) for surface, name in zip(surfaces, names, strict=True)]
    if target is not None:
        ready(target, files, check_common_space_target)
    started = time.perf_counter()
    graphs = [
        reeb_graph(surface, values, count=count, levels=levels, persistence=persistence)
        for surface, values in zip(surfaces, maps, strict=True)
    ]
    found = task(*graphs, effort=effort)
    between = f"{found.upper:.6g} (proved)" if found.proved else f"{found.lower:.6g} to {found.upper:.6g} (not proved)"
    echo(f"distance {between}")
    notes = (*notes_of(first, second, *(graph.notes for graph in graphs)), *found.notes)
    if target is None:
        for note in notes:
            echo(note, err=True)
        return 0 if found.complete else NOT_CERTIFIED
    defects = check_reeb_distance(found, *graphs)
    facts = {name: getattr(found, name) for name in ("lower", "upper", "by_persistence", "proved", "complete")}
    facts |= {"checked": not defects, "seconds": time.perf_counter() - started}
    options = {"map": names[0], "second_map": names[1], "count": count, "levels": levels, "persistence": persistence}
    options |= {"effort": effort}
    read = notes_of(first, second, *(surface.notes for surface in surfaces))
    method = "distance of Reeb graphs"
    code = finish(target, found.space, None, method, options, files, facts, (*notes, *defects), read)
    return NOT_CERTIFIED if defects else code


def _map(surface: Surface, name: str, files: Inputs) -> Floats:
    """Return a map by its name or file, or a coordinate where there is neither."""
    if name in AXES and name not in surface.scalars and not Path(name).exists():
        return surface.mesh.vertices[:, AXES.index(name)]
    return map_of(surface, name, files, None)
