"""Sizes that a file declares, checked before a parser believes them.

nibabel counts to a declared number of dimensions, walks extensions by their declared lengths and makes room for declared
vertices: with numbers that lie it is busy for hours, or asks for more memory than there is.
"""

from __future__ import annotations

import gzip
import re
import struct
import zlib
from collections.abc import Mapping
from pathlib import Path
from xml.parsers import expat

from surfexp.io.cifti import is_cifti
from surfexp.io.freesurfer_sizes import VOLUMES, check_annotation, check_volume
from surfexp.io.gifti import POINTS, TRIANGLES, is_gifti
from surfexp.io.unpacked_sizes import NUMBER_BYTES, check_nifti, check_unpacked

# of the GIFTI standard
MOST_DIMENSIONS = 6
LARGEST_COUNT = 1 << 28
PIECE = 1 << 20
# NIfTI-2: bytes of the header, and of the flag of extensions behind it
HEADER, FLAG = 540, 4
# NaN is written for every vertex that a hemisphere is said to have
MOST_VERTICES = 1 << 26
COUNTS = re.compile(rb"""(SurfaceNumberOfVertices|IndexCount|NumberOfSeriesPoints)\s*=\s*["'](\d+)["']""")


def check_declared_sizes(path: Path) -> None:
    """Refuse a GIFTI, CIFTI, NIfTI, .mgh or .annot file whose declared sizes cannot be true; others, and what is none, pass.

    Raises
    ------
    ValueError
        With the declared number and its bound.
    """
    if is_gifti(path):
        _check_gifti(path)
    elif is_cifti(path):
        _check_cifti(path)
    elif path.name.lower().endswith((".nii", ".nii.gz")):
        check_nifti(path)
    elif path.suffix.lower() in VOLUMES:
        check_volume(path)
    elif path.suffix == ".annot":
        check_annotation(path)


def _check_gifti(path: Path) -> None:
    refused: list[str] = []
    single: set[str] = set()

    def begin(name: str, attributes: Mapping[str, str]) -> None:
        if name == "DataArray" and not refused:
            refused.extend(_unfit(attributes))
            intent = attributes.get("Intent", "")
            if intent in single:
                refused.append(f"it has two arrays of {intent}, one is read: write each surface to a file of its own")
            single.update({intent} & {POINTS, TRIANGLES})

    parser = expat.ParserCreate()
    parser.StartElementHandler = begin
    opened = gzip.open if path.name.lower().endswith(".gz") else open
    read = 0
    try:
        with opened(path, "rb") as stream:
            while not refused and (piece := stream.read(PIECE)):
                parser.Parse(piece)
                check_unpacked(read := read + len(piece), path.stat().st_size)
    except (expat.ExpatError, OSError, EOFError, LookupError, zlib.error):
        pass  # not XML, or cut off: the reader of the format says so
    if refused:
        raise ValueError(refused[0])


def _unfit(attributes: Mapping[str, str]) -> list[str]:
    """What is wrong with the dimensions of a data array."""
    said = attributes.get("Dimensionality", "1")
    if not said.isdecimal() or not 1 <= int(said) <= MOST_DIMENSIONS:
        return [f"a data array has Dimensionality {said[:20]!r}, 1 to {MOST_DIMENSIONS} are possible"]
    for name in (f"Dim{k}" for k in range(int(said))):
        count = attributes.get(name, "1")
        if not count.isdecimal() or int(count) > LARGEST_COUNT:
            return [f"a data array has {name} {count[:20]!r}, at most {LARGEST_COUNT} are read"]
    return []


def _check_cifti(path: Path) -> None:
    size = path.stat().st_size
    with path.open("rb") as stream:
        head = stream.read(HEADER + FLAG)
        order = next((order for order in "<>" if head[:4] == struct.pack(f"{order}i", HEADER)), "")
        if len(head) < HEADER + FLAG or not order:
            return  # no NIfTI-2 header: the reader of the format says so
        kind = struct.unpack_from(f"{order}h", head, 12)[0]
        dimensions, begin = struct.unpack_from(f"{order}8q", head, 16), struct.unpack_from(f"{order}q", head, 168)[0]
        _check_extent(dimensions, kind, begin, size)
        end = HEADER + FLAG
        while head[HEADER] and end + 8 <= begin:
            stream.seek(end)
            length = struct.unpack(f"{order}i", stream.read(8)[:4])[0]
            if not 16 <= length <= begin - end:
                raise ValueError(f"an extension of its header has {length} bytes, 16 to {begin - end} have room")
            for name, count in COUNTS.findall(stream.read(length - 8)):
                if len(count) > 12 or int(count) > MOST_VERTICES:
                    shown = count[:20].decode()
                    raise ValueError(f"its {name.decode()} is {shown}, at most {MOST_VERTICES} are read")
            end += length


def _check_extent(dimensions: tuple[int, ...], kind: int, begin: int, size: int) -> None:
    """The array must fit into the file behind its header."""
    used, rest = dimensions[0], size - begin
    if not 1 <= used <= 7 or min(dimensions[1 : used + 1]) < 0:
        raise ValueError(
            f"its header has the dimensions {', '.join(map(str, dimensions[:3]))}, ...: none below 0, 1 to 7"
        )
    bytes_of_array = NUMBER_BYTES.get(kind, 1)
    for extent in dimensions[1 : used + 1]:
        bytes_of_array *= extent
    if not HEADER + FLAG <= begin <= size or bytes_of_array > rest:
        raise ValueError(f"its header says {bytes_of_array} bytes of data from byte {begin} on, the file has {size}")
