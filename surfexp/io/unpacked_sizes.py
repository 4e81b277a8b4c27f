"""What a packed file unpacks to, measured before room is made for it."""

from __future__ import annotations

import gzip
import math
import struct
import zipfile
import zlib
from pathlib import Path
from typing import IO

import numpy as np

from surfexp.io.foreign import parsing
from surfexp.io.numbers import LARGEST_BYTES

PIECE = 1 << 20
# zeros are packed a thousand times smaller, numbers that were measured hardly ten times
MOST_TIMES, ALWAYS_READ = 100, 256 << 20
READ_HEADER = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
# of NIfTI-1 and NIfTI-2: bytes of the header, places and types of the extents, the kind of number and the first byte of data
NIFTI = {348: ("8h", 40, 70, "f", 108), 540: ("8q", 16, 12, "q", 168)}
NUMBER_BYTES = {2: 1, 4: 2, 8: 4, 16: 4, 32: 8, 64: 8, 256: 1, 512: 2, 768: 4, 1024: 8, 1280: 8, 1792: 16}


def check_unpacked(unpacked: int, packed: int) -> None:
    """Refuse what unpacks to more than is read, or to so much more than it is that nobody can have measured it.

    Raises
    ------
    ValueError
        With the bound.
    """
    most = min(LARGEST_BYTES, max(ALWAYS_READ, MOST_TIMES * packed))
    if unpacked > most:
        raise ValueError(f"unpacked it has over {most:,} bytes, the most that is read of a file of {packed:,}")


def check_arrays(path: Path) -> None:
    """Refuse a .npy or .npz file that unpacks to too much, or whose arrays announce more than it holds.

    Raises
    ------
    ValueError
        With both sizes; what is no such file is left to numpy.
    """
    if not zipfile.is_zipfile(path):
        with path.open("rb") as stream:
            _check_array(stream, path.stat().st_size)
        return
    with parsing("array file"), zipfile.ZipFile(path) as archive:
        members = archive.infolist()
        check_unpacked(sum(member.file_size for member in members), path.stat().st_size)
        for member in members:
            with archive.open(member) as opened:
                _check_array(opened, member.file_size)


def _check_array(stream: IO[bytes], size: int) -> None:
    try:
        shape, _, dtype = READ_HEADER[np.lib.format.read_magic(stream)](stream)
    except Exception:  # whatever the bytes provoke: numpy says so when it reads them
        return
    announced = math.prod(shape) * dtype.itemsize
    if announced > size and not dtype.hasobject:
        raise ValueError(f"an array announces {announced:,} bytes, the file has {size:,} for it")


def check_nifti(path: Path) -> None:
    """Refuse a .nii or .nii.gz volume that unpacks to too much, or whose header announces more than it holds.

    Raises
    ------
    ValueError
        With both sizes; what is no such file is left to nibabel.
    """
    size, head = 0, b""
    try:
        with (gzip.open if path.suffix.lower() == ".gz" else open)(path, "rb") as stream:
            while piece := stream.read(PIECE):
                head, size = head or piece[:540], size + len(piece)
                check_unpacked(size, path.stat().st_size)
    except (OSError, EOFError, zlib.error):
        return
    order = next((order for order in "<>" if head[:4] in [struct.pack(f"{order}i", length) for length in NIFTI]), "")
    if not order or len(head) < (length := struct.unpack(f"{order}i", head[:4])[0]):
        return
    extents, place, kind_place, first, first_place = NIFTI[length]
    used, *dimensions = struct.unpack_from(f"{order}{extents}", head, place)
    kind, begin = (
        struct.unpack_from(f"{order}{of}", head, at)[0] for of, at in (("h", kind_place), (first, first_place))
    )
    needed = math.prod(max(extent, 0) for extent in dimensions[: max(used, 0)]) * NUMBER_BYTES.get(kind, 1)
    if not math.isfinite(begin) or begin + needed > size:
        raise ValueError(f"its header says {needed:,} bytes of data from byte {begin:g} on, the file has {size:,}")
