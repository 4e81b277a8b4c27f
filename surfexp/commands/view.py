"""`surfexp view`: a surface in an interactive window, through open3d."""

from __future__ import annotations

from pathlib import Path

import click

from surfexp.commands.click_command import shown
from surfexp.lab.errors import UserError


@click.command(**shown("view", "lh.white", "scan.ply"))
@click.argument("file", type=click.Path(path_type=Path))
def view(file: Path) -> None:
    """Rotate a surface in a window (needs open3d)."""
    from surfexp.io.reading import read_mesh

    vertices, faces, _ = read_mesh(file)
    try:
        import open3d
    except (ImportError, OSError) as error:
        remedy = "pip install 'surfexp[open3d]' and the system package libusb-1.0-0"
        raise UserError(f"the viewer needs open3d: {remedy} ({error})") from None
    mesh = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(vertices), open3d.utility.Vector3iVector(faces.astype("int32"))
    )
    mesh.compute_vertex_normals()
    open3d.visualization.draw_geometries([mesh], window_name=str(file))
