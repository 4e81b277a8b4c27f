"""How the result of a command on surfaces leaves: refused before it is computed, or written with its certificate."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from surfexp.commands.certificate import Inputs, write_certificate
from surfexp.commands.terminal import echo

if TYPE_CHECKING:
    from surfexp.contract.arrays import Floats
    from surfexp.mesh.surface import Surface

NOT_CERTIFIED = 3


def ready(target: Path, files: Inputs, check: Callable[..., None], **wanted: Any) -> None:
    """Refuse a result that cannot be written, or would overwrite what it is made of, before anything is computed.

    Parameters
    ----------
    target : Path
    files : Inputs
    check : callable
        Refuses targets of the kind of the result.
    **wanted
        What `check` has to know of the result beside the target.

    Raises
    ------
    ValueError
        Naming what is wrong with the target.
    """
    from surfexp.io.hemisphere import written_files

    check(target, **wanted)
    for file in written_files(target, wanted.get("hemisphere") or ""):
        files.refuse_to_overwrite(file)


def ready_map(target: Path, files: Inputs, surface: Surface, *maps: Any, **wanted: Any) -> None:
    """Refuse a file that maps on a surface, NaN where it has no vertex or a map no value, cannot be written to, as `ready`."""
    import numpy as np

    from surfexp.tasks.written_targets import check_target

    outside = surface.mask is not None and not surface.mask.all()
    faces_at = np.bincount(surface.mesh.faces.ravel(), minlength=len(surface.mesh.vertices))
    unknown = outside or not faces_at.all() or any(np.isnan(values).any() for values in maps)
    ready(target, files, check_target, hemisphere=surface.hemisphere, unknown=unknown, **wanted)


def named_as(maps: dict[str, Floats], values: Floats, target: Path) -> dict[str, Floats]:
    """Give the columns of a result the names of the maps that it was made of, where its format has room.

    A colour is rounded to whole numbers from 0 to 255 in PLY, and a line says so.
    """
    import numpy as np

    from surfexp.mesh.vertex_colours import NAMES

    if len(maps) == 1 and next(iter(maps)) in NAMES and target.suffix.lower() == ".ply" and np.isfinite(values).all():
        values = np.clip(np.rint(values), 0.0, 255.0)
        echo(f"{target.name}: colours are rounded to whole numbers from 0 to 255, as viewers read them.", err=True)
    if len(maps) == 1 or not has_room_for_names(target):
        return {next(iter(maps)): values}
    widths = [1 if part.ndim == 1 else part.shape[1] for part in maps.values()]
    parts = np.split(values, np.cumsum(widths)[:-1], axis=1)
    return {name: part[:, 0] if part.shape[1] == 1 else part for name, part in zip(maps, parts, strict=True)}


def has_room_for_names(target: Path) -> bool:
    """Whether the format of a file holds several maps by name, alone or beside their surface."""
    from surfexp.io.writing import WITH_MAPS
    from surfexp.io.written_maps import holds_names

    return holds_names(target) or target.suffix.lower() in WITH_MAPS


def files_made(target: Path, result: Any, surface: Surface | None = None) -> str:
    """Name the files that a result was written to."""
    from surfexp.tasks.written_files import places

    return " and ".join(map(str, places(target, result, surface)))


def finish(
    target: Path,
    result: Any,
    surface: Surface | None,
    method: str,
    options: dict[str, Any],
    files: Inputs,
    facts: dict[str, Any],
    notes: tuple[str, ...] = (),
    read: tuple[str, ...] | None = None,
) -> int:
    """Write a result with its certificate, and say both in one line.

    Parameters
    ----------
    target : Path
    result : object
    surface : Surface, optional
        That on whose vertices the result is.
    method : str
    options, files, facts
        Of the certificate.
    notes : tuple of str
        Of the result: they are said, and in the certificate.
    read : tuple of str, optional
        Of the surfaces that it is made of, default that one: they were said when those were read, and are in the certificate.

    Returns
    -------
    int
        3 where the certificate says that something did not converge or is not proved complete, else 0.
    """
    from surfexp.tasks.written_files import written

    notes = (*notes, *written(target, result, surface))
    if read is None:
        read = surface.notes if surface is not None else ()
    said = tuple(dict.fromkeys((*read, *notes)))
    certificate = write_certificate(target, method, options, files, facts, said)
    for note in notes:
        echo(note, err=True)
    shown = ", ".join(f"{name} {_short(value)}" for name, value in facts.items() if value is not None)
    echo(f"{files_made(target, result, surface)}: {shown} (certificate: {certificate.name})")
    return NOT_CERTIFIED if facts.get("converged") is False or facts.get("complete") is False else 0


def _short(value: Any) -> str:
    return f"{value:.3g}" if isinstance(value, float) else str(value)
