"""A fault and the tests that should catch it."""

from __future__ import annotations

from dataclasses import dataclass


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

    def planted(self, source: str) -> str:
        """Return the source with the fault in it.

        Raises
        ------
        ValueError
            If the text to replace is not there exactly once.
        """
        count = source.count(self.old)
        if count != 1:
            raise ValueError(f"fault {self.name!r}: {self.old!r} occurs {count} times in surfexp/{self.path}, not once")
        return source.replace(self.old, self.new)
