"""What commands say on a terminal: names and words of others steer nothing."""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

import click

# control codes, and those that turn the direction of writing; "\r" at the start and "erase to the end" are our own
STEERING = re.compile(
    r"\x1b\[K|(?<=.)\r(?!\n)|[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]"
)


def plain_text(text: str) -> str:
    """Return a text whose control codes are written out.

    Examples
    --------
    >>> plain_text("lh\\x1b[2J.white")
    'lh\\\\x1b[2J.white'
    """
    return STEERING.sub(lambda found: found[0] if found[0] == "\x1b[K" else ascii(found[0])[1:-1], text)


def counted(count: int, noun: str) -> str:
    """Return a number with its noun.

    Examples
    --------
    >>> counted(1, "stage"), counted(0, "stage")
    ('1 stage', '0 stages')
    """
    return f"{count} {noun}{'s' * (count != 1)}"


def echo(message: object = "", nl: bool = True, err: bool = False) -> None:
    """Print a message, of which names and words of others may be a part."""
    click.echo(plain_text(str(message)), nl=nl, err=err)


def say_once(lines: Iterable[str]) -> None:
    """Say each line once on standard error, after the name of the program; empty ones are left out."""
    for line in dict.fromkeys(filter(None, lines)):
        echo(f"surfexp: {line}", err=True)


@contextmanager
def progress_line(label: str) -> Iterator[Callable[[int, float], None]]:
    """Yield a progress callback that keeps one line of the terminal up to date, with the elapsed time; silent without one."""
    started, last = time.monotonic(), [0.0]
    shown = sys.stderr.isatty()

    def report(step: int, rest: float) -> None:
        now = time.monotonic()
        if shown and now - last[0] > 0.2:
            last[0] = now
            echo(f"\r{label}: {step:,}, {rest:.1e} left, {now - started:.0f} s \x1b[K", nl=False, err=True)

    yield report
    if shown and last[0]:
        echo("\r\x1b[K", nl=False, err=True)
