"""VTK polygonal data in XML (.vtp), and the polygons of unstructured grids (.vtu)."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.mesh_file import Decoded
from surfexp.io.polygons import polygons_between
from surfexp.io.vtk_cells import maps_passed_over, polygons_of_cells, triangles
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


def read_vtp(path: Path) -> Decoded:
    """Points, polygons, strips and point data of XML polygonal data, however its arrays are written: `surfexp.io.vtk_xml`.

    Raises
    ------
    ValueError
        If it is another data set, in pieces, packed by LZ4, or ends early.
    """
    file = VtkXml.read(path, "PolyData")
    points, maps = _points_and_maps(file)
    polygons, strips = _cells(file, "Polys"), _cells(file, "Strips")
    if not polygons and not strips:
        raise ValueError("it has no points or no polygons")
    for what, found in (("Polys", polygons), ("Strips", strips)):
        announced = re.search(rf'<Piece\b[^>]*\bNumberOf{what}="\s*(\d+)', file.text)
        if announced and int(announced[1]) != len(found):
            raise ValueError(f"it announces {announced[1]} {what.lower()} and has {len(found)}")
    return Decoded(points, [*polygons, *triangles(strips)], maps, maps_passed_over(file.names("CellData")))


def read_vtu(path: Path) -> Decoded:
    """Points, the polygons among cells, and point data of an XML unstructured grid.

    Raises
    ------
    ValueError
        As `read_vtp`, or if a cell is a volume.
    """
    file = VtkXml.read(path, "UnstructuredGrid")
    points, maps = _points_and_maps(file)
    kinds = file.arrays("Cells").get("types", np.zeros((0, 1)))
    polygons, notes = polygons_of_cells(_cells(file, "Cells"), kinds.astype(np.int64).ravel().tolist())
    if not polygons:
        raise ValueError("it has no points or no polygons")
    return Decoded(points, polygons, maps, (*notes, *maps_passed_over(file.names("CellData"))))


def _points_and_maps(file: VtkXml) -> tuple[Floats, dict[str, Floats]]:
    pieces = re.findall(r"<Piece\b([^>]*)>", file.text)
    if len(pieces) > 1:
        raise ValueError(f"it has {len(pieces)} pieces, one is read: merge them, as ParaView's Merge Blocks does")
    points = file.arrays("Points")
    if not points:
        raise ValueError("it has no points or no polygons")
    maps = {name: values.astype(np.float64) for name, values in file.arrays("PointData").items()}
    return (
        np.asarray(next(iter(points.values())), dtype=np.float64).reshape(-1, 3),
        {name: values[:, 0] if values.shape[1] == 1 else values for name, values in maps.items()},
    )


def _cells(file: VtkXml, section: str) -> list[Sequence[int]]:
    arrays = file.arrays(section)
    if not {"connectivity", "offsets"} <= set(arrays):
        return []
    corners, offsets = (arrays[name].astype(np.int64).ravel().tolist() for name in ("connectivity", "offsets"))
    return polygons_between([0, *offsets], corners) if offsets or corners else []
