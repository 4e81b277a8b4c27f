"""Sizes that a file declares, checked before a parser believes them.

nibabel counts to a declared number of dimensions, walks extensions by their declared lengths and makes room for declared
vertices: with numbers that lie it is busy for hours, or asks for more memory than there is.
"""

from __future__ import annotations

import re
import struct
from pathlib import Path

from surfexp.io.cifti import is_cifti
from surfexp.io.freesurfer_sizes import VOLUMES, check_volume, entries_of_annotation
from surfexp.io.gifti import is_gifti
from surfexp.io.gifti_sizes import check_gifti
from surfexp.io.unpacked_sizes import NUMBER_BYTES, check_nifti

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
        check_gifti(path)
    elif is_cifti(path):
        _check_cifti(path)
    elif path.name.lower().endswith((".nii", ".nii.gz")):
        check_nifti(path)
    elif path.suffix.lower() in VOLUMES:
        check_volume(path)
    elif path.suffix.lower() == ".annot":
        entries_of_annotation(path.read_bytes())


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
