"""`surfexp view`: a surface in an interactive window, through open3d."""

from __future__ import annotations

from pathlib import Path

from surfexp.commands.parser import Parser
from surfexp.lab.errors import UserError


def command(name: str, arguments: list[str]) -> int:
    """Open a mesh file in open3d's viewer."""
    parser = Parser(f"surfexp {name}", description=__doc__)
    parser.add_argument("file", type=Path)
    given = parser.parse_args(arguments)
    from surfexp.io.reading import read_mesh

    try:
        vertices, faces, _ = read_mesh(given.file)
    except ValueError as error:
        raise UserError(str(error)) from None
    try:
        import open3d
    except (ImportError, OSError) as error:
        remedy = "pip install 'surfexp[open3d]' and the system package libusb-1.0-0"
        raise UserError(f"the viewer needs open3d: {remedy} ({error})") from None
    mesh = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(vertices), open3d.utility.Vector3iVector(faces.astype("int32"))
    )
    mesh.compute_vertex_normals()
    open3d.visualization.draw_geometries([mesh], window_name=str(given.file))
    return 0
