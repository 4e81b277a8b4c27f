"""Legacy VTK files as a stream of lines and numbers, in text or big-endian bytes."""

from __future__ import annotations

import re
from urllib.parse import quote, unquote

import numpy as np
from numpy.typing import NDArray

TYPES = {"float": "f4", "double": "f8", "int": "i4", "long": "i8", "vtktypeint64": "i8", "vtktypeint32": "i4"}
TYPES |= {"unsigned_char": "u1", "char": "i1", "short": "i2", "unsigned_short": "u2", "unsigned_int": "u4"}
TYPES |= {"signed_char": "i1", "unsigned_long": "u8", "vtktypeuint64": "u8", "vtktypeuint32": "u4", "bit": "u1"}
# vtkIdType is written as int, whatever it is in memory
TYPES |= {"vtkidtype": "i4", "long_long": "i8", "unsigned_long_long": "u8"}


# what VTK leaves as it is in a name: all that is printed in ASCII but the quotation mark and the percent sign
PLAIN = "".join(chr(code) for code in range(33, 127) if chr(code) not in '"%')


def name_to_word(name: str) -> str:
    """Return the name of an array as one word, in which VTK writes a space as %20."""
    return quote(name, safe=PLAIN)


def word_to_name(word: str) -> str:
    """Return the name that a word stands for."""
    return unquote(word)


class LegacyVtk:
    """A legacy file read piece by piece: lines of words, then numbers as text or big-endian bytes."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0
        head = [self._raw_line() for _ in range(3)]  # the title, the second of them, may be empty
        version = re.match(r"# vtk datafile version (\d{1,3})\.", head[0], re.I)
        if not version or head[2].upper() not in ("ASCII", "BINARY"):
            raise ValueError("it has no header of a legacy VTK file")
        self.major, self.binary = int(version[1]), head[2].upper() == "BINARY"

    def line(self) -> str:
        """Return the next line that is not empty, or nothing at the end."""
        while self.at < len(self.data):
            if line := self._raw_line():
                return line
        return ""

    def _raw_line(self) -> str:
        stop = self.data.find(b"\n", self.at)
        stop = len(self.data) if stop < 0 else stop
        line, self.at = self.data[self.at : stop].decode("latin-1").strip(), stop + 1
        return line

    def numbers(self, count: int, kind: str) -> NDArray[np.generic]:
        """Return the next `count` numbers of a type."""
        if kind.lower() == "bit" and self.binary:
            packed = self.numbers((count + 7) // 8, "unsigned_char").astype(np.uint8)
            return np.unpackbits(packed)[:count]
        if kind.lower() not in TYPES:
            raise ValueError(f"it has numbers of type {kind[:20]!r}, known are {', '.join(TYPES)}")
        dtype = np.dtype(TYPES[kind.lower()])
        if count < 0 or count * (dtype.itemsize if self.binary else 2) > len(self.data) - self.at + 1:
            raise ValueError(f"it ends before {count} numbers that it announces")
        if self.binary:
            found = np.frombuffer(self.data, dtype.newbyteorder(">"), count, self.at)
            self.at += count * dtype.itemsize
            return found.astype(dtype)
        words: list[str] = []
        while len(words) < count:
            line = self.line()
            if not line:
                raise ValueError(f"it ends after {len(words)} of {count} numbers")
            words += line.split()
        if len(words) > count:
            raise ValueError(f"it has {len(words)} numbers where {count} are announced")
        return np.array(words, dtype=np.float64).astype(dtype)

    def skip_metadata(self) -> None:
        """Pass over what is said of an array or the data set, to the next empty line."""
        while self.at < len(self.data) and self._raw_line():
            pass

    def peek(self) -> list[str]:
        """Return the words of the next line without going on."""
        at = self.at
        words = self.line().split()
        self.at = at
        return words

    def skip_strings(self, count: int) -> None:
        """Pass over so many pieces of text: one a line, or behind their length in 1, 2, 4 or 8 bytes."""
        for _ in range(count):
            if self.at >= len(self.data):
                raise ValueError(f"it ends before {count} pieces of text that it announces")
            if not self.binary:
                self._raw_line()
                continue
            size = {3: 1, 2: 2, 1: 4, 0: 8}[self.data[self.at] >> 6]
            length = int.from_bytes(self.data[self.at : self.at + size], "big") & ((1 << (8 * size - 2)) - 1)
            self.at += size + length
        if self.at > len(self.data) + 1:
            raise ValueError(f"it ends before {count} pieces of text that it announces")

    def named(self, name: str, count: int) -> list[int]:
        """Return `count` whole numbers behind a line with this name and their type."""
        line = self.line().split()
        if len(line) != 2 or line[0].upper() != name:
            raise ValueError(f"it has {' '.join(line)[:40]!r} where {name} and a type are needed")
        return self.numbers(count, line[1]).astype(np.int64).tolist()
