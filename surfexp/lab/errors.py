"""Errors that a person can act on: one line, an exit code, the nearest valid choice."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class UserError(Exception):
    """A mistake in what was asked for; the command line prints it in one line and exits with 2."""


class DamagedResult(UserError):
    """A stored result that is not what was written; the next run removes it and computes it again."""


class StageFailure(Exception):
    """A stage that ran and failed; the command line prints it in one line and exits with 1."""


def check_known(thing: str, names: Iterable[str], choices: Iterable[str]) -> None:
    """Raise `unknown` for the first name that is no choice."""
    for name in names:
        if name not in choices:
            raise unknown(thing, str(name), choices)


def unknown(thing: str, name: str, choices: Iterable[str]) -> UserError:
    """Say that `name` does not exist and what comes nearest."""
    known = sorted(choices)
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    hint = f"did you mean {near[0]!r}?" if near else f"choose from: {', '.join(known) or 'none'}"
    return UserError(f"unknown {thing} {name!r}; {hint}")
