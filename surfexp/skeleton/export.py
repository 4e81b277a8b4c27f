"""Skeletons as files: GraphML for graph programs, VTK and PLY for viewers of surfaces."""

from __future__ import annotations

from pathlib import Path

from surfexp.io.replacing import check_writable, replacing
from surfexp.skeleton.skeleton import Skeleton

FORMATS = (".graphml", ".vtk", ".ply")


def write_skeleton(path: Path | str, skeleton: Skeleton) -> None:
    """Write nodes and arcs in the format of the file's ending.

    GraphML keeps position, kind, value, contour length and level of every node; legacy VTK positions, lines, and the values
    and contour lengths as point data; PLY positions and edges.

    Raises
    ------
    ValueError
        If the ending is none of .graphml, .vtk and .ply.
    """
    path = Path(path)
    check_skeleton_target(path)
    if path.suffix == ".graphml":
        import networkx

        with replacing(path) as temporary:
            networkx.write_graphml(skeleton.graph(), temporary)
        return
    with replacing(path) as temporary:
        temporary.write_text(_vtk(skeleton) if path.suffix == ".vtk" else _ply(skeleton), encoding="ascii")


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


def _points(skeleton: Skeleton) -> list[str]:
    return [" ".join(f"{x:.9g}" for x in point) for point in skeleton.positions.tolist()]


def _vtk(skeleton: Skeleton) -> str:
    nodes, arcs = len(skeleton.positions), len(skeleton.arcs)
    lines = ["# vtk DataFile Version 3.0", "skeleton", "ASCII", "DATASET POLYDATA", f"POINTS {nodes} double"]
    lines += [*_points(skeleton), f"LINES {arcs} {3 * arcs}", *(f"2 {a} {b}" for a, b in skeleton.arcs.tolist())]
    lines.append(f"POINT_DATA {nodes}")
    for name, values in (("value", skeleton.values), ("length", skeleton.lengths)):
        lines += [f"SCALARS {name} double 1", "LOOKUP_TABLE default", *(f"{value:.9g}" for value in values.tolist())]
    return "\n".join(lines) + "\n"


def _ply(skeleton: Skeleton) -> str:
    head = ["ply", "format ascii 1.0", f"element vertex {len(skeleton.positions)}"]
    head += [f"property double {axis}" for axis in "xyz"]
    head += [f"element edge {len(skeleton.arcs)}", "property int vertex1", "property int vertex2", "end_header"]
    return "\n".join([*head, *_points(skeleton), *(f"{a} {b}" for a, b in skeleton.arcs.tolist())]) + "\n"
