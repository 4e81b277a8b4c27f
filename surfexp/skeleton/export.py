"""Skeletons as files: GraphML for graph programs, SWC for those of neurons and vessels, VTK and PLY for viewers.

Common spaces of Reeb graphs are archives of numpy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

import numpy as np

from surfexp.io.npz import write_arrays
from surfexp.io.replacing import check_writable, replacing
from surfexp.skeleton.common_space import CommonSpace
from surfexp.skeleton.skeleton import Skeleton

FORMATS = (".graphml", ".swc", ".vtk", ".ply")


def write_skeleton(path: Path | str, skeleton: Skeleton, unit: str = "") -> None:
    """Write nodes and arcs in the format of the file's ending.

    GraphML keeps position, kind, value, contour length, radius and level of every node. SWC keeps positions and radii of trees,
    each with its lowest node as root; the type of all is 0, undefined, and an end has radius 0, that of an open tube too. Legacy
    VTK keeps positions, lines, and values, contour lengths and radii as point data; PLY positions and edges.

    Parameters
    ----------
    path : path
    skeleton : Skeleton
    unit : str
        Of its lengths: SWC, which is read in micrometres, names it in its head.

    Raises
    ------
    ValueError
        If the ending is none of these, or a skeleton with loops, seen or hidden between its levels, or without radii, is to be
        an SWC file.
    """
    path = Path(path)
    check_skeleton_target(path)
    if path.suffix == ".graphml":
        import networkx

        with replacing(path) as temporary:
            networkx.write_graphml(skeleton.graph(), temporary)
        return
    text = _swc(skeleton, unit) if path.suffix == ".swc" else WRITERS[path.suffix](skeleton)
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def check_skeleton_target(path: Path) -> None:
    """Refuse a file that no skeleton can be written to: of another format, or in no writable folder.

    Raises
    ------
    ValueError
        Naming the formats.
    """
    if path.suffix not in FORMATS:
        raise ValueError(f"{path.name} ends in {path.suffix!r}, a skeleton is written as one of {', '.join(FORMATS)}")
    check_writable(path)


def write_common_space(path: Path, space: CommonSpace) -> None:
    """Write heights, arcs and triangles under their names, as `CommonSpace(**numpy.load(path))` reads them.

    Raises
    ------
    ValueError
        If the file is no .npz, or in no writable folder.
    """
    check_common_space_target(path)
    with replacing(path) as temporary:
        write_arrays(temporary, {field.name: getattr(space, field.name) for field in fields(space)})


def check_common_space_target(path: Path) -> None:
    """Refuse a file that no common space can be written to.

    Raises
    ------
    ValueError
        If it is no .npz, or in no writable folder.
    """
    if path.suffix.lower() != ".npz":
        raise ValueError(f"{path} cannot hold a common space with its arcs and triangles: choose .npz")
    check_writable(path)


def _points(skeleton: Skeleton) -> list[str]:
    return [" ".join(f"{x:.9g}" for x in point) for point in skeleton.positions.tolist()]


def _vtk(skeleton: Skeleton) -> str:
    nodes, arcs = len(skeleton.positions), len(skeleton.arcs)
    lines = ["# vtk DataFile Version 3.0", "skeleton", "ASCII", "DATASET POLYDATA", f"POINTS {nodes} double"]
    lines += [*_points(skeleton), f"LINES {arcs} {3 * arcs}", *(f"2 {a} {b}" for a, b in skeleton.arcs.tolist())]
    lines.append(f"POINT_DATA {nodes}")
    for name, values in (("value", skeleton.values), ("length", skeleton.lengths), ("radius", skeleton.radii)):
        lines += [f"SCALARS {name} double 1", "LOOKUP_TABLE default", *(f"{value:.9g}" for value in values.tolist())]
    return "\n".join(lines) + "\n"


def _ply(skeleton: Skeleton) -> str:
    head = ["ply", "format ascii 1.0", f"element vertex {len(skeleton.positions)}"]
    head += [f"property double {axis}" for axis in "xyz"]
    head += [f"element edge {len(skeleton.arcs)}", "property int vertex1", "property int vertex2", "end_header"]
    return "\n".join([*head, *_points(skeleton), *(f"{a} {b}" for a, b in skeleton.arcs.tolist())]) + "\n"


def _swc(skeleton: Skeleton, unit: str) -> str:
    """Rows of number, type, position, radius and parent; parents stand before their children."""
    hidden = int(skeleton.metrics.get("hidden_handles", 0))
    if loops := int(skeleton.metrics["b1"]) + hidden:
        unseen = f", {hidden} of them between two levels" if hidden else ""
        raise ValueError(f"the skeleton has loops ({loops}{unseen}), an SWC file holds trees only: choose .graphml")
    if not np.isfinite(skeleton.radii).all():
        raise ValueError("the skeleton has nodes without a radius, which an SWC file needs: choose .graphml")
    around: list[list[int]] = [[] for _ in skeleton.positions]
    for a, b in skeleton.arcs.tolist():
        around[a].append(b)
        around[b].append(a)
    number: dict[int, int] = {}
    lines = ["# Reeb graph by surfexp: number, type (0, undefined), x, y, z, radius, parent"]
    lines += [f"# unit of length: {unit}"] if unit else []
    for root in np.argsort(skeleton.values, kind="stable").tolist():
        waiting = [] if root in number else [(root, -1)]
        while waiting:
            node, parent = waiting.pop()
            number[node] = len(number) + 1
            x, y, z, radius = (f"{value:.9g}" for value in (*skeleton.positions[node].tolist(), skeleton.radii[node]))
            lines.append(f"{number[node]} 0 {x} {y} {z} {radius} {number.get(parent, -1)}")
            waiting += [(other, node) for other in reversed(around[node]) if other != parent]
    return "\n".join(lines) + "\n"


WRITERS: dict[str, Callable[[Skeleton], str]] = {".vtk": _vtk, ".ply": _ply}
