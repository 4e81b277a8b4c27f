"""A fault and the tests that should catch it."""

from __future__ import annotations

from dataclasses import dataclass

from audits.mutation import ROOT
from audits.mutation.change import Change, source_of


@dataclass(frozen=True)
class Fault:
    """One exact replacement in one file.

    Parameters
    ----------
    name : str
        What is wrong then.
    path : str
        Below the root of the checkout.
    old, new : str
        `old` occurs exactly once.
    tests : tuple of str
        pytest identifiers; at least one has to fail.
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
        source, old = source_of(ROOT / self.path), self.old.encode()
        count = source.count(old)
        if count != 1:
            raise ValueError(f"fault {self.name!r}: {self.old!r} occurs {count} times in {self.path}, not once")
        start = source.index(old)
        return Change(self.path, start, start + len(old), self.new.encode(), "planted")
