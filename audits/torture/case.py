"""One thing that goes wrong, and how it ended."""

from __future__ import annotations

import faulthandler
import os
import re
import resource
import selectors
import signal
import sys
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

REFUSED, REPAIRED, RIGHT, UNKNOWABLE = "refused clearly", "repaired", "right", "nobody can tell"
WRONG, HUNG = "wrong", "hung"
OUTCOMES = (REFUSED, REPAIRED, RIGHT, UNKNOWABLE, WRONG, HUNG)
SECONDS, BYTES = 10.0, 2**30
LONGEST_LINE = 300
# the line of an exception that nobody foresaw
UNFORESEEN = re.compile(r"unexpected \w+ in \S*\.py:\d+|Traceback")


@dataclass(frozen=True)
class Ended:
    """How a case ended.

    Parameters
    ----------
    kind, name : str
        Of the fault.
    outcome : str
        One of OUTCOMES.
    said : str
        The line that was said, or what is wrong.
    seconds : float
    """

    kind: str
    name: str
    outcome: str
    said: str
    seconds: float = 0.0


def clear(message: str) -> str:
    """Return what is wrong with a refusal as a person reads it; empty where nothing is."""
    if not message.strip():
        return "says nothing"
    if "\n" in message.strip():
        return f"has several lines: {message.strip()[:200]!r}"
    if len(message) > LONGEST_LINE:
        return f"has {len(message)} characters: {message[:200]!r}"
    if UNFORESEEN.search(message):
        return f"is no explanation: {message!r}"
    return ""


def in_a_child(
    kind: str, name: str, work: Callable[[], tuple[str, str]], seconds: float = SECONDS, memory: int = BYTES
) -> Ended:
    """Run a case in a forked process with limits of time and memory; `work` returns outcome and line.

    A ValueError is a refusal, judged by its line; any other exception or a signal is wrong. More memory than the limit
    is refused by the system.
    """
    reading, writing = os.pipe()
    begin = time.monotonic()
    child = os.fork()
    if child == 0:
        os.close(reading)
        _limit_memory(memory)
        _answer(work, writing)
    os.close(writing)
    text = _read(reading, seconds)
    if text is None:
        os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    os.close(reading)
    spent = time.monotonic() - begin
    if text is None:
        return Ended(kind, name, HUNG, f"not done after {seconds:g} s", spent)
    outcome, _, said = text.partition("\n")
    if status != 0 or not outcome:
        return Ended(kind, name, WRONG, f"the process ended with status {status}", spent)
    return Ended(kind, name, outcome, said, spent)


def _limit_memory(more: int) -> None:
    """Let this process take so many bytes more than it has."""
    facts = Path("/proc/self/status").read_text()
    own = int(facts.partition("VmData:")[2].split()[0]) * 1024
    resource.setrlimit(resource.RLIMIT_DATA, (own + more, resource.RLIM_INFINITY))


def _answer(work: Callable[[], tuple[str, str]], writing: int) -> None:
    faulthandler.disable()  # a crash on purpose is an outcome, told by the status
    try:
        sys.stdout = sys.stderr = Path(os.devnull).open("w")  # noqa: SIM115, the process ends soon
        outcome, said = work()
    except ValueError as error:
        wrong = clear(str(error))
        outcome, said = (WRONG, f"the refusal {wrong}") if wrong else (REFUSED, str(error))
    except BaseException as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        outcome, said = WRONG, f"{type(error).__name__}: {error} ({place.filename}:{place.lineno})"
    with os.fdopen(writing, "w", errors="replace") as pipe:
        pipe.write(f"{outcome}\n{said}")
    os._exit(0)


def _read(pipe: int, seconds: float) -> str | None:
    """Everything until the other end is closed, or None where that takes too long."""
    parts: list[bytes] = []
    limit = time.monotonic() + seconds
    with selectors.DefaultSelector() as selector:
        selector.register(pipe, selectors.EVENT_READ)
        while True:
            if not selector.select(max(limit - time.monotonic(), 0.0)):
                return None
            part = os.read(pipe, 65536)
            if not part:
                return b"".join(parts).decode(errors="replace")
            parts.append(part)
