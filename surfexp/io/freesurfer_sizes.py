"""Sizes that FreeSurfer's maps and annotations declare, checked before nibabel makes room for them."""

from __future__ import annotations

import gzip
import struct
import zlib
from pathlib import Path

from surfexp.io.unpacked_sizes import check_unpacked

VOLUMES = (".mgh", ".mgz")
# of the .mgh format: where the data begin, and bytes of a number by type
DATA_BEGIN = 284
NUMBER_BYTES = {0: 1, 1: 4, 3: 4, 4: 2}
# an entry of a table of colours: length of its name, four numbers
ENTRY_BYTES = 20
LARGEST_KEY = 1 << 20
PIECE = 1 << 20


def check_volume(path: Path) -> None:
    """Refuse a .mgh or .mgz file that is shorter than its header says.

    Raises
    ------
    ValueError
        With both sizes.
    """
    size, head = 0, b""
    try:
        with (gzip.open if path.suffix.lower() == ".mgz" else open)(path, "rb") as stream:
            while piece := stream.read(PIECE):
                head, size = head or piece[:24], size + len(piece)
                check_unpacked(size, path.stat().st_size)
    except (OSError, EOFError, zlib.error):
        return  # cut off: the reader says so
    if len(head) < 24:
        return
    _, *extents, kind = struct.unpack(">6i", head)
    needed = NUMBER_BYTES.get(kind, 1)
    for extent in extents:
        needed *= max(extent, 0)
    if DATA_BEGIN + needed > size:
        raise ValueError(f"its header says {needed} bytes of data from byte {DATA_BEGIN} on, the file has {size}")


class _Cursor:
    """A place among bytes, behind numbers that must not count further than the end."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0

    def number(self, what: str, unit: int) -> int:
        """Take the next number, which counts things of `unit` bytes behind it, or is a label where that is 0."""
        found = self.peek(what)
        self.at += 4
        most = (len(self.data) - self.at) // unit if unit else LARGEST_KEY
        if not 0 <= found <= most:
            raise ValueError(f"{what} is {found}, 0 to {most} are possible")
        return found

    def peek(self, what: str) -> int:
        """Return the next number."""
        if self.at + 4 > len(self.data):
            raise ValueError(f"it ends at byte {len(self.data)}, before {what}")
        return int(struct.unpack_from(">i", self.data, self.at)[0])

    def skip(self, count: int) -> None:
        """Pass over so many bytes."""
        self.at += count


def entries_of_annotation(data: bytes) -> list[int]:
    """Return the number of each entry in a table of colours, in the order of the file; a table may leave numbers out.

    Raises
    ------
    ValueError
        If a count or a length reaches beyond the end, with the number and what has room.
    """
    cursor = _Cursor(data)
    cursor.skip(8 * cursor.number("its number of vertices", 8))
    if not cursor.peek("its mark of a table of colours"):
        return []  # no table: the reader says what that means
    cursor.skip(4)
    is_old = cursor.peek("its number of labels") > 0
    if is_old:
        entries = cursor.number("its number of labels", ENTRY_BYTES)
    else:
        cursor.skip(4)
        cursor.number("its largest label", 0)
    cursor.skip(cursor.number("the length of a name", 1))
    if not is_old:
        entries = cursor.number("its number of labels", ENTRY_BYTES)
    numbers = []
    for entry in range(entries):
        numbers.append(entry if is_old else cursor.number("a label", 0))
        cursor.skip(cursor.number("the length of a name", 1) + 16)
    return numbers
