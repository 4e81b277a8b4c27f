"""A stage in a process of its own, forked from one that waits for it: a stage that dies takes nothing else with it.

`python -m surfexp.lab.running.stage_process PLAN KEY` makes one result; `stage_server` forks many from one warm process.
"""

from __future__ import annotations

import contextlib
import json
import os
import resource
import signal
import sys
import traceback
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from surfexp.lab.plan.outcome import event_path
from surfexp.lab.plan.plan import Node, Plan, read_plan
from surfexp.lab.running import stage
from surfexp.lab.running.lifetime import die_with_parent
from surfexp.lab.store import store


def fork_stage(
    plan_path: Path, plan: Plan, key: str, log: Path | None = None, tell: Callable[[], None] = lambda: None
) -> int:
    """Make one result in a child of this process; return its process id.

    Its output goes to `log` where one is given, and `tell` is called there when the result is stored.
    """
    node = plan.nodes[key]
    event_path(plan_path.resolve().parent.parent, node.kind, key).unlink(missing_ok=True)
    sys.stdout.flush()
    sys.stderr.flush()
    parent = os.getpid()
    if child := os.fork():
        return child
    code = 1
    try:
        die_with_parent(parent)
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        if log is not None:
            _write_to(log)
        _limit(plan.settings.resources)
        code = stage.run_stage(plan_path, key, plan)
        tell()
    except BaseException:  # a plugin that calls sys.exit ends here as well
        traceback.print_exc()
    finally:
        with contextlib.suppress(OSError):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(code)


def _limit(resources: Mapping[Any, float | None]) -> None:
    """Let the kernel end this process after its time, and refuse it memory beyond its share; MB are of 10^6 bytes."""
    if seconds := resources.get("time"):
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, seconds)
    if megabytes := resources.get("memory"):
        resource.setrlimit(resource.RLIMIT_DATA, (int(megabytes * 1e6),) * 2)


def finished(plan_path: Path, plan: Plan, key: str, status: int, usage: resource.struct_rusage) -> int:
    """Exit code of a stage from its wait status; one that died without a word gets an event that says how."""
    results, node = plan_path.resolve().parent.parent, plan.nodes[key]
    code = os.waitstatus_to_exitcode(status)
    if not event_path(results, node.kind, key).exists():
        limit = plan.settings.resources.get("time")
        reason = f"it was ended after {limit:g} s, the limit resources.time" if code == -signal.SIGALRM else death(code)
        write_death(results, node, reason, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024.0)
        return 1
    return 1 if code else 0


def death(code: int) -> str:
    """How a process ended that did not say why itself; `code` is negative for a signal."""
    if code >= 0:
        return f"its process ended with exit code {code} before there was a result"
    names = {number.value: number.name for number in signal.Signals}
    memory = ", as the kernel does when memory is short" if -code == signal.SIGKILL else ""
    return f"its process was killed by signal {-code} ({names.get(-code, 'unnamed')}){memory}"


def write_death(results: Path, node: Node, reason: str, seconds: float = 0.0, memory: float = 0.0) -> None:
    """Write the event of a stage whose process died."""
    event = {"kind": node.kind, "plugin": node.plugin, "failure": f"{node.kind}/{node.plugin}: {reason}"}
    event_path(results, node.kind, node.key).with_suffix(".progress").unlink(missing_ok=True)
    measured = {"seconds": seconds, "peak_memory_mb": memory, "warnings": []}
    store.write_text(event_path(results, node.kind, node.key), json.dumps(event | measured, indent=1))


def _write_to(log: Path) -> None:
    log.parent.mkdir(parents=True, exist_ok=True)
    descriptor = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
    os.dup2(descriptor, 1)
    os.dup2(descriptor, 2)
    os.close(descriptor)


def main(plan_path: Path, key: str) -> int:
    """Make one result and return the exit code; the child's death is named."""
    die_with_parent(os.getppid())
    plan = read_plan(plan_path, key)
    _, status, usage = os.wait4(fork_stage(plan_path, plan, key), 0)
    return finished(plan_path, plan, key, status, usage)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2]))
