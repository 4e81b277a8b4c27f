"""Files that are written to: what is refused before anything is computed, and what a format cannot hold."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.io.hemisphere import check_named_side, hemisphere_of_name, holds_hemisphere
from surfexp.io.replacing import check_writable
from surfexp.io.writing import ARCHIVE, WITH_MAPS, check_mesh_target, format_of
from surfexp.io.written_maps import check_map_target
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

LABEL_SUFFIXES = (".label.gii", ".annot")
# of an edge, by rounding
LARGEST_CHANGE = 1e-3


def check_target(
    path: Path | str,
    count: int = 1,
    channels: int = 1,
    hemisphere: str | None = None,
    labels: bool = False,
    unknown: bool = False,
) -> None:
    """Refuse a file that maps on a surface cannot be written to, before anything is computed.

    Parameters
    ----------
    path : path
    count, channels : int
        Of the maps.
    hemisphere : {"", "left", "right", "both"}, optional
        Of the maps; None if it is not known yet.
    labels : bool
        Whether formats of labels are among those that are known.
    unknown : bool
        Whether the maps are NaN somewhere.

    Raises
    ------
    ValueError
        If the format is unknown or too narrow, the folder is missing, or it cannot be written to.
    """
    target = Path(path)
    if target.suffix.lower() in WITH_MAPS or (labels and target.name.endswith(LABEL_SUFFIXES)):
        check_named_side(target, hemisphere or "")
        check_writable(target)
    else:
        check_map_target(target, count, channels, hemisphere, unknown)


def check_surface_target(path: Path | str, hemisphere: str = "") -> None:
    """Refuse a file that a surface of a hemisphere cannot be written to.

    Raises
    ------
    ValueError
        As `check_mesh_target`, or if it is named as the other hemisphere.
    """
    check_mesh_target(path)
    check_named_side(Path(path), hemisphere)


def left_out(path: Path | str, surface: Surface) -> tuple[str, ...]:
    """Return what the format of a file cannot hold of a surface, one sentence each."""
    target = Path(path)
    if target.suffix.lower() == ARCHIVE:
        return ()
    maps = {} if target.suffix.lower() in WITH_MAPS else surface.scalars
    unit = _unit_read_back(target, surface)
    lost = [f"maps ({', '.join(maps)})"] if maps else []
    lost += [f"labels ({', '.join(surface.labels)})"] if surface.labels else []
    lost += ["mask"] if surface.mask is not None else []
    lost += [f"unit ({surface.unit})"] if surface.unit and not unit else []
    said = [f"{target.name} does not hold {' and '.join(lost)} of the surface: left out."] if lost else []
    if unit and surface.unit not in ("", unit):
        said.append(
            f"{target.name} is read in {unit}, the surface is in {surface.unit}: give unit={surface.unit!r} where it is read."
        )
    if target.suffix.lower() == ".stl":
        said.append(f"{target.name} holds no numbers of vertices: maps of the surface do not fit what is read from it.")
    moved = surface.frame.lost_in(format_of(target))
    rounded = _rounded(target, surface.mesh)
    return (*said, *rounded, *side_left_out(target, surface.hemisphere), *([moved] if moved else []))


def _unit_read_back(target: Path, surface: Surface) -> str:
    """The unit that `surfexp.read` finds in a file: that of a scanner's space in FreeSurfer's, of a hemisphere in GIFTI."""
    known = {
        "FreeSurfer": bool(surface.frame.volume),
        "GIFTI": bool(surface.hemisphere or surface.frame.metadata.get("AnatomicalStructurePrimary")),
    }
    return "mm" if known.get(format_of(target)) else ""


def _rounded(target: Path, mesh: TriangleMesh) -> tuple[str, ...]:
    """Say by how much a format of single precision changes edges, where it is more than a thousandth of one."""
    if format_of(target) not in ("FreeSurfer", "GIFTI", ".stl"):
        return ()
    starts, ends = (mesh.vertices[mesh.edges[:, k]] for k in (0, 1))
    moved = (ends.astype(np.float32) - ends) - (starts.astype(np.float32) - starts)
    lengths = np.linalg.norm(ends - starts, axis=1)
    shares = np.linalg.norm(moved, axis=1)[lengths > 0] / lengths[lengths > 0]
    largest = float(shares.max(initial=0.0))
    if largest <= LARGEST_CHANGE:
        return ()
    return (
        f"{target.name} is in single precision: edges change by up to {largest:.1%} of their length; move the surface to the "
        "origin, or write .ply, .vtp or .npz.",
    )


def side_left_out(target: Path, side: str) -> tuple[str, ...]:
    """Say that neither a file nor its name holds the hemisphere, where it does not."""
    if not side or holds_hemisphere(target) or hemisphere_of_name(target.name) == side:
        return ()
    return (f"{target.name} does not say the {side} hemisphere: a name that begins with {side[0]}h. would.",)
