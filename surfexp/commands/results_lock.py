"""The lock of a results folder: one run at a time works there."""

from __future__ import annotations

import fcntl
import os
from pathlib import Path

from surfexp.commands.terminal import echo, say_once
from surfexp.lab.errors import UserError

HELD = "SURFEXP_HOLDS_RESULTS"
locks: list[int] = []


def hold_results(results: Path, wait: bool = False) -> None:
    """Take the results folder for this process; a second run waits for it, or is refused when `wait` is false."""
    if os.environ.get(HELD) or locks:
        return
    results.mkdir(parents=True, exist_ok=True)
    descriptor = os.open(results / ".lock", os.O_RDWR | os.O_CREAT)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        if not wait:
            os.close(descriptor)
            raise UserError(f"results folder {results} is in use by another run; wait for it to end") from None
        echo(f"{results} is in use by another run; waiting for it to end", err=True)
        fcntl.flock(descriptor, fcntl.LOCK_EX)
    except OSError as error:  # of a file system without locks
        say_once([f"{results} cannot be locked ({error.strerror}): let one run at a time work there"])
    locks.append(descriptor)
