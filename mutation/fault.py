"""A fault and the tests that should catch it."""

from __future__ import annotations

from dataclasses import dataclass

from mutation import ROOT
from mutation.change import Change, source_of


@dataclass(frozen=True)
class Fault:
    """One exact replacement in one file.

    Parameters
    ----------
    name : str
        What is wrong then.
    path : str
        Below `surfexp/`.
    old, new : str
        `old` occurs exactly once.
    tests : tuple of str
        pytest identifiers below `tests/`; at least one has to fail.
    """

    name: str
    path: str
    old: str
    new: str
    tests: tuple[str, ...]

    @property
    def change(self) -> Change:
        """The replacement in the file.

        Raises
        ------
        ValueError
            If the text to replace is not there exactly once.
        """
        path = f"surfexp/{self.path}"
        source, old = source_of(ROOT / path), self.old.encode()
        count = source.count(old)
        if count != 1:
            raise ValueError(f"fault {self.name!r}: {self.old!r} occurs {count} times in {path}, not once")
        start = source.index(old)
        return Change(path, start, start + len(old), self.new.encode(), "planted")
