"""Files that are written to: what is refused before anything is computed, and what a format cannot hold."""

from __future__ import annotations

from pathlib import Path

from surfexp.io.hemisphere import check_named_side, hemisphere_of_name, holds_hemisphere
from surfexp.io.replacing import check_writable
from surfexp.io.writing import ARCHIVE, WITH_MAPS, check_mesh_target, format_of
from surfexp.io.written_maps import check_map_target
from surfexp.mesh.surface import Surface

LABEL_SUFFIXES = (".label.gii", ".annot")


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
    lost = [f"maps ({', '.join(maps)})"] if maps else []
    lost += [f"labels ({', '.join(surface.labels)})"] if surface.labels else []
    lost += ["mask"] if surface.mask is not None else []
    said = [f"{target.name} does not hold {' and '.join(lost)} of the surface: they are left out."] if lost else []
    moved = surface.frame.lost_in(format_of(target))
    return (*said, *side_left_out(target, surface.hemisphere), *([moved] if moved else []))


def side_left_out(target: Path, side: str) -> tuple[str, ...]:
    """Say that neither a file nor its name holds the hemisphere, where it does not."""
    if not side or holds_hemisphere(target) or hemisphere_of_name(target.name) == side:
        return ()
    return (f"{target.name} does not say the {side} hemisphere: a name that begins with {side[0]}h. would.",)
