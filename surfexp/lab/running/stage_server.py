"""A warm process: all that the stages of a plan import is loaded once, and each stage is a fork of it.

`python -m surfexp.lab.running.stage_server PLAN STATE` reads a line of JSON for each stage, `{"key": ..., "log": ...}`, and
writes one when it has ended: its key, exit code, seconds, processor seconds and peak memory. It has one thread, so that
a fork holds no lock of another, and it ends with its standard input, and all stages with it.
"""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import sys
import time
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from surfexp.lab.plan.plan import Node, Plan, read_plan
from surfexp.lab.registry import registry
from surfexp.lab.running import compiled_code
from surfexp.lab.running.lifetime import die_with_parent
from surfexp.lab.running.planned_code import read_code
from surfexp.lab.running.stage_process import finished, fork_stage
from surfexp.lab.store import store

if TYPE_CHECKING:
    from surfexp.lab.running.recall import Recall

NUMERICS = ("numpy", "scipy.sparse.linalg", "numba")


class Forgetful:
    """In place of `Recall` where numba does not let it look inside: each stage loads compiled code by itself."""

    def tell(self) -> None:
        """Say nothing."""

    def learn(self) -> None:
        """Learn nothing."""


def preload(plan: Plan, missing: list[Node], state: str) -> Recall | Forgetful:
    """Import what the missing stages of one state of the code need: their plugins' files and those of their inputs."""
    compiled_code.use(state)
    files = {plan.nodes[key].file for node in missing for key in (node.key, *node.children)}
    for module in NUMERICS:
        __import__(module)
    for node in missing:
        with contextlib.suppress(Exception):  # as below; what is read is known to all forks
            read_code(plan.nodes, node.key)
    for file in sorted(files):
        with contextlib.suppress(Exception):  # the stage that needs it fails with the reason
            registry.load_file(Path(file))
    return recalled()


def recalled() -> Recall | Forgetful:
    """What this process knows of its stages; nothing where numba has other insides than those that tell."""
    try:
        from surfexp.lab.running.recall import Recall  # which takes numba, whose settings were made here

        return Recall()
    except (ImportError, AttributeError):
        return Forgetful()


class Server:
    """The stages that run, by process id, and where to tell that one has ended."""

    def __init__(
        self, plan_path: Path, plan: Plan, replies: int, missing: list[Node], recall: Recall | Forgetful
    ) -> None:
        self.plan_path, self.plan, self.replies, self.recall = plan_path, plan, replies, recall
        self.awaited = Counter(node.kind for node in missing)
        self.running: dict[int, tuple[str, float]] = {}

    def start(self, request: bytes) -> None:
        """Fork one stage."""
        wanted = json.loads(request)
        child = fork_stage(self.plan_path, self.plan, wanted["key"], Path(wanted["log"]), self.recall.tell)
        self.running[child] = wanted["key"], time.monotonic()
        self.awaited[self.plan.nodes[wanted["key"]].kind] -= 1

    def reap(self) -> None:
        """Tell of every stage that has ended."""
        while self.running:
            child, status, usage = os.wait4(-1, os.WNOHANG)
            if not child:
                return
            key, started = self.running.pop(child)
            try:
                code = finished(self.plan_path, self.plan, key, status, usage)
            except OSError as error:  # of a full disk: the stage has failed, the others may still end
                print(f"what became of {key} cannot be written: {error.strerror}", file=sys.stderr)
                code = 1
            reply = {"key": key, "code": code, "seconds": time.monotonic() - started}
            reply |= {"processor": usage.ru_utime + usage.ru_stime, "memory": usage.ru_maxrss / 1024.0}
            os.write(self.replies, json.dumps(reply).encode() + b"\n")
            if self.awaited[self.plan.nodes[key].kind] > 0:
                self.recall.learn()


def main(plan_path: Path, state: str, parent: int) -> None:
    """Serve until standard input ends, or its parent does."""
    die_with_parent(parent)
    replies = os.dup(1)
    os.set_inheritable(replies, False)
    os.dup2(2, 1)  # what a plugin prints is no reply
    plan = read_plan(plan_path)
    results = plan_path.resolve().parent.parent
    missing = [node for node in plan.nodes.values() if node.cache == state]
    missing = [node for node in missing if not store.is_done(results, node.kind, node.key)]
    server, waiting = Server(plan_path, plan, replies, missing, preload(plan, missing, state)), b""
    ended, tell = os.pipe2(os.O_NONBLOCK)
    signal.signal(signal.SIGCHLD, lambda number, frame: None)
    signal.set_wakeup_fd(tell, warn_on_full_buffer=False)
    while True:
        readable = select.select([0, ended], [], [])[0]
        if ended in readable:
            os.read(ended, 4096)
            server.reap()
        if 0 in readable:
            received = os.read(0, 65536)
            if not received:
                return
            *requests, waiting = (waiting + received).split(b"\n")
            for request in requests:
                server.start(request)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]))
