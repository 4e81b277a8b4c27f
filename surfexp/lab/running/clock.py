"""Processor seconds of a call, without those in which numba compiles or loads what the call needs for the first time."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from typing import Any

COMPILER = "numba:compiler_lock"


@dataclass
class Clock:
    """What a block has taken, once it has ended.

    Attributes
    ----------
    seconds : float
        Processor seconds of this process, less those of the compiler.
    compiling : float
        Processor seconds of the compiler, which only a first call takes.
    """

    seconds: float = 0.0
    compiling: float = 0.0


@contextmanager
def clocked() -> Iterator[Clock]:
    """Clock a block.

    Examples
    --------
    >>> with clocked() as clock:
    ...     total = sum(range(1000))
    >>> clock.seconds >= 0.0 == clock.compiling
    True
    """
    clock = Clock()
    with ExitStack() as scope:
        started = time.process_time()
        if "numba" in sys.modules:
            with suppress(ImportError):
                from numba.core import event

                scope.enter_context(event.install_listener(COMPILER, _listener(event.Listener, clock)))
        try:
            yield clock
        finally:
            clock.seconds = max(0.0, time.process_time() - started - clock.compiling)


def _listener(base: Any, clock: Clock) -> Any:
    """What numba tells of its compiler, which may start inside itself."""

    class Compiler(base):
        depth, since = 0, 0.0

        def on_start(self, event: Any) -> None:
            if self.depth == 0:
                self.since = time.process_time()
            self.depth += 1

        def on_end(self, event: Any) -> None:
            self.depth -= 1
            if self.depth == 0:
                clock.compiling += time.process_time() - self.since

    return Compiler()
