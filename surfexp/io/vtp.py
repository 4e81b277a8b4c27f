"""VTK polygonal data in XML (.vtp)."""

from __future__ import annotations

import re
from base64 import b64encode
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.polygons import polygons_between, triangulate
from surfexp.io.vtk_xml import VtkXml
from surfexp.mesh.triangle_mesh import TriangleMesh


def write_vtp(path: Path, mesh: TriangleMesh, scalars: dict[str, Floats] | None = None) -> None:
    """Write XML polygonal data, arrays in base64, double precision."""
    m = len(mesh.faces)
    maps = scalar_channels(scalars or {})
    data = "".join(_xml_array(name, values) for name, values in maps.items())
    points, corners = _xml_array("Points", mesh.vertices), _xml_array("connectivity", mesh.faces.ravel())
    offsets = _xml_array("offsets", 3 * np.arange(1, m + 1))
    path.write_text(
        '<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
        f'<PolyData><Piece NumberOfPoints="{len(mesh.vertices)}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" '
        f'NumberOfPolys="{m}">\n<PointData>{data}</PointData>\n<Points>{points}</Points>\n'
        f"<Polys>{corners}{offsets}</Polys>\n</Piece></PolyData></VTKFile>\n",
        encoding="utf-8",
    )


def _xml_array(name: str, values: NDArray[np.generic]) -> str:
    whole = np.issubdtype(values.dtype, np.integer)
    data = np.ascontiguousarray(values, dtype="<i8" if whole else "<f8").tobytes()
    text = b64encode(len(data).to_bytes(8, "little") + data).decode()
    width = values.shape[1] if values.ndim == 2 else 1
    kind = "Int64" if whole else "Float64"
    return f'<DataArray type="{kind}" Name={quoteattr(name)} NumberOfComponents="{width}" format="binary">{text}</DataArray>'


def read_vtp(path: Path) -> tuple[Floats, Integers, dict[str, Floats]]:
    """Points, polygons and point data of XML polygonal data, however its arrays are written: see `surfexp.io.vtk_xml`.

    Raises
    ------
    ValueError
        If it is another data set, in pieces, of strips, packed by LZ4, or ends early.
    """
    file = VtkXml.read(path, "PolyData")
    pieces = re.findall(r"<Piece\b([^>]*)>", file.text)
    if len(pieces) > 1:
        raise ValueError(f"it has {len(pieces)} pieces, one is read: merge them, as ParaView's Merge Blocks does")
    if strips := re.search(r'NumberOfStrips="\s*(0*[1-9]\d*)', pieces[0] if pieces else ""):
        raise ValueError(f"it holds {strips[1]} triangle strips, which only PLY files may have here: write polygons")
    points, cells = file.arrays("Points"), file.arrays("Polys")
    if not points or not {"connectivity", "offsets"} <= set(cells):
        raise ValueError("it has no points or no polygons")
    corners, offsets = (cells[name].astype(np.int64).ravel().tolist() for name in ("connectivity", "offsets"))
    maps = {name: values.astype(np.float64) for name, values in file.arrays("PointData").items()}
    return (
        np.asarray(next(iter(points.values())), dtype=np.float64).reshape(-1, 3),
        triangulate(polygons_between([0, *offsets], corners)),
        {name: values[:, 0] if values.shape[1] == 1 else values for name, values in maps.items()},
    )
