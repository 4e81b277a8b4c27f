"""VTK polygonal data in XML (.vtp).

By hand: neither meshio 5.3 nor trimesh 5.2 reads .vtp; no XML parser is needed for its arrays, and none can be abused.
"""

from __future__ import annotations

import re
from base64 import b64decode, b64encode
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from surfexp.arrays import Floats, Integers
from surfexp.io.polygons import polygons_between, triangulate
from surfexp.io.vtk import scalar_channels
from surfexp.mesh.triangle_mesh import TriangleMesh

XML_TYPES = {
    "Float32": "f4",
    "Float64": "f8",
    "Int32": "i4",
    "Int64": "i8",
    "UInt8": "u1",
    "Int8": "i1",
    "UInt32": "u4",
}


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
        f"<Polys>{corners}{offsets}</Polys>\n</Piece></PolyData></VTKFile>\n"
    )


def _xml_array(name: str, values: NDArray[np.generic]) -> str:
    whole = np.issubdtype(values.dtype, np.integer)
    data = np.ascontiguousarray(values, dtype="<i8" if whole else "<f8").tobytes()
    text = b64encode(len(data).to_bytes(8, "little") + data).decode()
    width = values.shape[1] if values.ndim == 2 else 1
    kind = "Int64" if whole else "Float64"
    return f'<DataArray type="{kind}" Name={quoteattr(name)} NumberOfComponents="{width}" format="binary">{text}</DataArray>'


def read_vtp(path: Path) -> tuple[Floats, Integers, dict[str, Floats]]:
    """Points, polygons and point data of XML polygonal data: ASCII or uncompressed base64 arrays.

    Raises
    ------
    ValueError
        If it is another data set, compressed or appended, or ends early.
    """
    text = path.read_text("utf-8", "replace")
    # no XML parser: arrays are all that is looked for, and entities stay what they are, text
    if 'type="PolyData"' not in text or "</VTKFile>" not in text:
        raise ValueError("it is not XML polygonal data, or is cut off")
    if "<!ENTITY" in text or "<!DOCTYPE" in text:
        raise ValueError("it declares entities, which VTK files do not have")
    if "compressor=" in text or 'format="appended"' in text:
        raise ValueError("its arrays are compressed or appended: save as ASCII or base64 without compression")
    order = ">" if 'byte_order="BigEndian"' in text else "<"
    header = "u8" if 'header_type="UInt64"' in text else "u4"
    sections = {name: _section(text, name) for name in ("PointData", "Points", "Polys")}
    arrays = {name: _xml_arrays(part, order, header) for name, part in sections.items()}
    if not arrays["Points"] or not {"connectivity", "offsets"} <= set(arrays["Polys"]):
        raise ValueError("it has no points or no polygons")
    points = np.asarray(next(iter(arrays["Points"].values())), dtype=np.float64).reshape(-1, 3)
    corners = arrays["Polys"]["connectivity"].astype(np.int64).ravel()
    offsets = arrays["Polys"]["offsets"].astype(np.int64).ravel()
    polygons = triangulate(polygons_between([0, *offsets.tolist()], corners.tolist()))
    return (
        points,
        polygons,
        {name: np.squeeze(values.astype(np.float64)) for name, values in arrays["PointData"].items()},
    )


def _section(text: str, name: str) -> str:
    found = re.search(rf"<{name}\b[^>]*>(.*?)</{name}>", text, re.S)
    return found.group(1) if found else ""


def _xml_arrays(text: str, order: str, header: str) -> dict[str, NDArray[np.generic]]:
    arrays = {}
    text = re.sub(r"<InformationKey\b.*?</InformationKey>", "", text, flags=re.S)  # VTK writes norms beside numbers
    for number, (tag, body) in enumerate(re.findall(r"<DataArray\b([^>]*)>(.*?)</DataArray>", text, re.S)):
        attributes = dict(re.findall(r'(\w+)="([^"]*)"', tag))
        kind = XML_TYPES.get(attributes.get("type", ""))
        if kind is None:
            raise ValueError(f"it has numbers of type {attributes.get('type', '')!r}, known are {', '.join(XML_TYPES)}")
        if attributes.get("format") == "ascii":
            values = np.array(body.split(), dtype=np.float64).astype(kind)
        else:
            raw = b64decode("".join(body.split()), validate=True)
            width = np.dtype(header).itemsize
            size = int(np.frombuffer(raw, order + header, 1)[0]) if len(raw) >= width else -1
            if size != len(raw) - width:
                raise ValueError(f"an array announces {size} bytes and has {len(raw) - width}")
            values = np.frombuffer(raw, order + kind, offset=width).astype(kind)
        columns = int(attributes.get("NumberOfComponents", "1") or 1)
        arrays[attributes.get("Name", f"array {number}")] = values.reshape(-1, columns)
    return arrays
