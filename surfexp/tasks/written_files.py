"""Surfaces and results as files: the suffix decides about the format, and what it cannot hold is said."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.io.csv_cells import write_columns
from surfexp.io.hemisphere import check_named_side, files_of_sides, holds_both, written_files
from surfexp.io.label_colours import write_coloured_labels
from surfexp.io.npz import write_arrays
from surfexp.io.replacing import replacing
from surfexp.io.writing import WITH_MAPS, write_mesh
from surfexp.io.written_maps import write_maps
from surfexp.mesh.both_hemispheres import vertices_of
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_facts import SurfaceFacts
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.common_space import CommonSpace
from surfexp.skeleton.export import write_common_space, write_skeleton
from surfexp.skeleton.skeleton import Skeleton
from surfexp.tasks.given_labels import labels_of_array
from surfexp.tasks.given_map import as_map
from surfexp.tasks.given_surface import SurfaceLike, arrays_of, is_mesh
from surfexp.tasks.maps_of_result import maps_of
from surfexp.tasks.parcel_table import Parcels
from surfexp.tasks.written_targets import LABEL_SUFFIXES, left_out, side_left_out

# formats that hold a surface beside its maps; an archive holds either
SURFACES_WITH_MAPS = (".ply", ".vtk", ".vtp")
# of eigenpairs, and of aligned modes
OF_MODES = ("values", "vectors", "residuals", "basis")
IN_MICROMETRES = "{} is read in micrometres, the unit of the surface is not known: its lengths are as they are there."


def write(path: Path | str, what: Any, surface: SurfaceLike | None = None) -> None:
    """Write a surface, a map, labels, or a result; the suffix decides the format.

    A surface as .npz comes back from `read` with its maps, mask, labels, unit, hemispheres and the space of its vertices; what
    another format cannot hold of them is named in a warning, as is a unit that is read back as another, and rounding that moves
    an edge by over a thousandth. Maps that are written beside a surface are without its mask, labels and unit. Both hemispheres
    are one file as .npz, their maps also as .dscalar.nii; everything else becomes two, lh.NAME and rh.NAME.

    Parameters
    ----------
    path : path
    what : Surface, mesh, (n,) or (n, c) array, dict of name to array, LabelMap, Skeleton, or a result
        A mesh is a `TriangleMesh`, (vertices, faces), or an object that has both. Eigenpairs become maps "mode 0", "mode 1",
        ... and in .npz `values`, `vectors`, `residuals`; aligned modes "mode 1", ... and in .npz `vectors`, `basis`. Mode 0 is
        the constant one, and modes of a window keep their numbers. A skeleton is .graphml, .swc where it is a tree, .vtk or
        .ply. A result is a denoised map, a segmentation, ... A test is all its maps by name. Parcels are their table in .csv, and
        the map of their means elsewhere. The common space of two Reeb graphs is .npz.
    surface : Surface or mesh, optional
        Of the maps: for formats that hold the geometry beside them (.ply, .vtk, .vtp), and for the hemisphere. Where it was
        repaired, maps alone are written on the vertices of its file. Of a skeleton: an .swc file names its unit.

    Raises
    ------
    ValueError
        If the format is unknown or cannot hold the data, or the file is named as the other hemisphere.

    Examples
    --------
    >>> import surfexp as sx
    >>> sphere = sx.shape("icosphere", levels=2)
    >>> sx.write("height.shape.gii", sphere.mesh.vertices[:, 2], sphere)
    >>> sx.write("sphere.ply", (sphere.mesh.vertices, sphere.mesh.faces))
    """
    for note in written(path, what, surface):
        warnings.warn(note, stacklevel=2)


def written(path: Path | str, what: Any, surface: SurfaceLike | None = None) -> tuple[str, ...]:
    """Write as `write` does, and return what the format cannot hold, one sentence each.

    Raises
    ------
    ValueError
        As `write`.
    """
    if not isinstance(path, str | Path):
        raise ValueError(f"the target is a {type(path).__name__}, a path is needed first: sx.write(path, what)")
    target = Path(path)
    if isinstance(what, Skeleton):
        unit = surface.unit if isinstance(surface, Surface) else ""
        write_skeleton(target, what, unit)
        return () if unit or target.suffix != ".swc" else (IN_MICROMETRES.format(target.name),)
    if isinstance(what, CommonSpace):
        write_common_space(target, what)
        return ()
    if isinstance(what, Parcels) and target.suffix.lower() == ".csv":
        write_columns(target, what.table())
        return ()
    if surface is not None:
        if not is_mesh(surface):
            raise ValueError(f"surface is a {type(surface).__name__}: give write(path, map, surface), the surface last")
        if is_mesh(what) and what is not surface:
            raise ValueError("two surfaces are given: give write(path, surface), or write(path, map, surface)")
        surface = surface if isinstance(surface, Surface) else Surface(TriangleMesh(*arrays_of(surface)))
    both = what if isinstance(what, Surface) else surface
    if both is not None and both.right is not None and not holds_both(target):
        return _written_apart(target, what, both)
    if is_mesh(what):
        owner = what if isinstance(what, Surface) else Surface(TriangleMesh(*arrays_of(what)))
        if not len(owner.mesh.faces):
            raise ValueError(
                f"surface has {len(owner.mesh.vertices)} vertices and 0 faces, at least one face is needed"
            )
        scalars = owner.scalars if target.suffix.lower() in WITH_MAPS else {}
        facts = SurfaceFacts(owner.unit, owner.mask, owner.labels, owner.right)
        write_mesh(target, owner.mesh, scalars, owner.frame, owner.hemisphere, facts)
        return left_out(target, owner)
    side = surface.hemisphere if surface is not None else ""
    unsaid = side_left_out(target, side)
    table = _labels_for(target, what)
    if table is not None and (target.name.endswith(LABEL_SUFFIXES) or isinstance(what, LabelMap)):
        _check_rows(len(table.keys), surface, "labels")
        write_coloured_labels(target, replace(table, keys=_on_file(table.keys, surface)), side)
        return unsaid
    if hasattr(what, "vectors") and target.suffix.lower() == ".npz":
        check_named_side(target, side)
        arrays = {name: getattr(what, name) for name in OF_MODES if hasattr(what, name)}
        arrays["vectors"] = _on_file(arrays["vectors"], surface)
        with replacing(target) as temporary:
            write_arrays(temporary, arrays, _side_of_rows(surface))
        return unsaid
    maps = maps_of(what)
    for name, values in maps.items():
        _check_rows(len(values), surface, f"map {name!r}")
    if target.suffix.lower() not in SURFACES_WITH_MAPS:
        write_maps(target, {name: _on_file(values, surface) for name, values in maps.items()}, _side_of_rows(surface))
        return unsaid
    if surface is None:
        raise ValueError(
            f"{target} holds a surface beside its maps: give the surface, or choose .shape.gii, .npz, .csv"
        )
    beside = {name: as_map(surface, values) for name, values in maps.items()}
    write_mesh(target, surface.mesh, beside, surface.frame, side)
    return left_out(target, replace(surface, unit="", scalars={}, mask=None, labels={}))


def places(path: Path, what: Any, surface: Surface | None = None) -> tuple[Path, ...]:
    """Return the files that `write` makes: one for each hemisphere where there are both and the format holds one."""
    table = isinstance(what, Parcels) and path.suffix.lower() == ".csv"
    both = what if isinstance(what, Surface) else surface
    if both is None or table or isinstance(what, Skeleton | CommonSpace):
        return (path,)
    return written_files(path, both.hemisphere)


def _labels_for(target: Path, what: Any) -> LabelMap | None:
    """Return labels where they are given; for a file of labels those that an array of whole numbers or names is."""
    table = what if isinstance(what, LabelMap) else getattr(what, "label_map", None)
    array = getattr(what, "values", what)
    if (
        table is not None
        or not target.name.endswith(LABEL_SUFFIXES)
        or isinstance(array, Mapping)
        or not np.ndim(array)
    ):
        return table
    table = labels_of_array(array)
    # 0 is none, which an annotation writes for labels without a name
    return table if target.suffix != ".annot" else replace(table, keys=np.where(table.keys == 0, -1, table.keys))


def _written_apart(target: Path, what: Any, both: Surface) -> tuple[str, ...]:
    """Write each hemisphere to a file of its own."""
    check_named_side(target, both.hemisphere)
    table = _labels_for(target, what)
    said: list[str] = []
    for side, one in both.hemispheres().items():
        own = vertices_of(both, side)
        if is_mesh(what):
            part: Any = one
        elif table is not None and (target.name.endswith(LABEL_SUFFIXES) or isinstance(what, LabelMap)):
            _check_rows(len(table.keys), both, "labels")
            part = replace(table, keys=_on_mesh(table.keys, both)[own])
        else:
            part = maps_of(what)
            for name, values in part.items():
                _check_rows(len(values), both, f"map {name!r}")
            part = {name: _on_mesh(values, both)[own] for name, values in part.items()}
        said += written(files_of_sides(target)[side], part, one)
    return tuple(dict.fromkeys(said))


def _on_mesh(values: NDArray[Any], surface: Surface) -> NDArray[Any]:
    """Return rows of the file of a surface as rows of its mesh."""
    file = surface.file
    return values if file is None or len(values) == len(file.origin) else file.onto_mesh(values)


def _side_of_rows(surface: Surface | None) -> str | NDArray[np.str_]:
    """The hemisphere of a surface; of both that of each row of its file."""
    if surface is None or surface.right is None:
        return "" if surface is None else surface.hemisphere
    return np.where(_on_file(surface.right, surface), "right", "left")


def _on_file(values: NDArray[Any], surface: Surface | None) -> NDArray[Any]:
    """Return rows on the vertices of the file of a surface."""
    file = None if surface is None else surface.file
    return values if file is None or len(values) != len(file.origin) else file.onto_file(values)


def _check_rows(count: int, surface: Surface | None, what: str) -> None:
    counts = (
        ()
        if surface is None
        else (len(surface.mesh.vertices), *((len(surface.file.standing),) if surface.file else ()))
    )
    if surface is not None and count not in counts:
        raise ValueError(f"{what} has {count} values, the surface has {len(surface.mesh.vertices)} vertices")
