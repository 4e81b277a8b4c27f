"""One change of one source file."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from audits.mutation import ROOT


@dataclass(frozen=True)
class Change:
    """Bytes of a source file that are replaced.

    Parameters
    ----------
    path : str
        Below the root of the checkout.
    start, end : int
        Bytes.
    new : bytes
    kind : str
        "comparison", "constant", "sign", ...
    """

    path: str
    start: int
    end: int
    new: bytes
    kind: str

    @property
    def source(self) -> bytes:
        """The file as it is."""
        return source_of(ROOT / self.path)

    @property
    def mutated(self) -> bytes:
        """The file with the change."""
        return self.source[: self.start] + self.new + self.source[self.end :]

    @property
    def line(self) -> int:
        """Number of the first line that changes."""
        return self.source.count(b"\n", 0, self.start) + 1

    @property
    def texts(self) -> tuple[str, str]:
        """The changed lines before and after, without indentation."""
        first = self.source.rfind(b"\n", 0, self.start) + 1
        last = self.source.find(b"\n", self.end)
        before, after = self.source[first : self.start], self.source[self.end : last]
        old = before + self.source[self.start : self.end] + after
        return " ".join(old.decode().split()), " ".join((before + self.new + after).decode().split())

    @property
    def identity(self) -> str:
        """Digest of the file and of the change in it."""
        place = f"{self.path} {self.start} {self.end}".encode()
        return hashlib.sha256(b"\0".join((place, self.new, self.source))).hexdigest()[:12]


@cache
def source_of(path: Path) -> bytes:
    """Bytes of a file, read once."""
    return path.read_bytes()
