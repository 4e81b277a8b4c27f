"""Snakemake and its stages as one session of processes, which ends as a whole, at once, when the run is interrupted.

Snakemake answers SIGTERM by waiting for its running jobs, and can lock itself out for ever: its handler takes a lock that
the interrupted thread may hold. So nothing here waits for it. What a killed stage leaves is no result, since a result
is renamed into place when it is whole.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

_state = {"interrupted": False, "starting": False, "driven": False}
_running: list[subprocess.Popen[bytes]] = []


def end_on_signals() -> None:
    """Let Ctrl-C, SIGTERM and a closed terminal end the run; the second of them ends it without any clearing up.

    What a command before it in this process did counts no more.
    """
    _state.update(interrupted=False, driven=False)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) is not signal.SIG_IGN:  # nohup, or a shell's background job
            signal.signal(number, _interrupt)


def interrupted() -> str:
    """Return what is true of a command that was interrupted: only a run has stages to keep."""
    return "interrupted" + ("; finished stages are kept, run the same command to continue" if _state["driven"] else "")


def drive(
    command: Sequence[str],
    log: Path,
    follow: Callable[[subprocess.Popen[bytes]], None],
    grace: float = 0.0,
    **options: Any,
) -> int:
    """Run Snakemake in a session of its own and return its exit code; nothing of it is left running.

    `follow` shows the running process and returns when it has ended. `grace` is how many seconds it has to call its jobs
    off a cluster when the run is interrupted. Raises KeyboardInterrupt then; `options` are those of Popen.
    """
    _state["driven"] = True
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("w") as sink:
        _state["starting"] = True  # an exception inside Popen would leave a child that nobody knows
        process = subprocess.Popen(  # noqa: S603, Snakemake's command line as a list, no shell
            command, stdout=sink, stderr=sink, start_new_session=True, **options
        )
        _running.append(process)
        _state["starting"] = False
        try:
            if not _state["interrupted"]:
                follow(process)
        finally:
            if grace and process.poll() is None:
                process.send_signal(signal.SIGINT)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(grace)
            end_session(process)
            process.wait()
            _running.remove(process)
    if _state["interrupted"]:  # wherever the exception was lost
        raise KeyboardInterrupt
    return process.returncode


def _interrupt(number: int, frame: Any) -> None:
    if _state["interrupted"]:
        for process in _running:
            end_session(process)
        os.write(2, f"{interrupted()}\n".encode())
        os._exit(130)
    _state["interrupted"] = True
    if not _state["starting"]:
        raise KeyboardInterrupt


def end_session(process: subprocess.Popen[bytes]) -> None:
    """Kill a process that leads a session, with all that it has started."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)
