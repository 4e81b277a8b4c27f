"""Arrays of VTK's XML files: text, base64 or raw, beside their names or appended, whole or in packed blocks.

By hand: neither meshio 5.3 nor trimesh 5.2 reads .vtp, and the vtk package has over 100 MB. No XML parser is needed for
arrays, and none can be abused.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import unescape

import numpy as np
from numpy.typing import NDArray

from surfexp.io.counted_bytes import CountedBytes

TYPES = {"Float32": "f4", "Float64": "f8", "Int8": "i1", "Int16": "i2", "Int32": "i4", "Int64": "i8"}
TYPES |= {"UInt8": "u1", "UInt16": "u2", "UInt32": "u4", "UInt64": "u8"}
APPENDED = re.compile(rb"<AppendedData\b([^>]*)>\s*_")


@dataclass(frozen=True)
class VtkXml:
    """The text of a file, and the bytes that are appended to it.

    Parameters
    ----------
    text : str
        All but the appended bytes.
    appended : bytes
        From behind the underscore on, with what closes the file.
    encoding : str
        `raw` or `base64`.
    """

    text: str
    appended: bytes
    encoding: str

    @classmethod
    def read(cls, path: Path, kind: str) -> VtkXml:
        """Read a file of a kind of data, such as PolyData.

        Raises
        ------
        ValueError
            If it is another file, cut off, or declares entities.
        """
        data = path.read_bytes()
        found = APPENDED.search(data)
        end = found.start() if found else len(data)
        appended = data[found.end() :] if found else b""
        text = data[:end].decode("utf-8", "replace")
        # entities stay what they are, text
        if "<!ENTITY" in text or "<!DOCTYPE" in text:
            raise ValueError("it declares entities, which VTK files do not have")
        encoding = _attributes(found[1].decode("latin-1")).get("encoding", "base64") if found else ""
        file = cls(text, appended, encoding)
        if file.head.get("type") != kind or b"</VTKFile>" not in data[-1000:]:
            raise ValueError(f"it is no XML file of {kind}, or is cut off")
        return file

    @property
    def head(self) -> dict[str, str]:
        """Attributes of the file."""
        found = re.search(r"<VTKFile\b([^>]*)>", self.text)
        return _attributes(found[1]) if found else {}

    @property
    def compressor(self) -> str:
        """By what arrays are packed; empty where they are whole."""
        return self.head.get("compressor", "")

    @property
    def order(self) -> str:
        """Byte order of all numbers, as numpy writes it."""
        return ">" if self.head.get("byte_order") == "BigEndian" else "<"

    @property
    def count_type(self) -> np.dtype[np.unsignedinteger]:
        """Of the numbers of bytes before an array."""
        return np.dtype(self.order + ("u8" if self.head.get("header_type") == "UInt64" else "u4"))

    def names(self, section: str) -> list[str]:
        """Names of the arrays of the first element of a name; their numbers are not looked at."""
        tags = (_attributes(tag) for _, _, tag, _ in _elements(self._inside(section), "DataArray"))
        return [told.get("Name", f"array {number}") for number, told in enumerate(tags)]

    def arrays(self, section: str) -> dict[str, NDArray[np.generic]]:
        """(t, c) numbers of each array of the first element of a name, such as `Points`, by the names of the arrays.

        Raises
        ------
        ValueError
            If an array is of an unknown type, is cut off, or does not unpack to what it announces.
        """
        inside = self._inside(section)
        arrays = {}
        for number, (_, _, tag, body) in enumerate(_elements(inside, "DataArray")):
            told = _attributes(tag)
            columns = told.get("NumberOfComponents", "") or "1"
            values = self._values(told, _without(body, "InformationKey"))  # norms beside numbers
            if not columns.isdecimal() or not 0 < int(columns) <= max(len(values), 1) or len(values) % int(columns):
                raise ValueError(f"an array has {len(values)} numbers in {columns[:20]} components")
            arrays[told.get("Name", f"array {number}")] = values.reshape(-1, int(columns))
        return arrays

    def _inside(self, section: str) -> str:
        begin = re.search(rf"<{section}\b[^>]*>", self.text)
        if begin is None or begin[0].endswith("/>"):
            return ""
        return self.text[begin.end() :].partition(f"</{section}>")[0]

    def _values(self, told: dict[str, str], body: str) -> NDArray[np.generic]:
        kind = TYPES.get(told.get("type", ""))
        if kind is None:
            raise ValueError(f"it has numbers of type {told.get('type', '')[:20]!r}, known are {', '.join(TYPES)}")
        if told.get("format") == "ascii":
            return np.array(body.split(), dtype=np.float64).astype(kind)
        if told.get("format") == "appended":
            offset = told.get("offset", "")
            if not offset.isdecimal() or int(offset) >= len(self.appended):
                raise ValueError(f"an array begins at byte {offset[:20]!r} of {len(self.appended)} that are appended")
            content = CountedBytes(self.appended, self.encoding != "raw", self.count_type, int(offset))
        else:
            content = CountedBytes("".join(body.split()).encode(), True, self.count_type)
        raw = content.unpacked(self.compressor) if self.compressor else content.whole()
        if content.data is not self.appended and content.at < len(content.data):
            raise ValueError(f"an array announces {len(raw)} bytes and has more")
        if len(raw) % np.dtype(kind).itemsize:
            raise ValueError(f"an array has {len(raw)} bytes, which are no {told['type']}")
        return np.frombuffer(raw, self.order + kind).astype(kind)


def _elements(text: str, name: str) -> Iterator[tuple[int, int, str, str]]:
    """Where each element of a name begins and ends, its attributes, and what is inside; they do not nest.

    By hand, since an expression looks for the end of each element to the end of the text, where there is none.
    """
    at = 0
    while (begin := text.find(f"<{name}", at)) >= 0 and (head := text.find(">", begin)) >= 0:
        tag, body, at = text[begin + len(name) + 1 : head], "", head + 1
        if tag[:1].isalnum():
            continue  # a longer name
        if not tag.endswith("/"):
            stop = text.find(f"</{name}>", at)
            if stop < 0:
                return
            body, at = text[at:stop], stop + len(name) + 3
        yield begin, at, tag.removesuffix("/"), body


def _without(text: str, name: str) -> str:
    """A text without the elements of a name."""
    kept, at = list[str](), 0
    for begin, end, _, _ in _elements(text, name):
        kept.append(text[at:begin])
        at = end
    return "".join([*kept, text[at:]])


def _attributes(tag: str) -> dict[str, str]:
    found = re.findall(r"""\b(\w+)\s*=\s*(?:"([^"]*)"|'([^']*)')""", tag)
    return {name: unescape(one or other, {"&quot;": '"', "&apos;": "'"}) for name, one, other in found}
