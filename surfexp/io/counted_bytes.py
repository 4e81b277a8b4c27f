"""Bytes behind their number, whole or in packed blocks, as VTK's XML files hold arrays."""

from __future__ import annotations

import lzma
import zlib
from base64 import b64decode
from binascii import Error
from dataclasses import dataclass

import numpy as np

from surfexp.io.numbers import LARGEST_BYTES

COMPRESSORS = ("vtkZLibDataCompressor", "vtkLZMADataCompressor")
MEMORY_OF_LZMA = 1 << 28


@dataclass
class CountedBytes:
    """Bytes behind one another, each piece in base64 of its own where they are coded.

    Parameters
    ----------
    data : bytes
    coded : bool
        Whether they are base64.
    count_type : dtype
        Of the numbers of bytes that stand before an array.
    at : int
        Where the next piece begins.
    """

    data: bytes
    coded: bool
    count_type: np.dtype[np.unsignedinteger]
    at: int = 0

    def peek(self, size: int) -> bytes:
        """Return the next bytes and stay."""
        piece = self.data[self.at : self.at + self._length(size)]
        try:
            known = b64decode(piece, validate=True)[:size] if self.coded else piece
        except Error:
            raise ValueError("an array is not base64, or ends early") from None
        if len(known) < size:
            raise ValueError(f"an array announces {size} bytes and ends before")
        return known

    def take(self, size: int) -> bytes:
        """Return the next bytes and go on behind them."""
        piece = self.peek(size)
        self.at += self._length(size)
        return piece

    def _length(self, size: int) -> int:
        return 4 * -(-size // 3) if self.coded else size

    def counts(self, number: int) -> list[int]:
        """Return the next numbers of bytes and stay."""
        return np.frombuffer(self.peek(number * self.count_type.itemsize), self.count_type).tolist()

    def whole(self) -> bytes:
        """Return bytes behind their number, in one piece with it."""
        width = self.count_type.itemsize
        return self.take(width + self.counts(1)[0])[width:]

    def unpacked(self, compressor: str) -> bytes:
        """Return packed blocks behind a piece with their number, size, size of the last one, and packed sizes."""
        if compressor not in COMPRESSORS:
            raise ValueError(
                f"its arrays are packed by {compressor[:40]!r}, known are {', '.join(COMPRESSORS)}, or none"
            )
        width = self.count_type.itemsize
        blocks, size, last = self.counts(3)
        if last > size:
            raise ValueError(f"the last block of an array announces {last} bytes, all others {size}")
        if blocks * size > LARGEST_BYTES:
            raise ValueError(f"an array announces {blocks * size} bytes, at most {LARGEST_BYTES} are read")
        packed = np.frombuffer(self.take((3 + blocks) * width), self.count_type)[3:].tolist()
        data, begin, parts = self.take(sum(packed)), 0, []
        for number, length in enumerate(packed, 1):
            wanted = last if last and number == blocks else size
            parts.append(_unpacked(data[begin : begin + length], wanted, compressor))
            begin += length
        return b"".join(parts)


def _unpacked(data: bytes, size: int, compressor: str) -> bytes:
    """Unpack a block, of which no more is made than one byte beyond its size."""
    try:
        if compressor == COMPRESSORS[0]:
            block = zlib.decompressobj().decompress(data, size + 1)
        else:
            block = lzma.LZMADecompressor(memlimit=MEMORY_OF_LZMA).decompress(data, size + 1)
    except (zlib.error, lzma.LZMAError, EOFError) as error:
        raise ValueError(f"a block of an array does not unpack: {error}") from None
    if len(block) != size:
        raise ValueError(
            f"a block of an array announces {size} bytes and has {'more' if len(block) > size else len(block)}"
        )
    return block
