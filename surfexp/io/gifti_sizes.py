"""What the data arrays of a GIFTI file declare, checked before nibabel makes room for it or opens the files that they name."""

from __future__ import annotations

import base64
import binascii
import gzip
import math
import zlib
from collections.abc import Mapping
from pathlib import Path
from xml.parsers import expat

from surfexp.io.unpacked_sizes import check_unpacked

POINTS, TRIANGLES = "NIFTI_INTENT_POINTSET", "NIFTI_INTENT_TRIANGLE"
# of the GIFTI standard
MOST_DIMENSIONS = 6
LARGEST_COUNT = 1 << 28
PIECE = 1 << 20


def check_gifti(path: Path) -> None:
    """Refuse a file whose arrays cannot be what they declare, unpack to too much, or lie elsewhere than beside it.

    Raises
    ------
    ValueError
        With the declared number and its bound, or the file that an array names.
    """
    arrays = _Arrays(path)
    parser = expat.ParserCreate()
    parser.buffer_text, parser.buffer_size = True, PIECE
    parser.StartElementHandler, parser.EndElementHandler = arrays.begin, arrays.end
    parser.CharacterDataHandler = arrays.text
    opened = gzip.open if path.name.lower().endswith(".gz") else open
    read = 0
    try:
        with opened(path, "rb") as stream:
            while piece := stream.read(PIECE):
                parser.Parse(piece)
                check_unpacked(read := read + len(piece), path.stat().st_size)
    except (expat.ExpatError, OSError, EOFError, LookupError, UnicodeError, binascii.Error, zlib.error):
        pass  # not XML, not packed, or cut off: the reader of the format says so


class _Arrays:
    """The data arrays of a file as its parser comes upon them."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.single: set[str] = set()
        self.encoding = ""
        self.unpacked = 0
        self.packed: list[str] | None = None

    def begin(self, name: str, attributes: Mapping[str, str]) -> None:
        if name == "DataArray":
            self._begin_array(attributes)
        if name == "Data":
            self.packed = [] if self.encoding == "B64GZ" else None

    def _begin_array(self, attributes: Mapping[str, str]) -> None:
        from nibabel.gifti.util import gifti_encoding_codes

        _check_dimensions(attributes)
        intent = attributes.get("Intent", "")
        if intent in self.single:
            raise ValueError(f"it has two arrays of {intent}, one is read: write each surface to a file of its own")
        self.single.update({intent} & {POINTS, TRIANGLES})
        given = attributes.get("Encoding", "")
        # nibabel knows several spellings of each, and takes what names none for packed
        self.encoding = gifti_encoding_codes.label.get(given, "B64GZ")
        if self.encoding == "External":
            self._check_beside(attributes.get("ExternalFileName", ""))

    def _check_beside(self, name: str) -> None:
        """An array in another file lies in the folder of this one: what strangers send does not choose which file is opened."""
        folder = self.path.absolute().parent.resolve()
        file = folder / name
        if not name or Path(name).name != name or not file.is_file() or file.resolve().parent != folder:
            raise ValueError(
                f"a data array is in the external file {name[:60]!r}, a regular file in the same folder is read: put it there"
            )

    def text(self, text: str) -> None:
        if self.packed is not None:
            self.packed.append(text)

    def end(self, name: str) -> None:
        if name != "Data" or self.packed is None:
            return
        rest, self.packed = base64.b64decode("".join(self.packed).encode("ascii")), None
        stream = zlib.decompressobj()
        while rest and not stream.eof:
            self.unpacked += len(stream.decompress(rest, PIECE))
            check_unpacked(self.unpacked, self.path.stat().st_size)
            rest = stream.unconsumed_tail


def _check_dimensions(attributes: Mapping[str, str]) -> None:
    said = attributes.get("Dimensionality", "1")
    if not said.isdecimal() or not 1 <= int(said) <= MOST_DIMENSIONS:
        raise ValueError(f"a data array has Dimensionality {said[:20]!r}, 1 to {MOST_DIMENSIONS} are possible")
    counts = [attributes.get(f"Dim{k}", "1") for k in range(int(said))]
    for k, count in enumerate(counts):
        if not count.isdecimal() or int(count) > LARGEST_COUNT:
            raise ValueError(f"a data array has Dim{k} {count[:20]!r}, at most {LARGEST_COUNT} are read")
    if (numbers := math.prod(map(int, counts))) > LARGEST_COUNT:
        raise ValueError(f"a data array has {numbers} numbers, at most {LARGEST_COUNT} are read")
